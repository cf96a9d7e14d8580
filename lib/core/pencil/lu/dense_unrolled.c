/* dense_unrolled.c: Gaussian elimination with partial pivoting for n <= 16 (Golub & Van Loan, Matrix
 * Computations, 3.4). Each kernel is written once for any n and instantiated with n constant where
 * that pays, so that its loops unroll.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "lu.h"
#include <float.h>
#include <math.h>

static inline void swap(double *x, double *y)
{
  const double t = *x;
  *x = *y, *y = t;
}

static inline int factor(const int n, double *restrict a, int *restrict perm)
{
  for (int i = 0; i < n; i++) perm[i] = i;
  for (int k = 0; k < n; k++) {
    int p = k;
    double big = fabs(a[k + n * k]);
    for (int i = k + 1; i < n; i++)
      if (fabs(a[i + n * k]) > big) big = fabs(a[i + n * k]), p = i;
    if (!(big >= DBL_MIN)) return k + 1;
    if (p != k) {
      const int t = perm[k];
      perm[k] = perm[p], perm[p] = t;
      for (int j = 0; j < n; j++) swap(&a[k + n * j], &a[p + n * j]);
    }
    for (int i = k + 1; i < n; i++) a[i + n * k] /= a[k + n * k];
    for (int j = k + 1; j < n; j++)
      for (int i = k + 1; i < n; i++) a[i + n * j] -= a[i + n * k] * a[k + n * j];
  }
  return 0;
}

static inline void subtract(const int n, const int k, const int from, const int to,
                            const double *restrict a, double *restrict x)
{
  for (int i = from; i < to; i++) x[i] -= a[i + n * k] * x[k];
}

static inline void up(const int n, const int k, const double *restrict a, double *restrict x)
{
  x[k] /= a[k + n * k]; /* exact where the quotient is: index-k layers keep their zeros */
  subtract(n, k, 0, k, a, x);
}

/* Without a loop over k: with n constant every step is straight code. */
static inline void solve_short(const int n, const double *restrict a, const int *restrict perm,
                               double *restrict b)
{
  double x[8];
  for (int i = 0; i < n; i++) x[i] = b[perm[i]];
  subtract(n, 0, 1, n, a, x);
  if (n > 1) subtract(n, 1, 2, n, a, x);
  if (n > 2) subtract(n, 2, 3, n, a, x);
  if (n > 3) subtract(n, 3, 4, n, a, x);
  if (n > 4) subtract(n, 4, 5, n, a, x);
  if (n > 5) subtract(n, 5, 6, n, a, x);
  if (n > 6) subtract(n, 6, 7, n, a, x);
  if (n > 7) up(n, 7, a, x);
  if (n > 6) up(n, 6, a, x);
  if (n > 5) up(n, 5, a, x);
  if (n > 4) up(n, 4, a, x);
  if (n > 3) up(n, 3, a, x);
  if (n > 2) up(n, 2, a, x);
  if (n > 1) up(n, 1, a, x);
  up(n, 0, a, x);
  for (int i = 0; i < n; i++) b[i] = x[i];
}

/* 1 / (x + i y) without overflow of the squares (Smith, CACM 5, 1962). */
static inline void invert(double *x, double *y)
{
  const double a = *x, b = *y;
  if (fabs(a) >= fabs(b)) {
    const double r = b / a, d = 1 / (a + b * r);
    *x = d, *y = -r * d;
  } else {
    const double r = a / b, d = 1 / (b + a * r);
    *x = r * d, *y = -d;
  }
}

/* Column j minus column k times entry (k, j), below row k. */
static inline void eliminate(const int n, const int k, const int j, double *restrict re,
                             double *restrict im)
{
  const double x = re[k + n * j], y = im[k + n * j];
  for (int i = k + 1; i < n; i++) {
    const double u = re[i + n * k], v = im[i + n * k];
    re[i + n * j] -= u * x - v * y;
    im[i + n * j] -= u * y + v * x;
  }
}

static inline int zpivot(const int n, const int k, const double *re, const double *im)
{
  int p = k;
  double big = 0;
  for (int i = k; i < n; i++) {
    const double size = fabs(re[i + n * k]) + fabs(im[i + n * k]);
    if (size > big) big = size, p = i;
  }
  return big >= DBL_MIN ? p : -1;
}

