/* circle_parts.h: what the files of a circle share.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_CIRCLE_PARTS_H
#define STF_CIRCLE_PARTS_H

#include "circle.h"

/* Most nodes. */
enum { STF_CIRCLE_MOST = 1024 };

/* Nodes for one pass, and what becomes of them. */
typedef struct stf_pass {
  stf_circle *c;
  const stf_polynomial *g;
  int done, count, *visit; /* of them, batch by batch */
  int bad;                 /* those that are left, in front of `visit` */
  sunrealtype error;       /* the largest */
} stf_pass;

/* -- circle.c ------------------------------------------------------------------------------------ */

/* Pivots by KLU at a node, for all batches. */
int stf_circle_pivot(stf_circle *c, int visit);
/* Batch i of a pass, from visit[done] on: factors and solutions, or solutions by the factors there. */
void stf_circle_work(void *pass, int i);
void stf_circle_solve(void *pass, int i);

/* -- circle_sums.c ------------------------------------------------------------------------------- */

sunrealtype stf_circle_angle(const stf_circle *c, int visit);
/* The good lanes of a batch at `visits` join the sums, partners together; first: there are none yet. */
void stf_circle_add(stf_circle *c, const stf_multishift *b, const int *visits, int count,
                    bool first);
void stf_circle_measure(stf_circle *c);

/* -- circle_team.c: batches that others work on ---------------------------------------------------- */

/* The number of processes, 1: no team. */
int stf_circle_processes(const stf_circle *c);
/* The first batch of process p, of so many for all of them. */
int stf_circle_first(const stf_circle *c, int batches, int p);
/* The others get their batches of a pass; to factor, or to solve by the factors that they have. */
int stf_circle_hand_out(const stf_pass *now, int batches, bool factor);
/* What became of batch k, one after the other, all of them whatever happens. *b has memory of a batch
 * of our own, whose solution is lost. */
int stf_circle_take(const stf_pass *now, int batches, int k, stf_multishift *b);
/* The others forget the circle. */
void stf_circle_leave(stf_circle *c);

#endif
