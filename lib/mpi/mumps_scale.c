/* mumps_scale.c: the matrix in even units before it is factored, and whether it is singular to rounding then.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "mumps.h"
#include <math.h>
#include <string.h>

/* Exponents of two at most: scales and their reciprocals are normal numbers. EVEN: a change too small for another
 * pass. SWEEPS: of the estimate of a norm. */
enum { EXPONENT = 1000, EVEN = 1, PASSES = 30, SWEEPS = 3 };

/* Reciprocal conditions up to which no digit of a solution is right, and parts of it that may be rounding. */
#define NOTHING 4e-16
#define LOST 0.05

/* -- scales ----------------------------------------------------------------------------------- */

/* While scales are sought, row[i] and column[j] are exponents of two. That of entry k of row i; false: it is 0. */
static bool exponent_of(const rows *r, const slot *t, sunindextype i, sunindextype k,
                        sunrealtype *exponent)
{
  const sunrealtype size = fmax(fabs(t->re * r->e[k] - r->a[k]), fabs(t->im * r->e[k]));
  int of_size = 0;
  if (!(size > 0)) return false;
  frexp(size, &of_size);
  *exponent = of_size + t->row[i] + t->column[r->local[k]];
  return true;
}

/* Rows times powers of two, so that the mean of their exponents, or the largest, is 0; the largest change. */
static sunrealtype scale_rows(const rows *r, slot *t, bool mean)
{
  sunrealtype change = 0;
  for (sunindextype i = 0; i < r->own.rows; i++) {
    sunrealtype sum = 0, count = 0, most = -INFINITY, now;
    for (sunindextype k = r->row_at[i]; k < r->row_at[i + 1]; k++)
      if (exponent_of(r, t, i, k, &now)) sum += now, count++, most = fmax(most, now);
    const sunrealtype by = count == 0 ? 0 : mean ? round(sum / count) : most;
    t->row[i] -= by;
    change = fmax(change, fabs(by));
  }
  return change;
}

static sunrealtype scale_columns(const mumps *s, slot *t, bool mean)
{
  rows *r = s->r;
  sunrealtype *const *of = s->part, change = 0, now;
  for (sunindextype j = 0; j < r->own.rows + r->halo.count; j++)
    of[0][j] = mean ? 0 : -INFINITY, of[1][j] = 0;
  for (sunindextype i = 0; i < r->own.rows; i++)
    for (sunindextype k = r->row_at[i]; k < r->row_at[i + 1]; k++) {
      const sunindextype j = r->local[k];
      if (!exponent_of(r, t, i, k, &now)) continue;
      of[0][j] = mean ? of[0][j] + now : fmax(of[0][j], now);
      of[1][j]++;
    }
  halo_return(r, 1, !mean, (const sunrealtype *const *)of, of);
  halo_return(r, 1, false, (const sunrealtype *const *)of + 1, of + 1);
  for (sunindextype j = 0; j < r->own.rows; j++) {
    const sunrealtype by = of[1][j] == 0 ? 0 : mean ? round(of[0][j] / of[1][j]) : of[0][j];
    t->column[j] -= by;
    change = fmax(change, fabs(by));
  }
  halo_exchange(r, 1, (const sunrealtype *const *)&t->column);
  memcpy(t->column, r->one, (size_t)(r->own.rows + r->halo.count) * sizeof *t->column);
  return change;
}

/* 2^exponent, a normal number as its reciprocal is. */
static void raise(sunrealtype *exponent, sunindextype count)
{
  for (sunindextype i = 0; i < count; i++)
    exponent[i] = ldexp(1, (int)fmax(-EXPONENT, fmin(EXPONENT, exponent[i])));
}

/* Until the means are 0 everywhere, nearly: scales of rows and those of columns part. */
static void scale_by_means(const mumps *s, slot *t)
{
  sunrealtype change = EVEN + 1;
  for (int pass = 0; pass < PASSES && change > EVEN; pass++) {
    const sunrealtype of_rows = scale_rows(s->r, t, true);
    change = fmax(of_rows, scale_columns(s, t, true));
    MPI_Allreduce(MPI_IN_PLACE, &change, 1, MPI_DOUBLE, MPI_MAX, s->r->own.comm);
  }
}

/* By largest entries; whether rows or columns come first matters where they have units of their own. Means (A. R. Curtis,
 * J. K. Reid, J. Inst. Math. Appl. 10, 1972) are right where both have, unless entries are nothing beside others. */
void mumps_scale(const mumps *s, slot *t)
{
  rows *r = s->r;
  const sunindextype all = r->own.rows + r->halo.count;
  memset(t->row, 0, (size_t)r->own.rows * sizeof *t->row);
  memset(t->column, 0, (size_t)all * sizeof *t->column);
  if (t->units == UNITS_COLUMNS) scale_columns(s, t, false);
  if (t->units == UNITS_MEAN) scale_by_means(s, t);
  scale_rows(r, t, false), scale_columns(s, t, false);
  raise(t->row, r->own.rows), raise(t->column, all);
}

