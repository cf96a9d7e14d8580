/* fill.c: matrices with constant diagonals in dense, band and compressed-column storage.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "collection.h"
#include <sunmatrix/sunmatrix_band.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

/* Rows of column j: j - i = first .. last, 0 <= i < n. */
static sunindextype top(sunindextype j, sunindextype last) { return j > last ? j - last : 0; }
static sunindextype end(sunindextype n, sunindextype j, sunindextype first)
{
  const sunindextype below = j - first + 1;
  return below < 0 ? 0 : below < n ? below : n;
}

sunindextype stf_collection_count(sunindextype n, sunindextype first, sunindextype last)
{
  sunindextype count = 0;
  for (sunindextype j = 0; j < n; j++) {
    const sunindextype rows = end(n, j, first) - top(j, last);
    if (rows > 0) count += rows;
  }
  return count;
}

static int sparse(SUNMatrix M, sunindextype first, sunindextype last, const sunrealtype *value)
{
  const sunindextype n = SM_COLUMNS_S(M);
  sunindextype *column = SM_INDEXPTRS_S(M), *row = SM_INDEXVALS_S(M), used = 0;
  sunrealtype *data = SM_DATA_S(M);
  if (SM_SPARSETYPE_S(M) != CSC_MAT || SM_NNZ_S(M) < stf_collection_count(n, first, last))
    return -1;
  for (sunindextype j = 0; j < n; j++) {
    column[j] = used;
    for (sunindextype i = top(j, last); i < end(n, j, first); i++) {
      row[used] = i;
      data[used++] = value[j - i - first];
    }
  }
  column[n] = used;
  return 0;
}

int stf_collection_toeplitz(SUNMatrix M, sunindextype first, sunindextype last,
                            const sunrealtype *value)
{
  const SUNMatrix_ID kind = SUNMatGetID(M);
  if (kind == SUNMATRIX_SPARSE) return sparse(M, first, last, value);
  if (kind != SUNMATRIX_DENSE && kind != SUNMATRIX_BAND) return -1;
  const bool dense = kind == SUNMATRIX_DENSE;
  const sunindextype n = dense ? SM_COLUMNS_D(M) : SM_COLUMNS_B(M);
  const sunindextype above = last < n ? last : n - 1, below = -first < n ? -first : n - 1;
  if (!dense && (SM_UBAND_B(M) < above || SM_LBAND_B(M) < below)) return -1;
  for (sunindextype j = 0; j < n; j++)
    for (sunindextype i = top(j, last); i < end(n, j, first); i++)
      *(dense ? &SM_ELEMENT_D(M, i, j) : &SM_ELEMENT_B(M, i, j)) = value[j - i - first];
  return 0;
}

sunrealtype *stf_collection_diagonal(SUNMatrix M, sunindextype i)
{
  if (SUNMatGetID(M) == SUNMATRIX_DENSE) return &SM_ELEMENT_D(M, i, i);
  if (SUNMatGetID(M) == SUNMATRIX_BAND) return &SM_ELEMENT_B(M, i, i);
  return SM_DATA_S(M) + SM_INDEXPTRS_S(M)[i] + (i > 0);
}
