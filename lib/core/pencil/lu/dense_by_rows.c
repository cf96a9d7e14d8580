/* dense_by_rows.c: algebra of dense matrices by rows whose orders are small: loops along rows, in vector
 * registers, that exist once per instruction set. LAPACK's calls cost more there, and some wake
 * threads.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "lu.h"
#include <math.h>

/* x -= sum of a[i] y_i, i < 4, the y_i `gap` apart. */
INLINE void minus4(int n, const sunrealtype *a, const sunrealtype *y, size_t gap,
                   sunrealtype *restrict x)
{
  const sunrealtype *restrict y0 = y, *restrict y1 = y + gap, *restrict y2 = y + 2 * gap,
                              *restrict y3 = y + 3 * gap;
  const sunrealtype a0 = a[0], a1 = a[1], a2 = a[2], a3 = a[3];
  for (int j = 0; j < n; j++) x[j] -= (a0 * y0[j] + a1 * y1[j]) + (a2 * y2[j] + a3 * y3[j]);
}

INLINE void minus(int n, sunrealtype a, const sunrealtype *restrict y, sunrealtype *restrict x)
{
  for (int j = 0; j < n; j++) x[j] -= a * y[j];
}

/* x -= sum of a[i] y_i, i < count. */
INLINE void minus_all(int n, int count, const sunrealtype *a, const sunrealtype *y,
                      sunrealtype *x)
{
  int i = 0;
  for (; i + 4 <= count; i += 4) minus4(n, a + i, y + (size_t)i * (size_t)n, (size_t)n, x);
  for (; i < count; i++) minus(n, a[i], y + (size_t)i * (size_t)n, x);
}

INLINE void swap_rows(int n, sunrealtype *restrict a, sunrealtype *restrict b)
{
  for (int j = 0; j < n; j++) {
    const sunrealtype kept = a[j];
    a[j] = b[j], b[j] = kept;
  }
}

INLINE int pivot_row(int n, const sunrealtype *A, int k)
{
  int best = k;
  for (int i = k + 1; i < n; i++)
    if (fabs(A[i * n + k]) > fabs(A[best * n + k])) best = i;
  return best;
}

/* Multipliers below the diagonal, reciprocals of the pivots on it. */
INLINE bool factor(int n, sunrealtype *A, int *pivot)
{
  for (int k = 0; k < n; k++) {
    const int p = pivot[k] = pivot_row(n, A, k);
    if (p != k) swap_rows(n, A + p * n, A + k * n);
    if (!(fabs(A[k * n + k]) > 0)) return false;
    const sunrealtype r = A[k * n + k] = 1 / A[k * n + k];
    for (int i = k + 1; i < n; i++) {
      const sunrealtype q = A[i * n + k] *= r;
      if (q != 0) minus(n - k - 1, q, A + k * n + k + 1, A + i * n + k + 1);
    }
  }
  return true;
}

INLINE sunrealtype product(int n, const sunrealtype *restrict a, const sunrealtype *restrict x)
{
  v4 sum = {0};
  int i = 0;
  for (; i + 4 <= n; i += 4) sum += *(const v4 *)(a + i) * *(const v4 *)(x + i);
  sunrealtype all = (sum[0] + sum[1]) + (sum[2] + sum[3]);
  for (; i < n; i++) all += a[i] * x[i];
  return all;
}

INLINE void substitute_one(int n, const sunrealtype *A, const int *pivot, sunrealtype *b)
{
  for (int k = 0; k < n; k++)
    if (pivot[k] != k) swap_rows(1, b + pivot[k], b + k);
  for (int i = 1; i < n; i++) b[i] -= product(i, A + i * n, b);
  for (int i = n; i-- > 0;)
    b[i] = (b[i] - product(n - 1 - i, A + i * n + i + 1, b + i + 1)) * A[i * n + i];
}

/* U^T z = b, L^T v = z, and the exchanges in the opposite order. */
INLINE void substitute_transposed(int n, const sunrealtype *A, const int *pivot, sunrealtype *b)
{
  for (int k = 0; k < n; k++) {
    b[k] *= A[k * n + k];
    minus(n - k - 1, b[k], A + k * n + k + 1, b + k + 1);
  }
  for (int k = n; k-- > 1;) minus(k, b[k], A + k * n, b);
  for (int k = n; k-- > 0;)
    if (pivot[k] != k) swap_rows(1, b + pivot[k], b + k);
}

