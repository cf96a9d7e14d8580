/* steif/bench.h: what a step costs against the kernels it cannot do without, and what a solve costs
 * against CVODE, IDA and ARKODE, as ratios in one run.
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
 *              solves alone, one after another; limit 1.3
 *   "small"    step_s: a step (n <= 10) less its measured f, J, factorisations and solves; floor_s: a
 *              whole step of CVODE on the same problem at rtol 1e-6, as the library found at run time
 *              has it; limit 1
 *   "splitting" a step of verlet with n = 1e6; floor_s: the force once, and y += h f twice for all of y;
 *              limit 1.2
 *   "threads"  step_s: a step with new factors by two threads, by the clock; floor_s: the same by
 *              one, with the same numbers bit for bit (else STEIF_NOT_CERTIFIED); limit 1/1.3; s = 3
 *              has one complex system, which takes nearly all the time
 *   "lyapunov" (steif_bench_lyapunov) step_s: a step with all n Lyapunov exponents, 10 where n is
 *              10000; floor_s: the step alone, J and its product with as many columns for every
 *              stage, the systems of the stages (one of order s n for s collocation stages), Q R by
 *              reflections and X R^{-1}, by direct calls of LAPACK and BLAS; of a sparse J the loop over
 *              its entries, and KLU's refactorisation and solves; limit 1.3 */
typedef struct steif_bench_row {
  char kind[16], problem[STEIF_SPEC_WORD], method[STEIF_SPEC_WORD];
  sunindextype n;
  sunrealtype step_s, floor_s, ratio, limit;
} steif_bench_row;

/* Row i; STEIF_BAD_INPUT without a sentence past the end. */
STEIF_EXPORT int steif_bench_step(steif_context *ctx, size_t i, steif_bench_row *row);
STEIF_EXPORT int steif_bench_lyapunov(steif_context *ctx, size_t i, steif_bench_row *row);
/* Whole runs of `auto` on the dense problems of 3 to 30 unknowns, at the tolerance that stands in kind;
 * floor_s: what f, J, factorisations and solves take of a step, by the run's counters and their times at
 * its end; step_s: the rest of the step, limit 1. */
STEIF_EXPORT int steif_bench_books(steif_context *ctx, size_t i, steif_bench_row *row);

/* The exponents of Lorenz' equations over `time` behind a transient, by equal steps. The tolerance rtol
 * is one with which an adaptive method of order 8 keeps their sum about as well; its exact value is
 * the divergence. STEIF_BAD_INPUT without a sentence past the end. */
typedef struct steif_bench_attractor {
  char method[STEIF_SPEC_WORD];
  sunrealtype h, time, transient, rtol;
  sunrealtype cpu_s, exponent[3], error[3]; /* error: their standard errors */
  sunrealtype sum, defect;                  /* sum: exact; |sum of the exponents - sum| */
} steif_bench_attractor;
STEIF_EXPORT int steif_bench_lorenz(steif_context *ctx, size_t i, steif_bench_attractor *row);

/* Work against precision: whole solves, from the creation of the solver to its destruction. Least
 * processor time of all threads over 5 solves and 20 ms; longer solves are repeated less. */
typedef struct steif_bench_solve {
  char problem[STEIF_SPEC_WORD], method[STEIF_SPEC_WORD];
  sunindextype n;
  sunrealtype rtol, cpu_s, mescd; /* mescd: digits, NaN when the run failed */
  sunrealtype due;                /* -log10(rtol) - 1: a good run has more digits than this */
  int baseline;                   /* CVODE, IDA or ARKODE */
  int code;                       /* enum steif_code */
  int late;                       /* ended by the clock */
  char message[256];
} steif_bench_solve;

/* Problem or method i of the usual plan, NULL past the end. */
STEIF_EXPORT const char *steif_bench_problem(size_t i);
STEIF_EXPORT const char *steif_bench_method(size_t i);

/* Measure; a failed run is a result. STEIF_UNSUPPORTED: the method does not take the form of the
 * problem. longest: processor seconds after which a solve is ended. */
STEIF_EXPORT int steif_bench_measure(steif_context *ctx, const char *problem, const char *method,
                                     sunrealtype rtol, sunrealtype longest,
                                     steif_bench_solve *solve);

/* The cheapest run that reaches the digits; cpu_s = NaN and an empty name: none does. */
typedef struct steif_bench_pick {
  char method[STEIF_SPEC_WORD];
  sunrealtype rtol, cpu_s, mescd;
} steif_bench_pick;
typedef struct steif_bench_match {
  char problem[STEIF_SPEC_WORD];
  sunindextype n;
  sunrealtype digits;
  steif_bench_pick ours, automatic, baseline; /* automatic: method "auto" */
  sunrealtype ratio, auto_ratio;              /* to the baseline; NaN when one of them is missing */
  sunrealtype peer_s, peer_baseline_s; /* published: best peer, best of CVODE, IDA, ARKODE; or NaN */
  const char *peer;
} steif_bench_match;

