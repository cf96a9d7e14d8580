/* shared_pivots.c: the sequence of pivots out of KLU's factors, for shifts side by side.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "multishift.h"
#include "sparse.h"
#include <limits.h>
#include <string.h>

/* What klu_zl_extract writes. */
typedef struct extract {
  SuiteSparse_long *lp, *li, *up, *ui, *p, *q, *r;
  double *values; /* nobody reads them */
} extract;

static int claim(stf_pool *pool, const klu_l_numeric *f, const klu_l_symbolic *s, extract *x)
{
  const size_t n = (size_t)f->n, size = sizeof *x->lp;
  const size_t lnz = (size_t)f->lnz, unz = (size_t)f->unz;
  x->lp = stf_pool_array(pool, n + 1, size), x->up = stf_pool_array(pool, n + 1, size);
  x->li = stf_pool_array(pool, lnz, size), x->ui = stf_pool_array(pool, unz, size);
  x->p = stf_pool_array(pool, n, size), x->q = stf_pool_array(pool, n, size);
  x->r = stf_pool_array(pool, (size_t)s->nblocks + 1, size);
  x->values = stf_pool_array(pool, lnz > unz ? lnz : unz, sizeof *x->values);
  return x->lp && x->up && x->li && x->ui && x->p && x->q && x->r && x->values
           ? STEIF_OK
           : STEIF_NO_MEMORY;
}

static int allocate(const stf_pattern *u, const klu_l_numeric *f, stf_steps *q)
{
  const size_t n = (size_t)q->n, nnz = (size_t)u->nnz, wide = sizeof *q->lower;
  q->first = stf_allocate(q->ctx, (size_t)q->blocks + 1, sizeof *q->first);
  q->face.equation = stf_allocate(q->ctx, n, sizeof *q->face.equation);
  q->face.unknown = stf_allocate(q->ctx, n, sizeof *q->face.unknown);
  q->place = stf_allocate(q->ctx, n, sizeof *q->place);
  q->run = stf_allocate(q->ctx, n, sizeof *q->run);
  q->lower = stf_allocate(q->ctx, n + 1, wide), q->upper = stf_allocate(q->ctx, n + 1, wide);
  q->below = stf_allocate(q->ctx, (size_t)f->lnz - n, sizeof *q->below);
  q->above = stf_allocate(q->ctx, (size_t)f->unz - n, sizeof *q->above);
  q->column = stf_allocate(q->ctx, n + 1, wide), q->inner = stf_allocate(q->ctx, n, wide);
  q->row = stf_allocate(q->ctx, n + 1, wide);
  q->entry = stf_allocate(q->ctx, nnz, sizeof *q->entry);
  q->across = stf_allocate(q->ctx, nnz, sizeof *q->across);
  q->e = stf_allocate(q->ctx, 2 * nnz, sizeof *q->e), q->row_e = q->e ? q->e + nnz : NULL;
  q->a = stf_allocate(q->ctx, 2 * nnz, sizeof *q->a), q->row_a = q->a ? q->a + nnz : NULL;
  return q->first && q->face.equation && q->face.unknown && q->place && q->run && q->lower &&
             q->upper && q->below && q->above && q->column && q->inner && q->row && q->entry &&
             q->across && q->e && q->a
           ? STEIF_OK
           : STEIF_NO_MEMORY;
}

/* Columns of a triangular factor without their diagonal, which comes first in L, last in U. */
static void off_diagonal(int n, const SuiteSparse_long *ptr, const SuiteSparse_long *row,
                         int skip, SuiteSparse_long *to, int *index)
{
  for (int k = 0; k < n; k++) {
    to[k] = ptr[k] - k;
    for (SuiteSparse_long p = ptr[k]; p < ptr[k + 1] - 1; p++)
      index[p - k] = (int)row[p + skip];
  }
  to[n] = ptr[n] - n;
}

static void convert(const extract *x, stf_steps *q)
{
  off_diagonal(q->n, x->lp, x->li, 1, q->lower, q->below);
  off_diagonal(q->n, x->up, x->ui, 0, q->upper, q->above);
  for (int k = 0; k < q->n; k++) {
    q->face.equation[k] = (int)x->p[k], q->face.unknown[k] = (int)x->q[k];
    q->place[x->p[k]] = k;
  }
  for (int b = 0; b <= q->blocks; b++) q->first[b] = (int)x->r[b];
}

/* Column k of L has rows k + 1 and those of column k + 1. */
static bool continues(const stf_steps *q, int k)
{
  const SuiteSparse_long from = q->lower[k], next = q->lower[k + 1], end = q->lower[k + 2];
  return next - from == end - next + 1 && q->below[from] == k + 1 &&
         !memcmp(q->below + from + 1, q->below + next, (size_t)(end - next) * sizeof *q->below);
}

static void find_runs(stf_steps *q)
{
  q->run[q->n - 1] = 1;
  for (int k = q->n - 2; k >= 0; k--) q->run[k] = continues(q, k) ? q->run[k + 1] + 1 : 1;
}

