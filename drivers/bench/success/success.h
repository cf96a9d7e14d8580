/* success.h: what runs are worth that say ok.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef SUCCESS_H
#define SUCCESS_H

#include "program.h"

/* One run of a method. */
typedef struct success_run {
  char problem[STEIF_SPEC_WORD];
  sunrealtype rtol, cpu_s;
  sunrealtype
    error; /* at the end, in tolerances: max |y_i - known_i| / (rtol (scale + |known_i|)) */
  sunrealtype whole;    /* the largest over all steps; NAN: no solution in closed form */
  sunrealtype levels;   /* that of the components of index 2 and 3, which `error` leaves out */
  sunrealtype promised; /* what the run says of them; NAN: nothing */
  int code;
  bool late; /* ended by --longest */
  bool told; /* ok, but the run says that rounding is above its tolerance */
  long steps;
} success_run;

/* The runs of one method. */
enum { SUCCESS_RUNS = 4000 };
typedef struct success_runs {
  const char *method;
  size_t count;
  success_run run[SUCCESS_RUNS];
} success_runs;

/* What they come to; the rows of the report, and every run that is worth looking at. */
void success_report(success_runs *all, bool every, steif_report *r);

#endif
