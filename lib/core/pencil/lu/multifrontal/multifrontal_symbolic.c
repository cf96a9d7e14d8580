/* multifrontal_symbolic.c: order, elimination tree, fronts, and where entries go.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fill_order.h"
#include "multifrontal.h"
#include <stdlib.h>
#include <string.h>

/* What is needed on the way. */
typedef struct draft {
  steif_context *ctx;
  const stf_pattern *u;
  int n;
  SuiteSparse_long *ptr, *row, *order; /* the symmetric pattern without its diagonal */
  int *parent, *below, *mark, *head, *next, *front_of;
  SuiteSparse_long *tptr; /* entries of the union by rows: t[tptr[i]] .. */
  SuiteSparse_long *t;
  int *column; /* of an entry of the union */
} draft;

static void *claim(draft *d, sunindextype count, size_t size)
{
  return stf_allocate(d->ctx, (size_t)count + 1, size);
}

static bool open_draft(draft *d)
{
  const sunindextype n = d->n, nnz = d->u->nnz;
  int **const lists[] = {&d->parent, &d->below, &d->mark, &d->head, &d->next, &d->front_of};
  d->ptr = claim(d, n + 1, sizeof *d->ptr), d->row = claim(d, 2 * nnz, sizeof *d->row);
  d->order = claim(d, n, sizeof *d->order), d->tptr = claim(d, n + 1, sizeof *d->tptr);
  d->t = claim(d, nnz, sizeof *d->t), d->column = claim(d, nnz, sizeof *d->column);
  bool good = d->ptr && d->row && d->order && d->tptr && d->t && d->column;
  for (size_t k = 0; k < sizeof lists / sizeof *lists; k++)
    good = (*lists[k] = claim(d, n, sizeof **lists[k])) && good;
  return good;
}

static void close_draft(draft *d)
{
  void *const all[] = {d->ptr,  d->row,  d->order, d->parent, d->below,  d->mark,
                       d->head, d->next, d->tptr,  d->t,      d->column, d->front_of};
  for (size_t k = 0; k < sizeof all / sizeof *all; k++) stf_release(d->ctx, all[k]);
}

/* The union by rows. */
static void transpose(draft *d)
{
  const stf_pattern *u = d->u;
  SuiteSparse_long *at = d->tptr;
  for (sunindextype k = 0; k < u->nnz; k++) at[u->row[k] + 1]++;
  for (int i = 0; i < d->n; i++) at[i + 1] += at[i];
  for (int j = 0; j < d->n; j++)
    for (SuiteSparse_long k = u->ptr[j]; k < u->ptr[j + 1]; k++) {
      d->column[k] = j;
      d->t[at[u->row[k]]++] = k;
    }
  memmove(at + 1, at, (size_t)d->n * sizeof *at);
  at[0] = 0;
}

/* Columns of M and its transpose, each neighbour once. */
static void symmetrise(draft *d)
{
  const stf_pattern *u = d->u;
  SuiteSparse_long used = 0;
  for (int j = 0; j < d->n; j++) d->mark[j] = -1;
  for (int j = 0; j < d->n; j++) {
    d->ptr[j] = used, d->mark[j] = j;
    for (SuiteSparse_long k = u->ptr[j]; k < u->ptr[j + 1]; k++)
      if (d->mark[u->row[k]] != j) d->mark[d->row[used++] = u->row[k]] = j;
    for (SuiteSparse_long k = d->tptr[j]; k < d->tptr[j + 1]; k++) {
      const int i = d->column[d->t[k]];
      if (d->mark[i] != j) d->mark[d->row[used++] = i] = j;
    }
  }
  d->ptr[d->n] = used;
}

static void number(draft *d, stf_multifrontal *f)
{
  for (int k = 0; k < d->n; k++) f->place[f->order[k]] = k;
}

/* The elimination tree (J. W. H. Liu, ACM TOMS 12, 1986); mark holds the ancestors, compressed. */
static void tree(draft *d, const stf_multifrontal *f)
{
  for (int k = 0; k < d->n; k++) {
    d->parent[k] = d->mark[k] = -1;
    const int node = f->order[k];
    for (SuiteSparse_long e = d->ptr[node]; e < d->ptr[node + 1]; e++)
      for (int i = f->place[d->row[e]], up; i >= 0 && i < k; i = up) {
        up = d->mark[i], d->mark[i] = k;
        if (up < 0) d->parent[i] = k;
      }
  }
}

/* Children before parents, each subtree in one piece. */
static void postorder(draft *d, stf_multifrontal *f)
{
  int *number_of = d->below, *stack = d->mark, top = 0, given = 0, roots = -1;
  for (int k = 0; k < d->n; k++) d->head[k] = -1;
  for (int k = d->n; k-- > 0;) {
    int *list = d->parent[k] < 0 ? &roots : &d->head[d->parent[k]];
    d->next[k] = *list, *list = k;
  }
  for (int k = roots; k >= 0; k = d->next[k]) {
    for (stack[top++] = k; top > 0;) {
      const int at = stack[top - 1], child = d->head[at];
      if (child >= 0)
        d->head[at] = d->next[child], stack[top++] = child;
      else
        number_of[at] = given++, top--;
    }
  }
  for (int k = 0; k < d->n; k++) d->order[number_of[k]] = f->order[k];
  for (int k = 0; k < d->n; k++) f->order[k] = (int)d->order[k];
  number(d, f);
}

