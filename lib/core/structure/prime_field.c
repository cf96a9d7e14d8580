/* prime_field.c: ranks by sparse elimination over a prime field. A double m 2^e is a number there,
 * and no operation rounds: what cancels is zero, and what is not zero is so for the numbers as
 * given. By columns in order of few entries, each solved with the pivots before it (J. R. Gilbert,
 * T. Peierls, SIAM J. Sci. Stat. Comput. 9, 1988); the pivot is the row with fewest entries.
 * J. T. Schwartz, J. ACM 27 (1980), for how seldom a random point is a zero.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "prime_field.h"
#include <colamd.h>
#include <math.h>
#include <stdint.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

/* The two largest primes below 2^31, and points for s. */
static const uint64_t prime[2] = {2147483647, 2147483629}, point[2] = {1234567891, 987654321};

/* The factors may have GROWTH times as many entries as the matrix, as in prime_field.h; they are
 * allocated in pieces of at least CHUNK. */
enum { GROWTH = 64, CHUNK = 1 << 16, NONE = -1 };

/* Vectors of a kernel that are computed. */
enum { KERNEL_MOST = 64 };

/* Columns of a triangular factor, with room for more. */
typedef struct factor {
  sunindextype *start, *row, room, used;
  uint32_t *value;
} factor;

typedef struct field {
  steif_context *ctx;
  stf_pool *pool;
  uint64_t p, s;
  sunindextype n;          /* rows and columns */
  sunindextype *ptr, *row; /* the matrix by columns */
  uint32_t *value;
  sunindextype *weight, *order; /* entries of rows; columns by their number of entries */
  sunindextype *pivot_of;       /* row -> its step; NONE */
  factor L, U;                  /* by steps; of U only what a kernel asks for */
  sunindextype *column_of;      /* step -> column */
  unsigned char *kernel;        /* columns in its vectors; NULL: not wanted */
  uint64_t *x, *y;              /* one column, spread out by rows; by steps */
  sunindextype *reach, *stack, *next, *seen;
} field;

/* ---- numbers ------------------------------------------------------------------------------------ */

static uint64_t power(uint64_t p, uint64_t base, uint64_t exponent)
{
  uint64_t result = 1;
  for (; exponent; exponent >>= 1, base = base * base % p)
    if (exponent & 1) result = result * base % p;
  return result;
}

/* x = m 2^e with a whole m of 53 bits; 2^(p-1) = 1. */
static uint64_t residue(uint64_t p, sunrealtype x)
{
  int e;
  const int64_t m = (int64_t)ldexp(frexp(x, &e), 53);
  const uint64_t size = (uint64_t)(m < 0 ? -m : m) % p;
  const uint64_t twos = power(p, 2, (uint64_t)(e - 53 + (int64_t)(p - 1)));
  const uint64_t r = size * twos % p;
  return m < 0 && r ? p - r : r;
}

/* ---- the matrix ----------------------------------------------------------------------------------- */

static bool dense(SUNMatrix M) { return SUNMatGetID(M) == SUNMATRIX_DENSE; }
static sunindextype order_of(SUNMatrix M)
{
  return dense(M) ? SM_COLUMNS_D(M) : SM_COLUMNS_S(M);
}
static sunindextype entries(SUNMatrix M)
{
  return dense(M) ? SM_LDATA_D(M) : SM_INDEXPTRS_S(M)[SM_COLUMNS_S(M)];
}

/* Append column j of `times` M to a column of the matrix, from row `shift` on. */
static void join(field *f, SUNMatrix M, sunindextype j, sunindextype shift, uint64_t times,
                 sunindextype *count)
{
  const sunindextype height = order_of(M);
  const sunindextype from = dense(M) ? j * height : SM_INDEXPTRS_S(M)[j];
  const sunindextype to = dense(M) ? from + height : SM_INDEXPTRS_S(M)[j + 1];
  const sunrealtype *a = dense(M) ? SM_DATA_D(M) : SM_DATA_S(M);
  for (sunindextype k = from; k < to; k++) {
    if (a[k] == 0) continue;
    f->row[*count] = shift + (dense(M) ? k - from : SM_INDEXVALS_S(M)[k]);
    f->value[(*count)++] = (uint32_t)(times * residue(f->p, a[k]) % f->p);
  }
}

