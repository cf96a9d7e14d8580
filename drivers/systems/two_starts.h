/* two_starts.h: the nearest consistent values, which `steif diagnose` proposes, beside x(0+), to which the
 * equations lead with their impulses: `steif impulse`.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef TWO_STARTS_H
#define TWO_STARTS_H

#include "descriptor.h"

enum { TWO_STARTS_TEXT = 640 };

/* Why `nearest` and `plus` differ, or that they agree; n values each. */
void two_starts_compare(const char *const *name, size_t n, const double *nearest,
                        const double *plus, char text[TWO_STARTS_TEXT]);
/* The same for the start of a problem; text[0] = 0 where there is no x(0+) that is sure. */
void two_starts_of_problem(struct call *call, const steif_problem *p, const double *nearest,
                           char text[TWO_STARTS_TEXT]);
/* The same for a small system and its x(0+); text[0] = 0 where there are no nearest values. */
void two_starts_of_system(struct call *call, const struct descriptor *l, const double *plus,
                          char text[TWO_STARTS_TEXT]);

#endif