/* below[j]: entries of column j of L below the diagonal, by the subtrees of the rows. */
static void counts(draft *d, const stf_multifrontal *f)
{
  for (int k = 0; k < d->n; k++) {
    const int node = f->order[k];
    d->below[k] = 0, d->mark[k] = k;
    for (SuiteSparse_long e = d->ptr[node]; e < d->ptr[node + 1]; e++)
      for (int i = f->place[d->row[e]]; i < k && d->mark[i] != k; i = d->parent[i])
        d->below[i]++, d->mark[i] = k;
  }
}

/* Fronts of columns with the same rows; `first` in head, their number is returned. */
static int gather(draft *d)
{
  int count = 0;
  for (int j = 0; j < d->n; j++)
    if (!j || d->parent[j - 1] != j || d->below[j - 1] != d->below[j] + 1) d->head[count++] = j;
  d->head[count] = d->n;
  return count;
}

/* Is a front of this width and share of explicit zeros worth what it saves? */
static bool worth(double width, double zeros, double all)
{
  const double share = zeros / all;
  return width <= 8 ? share < 0.4 : width <= 24 ? share < 0.2 : share < 0.05;
}

/* A front joins the one that follows when that is its parent and few zeros come in. */
static int amalgamate(draft *d, int count)
{
  int *first = d->head, *end = d->next, kept = count;
  double zeros = 0; /* of the front made last */
  end[kept - 1] = d->n;
  for (int s = count - 1; s-- > 0;) {
    const int from = first[s], last = first[s + 1] - 1, stop = end[kept - 1];
    const double own = last + 1 - from, height = stop - last - 1 + d->below[stop - 1];
    const double more = own * (height - d->below[last]);
    const double width = stop - from,
                 all = width * (width + 1) / 2 + width * d->below[stop - 1];
    const bool child = d->parent[last] > last && d->parent[last] < stop;
    if (child && worth(width, zeros + more, all))
      zeros += more;
    else
      zeros = 0, end[--kept - 1] = last + 1;
  }
  const int made = count - kept + 1;
  memmove(end, end + kept - 1, (size_t)made * sizeof *end);
  return made;
}

static double work_of(const stf_front *g)
{
  double sum = 0;
  for (int k = 0; k < g->width; k++) {
    const double m = g->width - 1 - k + g->below;
    sum += m + 2 * m * m;
  }
  return sum;
}

/* Sizes of the fronts whose ends are in d->next. */
static void measure(draft *d, stf_multifrontal *f)
{
  sunindextype row = 0, place = 0;
  for (int s = 0, from = 0; s < f->count; from = d->next[s++]) {
    stf_front *g = &f->front[s];
    const int stop = d->next[s];
    *g = (stf_front){.first = from,
                     .width = stop - from,
                     .below = d->below[stop - 1],
                     .parent = d->parent[stop - 1],
                     .child = -1,
                     .sibling = -1,
                     .row = row,
                     .place = place};
    row += g->below, place += (sunindextype)g->width * (g->width + 2 * (sunindextype)g->below);
    f->flops += work_of(g);
    if (g->below > f->highest) f->highest = g->below;
    for (int j = from; j < stop; j++) d->front_of[j] = s;
  }
  f->size = place;
}

/* Parents as fronts, their children, and how high the stack grows. */
static void link_fronts(draft *d, stf_multifrontal *f)
{
  sunindextype top = 0;
  for (int s = 0; s < f->count; s++) {
    stf_front *g = &f->front[s];
    const sunindextype r = g->below;
    if (top + r * r > f->peak) f->peak = top + r * r;
    for (int c = g->child; c >= 0; c = f->front[c].sibling) {
      const sunindextype below = f->front[c].below;
      top -= below * below;
    }
    top += r * r;
    if (g->parent < 0) continue;
    g->parent = d->front_of[g->parent];
    g->sibling = f->front[g->parent].child, f->front[g->parent].child = s;
  }
}

static int ascending(const void *x, const void *y)
{
  const int a = *(const int *)x, b = *(const int *)y;
  return (a > b) - (a < b);
}

/* Rows below front s: of its columns in M, and of its children. */
static void structure(draft *d, stf_multifrontal *f, int s)
{
  stf_front *g = &f->front[s];
  const int stop = g->first + g->width;
  int *rows = f->rows + g->row, used = 0;
  for (int j = g->first; j < stop; j++)
    for (SuiteSparse_long e = d->ptr[f->order[j]]; e < d->ptr[f->order[j] + 1]; e++) {
      const int i = f->place[d->row[e]];
      if (i >= stop && d->mark[i] != s) d->mark[i] = s, rows[used++] = i;
    }
  for (int k = g->child; k >= 0; k = f->front[k].sibling) {
    const stf_front *c = &f->front[k];
    for (int m = 0; m < c->below; m++) {
      const int i = f->rows[c->row + m];
      if (i >= stop && d->mark[i] != s) d->mark[i] = s, rows[used++] = i;
    }
  }
  qsort(rows, (size_t)used, sizeof *rows, ascending);
}

