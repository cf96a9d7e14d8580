/* qr.c: small dense algebra by rows: elimination, Householder's R, right division.
 *
 * Orders are those of the problem, mostly below 10: plain loops beat calls of LAPACK.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "variation.h"
#include <math.h>

static void swap_rows(int n, sunrealtype *a, sunrealtype *b)
{
  for (int j = 0; j < n; j++) {
    const sunrealtype kept = a[j];
    a[j] = b[j], b[j] = kept;
  }
}

static int pivot_row(int n, const sunrealtype *A, int k)
{
  int best = k;
  for (int i = k + 1; i < n; i++)
    if (fabs(A[i * n + k]) > fabs(A[best * n + k])) best = i;
  return best;
}

bool stf_eliminate(int n, int m, sunrealtype *A, sunrealtype *B)
{
  for (int k = 0; k < n; k++) {
    const int p = pivot_row(n, A, k);
    if (p != k) swap_rows(n, A + p * n, A + k * n), swap_rows(m, B + p * m, B + k * m);
    if (!(fabs(A[k * n + k]) > 0)) return false;
    for (int i = k + 1; i < n; i++) {
      const sunrealtype q = A[i * n + k] / A[k * n + k];
      if (q == 0) continue;
      for (int j = k + 1; j < n; j++) A[i * n + j] -= q * A[k * n + j];
      for (int j = 0; j < m; j++) B[i * m + j] -= q * B[k * m + j];
    }
  }
  for (int i = n; i-- > 0;)
    for (int j = 0; j < m; j++) {
      sunrealtype sum = B[i * m + j];
      for (int l = i + 1; l < n; l++) sum -= A[i * n + l] * B[l * m + j];
      B[i * m + j] = sum / A[i * n + i];
    }
  return true;
}

/* Length of column j of W below row j, free of overflow. */
static sunrealtype length(int d, int m, const sunrealtype *W, int j)
{
  sunrealtype size = 0, sum = 0;
  for (int i = j; i < d; i++) {
    const sunrealtype x = fabs(W[i * m + j]);
    if (!(x <= size)) size = x;
  }
  if (!(size > 0) || isinf(size)) return size;
  for (int i = j; i < d; i++) sum += W[i * m + j] / size * (W[i * m + j] / size);
  return size * sqrt(sum);
}

/* Reflect column j onto +-e_j: v = x +- |x| e_1 stays below the diagonal of column j. */
static void reflect(int d, int m, sunrealtype *W, int j, sunrealtype size)
{
  const sunrealtype x = W[j * m + j], image = x > 0 ? -size : size, v0 = x - image;
  for (int i = j + 1; i < d; i++) W[i * m + j] /= v0;
  const sunrealtype tau = -v0 / image; /* 2 / |v|^2 with v_0 = 1 */
  for (int k = j + 1; k < m; k++) {
    sunrealtype sum = W[j * m + k];
    for (int i = j + 1; i < d; i++) sum += W[i * m + j] * W[i * m + k];
    W[j * m + k] -= tau * sum;
    for (int i = j + 1; i < d; i++) W[i * m + k] -= tau * sum * W[i * m + j];
  }
  W[j * m + j] = image;
}

bool stf_triangle(int d, int m, sunrealtype *W, sunrealtype *R)
{
  for (int j = 0; j < m; j++) {
    const sunrealtype size = length(d, m, W, j);
    if (!(size > 0) || isinf(size)) return false;
    reflect(d, m, W, j, size);
    const sunrealtype sign = W[j * m + j] > 0 ? 1 : -1;
    for (int k = 0; k < m; k++) R[j * m + k] = k < j ? 0 : sign * W[j * m + k];
  }
  return true;
}

void stf_renormalise(int rows, int m, const sunrealtype *R, sunrealtype *X)
{
  for (int i = 0; i < rows; i++)
    for (int j = 0; j < m; j++) {
      sunrealtype sum = X[i * m + j];
      for (int l = 0; l < j; l++) sum -= X[i * m + l] * R[l * m + j];
      X[i * m + j] = sum / R[j * m + j];
    }
}
