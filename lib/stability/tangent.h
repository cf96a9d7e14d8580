/* tangent.h: y' = f(t, y) with one solution w of its variational equation, as a problem to solve.
 *
 *   z = (y, w),  z' = (f(t, y), J(t, y) w),  Newton's matrix diag(J, J);
 * where f is linear and homogeneous, z = w = y.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_TANGENT_H
#define STF_TANGENT_H

#include "base.h"
#include <steif/problem.h>

typedef struct stf_tangent {
  steif_context *ctx;
  const steif_problem *problem;
  bool direct;
  sunindextype n;
  sunrealtype rtol, atol;
  steif_problem pair;                /* y0 and t0 are the caller's to set */
  N_Vector y, fy, w, fw, scratch[3]; /* views, and room for callbacks */
  SUNMatrix J;
} stf_tangent;

int stf_tangent_open(stf_pool *pool, steif_context *ctx, const steif_problem *problem,
                     stf_tangent *tangent);
/* Error weights of the pair: rtol |y_i| + atol, and rtol |w| for all of w. */
int stf_tangent_weights(N_Vector z, N_Vector ewt, void *tangent);
/* |w|, Euclidean. */
sunrealtype stf_tangent_size(const stf_tangent *tangent, const sunrealtype *z);

#endif
