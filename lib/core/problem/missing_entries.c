/* missing_entries.c: a probe that finds entries missing from the pattern of differences, and the pattern that
 * grows by them.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "groups.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sunmatrix/sunmatrix_band.h>
#include <sunmatrix/sunmatrix_sparse.h>

static const sunrealtype move = 1e-6; /* relative size of the probing move */
enum { ASKED = 32 };                  /* rows looked at more closely */

static bool in_pattern(const stf_system *s, sunindextype i, sunindextype j)
{
  if (s->storage == STEIF_BAND) return i - j <= s->problem->lower && j - i <= s->problem->upper;
  const steif_pattern *p = s->groups->pattern;
  for (sunindextype k = p->column[j]; k < p->column[j + 1]; k++)
    if (p->row[k] == i) return true;
  return false;
}

/* d = evaluate(moved in columns [from, to), for row >= 0 in those that its pattern leaves out) - base;
 * also leaves the direction in work[2]. */
static int shove(stf_system *s, char which, sunrealtype t, N_Vector y, N_Vector yp,
                 sunindextype from, sunindextype to, sunindextype row)
{
  N_Vector moved = s->work[4], d = s->work[5];
  const sunrealtype *at = stf_array(which == 'A' ? y : yp);
  sunrealtype *m = stf_array(moved), *v = stf_array(s->work[2]);
  unsigned state = 12345;
  for (sunindextype j = 0; j < s->space.n; j++) {
    state = state * 1103515245u + 12345u;
    const sunrealtype factor = 0.5 + (sunrealtype)(state >> 16 & 1023) / 2048;
    const bool asked = j >= from && j < to && (row < 0 || !in_pattern(s, row, j));
    v[j] = asked ? move * factor * fmax(fabs(at[j]), stf_floor(s, j)) : 0;
    m[j] = at[j] + v[j];
  }
  STEIF_TRY(which == 'A' ? stf_groups_evaluate(s, t, moved, yp, d)
                         : stf_groups_evaluate(s, t, y, moved, d));
  stf_axpy(&s->space, -1, s->work[3], d);
  return STEIF_OK;
}

/* Do the columns that the pattern of row i leaves out have a part in the deviation `wrong` of that row, and
 * not rounding? Then halve them down to one of those that do: *column, else -1. */
static int halve(stf_system *s, char which, sunrealtype t, N_Vector y, N_Vector yp,
                 sunindextype i, sunrealtype wrong, sunindextype *column)
{
  const sunrealtype *d = stf_array(s->work[5]);
  sunindextype from = 0, to = s->space.n;
  *column = -1;
  STEIF_TRY(shove(s, which, t, y, yp, from, to, i));
  if (!(fabs(d[i]) > 1e-2 * wrong)) return STEIF_OK;
  while (to - from > 1) {
    const sunindextype middle = from + (to - from) / 2;
    const sunrealtype whole = d[i];
    STEIF_TRY(shove(s, which, t, y, yp, from, middle, i));
    if (fabs(d[i]) >= fabs(whole - d[i]))
      to = middle;
    else
      from = middle;
    STEIF_TRY(shove(s, which, t, y, yp, from, to, i));
  }
  *column = from;
  return STEIF_OK;
}

static int outside_band(stf_system *s, sunrealtype t, sunindextype i, sunindextype j)
{
  const sunrealtype *d = stf_array(s->work[5]), *v = stf_array(s->work[2]);
  char row[STEIF_SPEC_WORD], column[STEIF_SPEC_WORD];
  return STEIF_FAIL(
    s->ctx, STEIF_BAD_INPUT,
    "the band of problem '%s' misses the derivative of %s with respect to %s, row %lld, column "
    "%lld: a probe at t = %g found about %.3g there; widen it",
    s->problem->name, stf_equation(s->problem, i, row), stf_unknown(s->problem, j, column),
    (long long)i + 1, (long long)j + 1, t, d[i] / v[j]);
}

/* -- entries found ------------------------------------------------------------------------- */

typedef struct entry {
  sunindextype column, row;
} entry;

typedef struct list {
  entry *entry;
  size_t count, room;
} list;

static int append(steif_context *ctx, list *l, sunindextype row, sunindextype column)
{
  if (l->count == l->room) {
    entry *more = stf_allocate(ctx, 2 * l->room + 64, sizeof *more);
    if (!more) return STEIF_NO_MEMORY;
    if (l->count) memcpy(more, l->entry, l->count * sizeof *more);
    stf_release(ctx, l->entry);
    l->entry = more;
    l->room = 2 * l->room + 64;
  }
  l->entry[l->count++] = (entry){column, row};
  return STEIF_OK;
}

static int order(const void *left, const void *right)
{
  const entry *a = left, *b = right;
  if (a->column != b->column) return a->column < b->column ? -1 : 1;
  return a->row < b->row ? -1 : a->row > b->row;
}

void stf_groups_forget(void *groups)
{
  stf_groups *g = groups;
  stf_release(g->ctx, (void *)g->grown.column);
  stf_release(g->ctx, (void *)g->grown.row);
  g->grown = (steif_pattern){0};
}

/* Both ascend; entries that are in the pattern already, or twice in the list, join it once. */
static sunindextype merge_column(const steif_pattern *p, sunindextype j, const list *l,
                                 size_t *next, sunindextype used, sunindextype *row)
{
  const sunindextype begin = used;
  sunindextype k = p->column[j];
  while (k < p->column[j + 1] || (*next < l->count && l->entry[*next].column == j)) {
    const bool listed = *next < l->count && l->entry[*next].column == j &&
                        (k == p->column[j + 1] || l->entry[*next].row < p->row[k]);
    const sunindextype i = listed ? l->entry[(*next)++].row : p->row[k++];
    if (used == begin || row[used - 1] < i) row[used++] = i;
  }
  return used;
}

