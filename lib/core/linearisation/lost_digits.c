/* lost_digits.c: solutions without a right digit tell a matrix that is singular to rounding, whatever its norm and the
 * estimate of its condition say.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "lost_digits.h"
#include <math.h>
#include <string.h>

/* By chance of rounding one of 30 residuals of a singular matrix hides what is lost. */
enum { PROBES = 4 };
/* Solutions for b about 1, in even units, up to which the inverse is not large, and D of no account. */
static const sunrealtype harmless = 1e8;

static sunrealtype scale_of(const sunrealtype *scale, size_t i) { return scale ? scale[i] : 1; }

static sunrealtype entry(const stf_shifted *M, size_t j, sunindextype k)
{
  return (M->s * M->view->e[k] + M->view->b[k]) * scale_of(M->left, (size_t)M->view->row[k]) *
         scale_of(M->right, j);
}

/* Largest entries of the rows, and of the columns after those are 1. */
static void measure(const stf_shifted *M, sunrealtype *row, sunrealtype *column)
{
  const stf_view *v = M->view;
  memset(row, 0, v->n * sizeof *row);
  memset(column, 0, v->n * sizeof *column);
  for (size_t j = 0; j < v->n; j++)
    for (sunindextype k = v->column[j]; k < v->column[j + 1]; k++)
      row[v->row[k]] = fmax(row[v->row[k]], fabs(entry(M, j, k)));
  for (size_t i = 0; i < v->n; i++)
    if (!(row[i] > 0)) row[i] = 1;
  for (size_t j = 0; j < v->n; j++) {
    for (sunindextype k = v->column[j]; k < v->column[j + 1]; k++)
      column[j] = fmax(column[j], fabs(entry(M, j, k)) / row[v->row[k]]);
    if (!(column[j] > 0)) column[j] = 1;
  }
}

static sunrealtype length(size_t n, const sunrealtype *x, const sunrealtype *unit)
{
  sunrealtype most = 0;
  for (size_t j = 0; j < n; j++) {
    const sunrealtype size = fabs(x[j]) * unit[j];
    most = isfinite(size) ? fmax(most, size) : INFINITY;
  }
  return most;
}

/* Away from 0 and of no two sizes: sums over rows that depend on each other do not cancel. */
static sunrealtype random_entry(unsigned *state)
{
  const sunrealtype x = stf_point_random(state);
  return x < 0 ? x - 0.3 : x + 0.3;
}

/* r -= M x by E and B apart: the sum is rounded in what was factored, not here. */
static void subtract(const stf_shifted *M, const sunrealtype *x, sunrealtype *r)
{
  const stf_view *v = M->view;
  for (size_t j = 0; j < v->n; j++) {
    const sunrealtype z = scale_of(M->right, j) * x[j];
    for (sunindextype k = v->column[j]; k < v->column[j + 1]; k++) {
      const sunrealtype left = scale_of(M->left, (size_t)v->row[k]);
      if (v->e[k] != 0) r[v->row[k]] -= left * (M->s * (v->e[k] * z));
      r[v->row[k]] -= left * (v->b[k] * z);
    }
  }
}

/* x = M^{-1} b, and the part of it that M^{-1} (b - M x) is. */
static int probe(steif_pencil *p, const stf_shifted *M, N_Vector v, const sunrealtype *b,
                 const sunrealtype *column, sunrealtype *x, sunrealtype *part)
{
  const size_t n = M->view->n, bytes = n * sizeof *x;
  sunrealtype *r = stf_array(v);
  memcpy(r, b, bytes);
  STEIF_TRY(steif_pencil_solve(p, 0, 1, &v, NULL));
  memcpy(x, r, bytes);
  const sunrealtype size = length(n, x, column);
  if (size <= harmless) return *part = 0, STEIF_OK;
  memcpy(r, b, bytes);
  subtract(M, x, r);
  STEIF_TRY(steif_pencil_solve(p, 0, 1, &v, NULL));
  *part = length(n, r, column) / size;
  return STEIF_OK;
}

int stf_lost_part(steif_pencil *p, const stf_shifted *M, N_Vector v, sunrealtype *work,
                  sunrealtype *part)
{
  const size_t n = M->view->n;
  sunrealtype *x = work, *b = work + n, *row = work + 2 * n, *column = work + 3 * n;
  unsigned state = 61681u;
  measure(M, row, column);
  *part = 0;
  for (int k = 0; k < PROBES && *part < STF_LOST; k++) {
    sunrealtype now;
    for (size_t i = 0; i < n; i++) b[i] = random_entry(&state) * row[i];
    STEIF_TRY(probe(p, M, v, b, column, x, &now));
    *part = isfinite(now) ? fmax(*part, now) : INFINITY;
    if (now == 0) break;
  }
  for (size_t j = 0; j < n; j++) x[j] *= column[j];
  return STEIF_OK;
}
