/* attractor.h: the exponents of Lorenz' equations in a long run, timed.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef ATTRACTOR_H
#define ATTRACTOR_H

#include <steif/solver.h>

/* The exponents of Lorenz' equations over `time` after a transient, with a constant step size. The tolerance rtol
 * is one with which an adaptive method of order 8 keeps their sum about as well; its exact value is
 * the divergence. STEIF_BAD_INPUT without a sentence past the end. */
typedef struct steif_bench_attractor {
  char method[STEIF_SPEC_WORD];
  sunrealtype h, time, transient, rtol;
  sunrealtype cpu_s, exponent[3], error[3]; /* error: their standard errors */
  sunrealtype sum, defect;                  /* sum: exact; |sum of the exponents - sum| */
} steif_bench_attractor;
int steif_bench_lorenz(steif_context *ctx, size_t i, steif_bench_attractor *row);

#endif
