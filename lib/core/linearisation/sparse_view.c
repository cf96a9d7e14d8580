/* sparse_view.c: E and F_y of a problem by columns, on the union of the patterns met so far.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "sparse_view.h"
#include <math.h>
#include <string.h>
#include <sunmatrix/sunmatrix_band.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

/* Entries below this part of the largest in their row of E or F_y are rounding; less where E and F_y vary: there small
 * ones of callbacks may become large, as the conductance of a diode. */
static const sunrealtype exact_noise = 1e-13, varying_noise = 1e-25, difference_noise = 1e-9;

static sunrealtype noise(const stf_point *s)
{
  if (s->every) return 0;
  if (!s->analytic) return s->quick || s->n > STEIF_DIAGNOSE_LARGEST ? 1e-6 : difference_noise;
  return s->system.linear ? exact_noise : varying_noise;
}

void stf_view_free(stf_point *s, stf_view *v)
{
  stf_release(s->ctx, v->column);
  stf_release(s->ctx, v->row);
  stf_release(s->ctx, v->e);
  stf_release(s->ctx, v->b);
  stf_release(s->ctx, v->has);
  *v = (stf_view){0};
}

static int claim(stf_point *s, stf_view *v, size_t room)
{
  *v = (stf_view){.n = s->n};
  v->column = stf_allocate(s->ctx, s->n + 1, sizeof *v->column);
  v->row = stf_allocate(s->ctx, room + 1, sizeof *v->row);
  v->e = stf_allocate(s->ctx, room + 1, sizeof *v->e);
  v->b = stf_allocate(s->ctx, room + 1, sizeof *v->b);
  v->has = stf_allocate(s->ctx, room + 1, 1);
  if (v->column && v->row && v->e && v->b && v->has) return STEIF_OK;
  stf_view_free(s, v);
  return STEIF_NO_MEMORY;
}

int stf_view_copy(stf_point *s, const stf_view *from, stf_view *to)
{
  const size_t n = from->n, used = (size_t)from->column[n];
  STEIF_TRY(claim(s, to, used));
  memcpy(to->column, from->column, (n + 1) * sizeof *to->column);
  memcpy(to->row, from->row, used * sizeof *to->row);
  memcpy(to->e, from->e, used * sizeof *to->e);
  memcpy(to->b, from->b, used * sizeof *to->b);
  memcpy(to->has, from->has, used);
  return STEIF_OK;
}

/* -- one column at a time, from matrices or from the old view ---------------------------- */

typedef struct accumulator {
  size_t n, count;
  sunindextype *touched;
  char *seen; /* 4: in the list, with the bits of stf_view.has */
  sunrealtype *e, *b;
} accumulator;

static void touch(accumulator *a, size_t i, sunrealtype e, sunrealtype b, int has)
{
  if (!a->seen[i]) a->touched[a->count++] = (sunindextype)i;
  a->seen[i] = (char)(a->seen[i] | 4 | has);
  a->e[i] += e, a->b[i] += b;
}

/* Column j of M, times sign, as E (which 1) or B (2). */
static void add(accumulator *a, SUNMatrix M, size_t j, int which, sunrealtype sign)
{
  const sunindextype J = (sunindextype)j, n = (sunindextype)a->n;
  if (!M) {
    touch(a, j, 1, 0, 1);
  } else if (SUNMatGetID(M) == SUNMATRIX_SPARSE) {
    for (sunindextype k = SM_INDEXPTRS_S(M)[j]; k < SM_INDEXPTRS_S(M)[j + 1]; k++) {
      const sunrealtype x = sign * SM_DATA_S(M)[k];
      touch(a, (size_t)SM_INDEXVALS_S(M)[k], which == 1 ? x : 0, which == 2 ? x : 0, 0);
    }
  } else {
    const bool dense = SUNMatGetID(M) == SUNMATRIX_DENSE;
    const sunindextype top = dense ? 0 : J - SM_UBAND_B(M),
                       end = dense ? n : J + SM_LBAND_B(M) + 1;
    for (sunindextype i = top < 0 ? 0 : top; i < (end < n ? end : n); i++) {
      const sunrealtype x = sign * (dense ? SM_ELEMENT_D(M, i, J) : SM_ELEMENT_B(M, i, J));
      if (x != 0) touch(a, (size_t)i, which == 1 ? x : 0, which == 2 ? x : 0, 0);
    }
  }
}