static int grow(stf_system *s, list *l)
{
  stf_groups *g = s->groups;
  const steif_pattern *p = g->pattern;
  const size_t n = (size_t)s->space.n, entries = (size_t)p->column[n] + l->count;
  sunindextype *column = stf_allocate(s->ctx, n + 1, sizeof *column), used = 0;
  sunindextype *row = stf_allocate(s->ctx, entries, sizeof *row);
  if (!column || !row) {
    stf_release(s->ctx, column);
    stf_release(s->ctx, row);
    return STEIF_NO_MEMORY;
  }
  size_t next = 0;
  qsort(l->entry, l->count, sizeof *l->entry, order);
  for (size_t j = 0; j < n; j++) {
    column[j] = used;
    used = merge_column(p, (sunindextype)j, l, &next, used, row);
  }
  column[n] = used;
  stf_groups_forget(g);
  g->grown = (steif_pattern){column, row};
  g->pattern = &g->grown;
  return stf_groups_colour(s);
}

/* All columns one by one: what moves and is not in the pattern is listed. */
static int sweep(stf_system *s, char which, sunrealtype t, N_Vector y, N_Vector yp, list *l)
{
  const sunrealtype *d = stf_array(s->work[5]);
  for (sunindextype j = 0; j < s->space.n; j++) {
    const int code = shove(s, which, t, y, yp, j, j + 1, -1);
    if (code < 0) return code;
    for (sunindextype i = 0; i < s->space.n && !code; i++)
      if (d[i] != 0 && isfinite(d[i])) STEIF_TRY(append(s->ctx, l, i, j));
  }
  return STEIF_OK;
}

/* -- the probe ----------------------------------------------------------------------------- */

/* out = |M| |v|, what the terms of a row may come to; product = M v. */
static void multiply(const stf_system *s, SUNMatrix M, const sunrealtype *v,
                     sunrealtype *product, sunrealtype *out)
{
  const sunindextype n = s->space.n;
  memset(out, 0, (size_t)n * sizeof *out);
  memset(product, 0, (size_t)n * sizeof *product);
  for (sunindextype j = 0; j < n && s->storage == STEIF_SPARSE; j++) {
    const sunindextype *column = SUNSparseMatrix_IndexPointers(M);
    for (sunindextype k = column[j]; k < column[j + 1]; k++) {
      const sunrealtype part = SUNSparseMatrix_Data(M)[k] * v[j];
      product[SUNSparseMatrix_IndexValues(M)[k]] += part;
      out[SUNSparseMatrix_IndexValues(M)[k]] += fabs(part);
    }
  }
  for (sunindextype j = 0; j < n && s->storage == STEIF_BAND; j++) {
    const sunindextype first = j - s->problem->upper, last = j + s->problem->lower;
    for (sunindextype i = first < 0 ? 0 : first; i <= (last < n ? last : n - 1); i++) {
      const sunrealtype part = SUNBandMatrix_Column(M, j)[i - j] * v[j];
      product[i] += part;
      out[i] += fabs(part);
    }
  }
}

/* Deviations of rows into work[1], 0 where rounding and curvature explain them; how many are left. */
static int deviations(stf_system *s, char which, sunrealtype t, N_Vector y, N_Vector yp,
                      SUNMatrix M, sunindextype *count)
{
  STEIF_TRY(stf_groups_evaluate(s, t, y, yp, s->work[3]));
  STEIF_TRY(shove(s, which, t, y, yp, 0, s->space.n, -1));
  const sunrealtype *d = stf_array(s->work[5]), *base = stf_array(s->work[3]);
  sunrealtype *wrong = stf_array(s->work[1]), *size = stf_array(s->work[0]);
  const sunrealtype sign = which == 'A' && s->form == STEIF_IMPLICIT ? -1 : 1;
  multiply(s, M, stf_array(s->work[2]), wrong, size);
  *count = 0;
  for (sunindextype i = 0; i < s->space.n; i++) {
    wrong[i] = fabs(d[i] - sign * wrong[i]);
    if (!(wrong[i] > 1e-3 * fmax(size[i], fabs(d[i])) + 1e3 * STF_EPS * fabs(base[i])))
      wrong[i] = 0;
    *count += wrong[i] > 0;
  }
  return STEIF_OK;
}

/* Row by row, at most ASKED of them. */
static int ask_rows(stf_system *s, char which, sunrealtype t, N_Vector y, N_Vector yp, list *l)
{
  const sunrealtype *wrong = stf_array(s->work[1]);
  int asked = 0;
  for (sunindextype i = 0; i < s->space.n && asked < ASKED; i++) {
    if (!(wrong[i] > 0)) continue;
    sunindextype j;
    asked++;
    STEIF_TRY(halve(s, which, t, y, yp, i, wrong[i], &j));
    if (j < 0) continue;
    if (s->storage == STEIF_BAND) return outside_band(s, t, i, j);
    STEIF_TRY(append(s->ctx, l, i, j));
  }
  return STEIF_OK;
}

int stf_probe(stf_system *s, char which, sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix M,
              bool *grown)
{
  sunindextype count;
  list l = {0};
  *grown = false;
  STEIF_TRY(deviations(s, which, t, y, yp, M, &count));
  int code = count ? ask_rows(s, which, t, y, yp, &l) : STEIF_OK;
  if (!code && count > ASKED && l.count > ASKED / 2) code = sweep(s, which, t, y, yp, &l);
  *grown = !code && l.count > 0;
  if (*grown) code = grow(s, &l);
  stf_release(s->ctx, l.entry);
  return code;
}
