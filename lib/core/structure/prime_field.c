/* prime_field.c: ranks by sparse elimination over a prime field. A double m 2^e is a number there,
 * and no operation rounds: what cancels is zero, and what is not zero is so for the numbers as
 * given. By columns in order of few entries, each solved with the pivots before it (J. R. Gilbert,
 * T. Peierls, SIAM J. Sci. Stat. Comput. 9, 1988); the pivot is the row with fewest entries.
 * J. T. Schwartz, J. ACM 27 (1980), for how seldom a random point is a zero.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "prime_field.h"
#include "residues.h"
#include <colamd.h>
#include <math.h>
#include <string.h>

/* The factors may have GROWTH times as many entries as the matrix, as in prime_field.h; they are
 * allocated in pieces of at least CHUNK. */
enum { GROWTH = 64, CHUNK = 1 << 16, NONE = -1 };

/* Vectors of a kernel that are computed. */
enum { KERNEL_MOST = 64 };

/* Columns of a triangular factor, with room for more. */
typedef struct factor {
  sunindextype *start, *row, room, used;
  uint64_t *value;
} factor;

typedef struct field {
  steif_context *ctx;
  stf_pool *pool;
  stf_modulus m;
  uint64_t s;
  stf_columns given[2];    /* E and F ... */
  uint64_t *residue[2];    /* ... and their entries modulo p */
  sunindextype n;          /* rows and columns */
  sunindextype *ptr, *row; /* the matrix by columns */
  uint64_t *value;
  sunindextype *weight, *order; /* entries of rows; columns by their number of entries */
  sunindextype *pivot_of;       /* row -> its step; NONE */
  factor L, U;                  /* by steps; of U only what a kernel asks for */
  sunindextype *column_of;      /* step -> column */
  unsigned char *kernel;        /* columns in its vectors; NULL: not wanted */
  uint64_t *x, *y;              /* one column, spread out by rows; by steps */
  sunindextype *reach, *stack, *next, *seen;
} field;

/* ---- the matrix ----------------------------------------------------------------------------------- */

/* Append column j of `times` E or F to a column of the matrix, from row `shift` on. */
static void join(field *f, int which, sunindextype j, sunindextype shift, uint64_t times,
                 sunindextype *count)
{
  const stf_columns *c = &f->given[which];
  for (sunindextype k = stf_columns_start(c, j); k < stf_columns_start(c, j + 1); k++) {
    if (!f->residue[which][k]) continue;
    f->row[*count] = shift + stf_columns_row(c, k);
    f->value[(*count)++] = stf_modular_product(&f->m, times, f->residue[which][k]);
  }
}

static void assemble(field *f, int blocks)
{
  const sunindextype n = f->given[0].n;
  const uint64_t one = f->m.one;
  sunindextype count = 0;
  for (sunindextype j = 0; j < f->n; j++) {
    const sunindextype block = j / n;
    join(f, 0, j % n, block * n, blocks ? one : f->s, &count);
    if (!blocks || block + 1 < blocks)
      join(f, 1, j % n, blocks ? (block + 1) * n : 0, one, &count);
    f->ptr[j + 1] = count;
  }
  for (sunindextype k = 0; k < count; k++) f->weight[f->row[k]]++;
}

/* Columns in an order with little fill for any choice of rows; COLAMD has integers of its own. */
static int arrange(field *f)
{
  const sunindextype n = f->n, count = f->ptr[n];
  const size_t room = colamd_l_recommended(count, n, n);
  SuiteSparse_long stats[COLAMD_STATS];
  SuiteSparse_long *row = stf_allocate(f->ctx, room + (size_t)n + 1, sizeof *row);
  if (!row) return STEIF_NO_MEMORY;
  SuiteSparse_long *ptr = row + room;
  for (sunindextype k = 0; k < count && room; k++) row[k] = f->row[k];
  for (sunindextype j = 0; j <= n; j++) ptr[j] = f->ptr[j];
  const bool good = room && colamd_l(n, n, (SuiteSparse_long)room, row, ptr, NULL, stats);
  for (sunindextype j = 0; j <= n; j++) f->order[j] = (sunindextype)ptr[j];
  stf_release(f->ctx, row);
  STEIF_CHECK(good, f->ctx, STEIF_NO_MEMORY, "no memory to order %lld columns", (long long)n);
  return STEIF_OK;
}

static int take_residues(field *f, const stf_field *of)
{
  for (int which = 0; which < 2; which++) {
    SUNMatrix M = which ? of->F : of->E;
    f->given[which] = stf_columns_of(M);
    const size_t count = (size_t)f->given[which].count;
    f->residue[which] = stf_pool_array(f->pool, count, sizeof **f->residue);
    if (!f->residue[which]) return STEIF_NO_MEMORY;
    STEIF_TRY(stf_residues_find(f->ctx, M, of->snap, &f->m, f->residue[which]));
  }
  return STEIF_OK;
}

