/* tangent.h: a problem with one solution w of its variational equation, as a problem to solve.
 *
 *   z = (y, w),  M y' = f(t, y),   M w' = J(t, y) w,        J = df/dy,  M = I or constant;
 *                F(t, y, y') = 0,  F_y w + F_y' w' = 0;
 * Newton's matrix is block diagonal. Where f or F is linear and homogeneous, z = w = y.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_TANGENT_H
#define STF_TANGENT_H

#include "base.h"
#include <steif/problem.h>

typedef struct stf_tangent {
  steif_context *ctx;
  const steif_problem *problem;
  int form;
  bool direct;
  sunindextype n;
  sunrealtype rtol, atol;
  steif_problem pair;                    /* y0 and t0 are the caller's to set */
  N_Vector y, fy, yp, w, fw, wp;         /* views */
  N_Vector scratch[3], turn, part, side; /* room for callbacks and products */
  SUNMatrix J, E;
} stf_tangent;

int stf_tangent_open(stf_pool *pool, steif_context *ctx, const steif_problem *problem,
                     stf_tangent *tangent);
/* Error weights of the pair: rtol |y_i| + atol, and rtol |w| for all of w. */
int stf_tangent_weights(N_Vector z, N_Vector ewt, void *tangent);
/* w into z: y0, or ones where that is 0; after a step of backward Euler with y at rest,
 * so short that it moves algebraic components alone. */
int stf_tangent_begin(stf_tangent *tangent, sunrealtype *z);
/* |w|, Euclidean. */
sunrealtype stf_tangent_size(const stf_tangent *tangent, const sunrealtype *z);

#endif
