/* collection.h: the shelf of problems, and what its entries share.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_COLLECTION_H
#define STF_COLLECTION_H

#include "base.h"
#include <steif/collection.h>

typedef struct stf_problem_entry {
  const char *name;
  const steif_problem *item;
} stf_problem_entry;
extern const stf_problem_entry stf_problem_shelf[];
extern const size_t stf_problem_count;
extern const char
  *const stf_problem_texts[]; /* of all entries, from the heads of their files */

/* .build works on a copy of the shelf entry. When it fails, steif_problem_find calls .destroy:
 * build releases nothing itself, and destroy accepts what build had set, user == NULL too. */

/* self->user: one zeroed block of `fixed` bytes and `count` reals; NULL when memory is short.
 * stf_collection_release is the .destroy that goes with it. */
void *stf_collection_allocate(steif_context *ctx, steif_problem *self, size_t fixed,
                              size_t count);
void stf_collection_release(steif_context *ctx, steif_problem *self);

/* self->storage from storage=dense|band|sparse; unchanged when absent. */
int stf_collection_storage(steif_context *ctx, const steif_spec *spec, steif_problem *self);

/* Fill a square dense, band or compressed-column matrix with constant diagonals:
 * M_ij = value[j - i - first], j - i = first .. last. */
int stf_collection_toeplitz(SUNMatrix M, sunindextype first, sunindextype last,
                            const sunrealtype *value);
/* Entry (i, i) of such a matrix with first = -1. */
sunrealtype *stf_collection_diagonal(SUNMatrix M, sunindextype i);
/* Its number of entries. */
sunindextype stf_collection_count(sunindextype n, sunindextype first, sunindextype last);

/* Angle from the vertical below and angular velocity at t of phi'' = -g sin phi, oscillating,
 * by Jacobi's elliptic functions. */
void stf_collection_pendulum(sunrealtype g, sunrealtype phi0, sunrealtype rate0, sunrealtype t,
                             sunrealtype *phi, sunrealtype *rate);

#endif
