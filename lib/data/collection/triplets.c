/* triplets.c: matrices from entries in any order, and solves with S = G W G^T.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "generated.h"
#include <nvector/nvector_serial.h>
#include <steif/pencil.h>
#include <string.h>
#include <sunmatrix/sunmatrix_sparse.h>

enum { SWEEPS = 3 }; /* of a refined solve */

int stf_sparse_open(stf_pool *pool, sunindextype n, sunindextype room, stf_sparse *m)
{
  *m = (stf_sparse){.n = n, .room = room};
  const size_t count = (size_t)(room > n + 1 ? room : n + 1);
  m->row = stf_pool_array(pool, (size_t)room + 1, sizeof *m->row);
  m->at = m->row ? stf_pool_array(pool, count, sizeof *m->at) : NULL;
  m->value = m->at ? stf_pool_array(pool, (size_t)room + 1, sizeof *m->value) : NULL;
  return m->value ? STEIF_OK : STEIF_NO_MEMORY;
}

void stf_linear_put(stf_sparse *m, sunindextype i, sunindextype j, sunrealtype value)
{
  if (m->sorted) {
    for (sunindextype k = m->at[j]; k < m->at[j + 1]; k++)
      if (m->row[k] == i) m->value[k] += value;
    return;
  }
  const sunindextype k = m->count++;
  if (k < m->room) {
    m->row[k] = i;
    m->at[k] = j;
    m->value[k] = value;
  }
}

/* Positions of the entries in the order of `key`, stable: a counting sort. next: n + 1 zeros. */
static void order(const stf_sparse *m, const sunindextype *key, const sunindextype *before,
                  sunindextype *next, sunindextype *after)
{
  for (sunindextype k = 0; k < m->count; k++) next[key[k] + 1]++;
  for (sunindextype i = 0; i < m->n; i++) next[i + 1] += next[i];
  for (sunindextype k = 0; k < m->count; k++) {
    const sunindextype e = before ? before[k] : k;
    after[next[key[e]]++] = e;
  }
}

/* Entries in the order of columns, and of rows within, added up where they meet. */
static void gather(const stf_sparse *m, const sunindextype *at, stf_sparse *out)
{
  sunindextype used = 0;
  for (sunindextype k = 0, j = 0; j < m->n; j++) {
    const sunindextype first = used;
    out->at[j] = first;
    for (; k < m->count && m->at[at[k]] == j; k++) {
      const sunindextype i = m->row[at[k]];
      if (used == first || out->row[used - 1] != i) {
        out->row[used] = i;
        out->value[used++] = 0;
      }
      out->value[used - 1] += m->value[at[k]];
    }
  }
  out->at[m->n] = out->count = used;
}

int stf_sparse_sort(steif_context *ctx, stf_pool *pool, const stf_sparse *m, stf_sparse *out)
{
  const size_t count = (size_t)m->count, n1 = (size_t)m->n + 1;
  STEIF_TRY(stf_sparse_open(pool, m->n, m->count, out));
  sunindextype *by_row = stf_allocate(ctx, 2 * (count + n1), sizeof *by_row);
  if (!by_row) return STEIF_NO_MEMORY;
  sunindextype *by_column = by_row + count, *next = by_column + count;
  order(m, m->row, NULL, next, by_row);
  order(m, m->at, by_row, next + n1, by_column);
  gather(m, by_column, out);
  stf_release(ctx, by_row);
  return STEIF_OK;
}

struct stf_schur {
  steif_context *ctx;
  SUNMatrix minus; /* -S: the pencil 0 I - (-S) */
  steif_pencil *pencil;
  N_Vector b;
  sunrealtype *x, *r; /* solution and residual */
};

void stf_schur_close(stf_schur **s)
{
  if (!*s) return;
  steif_pencil_free(&(*s)->pencil);
  if ((*s)->minus) SUNMatDestroy((*s)->minus);
  if ((*s)->b) N_VDestroy((*s)->b);
  stf_release((*s)->ctx, (*s)->x);
  stf_release((*s)->ctx, *s);
  *s = NULL;
}

