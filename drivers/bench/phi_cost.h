/* phi_cost.h: exponentials and phi functions of matrices, timed.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef PHI_COST_H
#define PHI_COST_H

#include <steif/solver.h>

/* e^A of dense matrices: row i of the plan, n = 16, 64, 256. A and X = e^A are n x n by columns, with
 * room for STEIF_BENCH_EXPM^2; STEIF_BAD_INPUT without a sentence past the end. */
enum { STEIF_BENCH_EXPM = 256 };
typedef struct steif_bench_expm {
  char matrix[32];
  int n;
  sunrealtype norm, cpu_s; /* ||A||_1; seconds of one steif_expm */
} steif_bench_expm;
int steif_bench_exponential(steif_context *ctx, size_t i, steif_bench_expm *row, sunrealtype *A,
                            sunrealtype *X);

/* phi functions of large matrices against implicit methods at equal digits: one steif_action_apply
 * where the problem is linear, exponential Rosenbrock methods elsewhere. Every method has the loosest
 * tolerance 10^-k that reaches the digits; NaN: none does in `longest` processor seconds. */
typedef struct steif_bench_phi {
  char problem[STEIF_SPEC_WORD], method[STEIF_SPEC_WORD];
  sunindextype n;
  int digits;
  sunrealtype cpu_s, radau_s, cvode_s; /* of the method, of radau:s=3, of CVODE */
} steif_bench_phi;
int steif_bench_functions(steif_context *ctx, size_t i, sunrealtype longest,
                          steif_bench_phi *row);

/* w = phi_p(tA) b, p = 0 .. 3, at three times within a factor of two, A the five-point Laplacian of
 * the unit square on grid i of the plan (32 x 32 and 1000 x 1000 inner points), b random in (0, 1), by
 * one steif_action with its default tolerance 1e-10. Counts are those of one application. */
enum { STEIF_BENCH_SQUARE = 12 };
typedef struct steif_bench_square {
  sunindextype n;
  int p;
  sunrealtype t, error; /* ||w - exact|| / ||exact||, 2-norm; exact by sine transforms */
  long factors, solves;
  sunrealtype cpu_s;
} steif_bench_square;
/* STEIF_BAD_INPUT without a sentence past the end. */
int steif_bench_squares(steif_context *ctx, size_t i,
                        steif_bench_square row[STEIF_BENCH_SQUARE]);

#endif