/* Where the rows of the children and the entries of the matrix go in front s; `where` numbers the
 * rows of the front. */
static sunindextype aim(draft *d, stf_multifrontal *f, int s, int *where, sunindextype used)
{
  stf_front *g = &f->front[s];
  const int stop = g->first + g->width, height = g->width + g->below;
  for (int k = 0; k < g->width; k++) where[g->first + k] = k;
  for (int m = 0; m < g->below; m++) where[f->rows[g->row + m]] = g->width + m;
  for (int k = g->child; k >= 0; k = f->front[k].sibling) {
    const stf_front *c = &f->front[k];
    for (int m = 0; m < c->below; m++) f->into[c->row + m] = where[f->rows[c->row + m]];
  }
  g->entry = used;
  for (int j = g->first; j < stop; j++) {
    const int node = f->order[j], k = j - g->first;
    for (SuiteSparse_long e = d->u->ptr[node]; e < d->u->ptr[node + 1]; e++) {
      const int i = f->place[d->u->row[e]];
      if (i < g->first) continue;
      f->entry[used] = (sunindextype)e, f->target[used++] = where[i] + (sunindextype)height * k;
    }
    for (SuiteSparse_long m = d->tptr[node]; m < d->tptr[node + 1]; m++) {
      const int i = f->place[d->column[d->t[m]]];
      if (i < stop) continue;
      f->entry[used] = (sunindextype)d->t[m];
      f->target[used++] =
        (sunindextype)height * g->width + k + (sunindextype)g->width * (where[i] - g->width);
    }
  }
  g->entries = used - g->entry;
  return used;
}

static void connect(draft *d, stf_multifrontal *f)
{
  sunindextype used = 0;
  for (int i = 0; i < d->n; i++) d->mark[i] = -1;
  for (int s = 0; s < f->count; s++) {
    structure(d, f, s);
    used = aim(d, f, s, d->next, used);
  }
}

static bool claim_fronts(draft *d, stf_multifrontal *f)
{
  sunindextype rows = 0;
  for (int s = 0; s < f->count; s++) rows += d->below[d->next[s] - 1];
  f->front = claim(d, f->count, sizeof *f->front);
  f->rows = claim(d, rows, sizeof *f->rows), f->into = claim(d, rows, sizeof *f->into);
  f->entry = claim(d, d->u->nnz, sizeof *f->entry);
  f->target = claim(d, d->u->nnz, sizeof *f->target);
  return f->front && f->rows && f->into && f->entry && f->target;
}

static int build(draft *d, stf_multifrontal *f)
{
  f->n = d->n;
  f->order = claim(d, d->n, sizeof *f->order), f->place = claim(d, d->n, sizeof *f->place);
  if (!open_draft(d) || !f->order || !f->place) return STEIF_NO_MEMORY;
  transpose(d);
  symmetrise(d);
  STEIF_TRY(stf_fill_order(d->n, d->ptr, d->row, d->order));
  for (int k = 0; k < d->n; k++) f->order[k] = (int)d->order[k];
  number(d, f);
  tree(d, f);
  postorder(d, f);
  tree(d, f);
  counts(d, f);
  f->count = amalgamate(d, gather(d));
  if (!claim_fronts(d, f)) return STEIF_NO_MEMORY;
  measure(d, f);
  link_fronts(d, f);
  connect(d, f);
  return STEIF_OK;
}

int stf_multifrontal_open(steif_context *ctx, const stf_pattern *u, stf_multifrontal **fronts)
{
  draft d = {.ctx = ctx, .u = u, .n = (int)u->n};
  stf_multifrontal *f = *fronts = stf_allocate(ctx, 1, sizeof *f);
  if (!f) return STEIF_NO_MEMORY;
  const int code = build(&d, f);
  close_draft(&d);
  if (code) stf_multifrontal_free(ctx, fronts);
  return code;
}

void stf_multifrontal_free(steif_context *ctx, stf_multifrontal **fronts)
{
  stf_multifrontal *f = *fronts;
  if (!f) return;
  void *const all[] = {f->order, f->place, f->front, f->rows, f->into, f->entry, f->target, f};
  for (size_t k = 0; k < sizeof all / sizeof *all; k++) stf_release(ctx, all[k]);
  *fronts = NULL;
}

stf_fronts_size stf_multifrontal_size(const stf_multifrontal *f)
{
  return (stf_fronts_size){.factors = (size_t)f->size,
                           .pivots = (size_t)f->n,
                           .stack = (size_t)f->peak,
                           .work = STF_FRONTS_COLUMNS * (size_t)(f->n + f->highest)};
}

const double *stf_multifrontal_pivots(const stf_multifrontal *f, const double *factors, int i,
                                      int *count, sunindextype *step)
{
  if (i >= f->count) return NULL;
  const stf_front *g = &f->front[i];
  *count = g->width;
  *step = g->width + g->below + (sunindextype)1;
  return factors + g->place;
}