INLINE void substitute(int n, int m, const sunrealtype *A, const int *pivot, sunrealtype *B)
{
  for (int k = 0; k < n; k++)
    if (pivot[k] != k) swap_rows(m, B + pivot[k] * m, B + k * m);
  for (int i = 1; i < n; i++) minus_all(m, i, A + i * n, B, B + i * m);
  for (int i = n; i-- > 0;) {
    minus_all(m, n - 1 - i, A + i * n + i + 1, B + (i + 1) * m, B + i * m);
    for (int j = 0; j < m; j++) B[i * m + j] *= A[i * n + i];
  }
}

/* The upper triangle of W^T W. */
INLINE void gram(int d, int m, const sunrealtype *W, sunrealtype *G)
{
  for (int a = 0; a < m; a++)
    for (int b = a; b < m; b++) G[a * m + b] = 0;
  int i = 0;
  for (; i + 4 <= d; i += 4, W += 4 * m)
    for (int a = 0; a < m; a++) {
      const sunrealtype w[] = {-W[a], -W[m + a], -W[2 * m + a], -W[3 * m + a]};
      minus4(m - a, w, W + a, (size_t)m, G + a * m + a);
    }
  for (; i < d; i++, W += m)
    for (int a = 0; a < m; a++) minus(m - a, -W[a], W + a, G + a * m + a);
}

/* G = R^T R in place. */
INLINE bool cholesky(int m, sunrealtype *G)
{
  for (int j = 0; j < m; j++) {
    sunrealtype *row = G + j * m;
    if (!(row[j] > 0)) return false;
    const sunrealtype size = sqrt(row[j]), r = 1 / size;
    row[j] = size;
    for (int k = j + 1; k < m; k++) row[k] *= r;
    for (int i = j + 1; i < m; i++) minus(m - i, row[i], row + i, G + i * m + i);
  }
  return true;
}

INLINE bool squares(int d, int m, const sunrealtype *W, sunrealtype *R)
{
  gram(d, m, W, R);
  return cholesky(m, R);
}

/* Of `count` <= 4 rows of X, which wait for each other less than the entries of one do. */
INLINE void divide_some(const int count, int m, const sunrealtype *R, sunrealtype *X)
{
  for (int j = 0; j < m; j++) {
    const sunrealtype r = 1 / R[j * m + j];
    for (int i = 0; i < count; i++) X[i * m + j] *= r;
    for (int i = 0; i < count; i++)
      minus(m - j - 1, X[i * m + j], R + j * m + j + 1, X + i * m + j + 1);
  }
}

INLINE void divide(int rows, int m, const sunrealtype *R, sunrealtype *X)
{
  int i = 0;
  for (; i + 4 <= rows; i += 4, X += 4 * m) divide_some(4, m, R, X);
  for (; i < rows; i++, X += m) divide_some(1, m, R, X);
}

/* -- instruction sets -------------------------------------------------------------------- */

#define ROWS(isa, attribute)                                                                   \
  attribute static bool factor_##isa(int n, sunrealtype *A, int *pivot)                        \
  {                                                                                            \
    return factor(n, A, pivot);                                                                \
  }                                                                                            \
  attribute static void substitute_##isa(int n, int m, const sunrealtype *A, const int *pivot, \
                                         sunrealtype *B)                                       \
  {                                                                                            \
    if (m == 1)                                                                                \
      substitute_one(n, A, pivot, B);                                                          \
    else                                                                                       \
      substitute(n, m, A, pivot, B);                                                           \
  }                                                                                            \
  attribute static void transposed_##isa(int n, const sunrealtype *A, const int *pivot,        \
                                         sunrealtype *b)                                       \
  {                                                                                            \
    substitute_transposed(n, A, pivot, b);                                                     \
  }                                                                                            \
  attribute static bool squares_##isa(int d, int m, const sunrealtype *W, sunrealtype *R)      \
  {                                                                                            \
    return squares(d, m, W, R);                                                                \
  }                                                                                            \
  attribute static void divide_##isa(int rows, int m, const sunrealtype *R, sunrealtype *X)    \
  {                                                                                            \
    divide(rows, m, R, X);                                                                     \
  }                                                                                            \
  static const stf_rows isa = {factor_##isa, substitute_##isa, transposed_##isa,               \
                               squares_##isa, divide_##isa};

ROWS(plain, )
#ifdef STF_SIMD_X86
ROWS(avx2, STF_AVX2)
ROWS(avx512, STF_AVX512)
#endif

const stf_rows *stf_rows_best(void)
{
#ifdef STF_SIMD_X86
  return stf_simd_width() == 8 ? &avx512 : stf_simd_width() == 4 ? &avx2 : &plain;
#else
  return &plain;
#endif
}
