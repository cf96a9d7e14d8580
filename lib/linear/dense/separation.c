/* separation.c: a pencil separated into its infinite and its finite part: x(0+), impulse
 * coefficients, slow projector and leading Laurent coefficient from the two diagonal blocks.
 *
 * With x = Q [I R; 0 I] (w, v) and P, L on the left, N w' + w = g and E_f v' + F_f v = f_f,
 * where N = F_inf^{-1} E_inf, g = F_inf^{-1} [I L] P^T f:
 *   v(0+) = v(0-),  w(0+) = sum_{j<k} (-N)^j g^(j)(0),  c_i = (-N)^i (N w(0-) - N w(0+)),
 * and N w(0-) = F_inf^{-1} [I L] P^T E x(0-), so that only E x(0-) enters.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "separation.h"
#include "lapack.h"
#include <math.h>
#include <string.h>

int stf_separation_open(steif_context *ctx, stf_pool *pool, int n, stf_separation *s)
{
  *s = (stf_separation){.ctx = ctx, .n = n};
  s->E = stf_pool_square(pool, n);
  s->F = stf_pool_square(pool, n);
  s->P = stf_pool_square(pool, n);
  s->Q = stf_pool_square(pool, n);
  for (int i = 0; i < STF_SEPARATION_VECTORS; i++)
    if (!(s->vector[i] = stf_pool_array(pool, (size_t)n, sizeof(sunrealtype))))
      return STEIF_NO_MEMORY;
  return s->E && s->F && s->P && s->Q ? STEIF_OK : STEIF_NO_MEMORY;
}

static int allocate_blocks(stf_pool *pool, stf_separation *s)
{
  const size_t m = (size_t)s->m, f = (size_t)s->n - m, size = sizeof(sunrealtype);
  s->R = stf_pool_array(pool, m * f, size);
  s->L = stf_pool_array(pool, m * f, size);
  s->N = stf_pool_array(pool, m * m, size);
  s->infinite = stf_pool_array(pool, m * m, size);
  s->finite = stf_pool_array(pool, f * f, size);
  s->infinite_pivot = stf_pool_array(pool, m, sizeof(int));
  s->finite_pivot = stf_pool_array(pool, f, sizeof(int));
  const bool got =
    s->R && s->L && s->N && s->infinite && s->finite && s->infinite_pivot && s->finite_pivot;
  return got ? STEIF_OK : STEIF_NO_MEMORY;
}

void stf_separation_block(const stf_separation *s, const sunrealtype *A, int i, int j, int rows,
                          int columns, sunrealtype *B)
{
  for (int k = 0; k < columns; k++)
    memcpy(B + (size_t)k * (size_t)rows, A + (size_t)(j + k) * (size_t)s->n + i,
           (size_t)rows * sizeof *B);
}

/* B := A^{-1} B or A^{-T} B from the factors of A, r x r, ldb = r. */
static void solve(char op, int r, const sunrealtype *factor, const int *pivot, int columns,
                  sunrealtype *B)
{
  int info;
  if (r > 0 && columns > 0) dgetrs_(&op, &r, &columns, factor, &r, pivot, B, &r, &info, 1);
}
void stf_separation_infinite(const stf_separation *s, int columns, sunrealtype *B)
{
  solve('N', s->m, s->infinite, s->infinite_pivot, columns, B);
}
void stf_separation_finite(const stf_separation *s, char op, int columns, sunrealtype *B)
{
  solve(op, s->n - s->m, s->finite, s->finite_pivot, columns, B);
}

static bool factor(int r, sunrealtype *A, int *pivot)
{
  int info = 0;
  if (r > 0) dgetrf_(&r, &r, A, &r, pivot, &info);
  return info == 0;
}

int stf_separation_factor(stf_pool *pool, stf_separation *s)
{
  const int m = s->m, f = s->n - m;
  STEIF_TRY(allocate_blocks(pool, s));
  stf_separation_block(s, s->F, 0, 0, m, m, s->infinite);
  stf_separation_block(s, s->E, m, m, f, f, s->finite);
  stf_separation_block(s, s->E, 0, 0, m, m, s->N);
  if (!factor(m, s->infinite, s->infinite_pivot) || !factor(f, s->finite, s->finite_pivot))
    return STEIF_RETRY;
  stf_separation_infinite(s, m, s->N);
  return STEIF_OK;
}

/* fast = F_inf^{-1} [I L] P^T b; after the first m of `all` comes the finite part of P^T b. */
static void fast_part(const stf_separation *s, const sunrealtype *b, sunrealtype *all,
                      sunrealtype *fast)
{
  const int n = s->n, m = s->m;
  stf_gemm('T', 'N', n, 1, n, 1, s->P, n, b, n, 0, all, n);
  memcpy(fast, all, (size_t)m * sizeof *fast);
  stf_gemm('N', 'N', m, 1, n - m, 1, s->L, m, all + m, n, 1, fast, n);
  stf_separation_infinite(s, 1, fast);
}