/* Sources of columns: dense arrays for small problems, the system's matrices for large
 * ones. */
typedef struct source {
  stf_point *point;
  const sunrealtype *E, *B;
  sunrealtype *top; /* 2 n: largest of the rows of E and of B, columns weighted by size */
  sunrealtype noise;
} source;

static void gather(const source *from, size_t j, accumulator *a)
{
  const stf_system *system = &from->point->system;
  if (!from->E) {
    add(a, system->E, j, 1, 1);
    add(a, system->A, j, 2, -1);
    return;
  }
  for (size_t i = 0; i < a->n; i++) {
    const sunrealtype e = from->E[j * a->n + i], b = from->B[j * a->n + i];
    if (e != 0 || b != 0) touch(a, i, e, b, 0);
  }
}

static void wipe(accumulator *a)
{
  for (size_t k = 0; k < a->count; k++) {
    const sunindextype i = a->touched[k];
    a->seen[i] = 0, a->e[i] = a->b[i] = 0;
  }
  a->count = 0;
}

static size_t measure(const source *from, accumulator *a)
{
  size_t total = 0;
  const size_t n = a->n;
  for (size_t j = 0; j < n; j++) {
    gather(from, j, a);
    total += a->count;
    for (size_t k = 0; k < a->count; k++) {
      const size_t i = (size_t)a->touched[k];
      from->top[i] = fmax(from->top[i], fabs(a->e[i]) * from->point->size[j]);
      from->top[n + i] = fmax(from->top[n + i], fabs(a->b[i]) * from->point->size[j]);
    }
    wipe(a);
  }
  return total;
}

static void mark_rounding(const source *from, size_t j, accumulator *a)
{
  const sunrealtype size = from->point->size[j];
  for (size_t k = 0; k < a->count; k++) {
    const size_t i = (size_t)a->touched[k];
    if (fabs(a->e[i]) * size <= from->noise * from->top[i])
      a->e[i] = 0;
    else
      a->seen[i] |= 1;
    if (fabs(a->b[i]) * size <= from->noise * from->top[a->n + i])
      a->b[i] = 0;
    else
      a->seen[i] |= 2;
  }
}

static int ascending(const sunindextype *row, sunindextype count)
{
  for (sunindextype k = 1; k < count; k++)
    if (row[k] < row[k - 1]) return 0;
  return 1;
}

static void sort(sunindextype *row, sunindextype count)
{
  if (ascending(row, count)) return;
  for (sunindextype gap = count / 2; gap > 0; gap /= 2)
    for (sunindextype k = gap; k < count; k++)
      for (sunindextype l = k; l >= gap && row[l - gap] > row[l]; l -= gap) {
        const sunindextype x = row[l];
        row[l] = row[l - gap], row[l - gap] = x;
      }
}

static void assemble(const source *from, accumulator *a, const stf_view *old, stf_view *v)
{
  sunindextype used = 0;
  for (size_t j = 0; j < a->n; j++) {
    gather(from, j, a);
    mark_rounding(from, j, a);
    for (sunindextype k = old->n ? old->column[j] : 0; old->n && k < old->column[j + 1]; k++)
      touch(a, (size_t)old->row[k], 0, 0, old->has[k]);
    sort(a->touched, (sunindextype)a->count);
    v->column[j] = used;
    for (size_t k = 0; k < a->count; k++) {
      const sunindextype i = a->touched[k];
      if (!(a->seen[i] & 3)) continue;
      v->row[used] = i, v->e[used] = a->e[i], v->b[used] = a->b[i];
      v->has[used++] = (char)(a->seen[i] & 3);
    }
    wipe(a);
  }
  v->column[a->n] = used;
}

