/* long_lu.c: Gaussian elimination with partial pivoting in complex long double, for the few
 * small systems that are solved when a table is taken up.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "table.h"
#include <math.h>

static long double size(stf_complex z) { return fabsl(creall(z)) + fabsl(cimagl(z)); }

/* Products are written out: Annex G's treatment of infinities would cost five times the work.
 * */
static stf_complex times(stf_complex x, stf_complex y)
{
  const long double a = creall(x), b = cimagl(x), c = creall(y), d = cimagl(y);
  return (a * c - b * d) + (a * d + b * c) * I;
}

static stf_complex inverse(stf_complex x)
{
  const long double scale = size(x), a = creall(x) / scale, b = cimagl(x) / scale;
  const long double square = (a * a + b * b) * scale;
  return a / square - b / square * I;
}

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
  for (int j = 0; j < m; j++) y[j] -= times(factor, x[j]);
}

bool stf_solve(int n, int m, stf_complex *A, stf_complex *X, long double tiny)
{
  for (int k = 0; k < n; k++) {
    int p = k;
    for (int i = k + 1; i < n; i++)
      if (size(A[i * n + k]) > size(A[p * n + k])) p = i;
    if (!(size(A[p * n + k]) > tiny)) return false;
    if (p != k) swap(n, A + p * n, A + k * n), swap(m, X + p * m, X + k * m);
    const stf_complex over = inverse(A[k * n + k]);
    A[k * n + k] = over; /* kept for the back substitution */
    for (int i = k + 1; i < n; i++) {
      const stf_complex factor = times(A[i * n + k], over);
      if (factor == 0) continue;
      subtract(n - k - 1, factor, A + k * n + k + 1, A + i * n + k + 1);
      subtract(m, factor, X + k * m, X + i * m);
    }
  }
  for (int k = n - 1; k >= 0; k--) {
    for (int i = k + 1; i < n; i++) subtract(m, A[k * n + i], X + i * m, X + k * m);
    for (int j = 0; j < m; j++) X[k * m + j] = times(X[k * m + j], A[k * n + k]);
  }
  return true;
}
