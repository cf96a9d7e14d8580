/* mumps_solve.c: solves with factors over ranks, and refinement of our own, since that of MUMPS does not work on spread
 * solutions.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "mumps.h"
#include <float.h>
#include <math.h>
#include <steif/ensemble.h>
#include <string.h>

enum { PROBES = 4 }; /* right-hand sides that tell how many digits solutions have */

/* A backward error that needs no refinement. */
#define ENOUGH 1e-14

/* Room for `count` right-hand sides. */
static int widen(mumps *s, int count)
{
  sunrealtype **const each[] = {&s->b, &s->d, &s->own};
  if (count <= s->columns) return STEIF_OK;
  for (int i = 0; i < 3; i++) {
    steif_release(s->r->ctx, *each[i]);
    *each[i] = steif_allocate(s->r->ctx, 2 * (size_t)count * ((size_t)s->r->own.rows + 1),
                              sizeof(sunrealtype));
  }
  s->columns = s->b && s->d && s->own ? count : 0;
  return s->columns ? STEIF_OK : STEIF_NO_MEMORY;
}

int mumps_room(mumps *s, slot *t, int columns)
{
  int code = widen(s, columns);
  if (!code) code = mumps_receive(s, t, t->room - 1, columns);
  code = steif_agree(s->r->ctx, s->r->like, code);
  if (code) t->columns = 0, t->get_at[s->r->own.size] = -1; /* on all ranks, or they part */
  return code;
}

/* Who gets which entries of the solution as MUMPS spreads it: found at the first solve by new
 * factors. */
static int find_way(mumps *s, slot *t, int count)
{
  const owners *o = &s->r->own;
  int *wanted = steif_allocate(s->r->ctx, (size_t)count + 1, sizeof *wanted);
  const int code = steif_agree(s->r->ctx, s->r->like, wanted ? STEIF_OK : STEIF_NO_MEMORY);
  if (code) return steif_release(s->r->ctx, wanted), code;
  memset(t->give, 0, (size_t)o->size * sizeof(int));
  for (int k = 0; k < count; k++) t->give[rows_owner(o, t->row_of_x[k] - 1)]++;
  MPI_Alltoall(t->give, 1, MPI_INT, t->get, 1, MPI_INT, o->comm);
  t->give_at[0] = t->get_at[0] = 0;
  for (int k = 0; k < o->size; k++) {
    t->give_at[k + 1] = t->give_at[k] + t->give[k];
    t->get_at[k + 1] = t->get_at[k] + t->get[k];
  }
  for (int k = 0; k < count; k++) {
    const int to = (int)rows_owner(o, t->row_of_x[k] - 1), at = t->give_at[to]++;
    t->order[at] = k;
    wanted[at] = (int)(t->row_of_x[k] - 1 - o->start[to]);
  }
  for (int k = o->size; k > 0; k--) t->give_at[k] = t->give_at[k - 1];
  t->give_at[0] = 0;
  MPI_Alltoallv(wanted, t->give, t->give_at, MPI_INT, t->place, t->get, t->get_at, MPI_INT,
                o->comm);
  steif_release(s->r->ctx, wanted);
  return STEIF_OK;
}

/* x += the correction, times `scale`, to its owners. */
static void give_back(mumps *s, slot *t, const sunrealtype *scale, const sunrealtype *from,
                      int count, sunrealtype *const *x)
{
  const owners *o = &s->r->own;
  const int width = t->with->complex ? 2 : 1;
  MPI_Datatype number = width == 2 ? MPI_C_DOUBLE_COMPLEX : MPI_DOUBLE;
  for (int k = 0; k < count; k++)
    for (int w = 0; w < width; w++) t->out[width * k + w] = from[width * t->order[k] + w];
  MPI_Alltoallv(t->out, t->give, t->give_at, number, t->in, t->get, t->get_at, number, o->comm);
  for (sunindextype k = 0; k < o->rows; k++)
    for (int w = 0; w < width; w++)
      x[w][t->place[k]] += t->in[width * k + w] * (scale ? scale[t->place[k]] : 1);
}