static int open(field *f, const stf_field *of, int blocks)
{
  STEIF_TRY(take_residues(f, of));
  const size_t size = sizeof(sunindextype), copies = blocks ? (size_t)blocks : 1;
  const size_t n = (size_t)f->given[0].n * copies;
  const size_t count = ((size_t)f->given[0].count + (size_t)f->given[1].count) * copies + 1;
  f->n = (sunindextype)n;
  f->ptr = stf_pool_array(f->pool, 11 * n + 5, size);
  f->row = stf_pool_array(f->pool, count, size);
  f->value = stf_pool_array(f->pool, count, sizeof *f->value);
  f->x = stf_pool_array(f->pool, 2 * n, sizeof *f->x);
  if (!f->ptr || !f->row || !f->value || !f->x) return STEIF_NO_MEMORY;
  f->weight = f->ptr + n + 1;
  f->order = f->weight + n;
  f->pivot_of = f->order + n + 1;
  f->L.start = f->pivot_of + n;
  f->U.start = f->L.start + n + 1;
  f->reach = f->U.start + n + 1;
  f->stack = f->reach + n;
  f->next = f->stack + n;
  f->seen = f->next + n;
  f->column_of = f->seen + n;
  f->y = f->x + n;
  assemble(f, blocks);
  for (sunindextype i = 0; i < f->n; i++) f->pivot_of[i] = f->seen[i] = NONE;
  return arrange(f);
}

/* ---- elimination ---------------------------------------------------------------------------------- */

/* Room for one more column. */
static int widen(const field *f, factor *t)
{
  if (t->used + f->n <= t->room) return STEIF_OK;
  const sunindextype room = 2 * t->room + f->n + CHUNK;
  sunindextype *row = stf_allocate(f->ctx, (size_t)room, sizeof *row);
  uint64_t *value = row ? stf_allocate(f->ctx, (size_t)room, sizeof *value) : NULL;
  if (value && t->used) {
    memcpy(row, t->row, (size_t)t->used * sizeof *row);
    memcpy(value, t->value, (size_t)t->used * sizeof *value);
  }
  stf_release(f->ctx, value ? t->row : row);
  if (!value) return STEIF_NO_MEMORY;
  stf_release(f->ctx, t->value);
  t->row = row;
  t->value = value;
  t->room = room;
  return STEIF_OK;
}

static void append(factor *t, sunindextype row, uint64_t value)
{
  t->row[t->used] = row;
  t->value[t->used++] = value;
}

/* Rows that row i leads to through the columns of L, depth first; they stand in `reach` from `top`
 * on, each before those it leads to. */
static sunindextype search(field *f, sunindextype i, sunindextype mark, sunindextype top)
{
  sunindextype depth = 0;
  f->stack[0] = i;
  f->next[0] = f->pivot_of[i] < 0 ? 0 : f->L.start[f->pivot_of[i]];
  f->seen[i] = mark;
  while (depth >= 0) {
    const sunindextype at = f->stack[depth], step = f->pivot_of[at];
    const sunindextype end = step < 0 ? 0 : f->L.start[step + 1];
    sunindextype k = f->next[depth];
    while (k < end && f->seen[f->L.row[k]] == mark) k++;
    if (k < end) {
      const sunindextype to = f->L.row[k];
      f->next[depth] = k + 1;
      f->seen[to] = mark;
      f->stack[++depth] = to;
      f->next[depth] = f->pivot_of[to] < 0 ? 0 : f->L.start[f->pivot_of[to]];
    } else {
      f->reach[--top] = at;
      depth--;
    }
  }
  return top;
}

/* x -= times the entries `from` .. `to` - 1 of a column. */
static void subtract(const stf_modulus *m, const factor *t, sunindextype from, sunindextype to,
                     uint64_t times, uint64_t *x)
{
  const uint64_t minus = stf_modular_negative(m, times);
  for (sunindextype q = from; q < to; q++) {
    uint64_t *at = x + t->row[q];
    *at = stf_modular_sum(m, *at, stf_modular_product(m, minus, t->value[q]));
  }
}

