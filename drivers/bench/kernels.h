/* kernels.h: what a step costs against the kernels it cannot do without, as ratios in one run.
 *
 * Processor time, least of several repetitions. Ratios compare things timed within milliseconds of
 * each other on the same data, so they hold on a busy machine where seconds do not.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef KERNELS_H
#define KERNELS_H

#include <steif/solver.h>

/* Kinds of rows:
 *   "sparse"   step_s: a fixed step of a linear sparse problem; floor_s: its KLU solves, called
 *              directly, and its products with E and A (the right-hand side); limit 1.3
 *   "stages"   a step with s collocation stages; floor_s: its floor(s/2) complex and s mod 2 real KLU
 *              solves alone, one after another; limit 1.3
 *   "small"    step_s: a step (n <= 10) less its measured f, J, factorisations and solves; floor_s: a
 *              whole step of CVODE on the same problem at rtol 1e-6, as the library found at run time
 *              has it; limit 1
 *   "splitting" a step of verlet with n = 1e6; floor_s: the force once, and y += h f twice for all of y;
 *              limit 1.2
 *   "threads"  step_s: a step with new factors by two threads, in wall-clock time; floor_s: the same by
 *              one, with the same numbers bit for bit (else STEIF_NOT_CERTIFIED); limit 1/1.3; s = 3
 *              has one complex system, which takes nearly all the time
 *   "price"    step_s: a whole run of a baseline through steif, from its creation to its destruction;
 *              floor_s: the same by a direct program (direct.h) with the same steps (else
 *              STEIF_NOT_CERTIFIED); ratio: median over runs in turns; limit 1.05
 *   "operations", "loops f", "compiled f", ... (steif_bench_model) step_s: f or J of a model as text, by the
 *              interpreter and compiled; floor_s: a nanosecond an operation, or f and J of the same problem
 *              in C; "run": a step of a whole run, of both; "reading": 1e5 equations, and 2 seconds
 *   "lyapunov" (steif_bench_lyapunov) step_s: a step with all n Lyapunov exponents, 10 where n is
 *              10000; floor_s: the step alone, J and its product with as many columns for every
 *              stage, the systems of the stages (one of order s n for s collocation stages), Q R by
 *              reflections and X R^{-1}, by direct calls of LAPACK and BLAS; of a sparse J the loop over
 *              its entries, and KLU's refactorisation and solves; limit 1.3 */
typedef struct steif_bench_row {
  char kind[16], problem[STEIF_SPEC_WORD], method[STEIF_SPEC_WORD];
  sunindextype n;
  sunrealtype h, rtol, atol; /* what was asked for; 0: not of this row */
  sunrealtype step_s, floor_s, ratio, limit;
} steif_bench_row;

/* Row i; STEIF_BAD_INPUT without a sentence past the end. */
int steif_bench_step(steif_context *ctx, size_t i, steif_bench_row *row);
/* Models as text against C. */
int steif_bench_model(steif_context *ctx, size_t i, steif_bench_row *row);
int steif_bench_lyapunov(steif_context *ctx, size_t i, steif_bench_row *row);
/* Whole runs of `auto` on the dense problems of 3 to 30 unknowns, at the tolerance that stands in kind;
 * floor_s: what f, J, factorisations and solves take of a step, by the run's counters and their times at
 * its end; step_s: the rest of the step, limit 1. */
int steif_bench_cost_accounting(steif_context *ctx, size_t i, steif_bench_row *row);

/* n, atol, step_s, floor_s, ratio of a row "price", at its rtol. */
int stf_bench_price(steif_context *ctx, const char *problem, const char *method,
                    steif_bench_row *row);
/* n, step_s, floor_s: a step by two threads and by one; STEIF_NOT_CERTIFIED where they disagree. */
int stf_bench_threads(steif_context *ctx, const char *problem, const char *method,
                      sunrealtype h, steif_bench_row *row);

#endif
