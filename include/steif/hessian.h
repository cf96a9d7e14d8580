/* steif/hessian.h: second derivatives of functionals of a solution, times a direction.
 *
 *     steif_direction *d = steif_direction_new(ctx, &problem, v, NULL);
 *     steif_gradient g = {0};
 *     sunrealtype Hv[3];
 *     if (!steif_hessian_product(ctx, d, "radau:s=3", &options, &J, &g, Hv, NULL)) use(g.dp, Hv);
 *     steif_gradient_free(ctx, &g), steif_direction_free(&d);
 *
 * Along p + theta v, y0 + theta u (direction.h) the gradient of gradient.h changes by
 *   d/dtheta dJ/dp = J_pp v + J_py0 u,   d/dtheta dJ/dy0 = J_y0p v + J_y0y0 u,
 * start values that follow p included. No Hessian is formed: one run, one sweep forward that carries Y' = dY/dtheta
 * through the stages, one sweep back with lambda and lambda',
 *   K^T w = r,   K^T w' = r' - K'^T w,
 * on the same mesh. So Hv is the derivative of the gradient that the run itself has, and symmetric, but for the
 * derivatives of products that K' is made of: those of F_y^T w, F_y'^T w, F_p^T w and of the functional's slopes with w
 * held are differences along (Y', v) of two lengths, extrapolated: to about 1e-11 relative with jac (idajac, E and A), dFdp
 * and functional.slopes, to about 1e-6 where one of these is left to differences.
 *
 * Costs beside those of a gradient: one factorisation of the stages' matrix a step, and at each stage four more fills of
 * the matrices and evaluations of F_p^T w; records of steps are twice as long.
 *
 * Krylov storage: by Atv and Etv at the points of the differences, and exact Av (STEIF_UNSUPPORTED without it, or matrices).
 *
 * Methods, problems, checks of derivatives and codes are those of steif_gradient_find; STEIF_UNSUPPORTED: events that change
 * or end a run, breaks.
 *
 * Sources: D. B. Ozyurt and P. I. Barton, SIAM J. Sci. Comput. 26 (2005) 1725-1743; A. Griewank and A. Walther, Evaluating
 * Derivatives (2008), 5.1: forward over reverse.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_HESSIAN_H
#define STEIF_HESSIAN_H

#include <steif/direction.h>
#include <steif/gradient.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Hp: products at i P + k, of functional i by parameter k, NULL without parameters; Hy0: at i n + j, NULL: not wanted.
 * *gradient, asked and found as by steif_gradient_find, holds the gradient of the same run. */
STEIF_EXPORT int steif_hessian_product(steif_context *ctx, steif_direction *d,
                                       const char *method, const steif_options *options,
                                       const steif_functional *functional,
                                       steif_gradient *gradient, sunrealtype *Hp,
                                       sunrealtype *Hy0);

#ifdef __cplusplus
}
#endif
#endif
