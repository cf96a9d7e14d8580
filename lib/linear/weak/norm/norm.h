/* norm.h: norms of the error of a run in H^-m.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_NORM_H
#define STF_NORM_H

#include "measure.h"

/* Gauss's points of a step where the smooth solution is known, and the largest m. */
enum { STF_NODES = 8, STF_SPACES = STEIF_SPACES };

/* What is subtracted from a run, panel by panel: [from, to] in steps, of the first panel from 0 and of the
 * last to t1 or beyond; impulses at `from` (rows of n: c_0, c_1, ...) and the smooth values at Gauss's
 * points: STF_NODES rows of n. */
typedef struct stf_panel {
  long double from, to;
  int impulses;
  const sunrealtype *c, *x;
} stf_panel;

/* B-splines of degree m on so many equal cells; the sum of squares of the cells, still without
 * t1^(1 - 2m), is added to `square`. */
typedef struct stf_cells {
  int m, count;
  long double square;
} stf_cells;

/* T^(1/2 - m) || I^m e ||_L2(0, T) of component `j` of events less panels (NULL: nothing), for
 * m = 1 .. most into norm[m - 1]; h: the unit of times. cells NULL: no B-splines. */
void stf_dual_norm(const stf_events *events, int n, int j, const stf_panel *panel,
                   long double h, size_t steps, long double t1, int most, stf_cells *cells,
                   long double *norm);

/* By rows h, h/2, ... of one m, `stride` apart: order and converges of its space. */
void stf_ball_judge(const steif_ball_row *row, size_t rows, size_t stride, sunrealtype longest,
                    steif_ball_space *space);
/* The verdict by all spaces; decidable: runs in many digits would see what rounding hides. */
void stf_ball_say(steif_weak_ball *ball, size_t rows, bool decidable);

#endif
