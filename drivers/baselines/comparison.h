/* comparison.h: methods on one problem at several tolerances.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef COMPARISON_H
#define COMPARISON_H

#include "curves.h"

typedef struct comparison {
  steif_problem problem;
  steif_report *report;
  work_curves work;
  size_t good;            /* runs that came to the end */
  steif_problem given;    /* as it was found */
  sunrealtype *start;     /* consistent, instead of the given one; NULL: none */
  int *number;            /* index of each component, where it was found; NULL: as given */
  steif_reference own;    /* end values made for a problem of which nothing is known */
  double *values, *check; /* y(t1) and that of the second run; NULL: not made */
} comparison;

/* One policy for the rows of all methods, baselines among them: an inconsistent start of a DAE is repaired
 * once (--initial), which the report tells, and each method takes it as it is. */
int compare_start(struct call *call, comparison *c);
void compare_end(struct call *call, comparison *c);

/* End values where the problem has none for this t1, by two tight runs, told as "reference". A row shows no more
 * digits than these agree to. */
void own_reference(struct call *call, comparison *c);
void own_digits(struct call *call, const comparison *c, const steif_options *o, outcome *out);

/* Rows of one method; of a baseline with several settings the best at each tolerance, and all of them in the
 * sheet "settings". */
void compare_method(struct call *call, comparison *c, const char *method);

#endif
