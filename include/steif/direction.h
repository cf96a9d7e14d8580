/* steif/direction.h: derivatives of a solution along one direction of parameters and start values.
 *
 *     sunrealtype v[] = {1, 0, -2};                                   // of the parameters
 *     steif_direction *d = steif_direction_new(ctx, &problem, v, NULL);
 *     options.sensitivities = 1;
 *     steif_solver *s = steif_solver_new(ctx, steif_direction_problem(d), "radau:s=3", &options);
 *     if (s && steif_solve_to(s, 40) == STEIF_OK) steif_sensitivity(s, 40, 0, Jv);
 *     steif_solver_free(&s), steif_direction_free(&d);
 *
 * steif_direction_problem is the same problem on the line p + theta v, y0 + theta u, with theta = 0 as its one
 * parameter, named "along". All that is said of one parameter holds for it: forward sensitivities of all methods that
 * have them, at the cost of one column whatever P is, through starts, events and breaks, with dense output, error test
 * and quadratures; gradients, whose dp is then v . dJ/dp + u . dJ/dy0. So optimisers have J v for the Jacobian J
 * of what they observe of y, and J^T w by steif_gradient_find with a functional whose slope is w: Gauss-Newton and
 * LSMR need no more. Second derivatives of functionals: hessian.h.
 *
 * Derivatives along the line are made of the callbacks of the problem (parameters.dFdp, start, reset, break_slope,
 * quadrature.slope), where v_k is not 0; those it lacks by differences along the line, one for all parameters.
 *
 * The problem must outlive the direction, and the direction the solvers of its problem. While a difference is being
 * made values of p are moved, and restored exactly; change them between runs as you like.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_DIRECTION_H
#define STEIF_DIRECTION_H

#include <steif/parameters.h>
#include <steif/problem.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct steif_direction steif_direction;

/* v: P numbers, NULL: parameters stay; u: n, NULL: start values stay, but as they follow parameters. Both are copied.
 * NULL with STEIF_BAD_INPUT: neither is given, v without parameters, u without y0 in host memory; STEIF_NOT_FINITE:
 * names the entry. */
STEIF_EXPORT steif_direction *steif_direction_new(steif_context *ctx,
                                                  const steif_problem *problem,
                                                  const sunrealtype *v, const sunrealtype *u);
STEIF_EXPORT const steif_problem *steif_direction_problem(const steif_direction *d);
STEIF_EXPORT void steif_direction_free(steif_direction **d);

#ifdef __cplusplus
}
#endif
#endif
