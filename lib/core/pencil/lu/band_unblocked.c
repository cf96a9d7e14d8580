/* band_unblocked.c: Gaussian elimination with partial pivoting in a narrow band (Golub & Van Loan, Matrix
 * Computations, 4.3.5), column by column.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "lu.h"
#include <float.h>
#include <math.h>

static int least(sunindextype x, sunindextype y) { return (int)(x < y ? x : y); }

static void swap(double *x, double *y)
{
  const double t = *x;
  *x = *y, *y = t;
}

/* The row of the largest of d[0 .. rows], counted from the diagonal; -1 when all vanish. */
static int pivot_row(const double *d, int rows)
{
  int p = 0;
  double big = fabs(d[0]);
  for (int i = 1; i <= rows; i++)
    if (fabs(d[i]) > big) big = fabs(d[i]), p = i;
  return big >= DBL_MIN ? p : -1;
}

/* A step to the next column keeps the row: ld - 1 doubles. The columns that row j reaches end at
 * `last`, which grows by the fill of exchanges. */
sunindextype stf_band_factor(const stf_band *b, double *ab, int *pivot)
{
  const int ld = 2 * b->kl + b->ku + 1, row = ld - 1;
  sunindextype last = 0;
  for (sunindextype j = 0; j < b->n; j++) {
    double *restrict d = ab + j * ld + b->kl + b->ku;
    const int rows = least(b->kl, b->n - 1 - j), p = pivot_row(d, rows);
    if (p < 0) return j + 1;
    pivot[j] = (int)j + p;
    if (last < j + b->ku + p) last = least(b->n - 1, j + b->ku + p);
    const int columns = (int)(last - j);
    for (int k = 0; p && k <= columns; k++) swap(&d[k * row], &d[k * row + p]);
    const double r = d[0] = 1 / d[0];
    for (int i = 1; i <= rows; i++) d[i] *= r;
    for (int k = 1; k <= columns; k++) {
      double *restrict c = d + k * row;
      const double t = c[0];
      for (int i = 1; t != 0 && i <= rows; i++) c[i] -= d[i] * t;
    }
  }
  return 0;
}

void stf_band_solve(const stf_band *b, const double *restrict ab, const int *restrict pivot,
                    double *restrict x)
{
  const int ld = 2 * b->kl + b->ku + 1, upper = b->kl + b->ku;
  for (sunindextype j = 0; j < b->n; j++) {
    const double *restrict d = ab + j * ld + upper, t = x[pivot[j]];
    const int rows = least(b->kl, b->n - 1 - j);
    x[pivot[j]] = x[j], x[j] = t;
    for (int i = 1; i <= rows; i++) x[j + i] -= d[i] * t;
  }
  for (sunindextype j = b->n - 1; j >= 0; j--) {
    const double *restrict d = ab + j * ld + upper, t = x[j] * d[0];
    const int rows = least(upper, j);
    x[j] = t;
    for (int i = 1; i <= rows; i++) x[j - i] -= d[-i] * t;
  }
}

static int zpivot_row(const double *d, int rows)
{
  int p = -1;
  double big = 0;
  for (int i = 0; i <= rows; i++) {
    const double size = fabs(d[2 * i]) + fabs(d[2 * i + 1]);
    if (size >= DBL_MIN && size > big) big = size, p = i;
  }
  return p;
}

/* 1 / (x + i y) without overflow of the squares (Smith, CACM 5, 1962). */
static void invert(double *z)
{
  const double a = z[0], b = z[1];
  if (fabs(a) >= fabs(b)) {
    const double r = b / a, d = 1 / (a + b * r);
    z[0] = d, z[1] = -r * d;
  } else {
    const double r = a / b, d = 1 / (b + a * r);
    z[0] = r * d, z[1] = -d;
  }
}

/* z_i -= d_i t for i = from .. to. */
static void zsubtract(const double *restrict d, double *restrict z, double tr, double ti,
                      int from, int to)
{
  for (int i = from; i <= to; i++) {
    const double u = d[2 * i], v = d[2 * i + 1];
    z[2 * i] -= u * tr - v * ti;
    z[2 * i + 1] -= u * ti + v * tr;
  }
}

static void zscale(double *d, int rows)
{
  invert(d);
  const double x = d[0], y = d[1];
  for (int i = 1; i <= rows; i++) {
    const double u = d[2 * i], v = d[2 * i + 1];
    d[2 * i] = u * x - v * y, d[2 * i + 1] = u * y + v * x;
  }
}

sunindextype stf_band_zfactor(const stf_band *b, double *ab, int *pivot)
{
  const int ld = 2 * b->kl + b->ku + 1, row = 2 * (ld - 1);
  sunindextype last = 0;
  for (sunindextype j = 0; j < b->n; j++) {
    double *d = ab + 2 * (j * ld + b->kl + b->ku);
    const int rows = least(b->kl, b->n - 1 - j), p = zpivot_row(d, rows);
    if (p < 0) return j + 1;
    pivot[j] = (int)j + p;
    if (last < j + b->ku + p) last = least(b->n - 1, j + b->ku + p);
    const int columns = (int)(last - j);
    for (int k = 0; p && k <= columns; k++)
      swap(&d[k * row], &d[k * row + 2 * p]), swap(&d[k * row + 1], &d[k * row + 2 * p + 1]);
    zscale(d, rows);
    for (int k = 1; k <= columns; k++) {
      double *c = d + k * row;
      zsubtract(d, c, c[0], c[1], 1, rows);
    }
  }
  return 0;
}

void stf_band_zsolve(const stf_band *b, const double *ab, const int *pivot, double *x)
{
  const int ld = 2 * b->kl + b->ku + 1, upper = b->kl + b->ku;
  for (sunindextype j = 0; j < b->n; j++) {
    double *y = x + 2 * (sunindextype)pivot[j], *z = x + 2 * j;
    const double *d = ab + 2 * (j * ld + upper);
    swap(y, z), swap(y + 1, z + 1);
    zsubtract(d, z, z[0], z[1], 1, least(b->kl, b->n - 1 - j));
  }
  for (sunindextype j = b->n - 1; j >= 0; j--) {
    const int rows = least(upper, j);
    const double *d = ab + 2 * (j * ld + upper);
    double *z = x + 2 * j;
    const double s = z[0] * d[0] - z[1] * d[1], t = z[0] * d[1] + z[1] * d[0];
    z[0] = s, z[1] = t;
    zsubtract(d - 2 * rows, z - 2 * rows, s, t, 0, rows - 1);
  }
}
