/* circle_orders.h: what the process that leads a team tells the others, and what they answer.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_CIRCLE_ORDERS_H
#define STF_CIRCLE_ORDERS_H

#include "circle.h"

enum stf_order_kind {
  STF_ORDER_OPEN,   /* then E and F: columns, rows and values of each */
  STF_ORDER_FACTOR, /* then `count` visits, and a right-hand side */
  STF_ORDER_SOLVE,  /* then a right-hand side */
  STF_ORDER_CLOSE,
  STF_ORDER_LEAVE
};

/* FACTOR and SOLVE are answered by a stf_answer, and, where its code is 0, by a stf_lanes_done for each batch with the
 * solutions after it, in the order of the unknowns. */
typedef struct stf_order {
  size_t size; /* of this and of an outcome: the same build */
  enum stf_order_kind kind;
  long long circle, pass; /* their numbers */
  sunindextype n, entries[2];
  int points, refinements, batches, careful, count;
  int given, scaled, powers;        /* the right-hand side: the constant, powers, scale */
  long long pivots;                 /* how often they were sought, and where they are from */
  int visit;                        /* the node, */
  sunrealtype from_radius, from_at; /* the radius and the size of the scales there */
  sunrealtype radius, at;           /* those of this pass */
} stf_order;

/* To which order: nothing that an interrupted pass has left is taken for another. */
typedef struct stf_answer {
  long long circle, pass;
  int code;
  char text[600];
} stf_answer;

typedef struct stf_lanes_done {
  double log_det[STF_LANES], error[STF_LANES];
  int solves[STF_LANES];
  bool good[STF_LANES];
} stf_lanes_done;

/* Bytes go in pieces of so many: a process without memory for them can take them all the same. */
enum { STF_TEAM_PIECE = 1 << 16 };
struct steif_team;
bool stf_team_put(const struct steif_team *team, int to, const void *data, size_t bytes);
/* data NULL: into nothing. */
bool stf_team_get(const struct steif_team *team, int from, void *data, size_t bytes);

enum { STF_ORDER_SIZE = sizeof(stf_order) + (sizeof(stf_lanes_done) << 16) };

#endif
