/* fronts.h: sparse LU in dense blocks, for large real shifts.
 *
 * Multifrontal elimination (I. S. Duff and J. K. Reid, ACM TOMS 9, 1983; J. W. H. Liu, SIAM Review 34,
 * 1992) on the symmetric pattern of M and its transpose, in an order of little fill. Columns whose
 * factors have (nearly) the same rows make a front: a dense matrix over its `width` columns and
 * the `below` rows that follow, in which they are eliminated,
 *   [L11 U12; L21 C] with C -= L21 U12,
 * and C is added to the front of the parent. Pivots are sought among the rows of the front's own
 * columns; a multiplier above STF_FRONTS_MOST refuses the matrix, and KLU, which pivots freely,
 * takes over. All loops run over dense columns, and a solve reads the factors once for up to 8
 * right-hand sides.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_FRONTS_H
#define STF_FRONTS_H

#include "order.h"
#include "pattern.h"

#define STF_FRONTS_MOST 1e3

typedef struct stf_front {
  int first, width, below, parent; /* columns first ..; parent -1: root */
  int child, sibling;          /* last child, the child of the same parent before; -1: none */
  sunindextype row;            /* of the rows below, in `rows` and `into` */
  sunindextype entry, entries; /* first and count in `entry` and `target` */
  sunindextype place; /* of its factors: L, (width + below) x width, U, width x below */
} stf_front;

/* Symbolic: what depends on the pattern alone. Numbers are places in the order of elimination. */
typedef struct stf_fronts {
  int n, count, highest; /* fronts; most rows below */
  double flops;
  sunindextype size, peak; /* doubles for the factors, and for the stack of matrices C */
  int *order, *place;      /* order[k]: unknown eliminated k-th; place: its inverse */
  stf_front *front;
  int *rows, *into; /* rows below, ascending; their places in the parent's front */
  sunindextype *entry,
    *target; /* entry[e] of the union goes to target[e] of its front's factors */
} stf_fronts;

/* STEIF_OK, or STEIF_NO_MEMORY without a sentence; pattern n < 2^31. */
int stf_fronts_open(steif_context *ctx, const stf_pattern *u, stf_fronts *f);
void stf_fronts_free(steif_context *ctx, stf_fronts *f);

/* Numeric. `factor` has f->size doubles, `pivot` f->n, `stack` f->peak. False: a pivot was too small. */
bool stf_fronts_factor(const stf_fronts *f, const double *value, double *factor, int *pivot,
                       double *stack);
/* nrhs columns, ld apart, in place; `work` has STF_FRONTS_WIDE (n + highest) doubles. */
enum { STF_FRONTS_WIDE = 8 };
void stf_fronts_solve(const stf_fronts *f, const double *factor, const int *pivot, int nrhs,
                      double *b, sunindextype ld, double *work);

/* sparse.c: the fronts whose factors a slot has in use, and these; NULL: KLU's are. */
const stf_fronts *stf_sparse_fronts(const steif_pencil *p, int slot, const double **block);

#endif