/* w = sum_{j<k} (-N)^j g^(j) by Horner's rule. */
static void smooth_fast_part(const stf_separation *s, int k, const stf_sources *sources,
                             sunrealtype *w)
{
  const int n = s->n, m = s->m;
  sunrealtype *all = s->vector[0], *g = s->vector[1];
  memset(w, 0, (size_t)n * sizeof *w);
  for (int j = k - 1; sources->f && j >= 0; j--) {
    fast_part(s, sources->f + (size_t)j * (size_t)n, all, g);
    stf_gemm('N', 'N', m, 1, m, -1, s->N, m, w, n, 1, g, n);
    memcpy(w, g, (size_t)m * sizeof *w);
  }
}

/* c_i = Q_inf u with u = N w(0-) - N w(0+), then -N u, ... */
static void impulses(const stf_separation *s, sunrealtype *u, steif_impulse *impulse)
{
  const int n = s->n, m = s->m;
  sunrealtype *next = s->vector[1];
  for (int i = 0; i < impulse->count; i++) {
    stf_gemm('N', 'N', n, 1, m, 1, s->Q, n, u, n, 0, impulse->c + (size_t)i * (size_t)n, n);
    stf_gemm('N', 'N', m, 1, m, -1, s->N, m, u, n, 0, next, n);
    memcpy(u, next, (size_t)m * sizeof *u);
  }
}

int stf_separation_impulse(const stf_separation *s, int k, const stf_sources *sources,
                           steif_impulse *impulse)
{
  const int n = s->n, m = s->m, f = n - m;
  sunrealtype *all = s->vector[0], *u = s->vector[2], *x = s->vector[3];
  STEIF_CHECK(!sources->f || sources->derivatives >= k - 1, s->ctx, STEIF_BAD_INPUT,
              "index %d needs derivatives of the forcing up to %d, given are %d", k, k - 1,
              sources->derivatives);
  STEIF_TRY(stf_impulse_allocate(s->ctx, n, k, impulse));
  smooth_fast_part(s, k, sources, x);
  fast_part(s, sources->Ex0, all, u);
  stf_separation_finite(s, 'N', 1, all + m);
  stf_gemm('N', 'N', m, 1, m, -1, s->N, m, x, n, 1, u, n);
  memcpy(x + m, all + m, (size_t)f * sizeof *x);
  stf_gemm('N', 'N', m, 1, f, 1, s->R, m, all + m, n, 1, x, n);
  stf_gemm('N', 'N', n, 1, n, 1, s->Q, n, x, n, 0, impulse->x_plus, n);
  impulses(s, u, impulse);
  return STEIF_OK;
}

static int projector(stf_pool *pool, const stf_separation *s, sunrealtype *slow)
{
  const int n = s->n, m = s->m, f = n - m;
  const size_t head = (size_t)n * (size_t)m;
  sunrealtype *part_f = stf_pool_square(pool, n);
  if (!part_f) return STEIF_NO_MEMORY;
  memcpy(part_f, s->Q + head, (size_t)n * (size_t)f * sizeof *part_f);
  stf_gemm('N', 'N', n, f, m, 1, s->Q, n, s->R, m, 1, part_f, n);
  stf_gemm('N', 'T', n, n, f, 1, part_f, n, s->Q + head, n, 0, slow, n);
  return STEIF_OK;
}

/* T = F_inf^{-1} [I L] P^T, m x n packed: g = T f. */
static void fast_rows(const stf_separation *s, sunrealtype *T)
{
  const int n = s->n, m = s->m;
  for (int j = 0; j < m; j++)
    for (int i = 0; i < n; i++)
      T[(size_t)i * (size_t)m + (size_t)j] = s->P[(size_t)j * (size_t)n + (size_t)i];
  stf_gemm('N', 'T', m, n, n - m, 1, s->L, m, s->P + (size_t)m * (size_t)n, n, 1, T, m);
  stf_separation_infinite(s, n, T);
}

int stf_separation_rows(stf_pool *pool, const stf_separation *s, sunrealtype *norm)
{
  sunrealtype *T = stf_pool_square(pool, s->n);
  if (!T) return STEIF_NO_MEMORY;
  fast_rows(s, T);
  *norm = stf_frobenius(s->m, s->n, T, s->m);
  return STEIF_OK;
}

/* [I -R] Q^T, with which w is had from x, or zeros above A_f Q_f^T. */
static void rows_of(const stf_separation *s, const sunrealtype *A, bool algebraic,
                    sunrealtype *B)
{
  const int n = s->n, m = s->m, f = n - m;
  const sunrealtype *finite = s->Q + (size_t)n * (size_t)m;
  for (int j = 0; j < n; j++)
    for (int i = 0; i < m; i++)
      B[(size_t)j * (size_t)n + (size_t)i] =
        algebraic ? s->Q[(size_t)i * (size_t)n + (size_t)j] : 0;
  if (algebraic) stf_gemm('N', 'T', m, n, f, -1, s->R, m, finite, n, 1, B, n);
  stf_gemm('N', 'T', f, n, f, 1, A + (size_t)n * (size_t)m + m, n, finite, n, 0, B + m, n);
}

