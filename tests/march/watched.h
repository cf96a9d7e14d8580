/* watched.h: y1' = 1, y2' = -y2 on [0, 2] from (0, 1), with event functions of the test, and what was
 * noticed.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef WATCHED_H
#define WATCHED_H

#include "smooth.h"

enum { SEEN = 64, FUNCTIONS = 4, STEPS = 4096 };
typedef struct watched {
  int count;
  double t[SEEN];
  int fired[SEEN][FUNCTIONS], functions;
  int steps; /* observed */
  double step_t[STEPS], step_y[STEPS][2];
} watched;

/* Of the shelf of tests: one function per event. */
steif_problem watched_problem(int events, steif_values event);
/* Run to t1 by `method` with equal steps h, or chosen ones (0). The code, with the message of ctx. */
int watched_run(steif_context *ctx, const steif_problem *p, const char *method, double h,
                watched *w);

#endif
