/* matrix_sum.c: sums and products of the matrices E and A, dense, band or by columns.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "baseline.h"
#include <math.h>
#include <string.h>
#include <sunmatrix/sunmatrix_band.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

static void destroy(void *M) { SUNMatDestroy(M); }

SUNMatrix stf_matrix_new(stf_run *run, enum steif_storage storage, sunindextype nnz)
{
  const steif_problem *p = run->problem;
  SUNContext sun = steif_sundials(run->ctx);
  const sunindextype n = p->n;
  SUNMatrix M = storage == STEIF_DENSE  ? SUNDenseMatrix(n, n, sun)
                : storage == STEIF_BAND ? SUNBandMatrix(n, p->upper, p->lower, sun)
                                        : SUNSparseMatrix(n, n, nnz, CSC_MAT, sun);
  if (!M) {
    STEIF_FAIL(
      run->ctx, STEIF_NO_MEMORY,
      "no memory for a matrix of %lld rows, or a bandwidth (%lld below, %lld above) or "
      "number of entries (%lld) that does not fit it",
      (long long)n, (long long)p->lower, (long long)p->upper, (long long)nnz);
    return NULL;
  }
  SUNMatZero(M);
  return stf_pool_adopt(run->pool, M, destroy) ? NULL : M;
}

stf_column stf_matrix_column(SUNMatrix M, sunindextype j)
{
  switch (SUNMatGetID(M)) {
  case SUNMATRIX_DENSE: return (stf_column){SM_ROWS_D(M), 0, NULL, SM_COLUMN_D(M, j)};
  case SUNMATRIX_BAND: {
    const sunindextype top = j - SM_UBAND_B(M), bottom = j + SM_LBAND_B(M);
    const sunindextype first = top > 0 ? top : 0;
    const sunindextype last = bottom < SM_ROWS_B(M) ? bottom : SM_ROWS_B(M) - 1;
    return (stf_column){last - first + 1, first, NULL, SM_COLUMN_B(M, j) + (first - j)};
  }
  default: {
    const sunindextype begin = SM_INDEXPTRS_S(M)[j];
    return (stf_column){SM_INDEXPTRS_S(M)[j + 1] - begin, 0, SM_INDEXVALS_S(M) + begin,
                        SM_DATA_S(M) + begin};
  }
  }
}

static sunindextype columns(SUNMatrix M)
{
  switch (SUNMatGetID(M)) {
  case SUNMATRIX_DENSE: return SM_COLUMNS_D(M);
  case SUNMATRIX_BAND: return SM_COLUMNS_B(M);
  default: return SM_COLUMNS_S(M);
  }
}

void stf_matrix_add(SUNMatrix J, sunrealtype a, SUNMatrix M)
{
  const sunindextype n = columns(J);
  for (sunindextype j = 0; j < n; j++) {
    const stf_column to = stf_matrix_column(J, j), from = stf_matrix_column(M, j);
    sunrealtype *x = to.entry + (from.first - to.first);
    if (from.row)
      for (sunindextype k = 0; k < from.count; k++) x[from.row[k]] += a * from.entry[k];
    else
      for (sunindextype k = 0; k < from.count; k++) x[k] += a * from.entry[k];
  }
}

void stf_matrix_times(SUNMatrix M, sunrealtype a, const sunrealtype *x, sunrealtype *out)
{
  const sunindextype n = columns(M);
  for (sunindextype j = 0; j < n; j++) {
    const stf_column c = stf_matrix_column(M, j);
    const sunrealtype ax = a * x[j];
    if (c.row)
      for (sunindextype k = 0; k < c.count; k++) out[c.row[k]] += ax * c.entry[k];
    else
      for (sunindextype k = 0; k < c.count; k++) out[c.first + k] += ax * c.entry[k];
  }
}

bool stf_matrix_finite(SUNMatrix M)
{
  const sunindextype n = columns(M);
  sunrealtype sum = 0; /* 0 * x is NaN exactly for the x that are not finite */
  for (sunindextype j = 0; j < n; j++) {
    const stf_column c = stf_matrix_column(M, j);
    for (sunindextype k = 0; k < c.count; k++) sum += 0 * c.entry[k];
  }
  return sum == 0;
}

void stf_matrix_difference(SUNMatrix M, SUNMatrix A)
{
  const sunindextype n = columns(M);
  for (sunindextype j = 0; j < n; j++) {
    const stf_column x = stf_matrix_column(M, j), y = stf_matrix_column(A, j);
    for (sunindextype k = 0; k < x.count; k++) x.entry[k] -= y.entry[k];
  }
}

void stf_matrix_columns(SUNMatrix M, sunrealtype *large)
{
  const sunindextype n = columns(M);
  for (sunindextype j = 0; j < n; j++) {
    const stf_column x = stf_matrix_column(M, j);
    large[j] = 0;
    for (sunindextype k = 0; k < x.count; k++) large[j] = fmax(large[j], fabs(x.entry[k]));
  }
}

