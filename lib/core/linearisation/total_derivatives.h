/* total_derivatives.h: F and its total derivatives along a curve.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_TOTAL_DERIVATIVES_H
#define STF_TOTAL_DERIVATIVES_H

#include "curve.h"

/* Nodes delta * (node - at), in sigma; 0: none. */
typedef struct stf_window {
  sunrealtype delta, at;
  bool beyond; /* wider than the part between two breaks, of equations without t */
} stf_window;

/* F and its derivatives along a curve, each order with the nodes that serve it best: they lie between two breaks of the
 * problem, but of equations that do not depend on t. */
typedef struct stf_total_derivatives {
  stf_point *point;
  stf_chebyshev rule;
  int order;
  bool exact;                         /* by point->taylor */
  bool narrow;                        /* some would lie wider but for breaks, ... */
  sunrealtype noise;                  /* ... by which derivatives are off, over their scale */
  stf_window window[STF_DEEPEST + 2]; /* of orders 1 .. order */
  sunrealtype fastest, slowest;
  sunrealtype *values, *still, *rows, *tail;
} stf_total_derivatives;
int stf_total_derivatives_open(stf_pool *pool, stf_point *point, int order,
                               stf_total_derivatives *ladder);
/* Choose nodes on this curve; scale: sizes of the terms of the equations; order[i] of
 * equation i, or NULL: all. */
int stf_total_derivatives_choose(stf_total_derivatives *ladder, const stf_curve *curve,
                                 const sunrealtype *scale, const int *order);
/* Do the nodes chosen lie about t, between two breaks? */
bool stf_total_derivatives_fit(const stf_total_derivatives *ladder, const stf_curve *curve);
/* out: (order + 1) x n Taylor coefficients by rows. */
int stf_total_derivatives_evaluate(stf_total_derivatives *ladder, const stf_curve *curve,
                                   sunrealtype *out);

#endif
