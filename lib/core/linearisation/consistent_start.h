/* consistent_start.h: a consistent start as it is found, and by the stages of the structure.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_CONSISTENT_START_H
#define STF_CONSISTENT_START_H

#include "pryce.h"
#include "sparse_view.h"

/* Node distances of derivatives along curves, which are dear to choose, for points of one run: they serve while the
 * time scales of the problem stay as they were, and not for ever, nor over a break. */
enum { STF_NODE_STAGES = 8, STF_NODE_ORDERS = 8 };
typedef struct stf_start_nodes {
  int uses;                               /* 0: nothing is known */
  sunrealtype slowest, fastest, from, to; /* from, to: the part between two breaks */
  bool
    narrow; /* of the last point: the part between two breaks has left no room for wider nodes */
  bool known[STF_NODE_STAGES];
  sunrealtype delta[STF_NODE_STAGES][STF_NODE_ORDERS];
} stf_start_nodes;

/* One search. */
typedef struct stf_start_task {
  stf_point *point;
  const steif_request *request;
  steif_start *start;
  const stf_view *view;
  sunrealtype *scale;     /* n: size of the terms of each equation */
  int most;               /* iterations of a stage */
  stf_start_nodes *nodes; /* NULL: they are chosen in every iteration */
} stf_start_task;

/* The lists of *start, from a pool of its own. */
int stf_start_allocate(steif_context *ctx, size_t n, steif_start *start);
enum steif_attribute stf_start_attribute(const stf_start_task *task, size_t j);
sunrealtype stf_start_weight(const stf_start_task *task, size_t j);
/* Fills task->scale at the point; > 0 where F cannot be evaluated. */
int stf_start_scale(stf_start_task *task);
/* The start of a problem whose structure is certified. */
int stf_start_stages(stf_start_task *task, const stf_offsets *s);

/* Weight of derivatives, which have no guess, beside 1 of guesses: small enough to leave the guesses
 * their place, large enough to make the nearest point one. */
#define STF_PROXIMAL 1e-3
/* Residuals over the terms of their equations: not fulfilled; fulfilled so well that an unfinished
 * search for the nearest point is good enough. */
#define STF_VIOLATED 1e-6
#define STF_FULFILLED 1e-10

#endif