SUNMatrix stf_matrix_identity(stf_run *run)
{
  const sunindextype n = run->problem->n;
  SUNMatrix M = stf_matrix_new(run, STEIF_SPARSE, n);
  for (sunindextype j = 0; M && j < n; j++) {
    SM_INDEXPTRS_S(M)[j + 1] = j + 1;
    SM_INDEXVALS_S(M)[j] = j;
    SM_DATA_S(M)[j] = 1;
  }
  return M;
}

/* Place the rows of column j of M that are not there yet, at `end` and after; place[i] - 1 is
 * the place of row i, and of an earlier column if place[i] <= begin. */
static sunindextype place_column(SUNMatrix M, sunindextype j, sunindextype begin,
                                 sunindextype end, stf_merge *merge, sunindextype *place,
                                 sunindextype *from)
{
  for (sunindextype k = SM_INDEXPTRS_S(M)[j]; k < SM_INDEXPTRS_S(M)[j + 1]; k++) {
    const sunindextype i = SM_INDEXVALS_S(M)[k];
    if (place[i] <= begin) {
      merge->row[end] = i;
      place[i] = ++end;
    }
    from[k] = place[i] - 1;
  }
  return end;
}

static bool proper(SUNMatrix M)
{
  const sunindextype n = SM_COLUMNS_S(M), *at = SM_INDEXPTRS_S(M);
  bool good = at[0] == 0 && at[n] <= SM_NNZ_S(M);
  for (sunindextype j = 0; good && j < n; j++) good = at[j] <= at[j + 1];
  for (sunindextype k = 0; good && k < at[n]; k++)
    good = SM_INDEXVALS_S(M)[k] >= 0 && SM_INDEXVALS_S(M)[k] < n;
  return good;
}

int stf_merge_open(stf_run *run, SUNMatrix E, SUNMatrix A, stf_merge *merge)
{
  STEIF_CHECK(
    proper(E) && proper(A), run->ctx, STEIF_BAD_INPUT,
    "a sparse matrix of '%s' is not filled properly: column pointers must rise from 0 "
    "to at most the room given (nnz, nnz_E), C row indices lie in 0 .. n-1",
    run->problem->name ? run->problem->name : "the problem");
  const sunindextype n = run->problem->n;
  merge->nnz_E = SM_INDEXPTRS_S(E)[n], merge->nnz_A = SM_INDEXPTRS_S(A)[n];
  const size_t all = (size_t)(merge->nnz_E + merge->nnz_A), size = sizeof(sunindextype);
  merge->column = stf_pool_array(run->pool, (size_t)n + 1, size);
  merge->row = stf_pool_array(run->pool, all, size);
  merge->from_E = stf_pool_array(run->pool, (size_t)merge->nnz_E, size);
  merge->from_A = stf_pool_array(run->pool, (size_t)merge->nnz_A, size);
  sunindextype *place = stf_pool_array(run->pool, (size_t)n, size), end = 0;
  if (!merge->column || !merge->row || !merge->from_E || !merge->from_A || !place)
    return STEIF_NO_MEMORY;
  for (sunindextype j = 0; j < n; j++) {
    const sunindextype begin = end;
    end = place_column(A, j, begin, end, merge, place, merge->from_A);
    end = place_column(E, j, begin, end, merge, place, merge->from_E);
    merge->column[j + 1] = end;
  }
  return STEIF_OK;
}

/* data += a M through `from`; false if an entry is not where it was. */
static bool scatter(const stf_merge *merge, const sunindextype *from, sunindextype nnz,
                    sunrealtype a, SUNMatrix M, sunrealtype *data)
{
  const sunindextype n = SM_COLUMNS_S(M), *at = SM_INDEXPTRS_S(M), *row = SM_INDEXVALS_S(M);
  if (at[n] != nnz) return false;
  for (sunindextype j = 0; j < n; j++)
    for (sunindextype k = at[j]; k < at[j + 1]; k++) {
      const sunindextype to = from[k];
      if (merge->row[to] != row[k] || to < merge->column[j] || to >= merge->column[j + 1])
        return false;
      data[to] += a * SM_DATA_S(M)[k];
    }
  return true;
}

bool stf_merge_fill(const stf_merge *merge, SUNMatrix J, sunrealtype c, SUNMatrix E,
                    SUNMatrix A)
{
  const sunindextype n = SM_COLUMNS_S(J), nnz = merge->column[n];
  memcpy(SM_INDEXPTRS_S(J), merge->column, ((size_t)n + 1) * sizeof *merge->column);
  memcpy(SM_INDEXVALS_S(J), merge->row, (size_t)nnz * sizeof *merge->row);
  memset(SM_DATA_S(J), 0, (size_t)nnz * sizeof(sunrealtype));
  return scatter(merge, merge->from_E, merge->nnz_E, c, E, SM_DATA_S(J)) &&
         (!A || scatter(merge, merge->from_A, merge->nnz_A, -1, A, SM_DATA_S(J)));
}