/* The factors are those of R M C, R and C the scales: M^{-1} = C (R M C)^{-1} R. */
int mumps_correct(mumps *s, slot *t, bool transposed, bool scaled, int count,
                  sunrealtype *const *d, sunrealtype *const *x)
{
  factors_answer a;
  const owners *o = &s->r->own;
  const int width = t->with->complex ? 2 : 1;
  const sunrealtype *first = scaled       ? NULL
                             : transposed ? t->column
                                          : t->row,
                    *last = scaled       ? NULL
                            : transposed ? t->row
                                         : t->column;
  sunrealtype *b = s->b;
  for (int k = 0; k < count; k++)
    for (sunindextype i = 0; i < o->rows; i++)
      for (int w = 0; w < width; w++) *b++ = d[width * k + w][i] * (first ? first[i] : 1);
  t->with->solve(t->m, transposed, count, s->b, s->row_of_b, (int)o->rows, t->x, t->row_of_x,
                 t->room, &a);
  s->r->stats.solves += count;
  MPI_TRY(mumps_told(s, &a, "solve", t));
  if (t->get_at[o->size] < 0 || t->way_across != transposed)
    MPI_TRY(find_way(s, t, t->give_at[o->size] = a.rows));
  t->way_across = transposed;
  for (int k = 0; k < count; k++)
    give_back(s, t, last, t->x + (size_t)(width * k) * (size_t)t->room, t->give_at[o->size],
              x + width * k);
  return STEIF_OK;
}

/* -- residuals ---------------------------------------------------------------------------------- */

/* One column: b, its solution x, and the residual that comes into d. */
typedef struct column {
  const sunrealtype *const *b;
  sunrealtype *const *x, *const *d;
  sunrealtype longest; /* entry of x in units of the columns as they were factored */
} column;

/* The backward error of one equation, whose terms have the size `size`, in units of the row as it was factored: by
 * itself (W. Oettli, W. Prager, Numer. Math. 6, 1964), or, where its terms are nothing but rounding of others, beside
 * the longest entry of x (M. Arioli, J. Demmel, I. S. Duff, SIAM J. Matrix Anal. Appl. 10, 1989). */
static sunrealtype error_of(sunrealtype residual, sunrealtype size, sunrealtype longest)
{
  if (!isfinite(residual) || !isfinite(size)) return 1; /* nothing is known */
  if (size < 1e3 * DBL_EPSILON * longest) size += longest;
  return size > 0 ? residual / size : residual > 0;
}

static sunrealtype size_of(sunrealtype re, sunrealtype im) { return fabs(re) + fabs(im); }

static sunrealtype direct(mumps *s, const slot *t, const column *c)
{
  rows *r = s->r;
  const bool pair = t->with->complex;
  sunrealtype largest = 0;
  halo_exchange(r, pair ? 2 : 1, (const sunrealtype *const *)c->x);
  for (sunindextype i = 0; i < r->own.rows; i++) {
    sunrealtype re = c->b[0][i], im = pair ? c->b[1][i] : 0, size = size_of(re, im);
    for (sunindextype k = r->row_at[i]; k < r->row_at[i + 1]; k++) {
      const sunrealtype m = t->re * r->e[k] - r->a[k], n = t->im * r->e[k];
      const sunrealtype u = r->one[r->local[k]], v = pair ? r->two[r->local[k]] : 0;
      re -= m * u - n * v, im -= m * v + n * u, size += size_of(m, n) * size_of(u, v);
    }
    c->d[0][i] = re;
    if (pair) c->d[1][i] = im;
    largest =
      fmax(largest, error_of(size_of(re, im) * t->row[i], size * t->row[i], c->longest));
  }
  return largest;
}

