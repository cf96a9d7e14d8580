/* impulse_cost.h: the analysis of large descriptor systems against their factorisations and solves.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef IMPULSE_COST_H
#define IMPULSE_COST_H

#include <steif/solver.h>

/* Structure, x(0+) and impulses of a sparse descriptor system by circles against the complex
 * factorisations (with and without new pivots) and solves that they take, called directly in KLU
 * in the same order, each on a matrix of its own. Both in one thread by processor seconds, and with
 * the threads of ctx, KLU in one, by wall-clock time; the goal is a ratio of 1.3, and 1 is no bound:
 * KLU takes one matrix at a time. */
typedef struct steif_bench_impulse {
  char problem[STEIF_SPEC_WORD];
  sunindextype n;
  long factors, refactors, solves;
  int threads;
  sunrealtype cpu_s, wall_s; /* the whole analysis and the impulses: one thread, `threads` */
  sunrealtype floor_s, floor_wall_s, ratio, wall_ratio;
  sunrealtype analyse_s;         /* KLU's symbolic analysis, one for all: not in the floor */
  sunrealtype peak_mb;           /* of the process so far: measure one row in a process */
  sunrealtype bytes_per_unknown; /* of what the peak grew by */
  sunrealtype estimate;          /* relative error of x(0+) by the algorithm's own account */
  int certified;
} steif_bench_impulse;

/* How times grow with n in the rows of the same family of problems as row `of`: exponents p of
 * c n^p, by least squares over the logarithms; NaN below two sizes. */
typedef struct steif_bench_growth {
  char family[STEIF_SPEC_WORD]; /* "ladder" */
  long rows;
  sunrealtype cpu, floor;
} steif_bench_growth;
steif_bench_growth steif_bench_exponents(const steif_bench_impulse *row, size_t count,
                                         size_t of);

/* Spec of row i of the usual plan, NULL past the end. */
const char *steif_bench_system(size_t i);
int steif_bench_circles(steif_context *ctx, const char *problem, steif_bench_impulse *row);

#endif