/* Out of the runs on one problem. */
STEIF_EXPORT steif_bench_match steif_bench_compare(const steif_bench_solve *solve, size_t count,
                                                   sunrealtype digits);

/* Geometric means over the matches with least_n < n <= most_n. */
typedef struct steif_bench_mean {
  sunindextype least_n, most_n;
  long count, auto_count, peer_count; /* ratios in each mean */
  long alone, beaten;   /* digits that only steif reaches, that only a baseline reaches */
  sunrealtype ratio, auto_ratio; /* NaN: of nothing */
  sunrealtype peer_ratio;        /* to the best peer at the speed of this machine */
} steif_bench_mean;
STEIF_EXPORT void steif_bench_average(const steif_bench_match *match, size_t count,
                                      steif_bench_mean *mean);

/* Speed of this machine and this SUNDIALS against the published times: geometric mean of measured
 * over published seconds of the best of CVODE, IDA, ARKODE; NaN: of nothing. */
STEIF_EXPORT sunrealtype steif_bench_speed(const steif_bench_match *match, size_t count);

/* Time of SUNDIALS' N_VLinearSum of 1000 numbers over that of a plain loop: 1 for a library
 * compiled with optimisation, above STEIF_BENCH_SLOW without. NaN when memory is short. */
#define STEIF_BENCH_SLOW 2.5
STEIF_EXPORT sunrealtype steif_bench_sundials(steif_context *ctx);

/* Structure, x(0+) and impulses of a sparse descriptor system by circles against the complex
 * factorisations (with and without new pivots) and solves that they take, called directly in KLU
 * in the same order, each on a matrix of its own. Both in one thread by processor seconds, and with
 * the threads of ctx, KLU in one, by the clock; the goal is a ratio of 1.3, and 1 is no bound:
 * KLU takes one matrix at a time. */
typedef struct steif_bench_impulse {
  char problem[STEIF_SPEC_WORD];
  sunindextype n;
  long factors, refactors, solves;
  int threads;
  sunrealtype cpu_s, wall_s;      /* the whole analysis and the impulses: one thread, `threads` */
  sunrealtype floor_s, floor_wall_s, ratio, wall_ratio;
  sunrealtype analyse_s;          /* KLU's symbolic analysis, one for all: not in the floor */
  sunrealtype peak_mb;            /* of the process so far: measure one row in a process */
  sunrealtype bytes_per_unknown;  /* of what the peak grew by */
  sunrealtype estimate;           /* relative error of x(0+) by the algorithm's own account */
  int certified;
} steif_bench_impulse;

/* How times grow with n in the rows of the same family of problems as row `of`: exponents p of
 * c n^p, by least squares over the logarithms; NaN below two sizes. */
typedef struct steif_bench_growth {
  char family[STEIF_SPEC_WORD]; /* "ladder" */
  long rows;
  sunrealtype cpu, floor;
} steif_bench_growth;
STEIF_EXPORT steif_bench_growth steif_bench_exponents(const steif_bench_impulse *row, size_t count,
                                                      size_t of);

/* Spec of row i of the usual plan, NULL past the end. */
STEIF_EXPORT const char *steif_bench_system(size_t i);
STEIF_EXPORT int steif_bench_circles(steif_context *ctx, const char *problem,
                                     steif_bench_impulse *row);

/* e^A of dense matrices: row i of the plan, n = 16, 64, 256. A and X = e^A are n x n by columns, with
 * room for STEIF_BENCH_EXPM^2; STEIF_BAD_INPUT without a sentence past the end. */
enum { STEIF_BENCH_EXPM = 256 };
typedef struct steif_bench_expm {
  char matrix[32];
  int n;
  sunrealtype norm, cpu_s; /* ||A||_1; seconds of one steif_expm */
} steif_bench_expm;
STEIF_EXPORT int steif_bench_exponential(steif_context *ctx, size_t i, steif_bench_expm *row,
                                         sunrealtype *A, sunrealtype *X);

/* phi functions of large matrices against implicit methods at equal digits: one steif_action_apply
 * where the problem is linear, exponential Rosenbrock methods elsewhere. Every method has the loosest
 * tolerance 10^-k that reaches the digits; NaN: none does in `longest` processor seconds. */
typedef struct steif_bench_phi {
  char problem[STEIF_SPEC_WORD], method[STEIF_SPEC_WORD];
  sunindextype n;
  int digits;
  sunrealtype cpu_s, radau_s, cvode_s; /* of the method, of radau:s=3, of CVODE */
} steif_bench_phi;
STEIF_EXPORT int steif_bench_functions(steif_context *ctx, size_t i, sunrealtype longest,
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
STEIF_EXPORT int steif_bench_squares(steif_context *ctx, size_t i,
                                     steif_bench_square row[STEIF_BENCH_SQUARE]);

#ifdef __cplusplus
}
#endif
#endif
