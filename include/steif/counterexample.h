/* steif/counterexample.h: an equation x' = lambda(t) x that decays while a given method grows.
 *
 * A. Steyer and E. Van Vleck (arXiv 1709.02059, theorem 3.4) take lambda = D cos(2 pi t / h) + L, which
 * is D + L > 0 wherever a method with integer nodes looks and L < 0 in the mean. For nodes xi_i that
 * are no integers the stages see other values, and midpoint, rk4 or Radau IIA decay after all. Let
 * c_1 .. c_m be the distinct xi_i modulo 1. Then
 *
 *   lambda(t) = rate - E q(t),   q(t) = prod_i sin^2(pi (t / h - c_i)),   E = 2 rate / mean(q),
 *
 * is smooth with period h and mean -rate, so the equation decays by that rate; every stage of every
 * step of length h sees the constant `rate`, and the numbers are those of x' = rate x: they grow where
 * h rate lies outside the stability region.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_COUNTEREXAMPLE_H
#define STEIF_COUNTEREXAMPLE_H

#include <steif/glm.h>
#include <steif/problem.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct steif_counterexample {
  int nodes;
  sunrealtype node[STEIF_STAGES]; /* modulo 1, ascending */
  sunrealtype mean, E;            /* of q, and its factor */
  sunrealtype constant; /* ln rho(M(h rate)) / h: growth of the numbers for x' = rate x */
  sunrealtype exponent; /* growth of the numbers for lambda, from 200 steps */
  sunrealtype cosine;   /* the same for 2 rate cos(2 pi t / h) - rate */
} steif_counterexample;

/* The equation as a problem with x(0) = 1, t1 = 200 h and its exact solution. method: any with a step
 * that glm.h knows. h, rate > 0. facts may be NULL. STEIF_UNSUPPORTED where h rate lies in the
 * stability region: shorten h. */
STEIF_EXPORT int steif_counterexample_new(steif_context *ctx, const char *method, sunrealtype h,
                                          sunrealtype rate, steif_problem *problem,
                                          steif_counterexample *facts);
STEIF_EXPORT void steif_counterexample_clear(steif_context *ctx, steif_problem *problem);

/* `steps` steps of length h with exact start values: after each of them its time, |x| of the method and
 * the solution itself. t, x, solution: room for `steps` numbers each; *made: how many there are, fewer where the
 * run stops early. */
STEIF_EXPORT int steif_counterexample_run(steif_context *ctx, const steif_problem *problem,
                                          const char *method, sunrealtype h, long steps,
                                          sunrealtype *t, sunrealtype *x, sunrealtype *solution,
                                          long *made);

#ifdef __cplusplus
}
#endif
#endif
