/* curve.h: Taylor coefficients of F, E and B along a polynomial curve.
 *
 * Derivatives are kept as Taylor coefficients in sigma = (t - t*)/tau: y(sigma) = sum z_k sigma^k,
 * z_k = tau^k y^(k)/k!, F(sigma) = sum F_k sigma^k along that curve.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_CURVE_H
#define STF_CURVE_H

#include "linearisation.h"

enum {
  STF_DEEPEST = 4,          /* differentiations of the derivative array */
  STF_CHEBYSHEV_NODES = 16, /* of an interpolant, at most */
};

/* Functionals of a fit through m nodes: weight[q * m + i] gives coefficient q <= order of the expansion about `at`, a
 * place among the nodes, 0 at first: the curve's t. */
typedef struct stf_chebyshev {
  int m, order;
  sunrealtype at;
  sunrealtype node[STF_CHEBYSHEV_NODES]; /* in (-1, 1) */
  sunrealtype middle[STF_DEEPEST + 3];   /* sums of |weight| about 0 */
  sunrealtype weight[(STF_DEEPEST + 3) * STF_CHEBYSHEV_NODES], tail[2 * STF_CHEBYSHEV_NODES];
} stf_chebyshev;
void stf_chebyshev_open(stf_chebyshev *rule, int m, int order);
void stf_chebyshev_about(stf_chebyshev *rule, sunrealtype at);
/* How much larger errors of values become in coefficient q than about 0. */
sunrealtype stf_chebyshev_growth(const stf_chebyshev *rule, int q);

typedef struct stf_curve {
  sunrealtype t, tau;
  int count;      /* coefficients z_0 .. z_{count-1} */
  sunrealtype *z; /* count x n by rows */
  bool still;     /* F is asked for at t along all of it */
} stf_curve;
void stf_curve_at(const stf_curve *curve, size_t n, sunrealtype sigma, sunrealtype *y,
                  sunrealtype *yp);
/* Half the length of the part between two breaks where the curve's t lies. */
sunrealtype stf_curve_room(const stf_point *point, const stf_curve *curve);
/* The place of t among nodes that lie in this part: 0 in their middle, -1 and 1 at its ends; delta is not above its room. */
sunrealtype stf_curve_place(const stf_point *point, const stf_curve *curve, sunrealtype delta);
/* Coefficients F_0 .. F_order (rows of out, or NULL) over nodes delta * (node - at); tail (n, or NULL): size of the last
 * two Chebyshev coefficients. `values`: m n. Times beyond a break become those next to it. */
int stf_curve_residual(stf_point *point, const stf_curve *curve, const stf_chebyshev *rule,
                       sunrealtype delta, sunrealtype *values, sunrealtype *out,
                       sunrealtype *tail);
/* Coefficients of E and B, order + 1 matrices each, delta chosen by their variation. */
int stf_curve_matrices(stf_point *point, const stf_curve *curve, stf_chebyshev *rule,
                       sunrealtype *nodes, sunrealtype *E, sunrealtype *B, sunrealtype *delta);

#endif