static int allocate(stf_schur *s, const stf_sparse *S)
{
  const SUNContext sun = steif_sundials(s->ctx);
  s->x = stf_allocate(s->ctx, 2 * (size_t)S->n, sizeof *s->x);
  if (!s->x) return STEIF_NO_MEMORY;
  s->r = s->x + S->n;
  s->minus = SUNSparseMatrix(S->n, S->n, S->count, CSC_MAT, sun);
  s->b = N_VNewEmpty_Serial(S->n, sun);
  STEIF_CHECK(s->minus && s->b, s->ctx, STEIF_NO_MEMORY,
              "no memory for the %lld constraints of the exact start; make the problem smaller",
              (long long)S->n);
  memcpy(SM_INDEXPTRS_S(s->minus), S->at, (size_t)(S->n + 1) * sizeof *S->at);
  memcpy(SM_INDEXVALS_S(s->minus), S->row, (size_t)S->count * sizeof *S->row);
  for (sunindextype k = 0; k < S->count; k++) SM_DATA_S(s->minus)[k] = -S->value[k];
  s->pencil = steif_pencil_new(s->ctx, NULL, s->minus);
  return s->pencil ? steif_pencil_factor(s->pencil, 1, &(steif_shift){0, 0})
                   : steif_status(s->ctx);
}

int stf_schur_of(steif_context *ctx, const stf_sparse *S, stf_schur **out)
{
  stf_schur *s = *out = stf_allocate(ctx, 1, sizeof *s);
  if (!s) return STEIF_NO_MEMORY;
  s->ctx = ctx;
  const int code = allocate(s, S);
  if (code) stf_schur_close(out);
  return code;
}

/* r = b - S x, products and sums with the digits of long double; S is symmetric: columns are rows. */
static void residual(const stf_schur *s, const sunrealtype *b)
{
  const sunindextype *at = SM_INDEXPTRS_S(s->minus), *row = SM_INDEXVALS_S(s->minus);
  const sunrealtype *value = SM_DATA_S(s->minus);
  for (sunindextype j = 0; j < SM_COLUMNS_S(s->minus); j++) {
    long double sum = b[j];
    for (sunindextype k = at[j]; k < at[j + 1]; k++)
      sum += (long double)value[k] * s->x[row[k]];
    s->r[j] = (sunrealtype)sum;
  }
}

/* Refined: what judges others must not lose the digits that the condition of S takes. */
int stf_schur_solve(stf_schur *s, sunrealtype *b)
{
  const sunindextype n = SM_COLUMNS_S(s->minus);
  for (sunindextype i = 0; i < n; i++) {
    s->x[i] = 0;
    s->r[i] = b[i];
  }
  NV_DATA_S(s->b) = s->r;
  for (int sweep = 0; sweep < SWEEPS; sweep++) {
    if (sweep) residual(s, b);
    STEIF_TRY(steif_pencil_solve(s->pencil, 0, 1, &s->b, NULL));
    for (sunindextype i = 0; i < n; i++) s->x[i] += s->r[i];
  }
  memcpy(b, s->x, (size_t)n * sizeof *b);
  return STEIF_OK;
}

/* The entries of rows base .. base + size - 1 in column j: positions *from .. *to - 1. */
static void block(const stf_sparse *M, sunindextype j, sunindextype base, sunindextype size,
                  sunindextype *from, sunindextype *to)
{
  for (*from = M->at[j]; *from < M->at[j + 1] && M->row[*from] < base;) ++*from;
  for (*to = *from; *to < M->at[j + 1] && M->row[*to] < base + size;) ++*to;
}

/* Sum of weight_j b_j b_j^T into `entries`, or only their number where `entries` is NULL. */
static sunindextype squares(const stf_sparse *M, sunindextype base, sunindextype size,
                            sunindextype first, sunindextype count, const sunrealtype *weight,
                            stf_sparse *entries)
{
  sunindextype room = 0, from, to;
  for (sunindextype j = 0; j < count; j++) {
    block(M, first + j, base, size, &from, &to);
    room += (to - from) * (to - from);
    for (sunindextype a = from; entries && a < to; a++)
      for (sunindextype b = from; b < to; b++)
        stf_linear_put(entries, M->row[a] - base, M->row[b] - base,
                       weight[j] * M->value[a] * M->value[b]);
  }
  return room;
}

int stf_schur_open(steif_context *ctx, const stf_sparse *M, sunindextype base,
                   sunindextype size, sunindextype first, sunindextype count,
                   const sunrealtype *weight, stf_schur **s)
{
  stf_sparse entries, S;
  *s = NULL;
  stf_pool *pool = stf_pool_new(ctx);
  if (!pool) return STEIF_NO_MEMORY;
  const sunindextype room = squares(M, base, size, first, count, weight, NULL);
  int code = stf_sparse_open(pool, size, room, &entries);
  if (code) goto done;
  squares(M, base, size, first, count, weight, &entries);
  code = stf_sparse_sort(ctx, pool, &entries, &S);
  if (!code) code = stf_schur_of(ctx, &S, s);
done:
  stf_pool_free(&pool);
  return code;
}
