/* qr.c: dense algebra by rows: LU, the R of Q R, right division.
 *
 * Loops along rows (dense by rows of lu.h) beat calls of LAPACK for small orders. Above, an array by rows is the
 * transpose by columns: A X = B becomes X^T A^T = B^T, W = Q R becomes W^T = R^T Q^T, and X R^{-1}
 * a solve with R^T from the left.
 *
 * Exponents do not ask for the R of an exact Q R: X <- X R^{-1} keeps the product of all steps
 * equal to X_n R_n ... R_1 whatever the triangles R_i are, and the triangle that X_n itself still
 * hides enters once, at the end, over the length of the run. So R comes from Cholesky's
 * W^T W = R^T R, faster than reflections and wrong by eps cond(W)^2, while the diagonal of R shows
 * W to be well conditioned, and from Householder's reflections otherwise.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "lyapunov_thresholds.h"
#include "lapack.h"
#include "lu.h"
#include "variation.h"
#include <math.h>
#include <string.h>

/* Orders of loops: systems, squares and division, reflections. */
enum { SYSTEM = 128, SMALL = 64, TINY = 16 };
enum { BLOCK = 64 }; /* LAPACK's columns at a time */

int stf_algebra_open(stf_pool *pool, int n, int d, int m, stf_algebra *room)
{
  room->rows = stf_rows_best();
  const int most = n > d ? n : d, wide = most > BLOCK ? BLOCK : most;
  room->length = m + m * wide;
  room->pivot = stf_pool_array(pool, (size_t)most, sizeof *room->pivot);
  room->work = stf_pool_array(pool, (size_t)room->length, sizeof *room->work);
  return room->pivot && room->work ? STEIF_OK : STEIF_NO_MEMORY;
}

/* ---- LU ---- */

static void swap_rows(int n, sunrealtype *a, sunrealtype *b)
{
  for (int j = 0; j < n; j++) {
    const sunrealtype kept = a[j];
    a[j] = b[j];
    b[j] = kept;
  }
}

/* The transpose by columns: A^T = P L U. */
static bool large_factor(int n, sunrealtype *A, const stf_algebra *room)
{
  int info;
  dgetrf_(&n, &n, A, &n, room->pivot, &info);
  for (size_t k = 0; k < (size_t)n; k++)
    if (!(fabs(A[k * (size_t)n + k]) > 0)) return false;
  return true;
}

/* X^T = B^T U^{-1} L^{-1} P^T. */
static void large_substitute(int n, int m, const sunrealtype *A, sunrealtype *B,
                             const stf_algebra *room)
{
  const sunrealtype one = 1;
  dtrsm_("R", "U", "N", "N", &m, &n, &one, A, &n, B, &m, 1, 1, 1, 1);
  dtrsm_("R", "L", "N", "U", &m, &n, &one, A, &n, B, &m, 1, 1, 1, 1);
  for (int k = n; k-- > 0;) {
    const size_t p = (size_t)room->pivot[k] - 1;
    if (p != (size_t)k) swap_rows(m, B + (size_t)k * (size_t)m, B + p * (size_t)m);
  }
}

bool stf_factor(int n, sunrealtype *A, const stf_algebra *room)
{
  return n > SYSTEM ? large_factor(n, A, room) : room->rows->factor(n, A, room->pivot);
}

void stf_substitute(int n, int m, const sunrealtype *A, sunrealtype *B, const stf_algebra *room)
{
  if (n > SYSTEM)
    large_substitute(n, m, A, B, room);
  else
    room->rows->substitute(n, m, A, room->pivot, B);
}

/* ---- R by W^T W ---- */

static bool large_squares(int d, int m, const sunrealtype *W, sunrealtype *R)
{
  const sunrealtype one = 1, zero = 0;
  int info;
  dsyrk_("L", "N", &m, &d, &one, W, &m, &zero, R, &m, 1, 1);
  dpotrf_("L", &m, R, &m, &info, 1);
  return info == 0;
}

/* False as well where W is too ill-conditioned, or its squares leave the range of numbers. */
static bool by_squares(int d, int m, const sunrealtype *W, sunrealtype *R,
                       const stf_algebra *room)
{
  if (!(m > SMALL ? large_squares(d, m, W, R) : room->rows->squares(d, m, W, R))) return false;
  sunrealtype least = INFINITY, most = 0;
  for (size_t j = 0; j < (size_t)m; j++) {
    const sunrealtype r = R[j * (size_t)m + j];
    least = r < least ? r : least;
    most = r > most ? r : most;
  }
  return least * STF_SQUARES_SPREAD >= most && least > STF_SQUARES_LEAST &&
         most < STF_SQUARES_MOST;
}

/* ---- R by reflections ---- */

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

static bool large_reflections(int d, int m, sunrealtype *W, sunrealtype *R,
                              const stf_algebra *room)
{
  const int length = room->length - m;
  int info;
  dgelqf_(&m, &d, W, &m, room->work, room->work + m, &length, &info);
  for (int j = 0; j < m; j++) {
    const sunrealtype size = W[j * m + j], sign = size > 0 ? 1 : -1;
    if (!(fabs(size) > 0) || isinf(size)) return false;
    for (int k = j; k < m; k++) R[j * m + k] = sign * W[j * m + k];
  }
  return true;
}

static bool by_reflections(int d, int m, sunrealtype *W, sunrealtype *R,
                           const stf_algebra *room)
{
  if (d > TINY && m > 1) return large_reflections(d, m, W, R, room);
  for (int j = 0; j < m; j++) {
    const sunrealtype size = length(d, m, W, j);
    if (!(size > 0) || isinf(size)) return false;
    reflect(d, m, W, j, size);
    const sunrealtype sign = W[j * m + j] > 0 ? 1 : -1;
    for (int k = j; k < m; k++) R[j * m + k] = sign * W[j * m + k];
  }
  return true;
}

bool stf_triangle(int d, int m, const sunrealtype *W, sunrealtype *spare, sunrealtype *R,
                  const stf_algebra *room)
{
  if (by_squares(d, m, W, R, room)) return true;
  if (spare != W) memcpy(spare, W, (size_t)d * (size_t)m * sizeof *W);
  return by_reflections(d, m, spare, R, room);
}

void stf_renormalise(int rows, int m, const sunrealtype *R, sunrealtype *X,
                     const stf_algebra *room)
{
  const sunrealtype one = 1;
  if (m > SMALL)
    dtrsm_("L", "L", "N", "N", &m, &rows, &one, R, &m, X, &m, 1, 1, 1, 1);
  else
    room->rows->divide(rows, m, R, X);
}
