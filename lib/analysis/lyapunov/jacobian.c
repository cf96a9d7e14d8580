/* jacobian.c: what exponents need of a Jacobian, in whatever storage it comes.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "jacobian.h"
#include "lapack.h"
#include <math.h>
#include <string.h>

enum { SMALL = 16 }; /* order up to which loops beat BLAS */

static inline sunindextype order_of(SUNMatrix M)
{
  switch (SUNMatGetID(M)) {
  case SUNMATRIX_DENSE: return SM_COLUMNS_D(M);
  case SUNMATRIX_BAND: return SM_COLUMNS_B(M);
  default: return SM_COLUMNS_S(M);
  }
}

stf_entries stf_jacobian_column(SUNMatrix M, sunindextype j)
{
  const sunindextype n = order_of(M);
  if (SUNMatGetID(M) == SUNMATRIX_DENSE)
    return (stf_entries){.count = n, .value = SM_COLUMN_D(M, j)};
  if (SUNMatGetID(M) == SUNMATRIX_BAND) {
    const sunindextype above = SM_UBAND_B(M), below = SM_LBAND_B(M);
    const sunindextype first = j > above ? j - above : 0,
                       last = j + below < n ? j + below : n - 1;
    return (stf_entries){first, last + 1 - first, NULL, &SM_ELEMENT_B(M, first, j)};
  }
  return stf_sparse_column(M, j);
}

static void destroy(void *M) { SUNMatDestroy(M); }

SUNMatrix stf_jacobian_new(stf_pool *pool, steif_context *ctx, enum steif_storage storage,
                           sunindextype n, sunindextype lower, sunindextype upper,
                           sunindextype entries)
{
  SUNContext sun = steif_sundials(ctx);
  SUNMatrix M = storage == STEIF_DENSE  ? SUNDenseMatrix(n, n, sun)
                : storage == STEIF_BAND ? SUNBandMatrix(n, upper, lower, sun)
                                        : SUNSparseMatrix(n, n, entries, CSC_MAT, sun);
  if (!M) {
    STEIF_FAIL(ctx, STEIF_NO_MEMORY, "no memory for a matrix of order %lld", (long long)n);
    return NULL;
  }
  return stf_pool_adopt(pool, M, destroy) ? NULL : M;
}

void stf_jacobian_clear(SUNMatrix M)
{
  if (SUNMatGetID(M) == SUNMATRIX_DENSE)
    memset(SM_DATA_D(M), 0, (size_t)SM_LDATA_D(M) * sizeof(sunrealtype));
  else if (SUNMatGetID(M) == SUNMATRIX_BAND)
    memset(SM_DATA_B(M), 0, (size_t)SM_LDATA_B(M) * sizeof(sunrealtype));
}

static void by_entries(SUNMatrix M, sunindextype n, int m, sunrealtype h, const sunrealtype *B,
                       sunrealtype *K)
{
  const size_t width = (size_t)m;
  const bool sparse = SUNMatGetID(M) == SUNMATRIX_SPARSE;
  memset(K, 0, (size_t)n * width * sizeof *K);
  for (sunindextype j = 0; j < n; j++) {
    const stf_entries c = sparse ? stf_sparse_column(M, j) : stf_jacobian_column(M, j);
    const sunrealtype *restrict b = B + (size_t)j * width;
    for (sunindextype e = 0; e < c.count; e++) {
      sunrealtype *restrict k = K + (size_t)stf_row_of(&c, e) * width, x = h * c.value[e];
      for (size_t i = 0; i < width; i++) k[i] += x * b[i];
    }
  }
}

static void small_times(int d, int m, sunrealtype h, const sunrealtype *M,
                        const sunrealtype *restrict B, sunrealtype *restrict K)
{
  for (int i = 0; i < d; i++)
    for (int k = 0; k < m; k++) {
      sunrealtype sum = 0;
      for (int j = 0; j < d; j++) sum += M[j * d + i] * B[j * m + k];
      K[i * m + k] = h * sum;
    }
}

void stf_jacobian_times(SUNMatrix M, int m, sunrealtype h, const sunrealtype *B, sunrealtype *K)
{
  const sunrealtype zero = 0;
  if (SUNMatGetID(M) != SUNMATRIX_DENSE) {
    by_entries(M, order_of(M), m, h, B, K);
    return;
  }
  const int d = (int)SM_COLUMNS_D(M);
  if (d <= SMALL)
    small_times(d, m, h, SM_DATA_D(M), B, K);
  else /* K^T = h B^T M^T, by columns */
    dgemm_("N", "T", &m, &d, &d, &h, B, &m, SM_DATA_D(M), &d, &zero, K, &m, 1, 1);
}

void stf_jacobian_scale(SUNMatrix M, sunrealtype x)
{
  for (sunindextype j = 0; j < order_of(M); j++) {
    const stf_entries c = stf_jacobian_column(M, j);
    for (sunindextype e = 0; e < c.count; e++) c.value[e] *= x;
  }
}

sunrealtype stf_jacobian_trace(SUNMatrix M)
{
  sunrealtype sum = 0;
  if (SUNMatGetID(M) == SUNMATRIX_DENSE) {
    for (sunindextype j = 0; j < SM_COLUMNS_D(M); j++) sum += SM_ELEMENT_D(M, j, j);
    return sum;
  }
  const sunindextype n = order_of(M);
  for (sunindextype j = 0; j < n; j++)
    if (SUNMatGetID(M) == SUNMATRIX_BAND) {
      sum += SM_ELEMENT_B(M, j, j);
    } else {
      const stf_entries c = stf_sparse_column(M, j);
      for (sunindextype e = 0; e < c.count; e++) sum += c.row[e] == j ? c.value[e] : 0;
    }
  return sum;
}

sunrealtype stf_jacobian_size(SUNMatrix M, sunrealtype *work)
{
  const sunindextype n = order_of(M);
  sunrealtype most = 0;
  memset(work, 0, (size_t)n * sizeof *work);
  for (sunindextype j = 0; j < n; j++) {
    const stf_entries c = stf_jacobian_column(M, j);
    for (sunindextype e = 0; e < c.count; e++) work[stf_row_of(&c, e)] += fabs(c.value[e]);
  }
  for (sunindextype i = 0; i < n; i++) most = fmax(most, work[i]);
  return most;
}

bool stf_jacobian_same(SUNMatrix A, SUNMatrix B)
{
  for (sunindextype j = 0; j < order_of(A); j++) {
    const stf_entries a = stf_jacobian_column(A, j), b = stf_jacobian_column(B, j);
    if (a.count != b.count) return false;
    for (sunindextype e = 0; e < a.count; e++)
      if (a.value[e] != b.value[e] || stf_row_of(&a, e) != stf_row_of(&b, e)) return false;
  }
  return true;
}

void stf_jacobian_spread(SUNMatrix J, sunrealtype c, int order, int row, int column,
                         sunrealtype *M)
{
  const sunindextype n = order_of(J);
  const size_t stride = (size_t)order;
  for (sunindextype j = 0; j < n; j++) {
    const stf_entries from = stf_jacobian_column(J, j);
    sunrealtype *to = M + (size_t)row * stride + (size_t)(column + j);
    for (sunindextype e = 0; e < from.count; e++)
      to[(size_t)stf_row_of(&from, e) * stride] += c * from.value[e];
  }
}
