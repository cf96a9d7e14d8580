/* scale.h: the price of a run over ranks, from counts of a run on one.
 *
 * u' = u_xx + u_yy + u_zz on a cube of side^3 inner points, u = 0 outside, side = 2^k - 1, by products and by V-cycles
 * of geometric multigrid as preconditioner, whose exchanges between neighbours and sums over all are counted
 * where they would be made. With rows unknowns on each of P ranks, cubes of them, a run takes
 *
 *   T(P) = W rows + S log2(P) alpha + sum over levels l of X_l (6 alpha + 6 (rows / 8^l)^(2/3) 8 bytes / bandwidth),
 *
 * W: seconds of the run on one rank for each unknown, S: sums, and one a step by which ranks agree,
 * X_l: exchanges of faces with six neighbours on grid l (0: the finest, of products, of f and of cycles; the
 * number of grids grows with P rows), alpha: latency of a message. Coarse grids with less than an unknown a rank still cost their latency. Efficiency is
 * W rows / T(P). Iterations are taken to be those of the grid that was measured, as multigrid has them;
 * nothing is overlapped, and bandwidth of memory is shared by no one.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef SCALE_H
#define SCALE_H

#include <steif/krylov.h>

enum { SCALE_LEVELS = 24 };

/* What is counted; `delay` seconds are slept at each, 0: none. */
typedef struct scale_network {
  double delay;
  long sums, exchange[SCALE_LEVELS], cycles, setups;
} scale_network;

/* scale_vector.c: serial vectors that count their sums, all in the network named last. */
N_Vector scale_vector(sunindextype n, SUNContext sun, scale_network *network);
void scale_sleep(const scale_network *network);
/* Seconds that such a sleep lasts on this machine, of many. */
double scale_sleep_lasts(double delay);

/* scale_grid.c: the problem, its exchanges counted. */
typedef struct scale_grid scale_grid;
scale_grid *scale_grid_new(int side, scale_network *network);
void scale_grid_free(scale_grid *g);
int scale_grid_levels(const scale_grid *g);
/* Callbacks and start values; g outlives it. */
steif_problem scale_grid_problem(scale_grid *g);
/* Largest error at t, against the solution of the equations of the grid. */
double scale_grid_error(const scale_grid *g, double t, N_Vector y);

/* scale_run.c: one run, counted, the seconds of its solve by processor and by clock. */
typedef struct scale_run {
  char method[STEIF_SPEC_WORD];
  sunindextype n;
  int levels;
  long steps, iterations,
    reductions; /* reductions: as the library counts the sums; 0: it does not */
  sunrealtype rtol, error, cpu_s, clock_s;
  scale_network network;
} scale_run;
int scale_measure(steif_context *ctx, int side, double delay, scale_run *run);

/* scale_model.c: the seconds that P ranks take, in parts. */
typedef struct scale_machine {
  double latency, bandwidth, rows; /* s, byte/s, unknowns of a rank */
} scale_machine;
typedef struct scale_price {
  double work, sums, fine, coarse, efficiency; /* exchanges of the finest grid, of the others */
} scale_price;
scale_price scale_price_of(const scale_run *run, const scale_machine *machine, double ranks);

#endif
