/* dense_transposed.c: solves with the transpose of factors P M = L U of dense unrolled:
 * M^H = U^H L^H P, so U^H z = b, L^H v = z and x = P^T v.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "lu.h"

/* x_k - sum over from <= i < to of entry (i, k) x_i. */
static double less(const double *restrict column, const double *restrict x, int k, int from,
                   int to)
{
  double sum = x[k];
  for (int i = from; i < to; i++) sum -= column[i] * x[i];
  return sum;
}

void stf_unrolled_solve_transposed(int n, const double *lu, const int *perm, double *b)
{
  double x[STF_UNROLLED];
  for (int k = 0; k < n; k++) {
    x[k] = b[k];
    x[k] = less(lu + n * k, x, k, 0, k) / lu[k + n * k];
  }
  for (int k = n - 2; k >= 0; k--) x[k] = less(lu + n * k, x, k, k + 1, n);
  for (int k = 0; k < n; k++) b[perm[k]] = x[k];
}

/* The same with conjugates. */
static void zless(const double *restrict re, const double *restrict im, double *restrict x,
                  double *restrict y, int k, int from, int to)
{
  for (int i = from; i < to; i++) {
    x[k] -= re[i] * x[i] + im[i] * y[i];
    y[k] -= re[i] * y[i] - im[i] * x[i];
  }
}

void stf_unrolled_zsolve_transposed(int n, const double *re, const double *im, const int *perm,
                                    double *br, double *bi)
{
  double x[STF_UNROLLED], y[STF_UNROLLED];
  for (int k = 0; k < n; k++) {
    x[k] = br[k], y[k] = bi[k];
    zless(re + n * k, im + n * k, x, y, k, 0, k);
    const double u = re[k + n * k], v = -im[k + n * k], s = x[k], t = y[k];
    x[k] = u * s - v * t, y[k] = u * t + v * s;
  }
  for (int k = n - 2; k >= 0; k--) zless(re + n * k, im + n * k, x, y, k, k + 1, n);
  for (int k = 0; k < n; k++) br[perm[k]] = x[k], bi[perm[k]] = y[k];
}
