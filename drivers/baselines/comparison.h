/* comparison.h: methods on one problem at several tolerances.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef COMPARISON_H
#define COMPARISON_H

#include "curves.h"

typedef struct comparison {
  steif_problem problem;
  steif_report *report;
  work_curves work;
  size_t good; /* runs that came to the end */
} comparison;

/* Rows of one method; of a baseline with several settings the best at each tolerance, and all of them in the
 * sheet "settings". */
void compare_method(struct call *call, comparison *c, const char *method);

#endif
