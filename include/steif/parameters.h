/* steif/parameters.h: numbers p that the equations, and perhaps the start, of a problem depend on.
 *
 *     double k[] = {0.04, 1e4, 3e7};                        // the callbacks read them here
 *     steif_parameters par = {.count = 3, .value = k};
 *     problem.parameters = &par;
 *
 * Change k[i] between runs as you like; a run reads what is there (problems of the collection: by
 * steif_parameter_set, their starts follow). A model as text has its numbers as
 * parameters, with exact derivatives: those are changed by steif_model_set, which makes form and start
 * follow. Derivatives by p are those of the residual F(t, y, y'; p), whatever the form of the problem:
 *
 *   ode          y' - f                mass         M y' - f
 *   implicit     F                     descriptor   E y' - A y - g
 *
 * A start value is a parameter too: one with dF/dp = 0 and dy0/dp a column of the identity.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_PARAMETERS_H
#define STEIF_PARAMETERS_H

#include <steif/problem.h>

#ifdef __cplusplus
extern "C" {
#endif

struct steif_parameters {
  int count;                /* P */
  sunrealtype *value;       /* p, where the callbacks read it */
  const char *const *name;  /* P names; NULL: p1, p2, ... */
  const sunrealtype *scale; /* typical |p_k|; NULL: |p_k|, and 1 where that is 0 */
  /* out = dF/dp_k, k from 0; NULL: differences of F. Returns as all callbacks do. */
  int (*dFdp)(sunrealtype t, N_Vector y, N_Vector yp, int k, N_Vector out, void *user);
  /* dy0/dp_k; NULL: 0, or differences of problem.start where that is given. Where both are there, one that contradicts
   * the differences of the other beyond their errors is STEIF_BAD_INPUT (of DAEs of index 1, in E dy0/dp_k). */
  int (*start)(int k, N_Vector S0, void *user);
  /* out_k += w . dF/dp_k for all k at once; NULL: one k after the other. */
  int (*dFdp_transposed)(sunrealtype t, N_Vector y, N_Vector yp, N_Vector w, sunrealtype *out,
                         void *user);
  /* Of what problem.handle_event makes of y at an event, y+ = R(t, y; p), with y before the event:
   * out = R_y dy + R_t dt + dR/dp_k. NULL: differences of handle_event, which is then called several times at
   * an event, as if it had not been called before: what it remembers is put back by begin and restore. */
  int (*reset)(sunrealtype t, N_Vector y, const int *fired, N_Vector dy, sunrealtype dt, int k,
               N_Vector out, void *user);
  /* *slope = d breaks[i]/dp_k; NULL: 0. */
  int (*break_slope)(int i, int k, sunrealtype *slope, void *user);
  /* What the problem keeps of p, start values too, is to be made anew: called when differences have moved a value and
   * when it is put back, and by steif_parameter_set; NULL: callbacks read p. Returns 0, or < 0: it cannot be. */
  int (*moved)(void *user);
  const char *
    obstacle; /* why derivatives of solutions cannot be had, a sentence; NULL: nothing is in their way */
};

/* The number k of a name; -1 with the nearest name as message, STEIF_UNKNOWN_NAME. */
STEIF_EXPORT int steif_parameter_find(steif_context *ctx, const steif_problem *problem,
                                      const char *name);
/* value[k] = value for the runs to come, and what the problem keeps of it follows. Models as text are changed by
 * steif_model_set. */
STEIF_EXPORT int steif_parameter_set(steif_context *ctx, const steif_problem *problem, int k,
                                     sunrealtype value);
/* out = dF/dp_k at (t, y, yp): by the callback, else by central differences, to about 1e-10 of the size
 * of F/p_k; value[k] is moved and restored exactly meanwhile. Where F bends within 1e-5 of p_k shorter differences are
 * taken, to 1e-6; STEIF_UNSUPPORTED with two of them where none can be trusted to 1e-3. STEIF_NOT_FINITE: F has no
 * derivative there. Where F cannot be evaluated on one side of
 * p_k the difference is one-sided. STEIF_RETRY: on neither. */
STEIF_EXPORT int steif_parameter_slope(steif_context *ctx, const steif_problem *problem, int k,
                                       sunrealtype t, N_Vector y, N_Vector yp, N_Vector out);
/* out = dy0/dp_k. */
STEIF_EXPORT int steif_parameter_start(steif_context *ctx, const steif_problem *problem, int k,
                                       N_Vector out);
/* out[k] = w . dF/dp_k, k = 0 .. P-1. */
STEIF_EXPORT int steif_parameter_pull(steif_context *ctx, const steif_problem *problem,
                                      sunrealtype t, N_Vector y, N_Vector yp, N_Vector w,
                                      sunrealtype *out);

#ifdef __cplusplus
}
#endif
#endif
