/* steif/record.h: a whole run as a function of time.
 *
 *   steif_record *r = steif_record_new(ctx, problem.n, 0);
 *   opt.observe = steif_record_step, opt.observer = r;       then solve, then anywhere in the run
 *   steif_record_at(r, t, y);
 *
 * Every step is kept as the polynomial through degree + 1 Chebyshev points of the method's dense
 * output: exact where that is a polynomial of this degree, as for BDF, Rosenbrock and collocation
 * methods with fewer stages, and close to it in any case. A step takes (degree + 1) n numbers. At an event
 * that changes the state the value is the one after it. The record allocates as the run goes on; the
 * solver does not.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_RECORD_H
#define STEIF_RECORD_H

#include <steif/solver.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct steif_record steif_record;

/* degree: 1 .. 20, 0: 6; STEIF_RECORD_STEPS: no polynomials, t and y of every step as it is observed, both sides
 * of an event; the start where steif_record_step is called with it. NULL with the message set. Free it before
 * the context. */
enum { STEIF_RECORD_STEPS = -1 };
STEIF_EXPORT steif_record *steif_record_new(steif_context *ctx, sunindextype n, int degree);
STEIF_EXPORT void steif_record_free(steif_record **r);

/* The observer; `record` is the steif_record, for one run of one solver. */
STEIF_EXPORT int steif_record_step(steif_solver *s, sunrealtype t, N_Vector y, void *record);

/* y(t), and y'(t) of the polynomial unless yp is NULL, n numbers each; STEIF_BAD_INPUT outside of the
 * run and of a record of steps alone. */
STEIF_EXPORT int steif_record_at(const steif_record *r, sunrealtype t, sunrealtype *y,
                                 sunrealtype *yp);
/* Ends of the steps kept: count + 1 times, the start first; of parts of steps where an event cuts
 * them. */
STEIF_EXPORT size_t steif_record_steps(const steif_record *r, const sunrealtype **t);
/* Of a record of steps alone: y at these times, by rows, until the next step. Else NULL. */
STEIF_EXPORT const sunrealtype *steif_record_values(const steif_record *r);

#ifdef __cplusplus
}
#endif
#endif