/* -- the condition ------------------------------------------------------------------------------ */

/* The largest sum of a row of the scaled matrix. */
static sunrealtype norm(const mumps *s, const slot *t)
{
  const rows *r = s->r;
  sunrealtype most = 0;
  for (sunindextype i = 0; i < r->own.rows; i++) {
    sunrealtype sum = 0;
    for (sunindextype k = r->row_at[i]; k < r->row_at[i + 1]; k++)
      sum +=
        hypot(t->re * r->e[k] - r->a[k], t->im * r->e[k]) * t->row[i] * t->column[r->local[k]];
    most = fmax(most, sum);
  }
  MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPI_DOUBLE, MPI_MAX, r->own.comm);
  return most;
}

/* y, halves of own rows, becomes y / |y|, conjugated; returns the sum of |y| over all ranks. */
static sunrealtype signs(const mumps *s, bool pair, sunrealtype *const *y)
{
  sunrealtype sum = 0;
  for (sunindextype i = 0; i < s->r->own.rows; i++) {
    const sunrealtype size = hypot(y[0][i], pair ? y[1][i] : 0);
    sum = isfinite(size) ? sum + size : INFINITY;
    y[0][i] = size > 0 ? y[0][i] / size : 1;
    if (pair) y[1][i] = size > 0 ? -y[1][i] / size : 0;
  }
  MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_DOUBLE, MPI_SUM, s->r->own.comm);
  return sum;
}

/* The unit vector of the longest entry of z, into x; the lowest number among equals. */
static void longest(const mumps *s, bool pair, sunrealtype *const *z, sunrealtype *const *x)
{
  const owners *o = &s->r->own;
  struct {
    double size;
    int rank;
  } best = {-1, o->rank};
  sunindextype at = 0;
  for (sunindextype i = 0; i < o->rows; i++) {
    const sunrealtype size = hypot(z[0][i], pair ? z[1][i] : 0);
    if (size > best.size) best.size = size, at = i;
    x[0][i] = 0;
    if (pair) x[1][i] = 0;
  }
  MPI_Allreduce(MPI_IN_PLACE, &best, 1, MPI_DOUBLE_INT, MPI_MAXLOC, o->comm);
  if (best.rank == o->rank && o->rows) x[0][at] = 1;
}

/* ||M^{-1}|| by sums of rows, from below: that of M^{-T} by sums of columns, W. W. Hager, SIAM J. Sci. Stat. Comput. 5,
 * 1984. */
static int inverse_norm(mumps *s, slot *t, sunrealtype *most)
{
  const bool pair = t->with->complex;
  const size_t here = (size_t)s->r->own.rows;
  sunrealtype *const x[] = {s->d, s->d + here}, *const y[] = {s->own, s->own + here};
  *most = 0;
  for (size_t i = 0; i < here; i++) x[0][i] = 1 / (sunrealtype)s->r->own.n, x[1][i] = 0;
  for (int sweep = 0; sweep < SWEEPS; sweep++) {
    memset(s->own, 0, 2 * here * sizeof *s->own);
    MPI_TRY(mumps_correct(s, t, true, true, 1, x, y));
    const sunrealtype now = signs(s, pair, y);
    if (!(now > *most)) break;
    *most = now;
    memset(s->d, 0, 2 * here * sizeof *s->d);
    MPI_TRY(mumps_correct(s, t, false, true, 1, y, x));
    longest(s, pair, x, x);
  }
  return STEIF_OK;
}

/* Of the matrix as it was factored. Estimates are from below, and rounding makes of a singular matrix one whose inverse
 * is large by chance: solutions that have no digits tell it, too. */
static int condition(mumps *s, slot *t, sunrealtype *out)
{
  sunrealtype inverse, lost = 1;
  MPI_TRY(mumps_room(s, t, 1));
  MPI_TRY(inverse_norm(s, t, &inverse));
  *out = norm(s, t) * inverse;
  if (*out * NOTHING < 1) MPI_TRY(mumps_lost(s, t, &lost));
  t->sound = lost < LOST;
  return STEIF_OK;
}

int mumps_sound(void *state, sunrealtype re, sunrealtype im)
{
  mumps *s = state;
  slot *t;
  sunrealtype least = INFINITY, now = 0;
  MPI_TRY(mumps_serve(s, re, im, 0, &t));
  for (int tries = 0; !t->sound && tries < UNITS; tries++) {
    if (tries) {
      t->units = (t->units + 1) % UNITS, t->ready = false;
      MPI_TRY(mumps_serve(s, re, im, 0, &t));
    }
    MPI_TRY(condition(s, t, &now));
    least = fmin(least, now);
  }
  if (t->sound) return STEIF_OK;
  return steif_fail(
    s->r->ctx, STEIF_SINGULAR,
    "c E - A is singular to rounding at c = %.10g%+.10gi: its reciprocal condition, rows and "
    "columns scaled, is %.1e at best, and solutions have no right digit; is the pencil "
    "regular, "
    "or is this an eigenvalue?",
    re, im, isfinite(least) ? 1 / least : 0);
}