/* x <- L^{-1} column j; its rows stand in `reach` from the value returned on. */
static sunindextype solve(field *f, sunindextype j)
{
  sunindextype top = f->n;
  for (sunindextype k = f->ptr[j]; k < f->ptr[j + 1]; k++)
    if (f->seen[f->row[k]] != j) top = search(f, f->row[k], j, top);
  for (sunindextype k = top; k < f->n; k++) f->x[f->reach[k]] = 0;
  for (sunindextype k = f->ptr[j]; k < f->ptr[j + 1]; k++)
    f->x[f->row[k]] = stf_modular_sum(&f->m, f->x[f->row[k]], f->value[k]);
  for (sunindextype k = top; k < f->n; k++) {
    const sunindextype step = f->pivot_of[f->reach[k]];
    const uint64_t x = f->x[f->reach[k]];
    if (step < 0 || !x) continue;
    subtract(&f->m, &f->L, f->L.start[step], f->L.start[step + 1], x, f->x);
  }
  return top;
}

/* The row to divide by; NONE: the column depends on those before it. */
static sunindextype choose(const field *f, sunindextype top)
{
  sunindextype best = NONE;
  for (sunindextype k = top; k < f->n; k++) {
    const sunindextype i = f->reach[k];
    if (f->pivot_of[i] >= 0 || !f->x[i]) continue;
    if (best < 0 || f->weight[i] < f->weight[best]) best = i;
  }
  return best;
}

static void keep(field *f, sunindextype step, sunindextype pivot, sunindextype top)
{
  const uint64_t over = stf_modular_inverse(&f->m, f->x[pivot]);
  for (sunindextype k = top; k < f->n; k++) {
    const sunindextype i = f->reach[k];
    if (!f->x[i] || i == pivot) continue;
    if (f->pivot_of[i] < 0) append(&f->L, i, stf_modular_product(&f->m, f->x[i], over));
    if (f->pivot_of[i] >= 0 && f->kernel) append(&f->U, f->pivot_of[i], f->x[i]);
  }
  if (f->kernel) append(&f->U, step, over);
  f->pivot_of[pivot] = step;
  f->L.start[step + 1] = f->L.used;
  f->U.start[step + 1] = f->U.used;
}

/* Column j is U y of those before it: they and j are in a vector of the kernel. */
static void mark_kernel(field *f, sunindextype j, sunindextype steps, sunindextype top)
{
  uint64_t *y = f->y;
  memset(y, 0, (size_t)f->n * sizeof *y);
  for (sunindextype k = top; k < f->n; k++) y[f->pivot_of[f->reach[k]]] = f->x[f->reach[k]];
  f->kernel[j] = 1;
  for (sunindextype step = steps - 1; step >= 0; step--) {
    if (!y[step]) continue;
    const sunindextype last = f->U.start[step + 1] - 1;
    y[step] = stf_modular_product(&f->m, y[step], f->U.value[last]);
    subtract(&f->m, &f->U, f->U.start[step], last, y[step], y);
    f->kernel[f->column_of[step]] = 1;
  }
}

static int eliminate(field *f, sunindextype *rank)
{
  const sunindextype most = GROWTH * (f->ptr[f->n] + CHUNK);
  sunindextype dependent = 0;
  *rank = 0;
  for (sunindextype k = 0; k < f->n; k++) {
    STEIF_TRY(widen(f, &f->L));
    if (f->kernel) STEIF_TRY(widen(f, &f->U));
    const sunindextype j = f->order[k], top = solve(f, j), pivot = choose(f, top);
    if (pivot >= 0) {
      f->column_of[*rank] = j;
      keep(f, *rank, pivot, top);
      ++*rank;
    } else if (f->kernel && dependent++ < KERNEL_MOST)
      mark_kernel(f, j, *rank, top);
    if (f->L.used + f->U.used <= most) continue;
    *rank = NONE;
    break;
  }
  return STEIF_OK;
}

static int rank_of(steif_context *ctx, const stf_field *of, int blocks, int which,
                   unsigned char *kernel, sunindextype *rank)
{
  field f = {.ctx = ctx, .pool = stf_pool_new(ctx), .kernel = kernel};
  if (!f.pool) return STEIF_NO_MEMORY;
  stf_modulus_set(of->prime[which], &f.m);
  f.s = stf_modular_whole(&f.m, of->point[which]);
  int code = open(&f, of, blocks);
  if (!code) code = eliminate(&f, rank);
  stf_release(ctx, f.L.row), stf_release(ctx, f.L.value);
  stf_release(ctx, f.U.row), stf_release(ctx, f.U.value);
  stf_pool_free(&f.pool);
  return code;
}

int stf_field_rank(steif_context *ctx, const stf_field *of, int blocks, int which,
                   sunindextype *rank)
{
  return rank_of(ctx, of, blocks, which, NULL, rank);
}

int stf_field_kernel(steif_context *ctx, const stf_field *of, unsigned char *in_kernel)
{
  sunindextype rank;
  return rank_of(ctx, of, 0, 0, in_kernel, &rank);
}