static void assemble(field *f, SUNMatrix E, SUNMatrix F, int blocks)
{
  const sunindextype n = order_of(E);
  sunindextype count = 0;
  for (sunindextype j = 0; j < f->n; j++) {
    const sunindextype block = j / n;
    join(f, E, j % n, block * n, blocks ? 1 : f->s, &count);
    if (!blocks || block + 1 < blocks)
      join(f, F, j % n, blocks ? (block + 1) * n : 0, 1, &count);
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

static int open(field *f, SUNMatrix E, SUNMatrix F, int blocks)
{
  const size_t size = sizeof(sunindextype), copies = blocks ? (size_t)blocks : 1;
  const size_t n = (size_t)order_of(E) * copies;
  const size_t count = ((size_t)entries(E) + (size_t)entries(F)) * copies + 1;
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
  assemble(f, E, F, blocks);
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
  uint32_t *value = row ? stf_allocate(f->ctx, (size_t)room, sizeof *value) : NULL;
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
  t->value[t->used++] = (uint32_t)value;
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

/* x <- L^{-1} column j; its rows stand in `reach` from the value returned on. */
static sunindextype solve(field *f, sunindextype j)
{
  sunindextype top = f->n;
  for (sunindextype k = f->ptr[j]; k < f->ptr[j + 1]; k++)
    if (f->seen[f->row[k]] != j) top = search(f, f->row[k], j, top);
  for (sunindextype k = top; k < f->n; k++) f->x[f->reach[k]] = 0;
  for (sunindextype k = f->ptr[j]; k < f->ptr[j + 1]; k++)
    f->x[f->row[k]] = (f->x[f->row[k]] + f->value[k]) % f->p;
  for (sunindextype k = top; k < f->n; k++) {
    const sunindextype step = f->pivot_of[f->reach[k]];
    const uint64_t x = f->x[f->reach[k]];
    if (step < 0 || !x) continue;
    for (sunindextype q = f->L.start[step]; q < f->L.start[step + 1]; q++)
      f->x[f->L.row[q]] = (f->x[f->L.row[q]] + (f->p - x) * f->L.value[q]) % f->p;
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
  const uint64_t over = power(f->p, f->x[pivot], f->p - 2);
  for (sunindextype k = top; k < f->n; k++) {
    const sunindextype i = f->reach[k];
    if (!f->x[i] || i == pivot) continue;
    if (f->pivot_of[i] < 0) append(&f->L, i, f->x[i] * over % f->p);
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
    y[step] = y[step] * f->U.value[last] % f->p;
    for (sunindextype q = f->U.start[step]; q < last; q++)
      y[f->U.row[q]] = (y[f->U.row[q]] + (f->p - y[step]) * f->U.value[q]) % f->p;
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

static int rank_of(steif_context *ctx, SUNMatrix E, SUNMatrix F, int blocks, int which,
                   unsigned char *kernel, sunindextype *rank)
{
  field f = {.ctx = ctx, .pool = stf_pool_new(ctx), .p = prime[which], .s = point[which]};
  if (!f.pool) return STEIF_NO_MEMORY;
  f.kernel = kernel;
  int code = open(&f, E, F, blocks);
  if (!code) code = eliminate(&f, rank);
  stf_release(ctx, f.L.row), stf_release(ctx, f.L.value);
  stf_release(ctx, f.U.row), stf_release(ctx, f.U.value);
  stf_pool_free(&f.pool);
  return code;
}

int stf_field_rank(steif_context *ctx, SUNMatrix E, SUNMatrix F, int blocks, sunindextype *rank)
{
  return rank_of(ctx, E, F, blocks, 0, NULL, rank);
}

int stf_field_singular(steif_context *ctx, SUNMatrix E, SUNMatrix F, bool *singular)
{
  *singular = true;
  for (int which = 0; which < 2 && *singular; which++) {
    sunindextype rank;
    STEIF_TRY(rank_of(ctx, E, F, 0, which, NULL, &rank));
    *singular = rank >= 0 && rank < order_of(E);
  }
  return STEIF_OK;
}

int stf_field_kernel(steif_context *ctx, SUNMatrix E, SUNMatrix F, unsigned char *in_kernel)
{
  sunindextype rank;
  return rank_of(ctx, E, F, 0, 0, in_kernel, &rank);
}
