/* gradient_terms.h: sums of components and of their squares, as users write them: 0.5*y1^2+y3.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef GRADIENT_TERMS_H
#define GRADIENT_TERMS_H

#include "program.h"

enum { TERMS = 64 };
struct sum {
  int count;
  struct {
    double factor;
    sunindextype component;
    int power; /* 1 or 2 */
  } term[TERMS];
};
/* false: the text is no such sum. */
bool sum_read(const steif_problem *p, const char *text, struct sum *sum);
double sum_at(const struct sum *sum, const double *y);
/* slope += by y. */
void sum_slope(const struct sum *sum, const double *y, double *slope);

#endif
