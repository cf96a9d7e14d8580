/* qr.c: dense algebra by rows: products, elimination, Householder's R, right division.
 *
 * Plain loops beat calls of LAPACK for small orders. Above, an array by rows is the transpose by
 * columns: A X = B becomes factors of A^T solved transposed, W = Q R becomes W^T = R^T Q^T, an LQ
 * decomposition in place, and X R^{-1} a solve with R^T from the left.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "blas.h"
#include "variation.h"
#include <math.h>

enum { SMALL = 16, BLOCK = 64 }; /* orders of loops; LAPACK's columns at a time */

int stf_algebra_open(stf_pool *pool, int n, int d, int m, stf_algebra *room)
{
  const int most = n > d ? n : d, wide = most > BLOCK ? most : BLOCK;
  room->length = m + m * wide;
  room->pivot = stf_claim(pool, (size_t)most, sizeof *room->pivot);
  room->work = stf_claim(pool, (size_t)room->length, sizeof *room->work);
  return room->pivot && room->work ? STEIF_OK : STEIF_NO_MEMORY;
}

void stf_variation_product(int d, int m, sunrealtype h, const sunrealtype *J,
                           const sunrealtype *B, sunrealtype *K)
{
  const sunrealtype zero = 0;
  if (d > SMALL) {
    dgemm_("N", "N", &m, &d, &d, &h, B, &m, J, &d, &zero, K, &m, 1, 1);
    return;
  }
  for (int a = 0; a < d; a++)
    for (int j = 0; j < m; j++) {
      sunrealtype sum = 0;
      for (int l = 0; l < d; l++) sum += J[a * d + l] * B[l * m + j];
      K[a * m + j] = h * sum;
    }
}

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

static bool large_eliminate(int n, int m, sunrealtype *A, sunrealtype *B,
                            const stf_algebra *room)
{
  int info;
  dgetrf_(&n, &n, A, &n, room->pivot, &info);
  for (int k = 0; k < n; k++)
    if (!(fabs(A[k * n + k]) > 0)) return false;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < m; j++) room->work[j * n + i] = B[i * m + j];
  dgetrs_("T", &n, &m, A, &n, room->pivot, room->work, &n, &info, 1);
  for (int i = 0; i < n; i++)
    for (int j = 0; j < m; j++) B[i * m + j] = room->work[j * n + i];
  return true;
}

bool stf_eliminate(int n, int m, sunrealtype *A, sunrealtype *B, const stf_algebra *room)
{
  if (n > SMALL) return large_eliminate(n, m, A, B, room);
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

static bool large_triangle(int d, int m, sunrealtype *W, sunrealtype *R,
                           const stf_algebra *room)
{
  const int length = room->length - m;
  int info;
  dgelqf_(&m, &d, W, &m, room->work, room->work + m, &length, &info);
  for (int j = 0; j < m; j++) {
    const sunrealtype size = W[j * m + j], sign = size > 0 ? 1 : -1;
    if (!(fabs(size) > 0) || isinf(size)) return false;
    for (int k = 0; k < m; k++) R[j * m + k] = k < j ? 0 : sign * W[j * m + k];
  }
  return true;
}

bool stf_triangle(int d, int m, sunrealtype *W, sunrealtype *R, const stf_algebra *room)
{
  if (d > SMALL && m > 1) return large_triangle(d, m, W, R, room);
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
  const sunrealtype one = 1;
  if (rows > SMALL && m > 1) {
    dtrsm_("L", "L", "N", "N", &m, &rows, &one, R, &m, X, &m, 1, 1, 1, 1);
    return;
  }
  for (int i = 0; i < rows; i++)
    for (int j = 0; j < m; j++) {
      sunrealtype sum = X[i * m + j];
      for (int l = 0; l < j; l++) sum -= X[i * m + l] * R[l * m + j];
      X[i * m + j] = sum / R[j * m + j];
    }
}