/* M^T x of own rows into own columns and those of the halo, and the size of its terms. */
static void spread(mumps *s, const slot *t, const column *c)
{
  rows *r = s->r;
  const bool pair = t->with->complex;
  const size_t all = (size_t)(r->own.rows + r->halo.count) * sizeof(sunrealtype);
  for (int k = 0; k < 3; k++) memset(s->part[k], 0, all);
  for (sunindextype i = 0; i < r->own.rows; i++)
    for (sunindextype k = r->row_at[i]; k < r->row_at[i + 1]; k++) {
      const sunrealtype m = t->re * r->e[k] - r->a[k], n = t->im * r->e[k];
      const sunrealtype u = c->x[0][i], v = pair ? c->x[1][i] : 0;
      const sunindextype j = r->local[k];
      s->part[0][j] += m * u - n * v, s->part[1][j] += m * v + n * u;
      s->part[2][j] += size_of(m, n) * size_of(u, v);
    }
  halo_return(r, 2, false, (const sunrealtype *const *)s->part, s->part);
  halo_return(r, 1, false, (const sunrealtype *const *)s->part + 2, s->part + 2);
}

static sunrealtype across(mumps *s, const slot *t, const column *c)
{
  const bool pair = t->with->complex;
  sunrealtype largest = 0;
  spread(s, t, c);
  for (sunindextype j = 0; j < s->r->own.rows; j++) {
    const sunrealtype re = c->b[0][j] - s->part[0][j],
                      im = pair ? c->b[1][j] - s->part[1][j] : 0;
    const sunrealtype size = s->part[2][j] + size_of(c->b[0][j], pair ? c->b[1][j] : 0);
    c->d[0][j] = re;
    if (pair) c->d[1][j] = im;
    largest =
      fmax(largest, error_of(size_of(re, im) * t->column[j], size * t->column[j], c->longest));
  }
  return largest;
}

/* In units of the columns as they were factored. */
static sunrealtype longest_of(const mumps *s, const slot *t, bool transposed,
                              const sunrealtype *const *x)
{
  const sunrealtype *unit = transposed ? t->row : t->column;
  sunrealtype most = 0;
  for (sunindextype i = 0; i < s->r->own.rows; i++) {
    const sunrealtype size = size_of(x[0][i], t->with->complex ? x[1][i] : 0) / unit[i];
    most = isfinite(size) ? fmax(most, size) : INFINITY;
  }
  return most;
}

/* d = b - M x, or with M^T; the largest backward error of the columns, over all ranks. */
static sunrealtype residual(mumps *s, const slot *t, bool transposed, int count,
                            const sunrealtype *const *b, sunrealtype *const *x,
                            sunrealtype *const *d)
{
  sunrealtype longest[COLUMNS], largest = 0;
  const int width = t->with->complex ? 2 : 1;
  for (int k = 0; k < count; k++)
    longest[k] = longest_of(s, t, transposed, (const sunrealtype *const *)x + width * k);
  MPI_Allreduce(MPI_IN_PLACE, longest, count, MPI_DOUBLE, MPI_MAX, s->r->own.comm);
  for (int k = 0; k < count; k++) {
    const column c = {b + width * k, x + width * k, d + width * k, longest[k]};
    largest = fmax(largest, transposed ? across(s, t, &c) : direct(s, t, &c));
  }
  MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPI_DOUBLE, MPI_MAX, s->r->own.comm);
  return largest;
}

/* -- digits ---------------------------------------------------------------------------------------- */

/* 1/2 to 3/2 of either sign, by the numbers of an unknown and of a column alone, so for any ranks the same. Sizes differ, for
 * right-hand sides that two equal equations share would not tell them. */
static sunrealtype entry_of(sunindextype row, int k)
{
  const sunrealtype x = 2 * steif_ensemble_uniform((unsigned)k, (unsigned long long)row) - 1;
  return x < 0 ? x - 0.5 : x + 0.5;
}

/* Rounding makes of M a matrix M + D, whose inverse is met here: a sweep of refinement changes x = (M + D)^{-1} b by
 * (M + D)^{-1} D x. Where M is singular, x is nearly in its null space, M x = 0, and the change is as long as x; else it
 * is as much shorter as x has digits. The largest ratio of PROBES right-hand sides, in even units. */