/* -- taking ------------------------------------------------------------------------------ */

static int take(stf_point *s, const source *from, accumulator *a, stf_view *v)
{
  const size_t n = s->n;
  stf_view fresh;
  a->touched = stf_allocate(s->ctx, n, sizeof *a->touched);
  a->seen = stf_allocate(s->ctx, n, 1);
  a->e = stf_allocate(s->ctx, 2 * n, sizeof *a->e);
  if (!a->touched || !a->seen || !a->e) return STEIF_NO_MEMORY;
  a->b = a->e + n;
  const size_t old = v->n ? (size_t)v->column[n] : 0;
  STEIF_TRY(claim(s, &fresh, old + measure(from, a)));
  assemble(from, a, v, &fresh);
  stf_view_free(s, v);
  *v = fresh;
  return STEIF_OK;
}

/* Large problems keep their storage; small ones are looked at dense. */
static int evaluate(stf_point *s, sunrealtype t, const sunrealtype *y, const sunrealtype *yp,
                    source *from)
{
  const size_t n = s->n;
  from->noise = noise(s);
  if (!(from->top = stf_allocate(s->ctx, 2 * n, sizeof *from->top))) return STEIF_NO_MEMORY;
  if (s->quick || n > STEIF_DIAGNOSE_LARGEST) {
    if (s->quick && s->views++ == 0) return STEIF_OK; /* as opened */
    memcpy(stf_array(s->y), y, n * sizeof *y);
    memcpy(stf_array(s->yp), yp, n * sizeof *yp);
    return stf_system_linearise(&s->system, t, s->y, s->yp);
  }
  sunrealtype *E = stf_allocate(s->ctx, 2 * n * n, sizeof *E);
  if (!E) return STEIF_NO_MEMORY;
  from->E = E, from->B = E + n * n;
  return stf_point_matrices(s, t, y, yp, E, E + n * n);
}

int stf_view_take(stf_point *s, sunrealtype t, const sunrealtype *y, const sunrealtype *yp,
                  stf_view *v)
{
  source from = {.point = s};
  accumulator a = {.n = s->n};
  int code = evaluate(s, t, y, yp, &from);
  if (!code) code = take(s, &from, &a, v);
  stf_release(s->ctx, a.touched);
  stf_release(s->ctx, a.seen);
  stf_release(s->ctx, a.e);
  stf_release(s->ctx, from.top);
  stf_release(s->ctx, (void *)from.E);
  return code;
}

void stf_view_rates(stf_point *s, const stf_view *v, sunrealtype *slowest, sunrealtype *fastest)
{
  const size_t n = s->n;
  sunrealtype *e = s->scratch, *b = s->scratch + n;
  *slowest = *fastest = 0;
  memset(e, 0, 2 * n * sizeof *e);
  for (size_t j = 0; j < n; j++)
    for (sunindextype k = v->column[j]; k < v->column[j + 1]; k++) {
      const sunindextype i = v->row[k];
      e[i] = fmax(e[i], fabs(v->e[k]) * s->size[j]);
      b[i] = fmax(b[i], fabs(v->b[k]) * s->size[j]);
    }
  for (size_t i = 0; i < n; i++) {
    if (!(e[i] > 0 && b[i] > 0)) continue;
    const sunrealtype rate = b[i] / e[i];
    if (!(*slowest > 0) || rate < *slowest) *slowest = rate;
    if (rate > *fastest) *fastest = rate;
  }
  if (!(*slowest > 0))
    *slowest = *fastest = 1 / (s->problem.t1 > s->t ? s->problem.t1 - s->t : 1);
}
