/* pryce.h: Pryce's offsets of equations and unknowns, and what they say of the index.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_PRYCE_H
#define STF_PRYCE_H

#include "base.h"

typedef struct stf_offsets {
  bool matched;                    /* every equation with an unknown of its own */
  int index;                       /* differentiation index by structure; -1: not matched */
  int *c, *d;                      /* n each: offsets of equations and of unknowns */
  int *component_index;            /* n: perturbation index of each component by structure */
  sunindextype degrees_of_freedom; /* sum d - sum c */
  int *surplus, *unsolved; /* n: 1 for equations in too few unknowns; for unknowns in too few */
} stf_offsets;
/* From where y_j occurs in equation i: `column` and `row` by columns, differential[k] & 1 where y_j'
 * does. The lists of *s are allocated from the pool when it is zero, else used again. */
int stf_offsets_find(steif_context *ctx, stf_pool *pool, size_t n, const sunindextype *column,
                     const sunindextype *row, const char *differential, stf_offsets *s);

#endif