/* G = T above P_f^T, or above zeros. */
static void sources_of(const stf_separation *s, const sunrealtype *T, bool finite,
                       sunrealtype *G)
{
  const size_t n = (size_t)s->n, m = (size_t)s->m;
  for (size_t j = 0; j < n; j++) {
    memcpy(G + j * n, T + j * m, m * sizeof *G);
    for (size_t i = m; i < n; i++) G[j * n + i] = finite ? s->P[i * n + j] : 0;
  }
}

static int reduce(stf_pool *pool, const stf_separation *s, stf_reduction *out)
{
  const int n = s->n, m = s->m;
  const size_t rows = (size_t)n, size = rows * rows;
  sunrealtype *T = stf_pool_square(pool, n), *next = stf_pool_square(pool, n);
  if (!T || !next) return STEIF_NO_MEMORY;
  out->algebraic = m;
  rows_of(s, s->E, false, out->E);
  rows_of(s, s->F, true, out->F);
  fast_rows(s, T);
  for (int k = 0; k < out->terms; k++) {
    sources_of(s, T, k == 0, out->G + (size_t)k * size);
    stf_gemm('N', 'N', m, n, m, -1, s->N, m, T, m, 0, next, m);
    memcpy(T, next, (size_t)m * rows * sizeof *T);
  }
  return STEIF_OK;
}

/* diag(A_inf, A_f) with A_inf m x m packed; NULL: I. */
static void diagonal(const stf_separation *s, const sunrealtype *head, const sunrealtype *A,
                     sunrealtype *B)
{
  const size_t n = (size_t)s->n, m = (size_t)s->m;
  memset(B, 0, n * n * sizeof *B);
  for (size_t j = 0; j < m; j++)
    for (size_t i = 0; i < m; i++) B[j * n + i] = head ? head[j * m + i] : i == j;
  for (size_t j = m; j < n; j++) memcpy(B + j * n + m, A + j * n + m, (n - m) * sizeof *B);
}

static int decouple(stf_pool *pool, const stf_separation *s, const stf_decoupling *out)
{
  const int n = s->n, m = s->m, f = n - m;
  const size_t head = (size_t)n * (size_t)m, size = (size_t)n * (size_t)n;
  sunrealtype *T = stf_pool_square(pool, n);
  if (!T) return STEIF_NO_MEMORY;
  diagonal(s, s->N, s->E, out->E);
  diagonal(s, NULL, s->F, out->F);
  fast_rows(s, T);
  sources_of(s, T, true, out->G);
  memcpy(out->back, s->Q, size * sizeof *T);
  stf_gemm('N', 'N', n, f, m, 1, s->Q, n, s->R, m, 1, out->back + head, n);
  for (int j = 0; j < n; j++)
    for (int i = 0; i < n; i++)
      out->to[(size_t)j * (size_t)n + (size_t)i] = s->Q[(size_t)i * (size_t)n + (size_t)j];
  stf_gemm('N', 'T', m, n, f, -1, s->R, m, s->Q + head, n, 1, out->to, n);
  return STEIF_OK;
}

int stf_separation_give(stf_pool *pool, const stf_separation *s, const stf_separated *parts)
{
  if (parts->slow) STEIF_TRY(projector(pool, s, parts->slow));
  if (parts->reduction) STEIF_TRY(reduce(pool, s, parts->reduction));
  return parts->decoupling ? decouple(pool, s, parts->decoupling) : STEIF_OK;
}

/* Norms of the rows and columns of Phi = Q_inf T. */
static int list_largest(stf_separation *s, const sunrealtype *Phi, steif_structure *structure)
{
  const int n = s->n;
  sunrealtype *row = s->vector[0], *column = s->vector[1];
  memset(row, 0, (size_t)n * sizeof *row);
  for (int j = 0; j < n; j++) {
    column[j] = stf_length(n, Phi + (size_t)j * (size_t)n);
    for (int i = 0; i < n; i++) row[i] = hypot(row[i], Phi[(size_t)j * (size_t)n + (size_t)i]);
  }
  STEIF_TRY(
    stf_list_large(s->ctx, n, column, &structure->equations_count, &structure->equations));
  return stf_list_large(s->ctx, n, row, &structure->unknowns_count, &structure->unknowns);
}

int stf_separation_offenders(stf_pool *pool, stf_separation *s, int k,
                             steif_structure *structure)
{
  const int n = s->n, m = s->m;
  sunrealtype *T = stf_pool_square(pool, n), *next = stf_pool_square(pool, n);
  if (!T || !next) return STEIF_NO_MEMORY;
  fast_rows(s, T);
  for (int j = 1; j < k; j++) {
    stf_gemm('N', 'N', m, n, m, 1, s->N, m, T, m, 0, next, m);
    memcpy(T, next, (size_t)m * (size_t)n * sizeof *T);
  }
  stf_gemm('N', 'N', n, n, m, 1, s->Q, n, T, m, 0, next, n);
  return list_largest(s, next, structure);
}
