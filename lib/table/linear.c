/* linear.c: Gaussian elimination with partial pivoting in complex long double, for the few small
 * systems that are solved when a table is taken up.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "table.h"

static long double size(stf_complex z) { return cabsl(z); }

static void swap(int m, stf_complex *x, stf_complex *y)
{
  for (int j = 0; j < m; j++) {
    const stf_complex t = x[j];
    x[j] = y[j], y[j] = t;
  }
}

/* y -= factor x */
static void subtract(int m, stf_complex factor, const stf_complex *x, stf_complex *y)
{
  for (int j = 0; j < m; j++) y[j] -= factor * x[j];
}

bool stf_solve(int n, int m, stf_complex *A, stf_complex *X, long double tiny)
{
  for (int k = 0; k < n; k++) {
    int p = k;
    for (int i = k + 1; i < n; i++)
      if (size(A[i * n + k]) > size(A[p * n + k])) p = i;
    if (!(size(A[p * n + k]) > tiny)) return false;
    if (p != k) swap(n, A + p * n, A + k * n), swap(m, X + p * m, X + k * m);
    for (int i = k + 1; i < n; i++) {
      const stf_complex factor = A[i * n + k] / A[k * n + k];
      if (factor == 0) continue;
      subtract(n - k, factor, A + k * n + k, A + i * n + k);
      subtract(m, factor, X + k * m, X + i * m);
    }
  }
  for (int k = n - 1; k >= 0; k--) {
    for (int i = k + 1; i < n; i++) subtract(m, A[k * n + i], X + i * m, X + k * m);
    for (int j = 0; j < m; j++) X[k * m + j] /= A[k * n + k];
  }
  return true;
}
