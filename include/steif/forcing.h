/* steif/forcing.h: functions of time from texts and files: f of E x' + F x = f, inputs u of f = B u, test
 * functions. The path "-" is standard input.
 *
 * Expressions in t, one for each component, in the language of models (doc/models.md):
 *     sin(3*t) + 2*exp(-t)                    # component 1
 *     step(t - 0.5) * t^2                     # component 2: declares a breakpoint at t = 0.5
 *     if t < 2 then t else 2                  # a breakpoint at 2
 *     sum(k in 1:5: sin((2*k - 1)*t)/k)
 * with + - * / ^, numbers, t, pi, all functions of that language but floor and mod, and conditions. Jumps (if, step,
 * sign) are at the zeros of a t + b, a and b numbers, which are breakpoints; so are those of abs, min, max and ramp,
 * which may have other arguments too (steif_function_smooth). Derivatives of any order up to 64 are exact, by Taylor
 * arithmetic; at breakpoints and kinks they are limits from the right.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_FORCING_H
#define STEIF_FORCING_H

#include <steif/problem.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct steif_function steif_function;

/* n expressions from a file (lines; # begins a comment; fewer lines than n is an error with the
 * line number), or from one text separated by ';'. B n x m dense or sparse: f = B u with m
 * expressions; NULL: none. */
STEIF_EXPORT steif_function *steif_function_read(steif_context *ctx, const char *path,
                                                 sunindextype n, SUNMatrix B);
STEIF_EXPORT steif_function *steif_function_parse(steif_context *ctx, const char *text,
                                                  sunindextype n, SUNMatrix B);
/* Samples: a CSV file with columns t, f_1 .. f_n (with B: t, u_1 .. u_m) at equal distances;
 * derivatives at the first time by one-sided formulas over `points` samples (0: 8). *accuracy:
 * that of the derivative of order 1 there. */
STEIF_EXPORT steif_function *steif_function_samples(steif_context *ctx, const char *path,
                                                    sunindextype n, SUNMatrix B, int points,
                                                    sunrealtype *accuracy);
/* Estimated relative error of a derivative at t: the largest difference between the formulas over
 * all points and over one less, over the largest component. 0 for expressions, which are exact;
 * infinite where one point less is too few. */
STEIF_EXPORT int steif_function_accuracy(const steif_function *f, sunrealtype t, int derivative,
                                         sunrealtype *accuracy);
STEIF_EXPORT void steif_function_free(steif_function **f);

/* Fits steif_problem.g and steif_impulse_find, with the function as user data; right limits at
 * breakpoints. A derivative that some components have there and others have not, as sqrt(t) at 0, is
 * NaN in these. */
STEIF_EXPORT int steif_function_value(sunrealtype t, int derivative, N_Vector g,
                                      void *function);
/* c_j = f^(j)(t) / j!, j = 0 .. order, of the first of the expressions; nonzero where there is none: fits steif_weight with the function as user data. */
STEIF_EXPORT int steif_function_taylor(long double t, int order, long double *c,
                                       void *function);
/* u of f = B u, or f itself where there is no B: how many values, and these at t. */
STEIF_EXPORT size_t steif_function_count(const steif_function *f);
STEIF_EXPORT int steif_function_inputs(sunrealtype t, steif_function *f, sunrealtype *u);
/* Declared breakpoints inside (t0, t1), ascending; returns how many there are. */
STEIF_EXPORT size_t steif_function_breaks(const steif_function *f, sunrealtype t0,
                                          sunrealtype t1, size_t room, sunrealtype *times);

/* Is an expression smooth between its declared breakpoints? 1, or 0 where abs, min or max of what is not
 * linear in t turns within [t0, t1], seen at 1000 places; *where: shortly after the first turn. */
STEIF_EXPORT int steif_function_smooth(steif_function *f, sunrealtype t0, sunrealtype t1,
                                       sunrealtype *where);

#ifdef __cplusplus
}
#endif
#endif