int mumps_lost(mumps *s, slot *t, sunrealtype *part)
{
  const rows *r = s->r;
  const int width = t->with->complex ? 2 : 1, halves = PROBES * width;
  const size_t here = (size_t)r->own.rows;
  sunrealtype *b[2 * PROBES], *d[2 * PROBES], *x[2 * PROBES], *dx[2 * PROBES];
  sunrealtype length[2 * PROBES];
  MPI_TRY(mumps_room(s, t, 2 * PROBES));
  memset(s->own, 0, 2 * (size_t)halves * here * sizeof *s->own);
  for (int k = 0; k < halves; k++) {
    d[k] = s->d + (size_t)k * here, b[k] = d[k] + (size_t)halves * here;
    x[k] = s->own + (size_t)k * here, dx[k] = x[k] + (size_t)halves * here;
    for (sunindextype i = 0; i < r->own.rows; i++)
      b[k][i] = entry_of(r->own.first + i, k) / t->row[i];
  }
  MPI_TRY(mumps_correct(s, t, false, false, PROBES, b, x));
  residual(s, t, false, PROBES, (const sunrealtype *const *)b, x, d);
  MPI_TRY(mumps_correct(s, t, false, false, PROBES, d, dx));
  for (int k = 0; k < PROBES; k++) {
    length[k] = longest_of(s, t, false, (const sunrealtype *const *)x + width * k);
    length[PROBES + k] = longest_of(s, t, false, (const sunrealtype *const *)dx + width * k);
  }
  MPI_Allreduce(MPI_IN_PLACE, length, 2 * PROBES, MPI_DOUBLE, MPI_MAX, r->own.comm);
  *part = 0;
  for (int k = 0; k < PROBES; k++) {
    const sunrealtype now = length[PROBES + k] / length[k];
    *part = isfinite(now) ? fmax(*part, now) : INFINITY;
  }
  return STEIF_OK;
}

/* -- solves --------------------------------------------------------------------------------------- */

/* At most COLUMNS of them. Sweeps of refinement while they at least halve the backward error. */
static int block(mumps *s, slot *t, bool transposed, int count, const sunrealtype *const *b,
                 sunrealtype *const *x)
{
  sunrealtype *d[2 * COLUMNS], *own[2 * COLUMNS];
  const size_t here = (size_t)s->r->own.rows;
  const int halves = count * (t->with->complex ? 2 : 1);
  MPI_TRY(mumps_room(s, t, count));
  for (int k = 0; k < halves; k++) {
    d[k] = s->d + (size_t)k * here, own[k] = s->own + (size_t)k * here;
    memcpy(d[k], b[k], here * sizeof(sunrealtype));
    memset(own[k], 0, here * sizeof(sunrealtype));
  }
  MPI_TRY(mumps_correct(s, t, transposed, false, count, d, own));
  sunrealtype left = 0, before = INFINITY;
  for (int sweep = 0; sweep <= s->set.refine; sweep++) {
    left = residual(s, t, transposed, count, b, own, d);
    if (sweep == s->set.refine || left <= ENOUGH || !(left < 0.5 * before)) break;
    before = left;
    MPI_TRY(mumps_correct(s, t, transposed, false, count, d, own));
  }
  s->r->stats.backward_error = fmax(s->r->stats.backward_error, left);
  for (int k = 0; k < halves; k++) memcpy(x[k], own[k], here * sizeof(sunrealtype));
  return STEIF_OK;
}

int mumps_solve(void *state, sunrealtype re, sunrealtype im, bool transposed, int count,
                const sunrealtype *const *b, sunrealtype *const *x)
{
  mumps *s = state;
  slot *t;
  MPI_TRY(mumps_serve(s, re, im, transposed ? 0 : 0.25, &t));
  const int width = t->with->complex ? 2 : 1;
  for (int k = 0; k < count; k += COLUMNS)
    MPI_TRY(block(s, t, transposed, count - k < COLUMNS ? count - k : COLUMNS, b + width * k,
                  x + width * k));
  return STEIF_OK;
}