/* Where columns and rows begin; entries above the block of their column stand behind the
 * others. */
static void arrange(const stf_pattern *u, stf_steps *q)
{
  SuiteSparse_long next = 0;
  for (int b = 0; b < q->blocks; b++)
    for (int k = q->first[b]; k < q->first[b + 1]; k++) {
      const int j = q->face.unknown[k];
      q->column[k] = q->inner[k] = next;
      for (SuiteSparse_long p = u->ptr[j]; p < u->ptr[j + 1]; p++) {
        const int i = q->place[u->row[p]];
        q->inner[k] += i >= q->first[b];
        q->row[i + 1]++;
      }
      next += u->ptr[j + 1] - u->ptr[j];
    }
  q->column[q->n] = next;
  for (int i = 0; i < q->n; i++) q->row[i + 1] += q->row[i];
}

/* While entries join the rows, row[i] is where the next one goes: in the end, where row i + 1
 * begins. */
static void fill(const stf_pattern *u, const double *A, stf_steps *q)
{
  for (int b = 0; b < q->blocks; b++)
    for (int k = q->first[b]; k < q->first[b + 1]; k++) {
      const int j = q->face.unknown[k];
      SuiteSparse_long inside = q->column[k], outside = q->inner[k];
      for (SuiteSparse_long p = u->ptr[j]; p < u->ptr[j + 1]; p++) {
        const int i = q->place[u->row[p]];
        const SuiteSparse_long by_column = i >= q->first[b] ? inside++ : outside++;
        const SuiteSparse_long by_row = q->row[i]++;
        const double e = u->e ? u->e[p] : u->row[p] == j;
        q->entry[by_column] = i, q->across[by_row] = k;
        q->e[by_column] = q->row_e[by_row] = e;
        q->a[by_column] = q->row_a[by_row] = A[p];
      }
    }
  memmove(q->row + 1, q->row, (size_t)q->n * sizeof *q->row);
  q->row[0] = 0;
}

void stf_sequence_fill(const steif_pencil *p, stf_sequence *sequence)
{
  const stf_pattern *u = stf_sparse_pattern(p);
  fill(u, stf_pattern_A(p, u), (stf_steps *)sequence);
}

/* From KLU's complex factors f. */
static int extract_steps(stf_pool *pool, const stf_pattern *u, klu_l_symbolic *symbolic,
                         klu_l_numeric *f, stf_steps *q)
{
  klu_l_common common;
  extract x;
  q->n = q->face.n = (int)f->n;
  q->blocks = (int)f->nblocks;
  STEIF_TRY(claim(pool, f, symbolic, &x));
  STEIF_TRY(allocate(u, f, q));
  klu_l_defaults(&common);
  STEIF_CHECK(klu_zl_sort(symbolic, f, &common), q->ctx, STEIF_NO_MEMORY,
              "no memory to sort factors of %d unknowns", q->n);
  klu_zl_extract(f, symbolic, x.lp, x.li, x.values, x.values, x.up, x.ui, x.values, x.values,
                 NULL, NULL, NULL, NULL, x.p, x.q, NULL, x.r, &common);
  convert(&x, q);
  find_runs(q);
  arrange(u, q);
  return STEIF_OK;
}

static int build(steif_pencil *p, int slot, stf_pool *pool, stf_steps *q)
{
  STEIF_TRY(extract_steps(pool, stf_sparse_pattern(p), stf_sparse_symbolic(p),
                          stf_sparse_factors(p, slot), q));
  stf_sequence_fill(p, &q->face);
  q->face.growth = stf_sparse_growth(p, slot);
  return STEIF_OK;
}

int stf_sequence_open(steif_pencil *p, int slot, stf_sequence **sequence)
{
  STEIF_CHECK(p->n <= INT_MAX, p->ctx, STEIF_UNSUPPORTED,
              "%lld unknowns: shifts side by side take up to %d", (long long)p->n, INT_MAX);
  stf_pool *pool = stf_pool_new(p->ctx);
  stf_steps *q = stf_allocate(p->ctx, 1, sizeof *q);
  int code = STEIF_NO_MEMORY;
  *sequence = q ? &q->face : NULL;
  if (q) q->ctx = p->ctx;
  if (pool && q) code = build(p, slot, pool, q);
  stf_pool_free(&pool);
  if (code) stf_sequence_close(sequence);
  return code;
}

void stf_sequence_close(stf_sequence **sequence)
{
  stf_steps *q = (stf_steps *)*sequence;
  if (!q) return;
  void *const block[] = {q->face.equation, q->face.unknown, q->first, q->place,
                         q->run,           q->lower,        q->upper, q->below,
                         q->above,         q->column,       q->inner, q->entry,
                         q->row,           q->across,       q->e,     q->a};
  steif_context *ctx = q->ctx;
  for (size_t i = 0; i < sizeof block / sizeof *block; i++) stf_release(ctx, block[i]);
  stf_release(ctx, q);
  *sequence = NULL;
}
