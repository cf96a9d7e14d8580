/* fill_matrix.c: entries into a matrix of any storage, for callbacks that fill E, A or a Jacobian.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "problem.h"
#include <string.h>
#include <sunmatrix/sunmatrix_band.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

static sunindextype order_of(SUNMatrix M)
{
  switch (SUNMatGetID(M)) {
  case SUNMATRIX_DENSE: return SM_COLUMNS_D(M);
  case SUNMATRIX_BAND: return SM_COLUMNS_B(M);
  case SUNMATRIX_SPARSE: return SM_COLUMNS_S(M);
  default: return -1;
  }
}

static int make_room(SUNMatrix M, sunindextype entries)
{
  if (SM_SPARSETYPE_S(M) != CSC_MAT) return STEIF_BAD_INPUT;
  if (SM_NNZ_S(M) >= entries) return STEIF_OK;
  return SUNSparseMatrix_Reallocate(M, entries) ? STEIF_NO_MEMORY : STEIF_OK;
}

/* Entries column by column in the order given; start[j + 1] runs through column j and ends at its end. */
static void place(SUNMatrix M, sunindextype count, const sunindextype *row,
                  const sunindextype *column, const sunrealtype *value)
{
  const sunindextype n = SM_COLUMNS_S(M);
  sunindextype *start = SM_INDEXPTRS_S(M), sum = 0;
  for (sunindextype j = 0; j <= n; j++) start[j] = 0;
  for (sunindextype k = 0; k < count; k++)
    if (column[k] + 2 <= n) start[column[k] + 2]++;
  for (sunindextype j = 0; j <= n; j++) start[j] = sum += start[j];
  for (sunindextype k = 0; k < count; k++) {
    const sunindextype to = start[column[k] + 1]++;
    SM_INDEXVALS_S(M)[to] = row[k];
    SM_DATA_S(M)[to] = value[k];
  }
}

/* Rows ascend, equal ones become their sum, columns move together. */
static void sort_columns(SUNMatrix M)
{
  sunindextype *start = SM_INDEXPTRS_S(M), *row = SM_INDEXVALS_S(M), used = 0, from = 0;
  sunrealtype *x = SM_DATA_S(M);
  for (sunindextype j = 0; j < SM_COLUMNS_S(M); j++) {
    const sunindextype begin = used, end = start[j + 1];
    for (sunindextype k = from; k < end; k++) {
      const sunindextype i = row[k];
      const sunrealtype v = x[k];
      sunindextype at = used;
      while (at > begin && row[at - 1] > i) at--;
      if (at > begin && row[at - 1] == i) {
        x[at - 1] += v;
        continue;
      }
      for (sunindextype l = used++; l > at; l--) {
        row[l] = row[l - 1];
        x[l] = x[l - 1];
      }
      row[at] = i;
      x[at] = v;
    }
    from = end;
    start[j + 1] = used;
  }
}

static void clear(SUNMatrix M)
{
  if (SUNMatGetID(M) == SUNMATRIX_DENSE)
    memset(SM_DATA_D(M), 0, (size_t)SM_LDATA_D(M) * sizeof(sunrealtype));
  else
    memset(SM_DATA_B(M), 0, (size_t)SM_LDATA_B(M) * sizeof(sunrealtype));
}

/* Of dense and band matrices; NULL: outside of the band. */
static sunrealtype *element(SUNMatrix M, sunindextype i, sunindextype j)
{
  if (SUNMatGetID(M) == SUNMATRIX_DENSE) return &SM_ELEMENT_D(M, i, j);
  return i - j <= SM_LBAND_B(M) && j - i <= SM_UBAND_B(M) ? &SM_ELEMENT_B(M, i, j) : NULL;
}

int steif_fill_triplets(SUNMatrix M, sunindextype count, const sunindextype *row,
                        const sunindextype *column, const sunrealtype *value)
{
  const sunindextype n = M ? order_of(M) : -1;
  if (n < 0 || count < 0 || (count > 0 && (!row || !column || !value))) return STEIF_BAD_INPUT;
  for (sunindextype k = 0; k < count; k++)
    if (row[k] < 0 || row[k] >= n || column[k] < 0 || column[k] >= n) return STEIF_BAD_INPUT;
  if (SUNMatGetID(M) == SUNMATRIX_SPARSE) {
    STEIF_TRY(make_room(M, count));
    place(M, count, row, column, value);
    sort_columns(M);
    return STEIF_OK;
  }
  clear(M);
  for (sunindextype k = 0; k < count; k++) {
    sunrealtype *at = element(M, row[k], column[k]);
    if (!at) return STEIF_BAD_INPUT;
    *at += value[k];
  }
  return STEIF_OK;
}

int steif_fill_diagonal(SUNMatrix M, const sunrealtype *d)
{
  const sunindextype n = M ? order_of(M) : -1;
  if (n < 0) return STEIF_BAD_INPUT;
  if (SUNMatGetID(M) != SUNMATRIX_SPARSE) {
    clear(M);
    for (sunindextype j = 0; j < n; j++) *element(M, j, j) = d ? d[j] : 1;
    return STEIF_OK;
  }
  STEIF_TRY(make_room(M, n));
  for (sunindextype j = 0; j < n; j++) {
    SM_INDEXPTRS_S(M)[j] = SM_INDEXVALS_S(M)[j] = j;
    SM_DATA_S(M)[j] = d ? d[j] : 1;
  }
  SM_INDEXPTRS_S(M)[n] = n;
  return STEIF_OK;
}
