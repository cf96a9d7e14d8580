/* nearest.h: the nearest point on r(z) = 0.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_NEAREST_H
#define STF_NEAREST_H

#include "linearisation.h"

/* Least movement: minimise sum (weight_j (z_j - target_j))^2 subject to r(z) = 0 by Gauss-
 * Newton with damping; target NaN: stay near the current value. Rows need not be
 * independent. */
typedef struct stf_nearest_point {
  steif_context *ctx;
  size_t rows, columns;
  sunrealtype *z, *target, *weight, *unit; /* unit: sizes of z for the test of convergence */
  int (*residual)(void *data, const sunrealtype *z, sunrealtype *r);
  int (*jacobian)(void *data, const sunrealtype *z, sunrealtype *J);
  void (*prepare)(void *data,
                  struct stf_nearest_point *move); /* fill z, target, weight, unit */
  int (*accept)(void *data,
                struct stf_nearest_point *move); /* take the solution, or say why not */
  void *data;
  int most; /* iterations */
  int iterations;
  bool converged;
  size_t rank;
  sunrealtype rcond;                      /* smallest kept singular value over the largest */
  sunrealtype *r, *J, *U, *VT, *s, *left; /* at the end: r and J at z, U of the scaled J */
  sunrealtype *work;
} stf_nearest_point;
/* From memory to acceptance; a callback that asks for another point becomes a sentence. */
int stf_nearest_point_find(stf_point *point, stf_nearest_point *move);

#endif