static inline int zfactor(const int n, double *restrict re, double *restrict im,
                          int *restrict perm)
{
  for (int i = 0; i < n; i++) perm[i] = i;
  for (int k = 0; k < n; k++) {
    const int p = zpivot(n, k, re, im);
    if (p < 0) return k + 1;
    if (p != k) {
      const int t = perm[k];
      perm[k] = perm[p], perm[p] = t;
      for (int j = 0; j < n; j++)
        swap(&re[k + n * j], &re[p + n * j]), swap(&im[k + n * j], &im[p + n * j]);
    }
    invert(&re[k + n * k], &im[k + n * k]);
    const double x = re[k + n * k], y = im[k + n * k];
    for (int i = k + 1; i < n; i++) {
      const double u = re[i + n * k], v = im[i + n * k];
      re[i + n * k] = u * x - v * y, im[i + n * k] = u * y + v * x;
    }
    for (int j = k + 1; j < n; j++) eliminate(n, k, j, re, im);
  }
  return 0;
}

/* x_i minus entry (i, k) times x_k, for i in from .. to - 1. */
static inline void zsubtract(const int n, const int k, const int from, const int to,
                             const double *restrict re, const double *restrict im,
                             double *restrict x, double *restrict y)
{
  const double s = x[k], t = y[k];
  for (int i = from; i < to; i++) {
    const double u = re[i + n * k], v = im[i + n * k];
    x[i] -= u * s - v * t;
    y[i] -= u * t + v * s;
  }
}

static inline void zsolve(const int n, const double *restrict re, const double *restrict im,
                          const int *restrict perm, double *restrict br, double *restrict bi)
{
  double x[STF_UNROLLED], y[STF_UNROLLED];
  for (int i = 0; i < n; i++) x[i] = br[perm[i]], y[i] = bi[perm[i]];
  for (int k = 0; k < n; k++) zsubtract(n, k, k + 1, n, re, im, x, y);
  for (int k = n - 1; k >= 0; k--) {
    const double u = re[k + n * k], v = im[k + n * k], s = x[k], t = y[k];
    x[k] = u * s - v * t, y[k] = u * t + v * s;
    zsubtract(n, k, 0, k, re, im, x, y);
  }
  for (int i = 0; i < n; i++) br[i] = x[i], bi[i] = y[i];
}

#define OF_EACH_SIZE(result, kernel, ...)                                                      \
  switch (n) {                                                                                 \
  case 1: result kernel(1, __VA_ARGS__); break;                                                \
  case 2: result kernel(2, __VA_ARGS__); break;                                                \
  case 3: result kernel(3, __VA_ARGS__); break;                                                \
  case 4: result kernel(4, __VA_ARGS__); break;                                                \
  case 5: result kernel(5, __VA_ARGS__); break;                                                \
  case 6: result kernel(6, __VA_ARGS__); break;                                                \
  case 8: result kernel(8, __VA_ARGS__); break;                                                \
  default: result kernel(n, __VA_ARGS__);                                                      \
  }

int stf_unrolled_factor(int n, double *a, int *perm)
{
  int info;
  if (n > 8) return stf_blocked_factor(n, a, perm);
  OF_EACH_SIZE(info =, factor, a, perm)
  return info;
}

int stf_unrolled_zfactor(int n, double *re, double *im, int *perm)
{
  int info;
  OF_EACH_SIZE(info =, zfactor, re, im, perm)
  return info;
}

void stf_unrolled_solve(int n, const double *lu, const int *perm, double *b)
{
  switch (n) {
  case 1: solve_short(1, lu, perm, b); break;
  case 2: solve_short(2, lu, perm, b); break;
  case 3: solve_short(3, lu, perm, b); break;
  case 4: solve_short(4, lu, perm, b); break;
  case 5: solve_short(5, lu, perm, b); break;
  case 6: solve_short(6, lu, perm, b); break;
  case 7: solve_short(7, lu, perm, b); break;
  case 8: solve_short(8, lu, perm, b); break;
  default: stf_blocked_solve(n, lu, perm, b);
  }
}

void stf_unrolled_zsolve(int n, const double *re, const double *im, const int *perm, double *br,
                         double *bi)
{
  OF_EACH_SIZE((void), zsolve, re, im, perm, br, bi)
}
