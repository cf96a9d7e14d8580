/* settings.h: a baseline in every setting that its package allows, and the best of them.
 *
 * IDA can be told which components its error test leaves out (IDASetId, IDASetSuppressAlg) and to change its
 * start first (IDACalcIC). What a DAE needs is not known beforehand, and a return code does not tell whether
 * the answer is right: so all settings run, and errors against the solution decide. Words of the verdict, with
 * errors in the maximum norm against `far`, 100 times the larger of atol and rtol times the largest component of the
 * solution:
 *   right                         the errors at 0+ and t1 are below far
 *   late right                    x at 0+ is off by more, its slow part is not, and x(t1) is right
 *   success with a wrong jump     code 0, but the slow part of x at 0+, which remembers, is wrong; without a
 *                                 pencil: x at 0+ and at t1 are wrong
 *   less than asked               code 0, but x(t1) is off by more than far
 *   success with no right digit   code 0, but x(t1) is off by more than its size
 *   stops                         t1 is not reached
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef SETTINGS_H
#define SETTINGS_H

#include "integration.h"

enum { SETTINGS_MOST = 6 };

/* The solution as far as it is known by other means than the baseline. */
typedef struct known_solution {
  size_t n;
  double *plus, *end;         /* x(0+), x(t1); NULL: not known */
  double *slow;               /* room for n numbers */
  double size_plus, size_end; /* of their largest components */
  bool pencil;                /* of a linear system: slow parts can be told */
  steif_linear system;
  steif_structure structure; /* of it */
  char source[80];           /* what x(t1) is from; "" */
  int index;                 /* of the DAE; -1: not known */
} known_solution;

/* x(t1) from the closed solution, the published one where it has the digits, or runs of steif that agree to
 * more digits than rtol; x(0+) by steif_impulse_find or steif_jump_find. known_close in any case. */
void known_open(const struct call *call, const steif_problem *p, const steif_options *o,
                known_solution *known);
void known_close(const struct call *call, known_solution *known);

typedef struct setting_run {
  char spec[STEIF_SPEC_WORD];
  outcome out;
  char word[32];           /* the package's own: IDA_SUCCESS, IDA_ERR_FAIL */
  double start, slow, end; /* errors of x at 0+, of its slow part, of x at t1; NaN: not known */
  const char *verdict;     /* "": not known */
} setting_run;

typedef struct settings {
  double rtol, atol;
  size_t count;                   /* at least 1 */
  setting_run run[SETTINGS_MOST]; /* by their verdicts, then their errors at t1 and at 0+ */
} settings;

/* "ida" alone asks for all settings of IDA that make a difference for a DAE of this index; every other spec
 * is a setting itself. At most 300 000 steps and 60 seconds a run, where the options do not say less. */
bool settings_many(const char *method, const steif_problem *p);
/* Setting i of IDA, NULL past the last. */
const char *settings_at(size_t i);
void settings_run(const struct call *call, const steif_problem *p, const char *method,
                  const steif_options *o, const known_solution *known, settings *s);

/* Rows of the sheet `sheet`: one for each run. */
void report_settings(steif_report *r, const char *sheet, const char *problem,
                     const settings *s);
/* Under `prefix` the best of them: settings, errors, digits, verdict. */
void report_best(steif_report *r, const char *prefix, const settings *s);

#endif
