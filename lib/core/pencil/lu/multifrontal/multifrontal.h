/* multifrontal.h: the fronts, which the symbolic part makes and the numeric part works through: over its
 * `width` columns and the `below` rows that follow a front is the dense matrix
 *   [L11 U12; L21 C] with C -= L21 U12,
 * and C is added to the front of the parent.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_MULTIFRONTAL_H
#define STF_MULTIFRONTAL_H

#include "lu.h"
#include "sum_pattern.h"

/* A larger multiplier rejects the matrix. */
#define STF_MULTIPLIER_MOST 1e3

typedef struct stf_front {
  int first, width, below, parent; /* columns first ..; parent -1: root */
  int child, sibling;          /* last child, the child of the same parent before; -1: none */
  sunindextype row;            /* of the rows below, in `rows` and `into` */
  sunindextype entry, entries; /* first and count in `entry` and `target` */
  sunindextype place; /* of its factors: L, (width + below) x width, U, width x below */
} stf_front;

/* What depends on the pattern alone. Numbers are places in the order of elimination. */
struct stf_multifrontal {
  int n, count, highest; /* fronts; most rows below */
  double flops;
  sunindextype size, peak; /* doubles for the factors, and for the stack of matrices C */
  int *order, *place;      /* order[k]: unknown eliminated k-th; place: its inverse */
  stf_front *front;
  int *rows, *into; /* rows below, ascending; their places in the parent's front */
  sunindextype *entry,
    *target; /* entry[e] of the union goes to target[e] of its front's factors */
};

#endif
