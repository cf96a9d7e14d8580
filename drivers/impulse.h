/* impulse.h: the start of a descriptor system, and the run that follows.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef IMPULSE_H
#define IMPULSE_H

#include "linear.h"
#include "run.h"

/* The start as fields of a report. */
void impulse_fill(steif_report *r, const struct linear *l, const steif_impulse *i);
/* Under "derivatives_accuracy", orders 1, 2, ...: that of samples. */
void impulse_accuracy(steif_report *r, const struct linear *l, const steif_impulse *i);
/* One row of a sheet with columns t, kind and x, or instead of x one for each name. */
void impulse_row(steif_report *r, const char *sheet, const char *const *name, const char *kind,
                 double t, size_t n, const double *x);
/* The rows of such a sheet: x-, c0, c1, ..., x+ of one jump. */
void impulse_rows(steif_report *r, const char *sheet, const char *const *name, double t,
                  const double *before, const steif_impulse *i);
/* The names of unknowns fit for columns beside t and kind; NULL: none. */
const char *const *impulse_columns(const struct linear *l);
/* Under "vs.": how far `method` comes from the same x(0-). */
void impulse_against(const struct call *call, const struct linear *l, const char *method,
                     steif_report *r);
/* Of systems with an output y = C x + D u: y(0+) and its impulses; y at t where x is known. */
void impulse_outputs(steif_report *r, const struct linear *l, const steif_impulse *i);
void impulse_output(steif_report *r, const char *name, const struct linear *l, double t,
                    const double *x);
/* EXIT_UNCERTIFIED after a sentence, or EXIT_OK. */
int impulse_verdict(const struct call *call, const steif_impulse *i);

/* Every descriptor system of the collection beside --vs; an exit code. */
int impulse_all(struct call *call);
/* Is the word a problem without a pencil of its own? Then it is opened, and impulse_jump closes it. */
bool impulse_is_nonlinear(struct call *call, steif_problem *problem);
/* Its jump; an exit code. */
int impulse_jump(struct call *call, steif_problem *problem);
/* Trajectory, jumps and impulses up to --t1 by --method; an exit code. */
int impulse_run(struct call *call, struct linear *l);

#endif
