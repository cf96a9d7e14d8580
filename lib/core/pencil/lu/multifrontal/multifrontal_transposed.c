/* multifrontal_transposed.c: solves with the transpose of the factors, front by front in the opposite
 * order. What a front does to its own unknowns x and the others X in a solve,
 *   x <- L11^{-1} P x, X <- X - L21 x    and then    x <- U11^{-1} (x - U12 X),
 * becomes
 *   x <- U11^{-T} x, X <- X - U12^T x    and then    x <- P^T L11^{-T} (x - L21^T X).
 * SPDX-License-Identifier: BSD-3-Clause */
#include "multifrontal.h"

static double dot(int count, const double *restrict a, const double *restrict x)
{
  double sum = 0;
  for (int i = 0; i < count; i++) sum += a[i] * x[i];
  return sum;
}

static void through_upper(const stf_front *g, const int *rows, const double *L, double *X)
{
  const sunindextype ld = g->width + g->below;
  const double *U = L + ld * g->width;
  double *x = X + g->first;
  for (int k = 0; k < g->width; k++) {
    const double *column = L + ld * k;
    x[k] = (x[k] - dot(k, column, x)) * column[k];
  }
  for (int i = 0; i < g->below; i++)
    X[rows[i]] -= dot(g->width, U + (sunindextype)i * g->width, x);
}

static void through_lower(const stf_front *g, const int *rows, const double *L,
                          const int *pivot, double *X, double *work)
{
  const sunindextype ld = g->width + g->below;
  double *x = X + g->first;
  for (int i = 0; i < g->below; i++) work[i] = X[rows[i]];
  for (int k = g->width; k-- > 0;) {
    const double *column = L + ld * k;
    x[k] -=
      dot(g->below, column + g->width, work) + dot(g->width - 1 - k, column + k + 1, x + k + 1);
  }
  for (int k = g->width; k-- > 0;) {
    const double t = x[k];
    x[k] = x[pivot[k]], x[pivot[k]] = t;
  }
}

void stf_multifrontal_solve_transposed(const stf_multifrontal *f, const double *in,
                                       const int *pivot, int nrhs, double *b, sunindextype ld,
                                       double *work)
{
  for (int q = 0; q < nrhs; q++, b += ld) {
    for (int k = 0; k < f->n; k++) work[k] = b[f->order[k]];
    for (int s = 0; s < f->count; s++)
      through_upper(&f->front[s], f->rows + f->front[s].row, in + f->front[s].place, work);
    for (int s = f->count; s-- > 0;) {
      const stf_front *g = &f->front[s];
      through_lower(g, f->rows + g->row, in + g->place, pivot + g->first, work, work + f->n);
    }
    for (int k = 0; k < f->n; k++) b[f->order[k]] = work[k];
  }
}
