/* steif/bench.h: what a step costs against the kernels it cannot do without, as ratios in one run.
 *
 * Processor time, least of several repetitions. Ratios compare things timed within milliseconds of
 * each other on the same data, so they hold on a busy machine where seconds do not.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_BENCH_H
#define STEIF_BENCH_H

#include <steif/solver.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Kinds of rows:
 *   "sparse"   step_s: a fixed step of a linear sparse problem; floor_s: its KLU solves, called
 *              directly, and its products with E and A (the right-hand side); limit 1.3
 *   "stages"   a step with s collocation stages; floor_s: its floor(s/2) complex and s mod 2 real KLU
 *              solves alone; limit 1.3
 *   "small"    step_s: a step (n <= 10) less its measured f, J, factorisations and solves; floor_s: a
 *              whole step of CVODE on the same problem at rtol 1e-6, as the library found at run time
 *              has it; limit 1 */
typedef struct steif_bench_row {
  char kind[16], problem[STEIF_SPEC_WORD], method[STEIF_SPEC_WORD];
  sunindextype n;
  sunrealtype step_s, floor_s, ratio, limit;
} steif_bench_row;

/* Row i; STEIF_BAD_INPUT without a sentence past the end. */
STEIF_EXPORT int steif_bench_step(steif_context *ctx, size_t i, steif_bench_row *row);

#ifdef __cplusplus
}
#endif
#endif
