/* band_transposed.c: solves with the transpose of factors of band unblocked, complex ones with the
 * conjugate transpose: columns of U from the first, columns of L and exchanges from the last.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "lu.h"

static int least(int width, sunindextype rest) { return rest < width ? (int)rest : width; }

static void swap(double *x, double *y)
{
  const double t = *x;
  *x = *y, *y = t;
}

void stf_band_solve_transposed(const stf_band *b, const double *ab, const int *pivot, double *x)
{
  const int ld = 2 * b->kl + b->ku + 1, upper = b->kl + b->ku;
  for (sunindextype j = 0; j < b->n; j++) {
    const double *d = ab + j * ld + upper;
    const int rows = least(upper, j);
    double sum = x[j];
    for (int i = 1; i <= rows; i++) sum -= d[-i] * x[j - i];
    x[j] = sum * d[0];
  }
  for (sunindextype j = b->n - 1; j >= 0; j--) {
    const double *d = ab + j * ld + upper;
    const int rows = least(b->kl, b->n - 1 - j);
    double sum = x[j];
    for (int i = 1; i <= rows; i++) sum -= d[i] * x[j + i];
    x[j] = sum;
    swap(&x[j], &x[pivot[j]]);
  }
}

/* z minus conj(d_i) x_i for i = from .. to. */
static void less(const double *d, const double *x, double *z, int from, int to)
{
  double s = z[0], t = z[1];
  for (int i = from; i <= to; i++) {
    s -= d[2 * i] * x[2 * i] + d[2 * i + 1] * x[2 * i + 1];
    t -= d[2 * i] * x[2 * i + 1] - d[2 * i + 1] * x[2 * i];
  }
  z[0] = s, z[1] = t;
}

void stf_band_zsolve_transposed(const stf_band *b, const double *ab, const int *pivot,
                                double *x)
{
  const int ld = 2 * b->kl + b->ku + 1, upper = b->kl + b->ku;
  for (sunindextype j = 0; j < b->n; j++) {
    const double *d = ab + 2 * (j * ld + upper);
    double *z = x + 2 * j;
    less(d, z, z, -least(upper, j), -1);
    const double s = z[0] * d[0] + z[1] * d[1], t = z[1] * d[0] - z[0] * d[1];
    z[0] = s, z[1] = t;
  }
  for (sunindextype j = b->n - 1; j >= 0; j--) {
    double *z = x + 2 * j, *y = x + 2 * (sunindextype)pivot[j];
    less(ab + 2 * (j * ld + upper), z, z, 1, least(b->kl, b->n - 1 - j));
    swap(z, y), swap(z + 1, y + 1);
  }
}
