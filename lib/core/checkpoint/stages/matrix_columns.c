/* matrix_columns.c: dense, band and sparse matrices column by column.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "backwards.h"
#include <sunmatrix/sunmatrix_band.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

typedef struct column {
  sunindextype count, first; /* rows first, first + 1, ... ... */
  const sunindextype *row;   /* ... unless they are listed */
  const sunrealtype *value;
} column;

static column column_of(SUNMatrix M, sunindextype j)
{
  if (SUNMatGetID(M) == SUNMATRIX_DENSE)
    return (column){.count = SM_ROWS_D(M), .value = SM_COLUMN_D(M, j)};
  if (SUNMatGetID(M) == SUNMATRIX_SPARSE) {
    const sunindextype from = SM_INDEXPTRS_S(M)[j];
    return (column){.count = SM_INDEXPTRS_S(M)[j + 1] - from,
                    .row = SM_INDEXVALS_S(M) + from,
                    .value = SM_DATA_S(M) + from};
  }
  const sunindextype n = SM_COLUMNS_B(M), up = SM_UBAND_B(M), low = SM_LBAND_B(M);
  const sunindextype first = j > up ? j - up : 0, last = j + low < n ? j + low : n - 1;
  return (column){
    .count = last - first + 1, .first = first, .value = SM_COLUMN_B(M, j) + (first - j)};
}

static void add_sparse(SUNMatrix M, sunindextype n, sunrealtype c, const sunrealtype *x,
                       sunrealtype *out)
{
  const sunindextype *from = SM_INDEXPTRS_S(M), *row = SM_INDEXVALS_S(M);
  const sunrealtype *value = SM_DATA_S(M);
  for (sunindextype j = 0; j < n; j++) {
    sunrealtype sum = 0;
    for (sunindextype k = from[j]; k < from[j + 1]; k++) sum += value[k] * x[row[k]];
    out[j] += c * sum;
  }
}

static void add_full(SUNMatrix M, sunindextype n, sunrealtype c, const sunrealtype *x,
                     sunrealtype *out)
{
  const sunrealtype *value = SM_DATA_D(M);
  for (sunindextype j = 0; j < n; j++, value += n) {
    sunrealtype sum = 0;
    for (sunindextype k = 0; k < n; k++) sum += value[k] * x[k];
    out[j] += c * sum;
  }
}

void stf_add_transposed(SUNMatrix M, sunindextype n, sunrealtype c, const sunrealtype *x,
                        sunrealtype *out)
{
  const SUNMatrix_ID kind = M ? SUNMatGetID(M) : SUNMATRIX_CUSTOM;
  if (kind == SUNMATRIX_SPARSE || kind == SUNMATRIX_DENSE) {
    (kind == SUNMATRIX_SPARSE ? add_sparse : add_full)(M, n, c, x, out);
    return;
  }
  for (sunindextype j = 0; j < n; j++) {
    sunrealtype sum = M ? 0 : x[j];
    const column v = M ? column_of(M, j) : (column){0};
    if (v.row)
      for (sunindextype k = 0; k < v.count; k++) sum += v.value[k] * x[v.row[k]];
    else
      for (sunindextype k = 0; k < v.count; k++) sum += v.value[k] * x[v.first + k];
    out[j] += c * sum;
  }
}

static void add_full_columns(SUNMatrix M, sunindextype n, sunrealtype c, double *to,
                             sunindextype step, sunindextype ld)
{
  const sunrealtype *value = SM_DATA_D(M);
  for (sunindextype j = 0; j < n; j++, to += ld, value += n)
    for (sunindextype k = 0; k < n; k++) to[step * k] += c * value[k];
}

void stf_add_dense(SUNMatrix M, sunindextype n, sunrealtype c, double *to, sunindextype step,
                   sunindextype ld)
{
  if (M && SUNMatGetID(M) == SUNMATRIX_DENSE) {
    add_full_columns(M, n, c, to, step, ld);
    return;
  }
  for (sunindextype j = 0; j < n; j++, to += ld) {
    if (!M) {
      to[step * j] += c;
      continue;
    }
    const column v = column_of(M, j);
    for (sunindextype k = 0; k < v.count; k++)
      to[step * (v.row ? v.row[k] : v.first + k)] += c * v.value[k];
  }
}
