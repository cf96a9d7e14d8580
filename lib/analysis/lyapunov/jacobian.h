/* jacobian.h: matrices in the storage that a problem fills, dense, band or CSC, seen by columns.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_JACOBIAN_H
#define STF_JACOBIAN_H

#include "base.h"
#include <steif/problem.h>
#include <sunmatrix/sunmatrix_band.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

/* The entries of a column: value[e] in row row[e], or first + e where row is NULL. Those of a sparse
 * matrix may come twice and add up. */
typedef struct stf_entries {
  sunindextype first, count;
  const sunindextype *row;
  sunrealtype *value;
} stf_entries;

static inline sunindextype stf_row_of(const stf_entries *c, sunindextype e)
{
  return c->row ? c->row[e] : c->first + e;
}

static inline stf_entries stf_sparse_column(SUNMatrix M, sunindextype j)
{
  const sunindextype from = SM_INDEXPTRS_S(M)[j];
  return (stf_entries){0, SM_INDEXPTRS_S(M)[j + 1] - from, SM_INDEXVALS_S(M) + from,
                       SM_DATA_S(M) + from};
}

stf_entries stf_jacobian_column(SUNMatrix M, sunindextype j);
/* A square matrix of order n for at most `entries` nonzeros where it is sparse, owned by the pool. */
SUNMatrix stf_jacobian_new(stf_pool *pool, steif_context *ctx, enum steif_storage storage,
                           sunindextype n, sunindextype lower, sunindextype upper,
                           sunindextype entries);
/* 0 where a callback only adds; a sparse matrix is written from its start. */
void stf_jacobian_clear(SUNMatrix M);
/* K := h M B, K and B n x m by rows. */
void stf_jacobian_times(SUNMatrix M, int m, sunrealtype h, const sunrealtype *B,
                        sunrealtype *K);
void stf_jacobian_scale(SUNMatrix M, sunrealtype c);
sunrealtype stf_jacobian_trace(SUNMatrix M);
/* The largest sum of |entries| of a row; work: n numbers. */
sunrealtype stf_jacobian_size(SUNMatrix M, sunrealtype *work);
/* Entry by entry, in one storage. */
bool stf_jacobian_same(SUNMatrix A, SUNMatrix B);
/* M += c J at (row, column), M of order `order` by rows. */
void stf_jacobian_spread(SUNMatrix J, sunrealtype c, int order, int row, int column,
                         sunrealtype *M);

#endif
