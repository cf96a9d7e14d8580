/* total_derivatives.h: F and its total derivatives along a curve.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_TOTAL_DERIVATIVES_H
#define STF_TOTAL_DERIVATIVES_H

#include "curve.h"

/* F and its derivatives along a curve, each order with the node distance that serves it
 * best. */
typedef struct stf_total_derivatives {
  stf_point *point;
  stf_chebyshev rule;
  int order;
  bool exact;                         /* by point->taylor */
  sunrealtype delta[STF_DEEPEST + 2]; /* of orders 1 .. order, in sigma */
  sunrealtype fastest, slowest;
  sunrealtype *values, *rows, *tail;
} stf_total_derivatives;
int stf_total_derivatives_open(stf_pool *pool, stf_point *point, int order,
                               stf_total_derivatives *ladder);
/* Choose delta on this curve; scale: sizes of the terms of the equations; order[i] of
 * equation i, or NULL: all. */
int stf_total_derivatives_choose(stf_total_derivatives *ladder, const stf_curve *curve,
                                 const sunrealtype *scale, const int *order);
/* out: (order + 1) x n Taylor coefficients by rows. */
int stf_total_derivatives_evaluate(stf_total_derivatives *ladder, const stf_curve *curve,
                                   sunrealtype *out);

#endif
