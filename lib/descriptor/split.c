/* split.c: a pencil split into its infinite and its finite part: x(0+), impulse coefficients,
 * slow projector and leading Laurent coefficient from the two diagonal blocks.
 *
 * With x = Q [I R; 0 I] (w, v) and P, L on the left, N w' + w = g and E_f v' + F_f v = f_f,
 * where N = F_inf^{-1} E_inf, g = F_inf^{-1} [I L] P^T f:
 *   v(0+) = v(0-),  w(0+) = sum_{j<k} (-N)^j g^(j)(0),  c_i = (-N)^i (N w(0-) - N w(0+)),
 * and N w(0-) = F_inf^{-1} [I L] P^T E x(0-), so that only E x(0-) enters.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "dense.h"
#include "lapack.h"
#include <math.h>
#include <string.h>

int stf_split_open(steif_context *ctx, stf_pool *pool, int n, stf_split *split)
{
  *split = (stf_split){.ctx = ctx, .n = n};
  split->E = stf_claim_square(pool, n);
  split->F = stf_claim_square(pool, n);
  split->P = stf_claim_square(pool, n);
  split->Q = stf_claim_square(pool, n);
  for (int i = 0; i < STF_SPLIT_VECTORS; i++)
    if (!(split->vector[i] = stf_claim(pool, (size_t)n, sizeof(sunrealtype))))
      return STEIF_NO_MEMORY;
  return split->E && split->F && split->P && split->Q ? STEIF_OK : STEIF_NO_MEMORY;
}

static int claim_blocks(stf_pool *pool, stf_split *split)
{
  const size_t m = (size_t)split->m, f = (size_t)split->n - m, size = sizeof(sunrealtype);
  split->R = stf_claim(pool, m * f, size);
  split->L = stf_claim(pool, m * f, size);
  split->N = stf_claim(pool, m * m, size);
  split->infinite = stf_claim(pool, m * m, size);
  split->finite = stf_claim(pool, f * f, size);
  split->infinite_pivot = stf_claim(pool, m, sizeof(int));
  split->finite_pivot = stf_claim(pool, f, sizeof(int));
  const bool got = split->R && split->L && split->N && split->infinite && split->finite &&
                   split->infinite_pivot && split->finite_pivot;
  return got ? STEIF_OK : STEIF_NO_MEMORY;
}

void stf_split_block(const stf_split *split, const sunrealtype *A, int i, int j, int rows,
                     int columns, sunrealtype *B)
{
  for (int k = 0; k < columns; k++)
    memcpy(B + (size_t)k * (size_t)rows, A + (size_t)(j + k) * (size_t)split->n + i,
           (size_t)rows * sizeof *B);
}

/* B := A^{-1} B or A^{-T} B from the factors of A, r x r, ldb = r. */
static void solve(char op, int r, const sunrealtype *factor, const int *pivot, int columns,
                  sunrealtype *B)
{
  int info;
  if (r > 0 && columns > 0) dgetrs_(&op, &r, &columns, factor, &r, pivot, B, &r, &info, 1);
}
void stf_split_infinite(const stf_split *split, int columns, sunrealtype *B)
{
  solve('N', split->m, split->infinite, split->infinite_pivot, columns, B);
}
void stf_split_finite(const stf_split *split, char op, int columns, sunrealtype *B)
{
  solve(op, split->n - split->m, split->finite, split->finite_pivot, columns, B);
}

static bool factor(int r, sunrealtype *A, int *pivot)
{
  int info = 0;
  if (r > 0) dgetrf_(&r, &r, A, &r, pivot, &info);
  return info == 0;
}

int stf_split_factor(stf_pool *pool, stf_split *split)
{
  const int m = split->m, f = split->n - m;
  STEIF_TRY(claim_blocks(pool, split));
  stf_split_block(split, split->F, 0, 0, m, m, split->infinite);
  stf_split_block(split, split->E, m, m, f, f, split->finite);
  stf_split_block(split, split->E, 0, 0, m, m, split->N);
  if (!factor(m, split->infinite, split->infinite_pivot) ||
      !factor(f, split->finite, split->finite_pivot))
    return STEIF_RETRY;
  stf_split_infinite(split, m, split->N);
  return STEIF_OK;
}

/* fast = F_inf^{-1} [I L] P^T b; behind the first m of `all` is the finite part of P^T b. */
static void part(const stf_split *split, const sunrealtype *b, sunrealtype *all,
                 sunrealtype *fast)
{
  const int n = split->n, m = split->m;
  stf_gemm('T', 'N', n, 1, n, 1, split->P, n, b, n, 0, all, n);
  memcpy(fast, all, (size_t)m * sizeof *fast);
  stf_gemm('N', 'N', m, 1, n - m, 1, split->L, m, all + m, n, 1, fast, n);
  stf_split_infinite(split, 1, fast);
}

/* w = sum_{j<k} (-N)^j g^(j) by Horner's rule. */
static void settle(const stf_split *split, int k, const stf_sources *sources, sunrealtype *w)
{
  const int n = split->n, m = split->m;
  sunrealtype *all = split->vector[0], *g = split->vector[1];
  memset(w, 0, (size_t)n * sizeof *w);
  for (int j = k - 1; sources->f && j >= 0; j--) {
    part(split, sources->f + (size_t)j * (size_t)n, all, g);
    stf_gemm('N', 'N', m, 1, m, -1, split->N, m, w, n, 1, g, n);
    memcpy(w, g, (size_t)m * sizeof *w);
  }
}

/* c_i = Q_inf u with u = N w(0-) - N w(0+), then -N u, ... */
static void strike(const stf_split *split, sunrealtype *u, steif_impulse *impulse)
{
  const int n = split->n, m = split->m;
  sunrealtype *next = split->vector[1];
  for (int i = 0; i < impulse->count; i++) {
    stf_gemm('N', 'N', n, 1, m, 1, split->Q, n, u, n, 0, impulse->c + (size_t)i * (size_t)n, n);
    stf_gemm('N', 'N', m, 1, m, -1, split->N, m, u, n, 0, next, n);
    memcpy(u, next, (size_t)m * sizeof *u);
  }
}

int stf_split_impulse(const stf_split *split, int k, const stf_sources *sources,
                      steif_impulse *impulse)
{
  const int n = split->n, m = split->m, f = n - m;
  sunrealtype *all = split->vector[0], *u = split->vector[2], *x = split->vector[3];
  STEIF_CHECK(!sources->f || sources->derivatives >= k - 1, split->ctx, STEIF_BAD_INPUT,
              "index %d needs derivatives of the forcing up to %d, given are %d", k, k - 1,
              sources->derivatives);
  STEIF_TRY(stf_impulse_claim(split->ctx, n, k, impulse));
  settle(split, k, sources, x);
  part(split, sources->Ex0, all, u);
  stf_split_finite(split, 'N', 1, all + m);
  stf_gemm('N', 'N', m, 1, m, -1, split->N, m, x, n, 1, u, n);
  memcpy(x + m, all + m, (size_t)f * sizeof *x);
  stf_gemm('N', 'N', m, 1, f, 1, split->R, m, all + m, n, 1, x, n);
  stf_gemm('N', 'N', n, 1, n, 1, split->Q, n, x, n, 0, impulse->x_plus, n);
  strike(split, u, impulse);
  return STEIF_OK;
}

static int projector(stf_pool *pool, const stf_split *split, sunrealtype *slow)
{
  const int n = split->n, m = split->m, f = n - m;
  const size_t head = (size_t)n * (size_t)m;
  sunrealtype *part_f = stf_claim_square(pool, n);
  if (!part_f) return STEIF_NO_MEMORY;
  memcpy(part_f, split->Q + head, (size_t)n * (size_t)f * sizeof *part_f);
  stf_gemm('N', 'N', n, f, m, 1, split->Q, n, split->R, m, 1, part_f, n);
  stf_gemm('N', 'T', n, n, f, 1, part_f, n, split->Q + head, n, 0, slow, n);
  return STEIF_OK;
}

/* T = F_inf^{-1} [I L] P^T, m x n packed: g = T f. */
static void fast_rows(const stf_split *split, sunrealtype *T)
{
  const int n = split->n, m = split->m;
  for (int j = 0; j < m; j++)
    for (int i = 0; i < n; i++)
      T[(size_t)i * (size_t)m + (size_t)j] = split->P[(size_t)j * (size_t)n + (size_t)i];
  stf_gemm('N', 'T', m, n, n - m, 1, split->L, m, split->P + (size_t)m * (size_t)n, n, 1, T, m);
  stf_split_infinite(split, n, T);
}

int stf_split_rows(stf_pool *pool, const stf_split *split, sunrealtype *norm)
{
  sunrealtype *T = stf_claim_square(pool, split->n);
  if (!T) return STEIF_NO_MEMORY;
  fast_rows(split, T);
  *norm = stf_frobenius(split->m, split->n, T, split->m);
  return STEIF_OK;
}

/* [I -R] Q^T, with which w is had from x, or zeros above A_f Q_f^T. */
static void rows_of(const stf_split *split, const sunrealtype *A, bool algebraic,
                    sunrealtype *B)
{
  const int n = split->n, m = split->m, f = n - m;
  const sunrealtype *finite = split->Q + (size_t)n * (size_t)m;
  for (int j = 0; j < n; j++)
    for (int i = 0; i < m; i++)
      B[(size_t)j * (size_t)n + (size_t)i] =
        algebraic ? split->Q[(size_t)i * (size_t)n + (size_t)j] : 0;
  if (algebraic) stf_gemm('N', 'T', m, n, f, -1, split->R, m, finite, n, 1, B, n);
  stf_gemm('N', 'T', f, n, f, 1, A + (size_t)n * (size_t)m + m, n, finite, n, 0, B + m, n);
}

/* G = T above P_f^T, or above zeros. */
static void sources_of(const stf_split *split, const sunrealtype *T, bool finite,
                       sunrealtype *G)
{
  const size_t n = (size_t)split->n, m = (size_t)split->m;
  for (size_t j = 0; j < n; j++) {
    memcpy(G + j * n, T + j * m, m * sizeof *G);
    for (size_t i = m; i < n; i++) G[j * n + i] = finite ? split->P[i * n + j] : 0;
  }
}

static int reduce(stf_pool *pool, const stf_split *split, stf_reduction *out)
{
  const int n = split->n, m = split->m;
  const size_t rows = (size_t)n, size = rows * rows;
  sunrealtype *T = stf_claim_square(pool, n), *next = stf_claim_square(pool, n);
  if (!T || !next) return STEIF_NO_MEMORY;
  out->algebraic = m;
  rows_of(split, split->E, false, out->E);
  rows_of(split, split->F, true, out->F);
  fast_rows(split, T);
  for (int k = 0; k < out->terms; k++) {
    sources_of(split, T, k == 0, out->G + (size_t)k * size);
    stf_gemm('N', 'N', m, n, m, -1, split->N, m, T, m, 0, next, m);
    memcpy(T, next, (size_t)m * rows * sizeof *T);
  }
  return STEIF_OK;
}

/* diag(A_inf, A_f) with A_inf m x m packed; NULL: I. */
static void diagonal(const stf_split *split, const sunrealtype *head, const sunrealtype *A,
                     sunrealtype *B)
{
  const size_t n = (size_t)split->n, m = (size_t)split->m;
  memset(B, 0, n * n * sizeof *B);
  for (size_t j = 0; j < m; j++)
    for (size_t i = 0; i < m; i++) B[j * n + i] = head ? head[j * m + i] : i == j;
  for (size_t j = m; j < n; j++) memcpy(B + j * n + m, A + j * n + m, (n - m) * sizeof *B);
}

static int decouple(stf_pool *pool, const stf_split *split, const stf_decoupling *out)
{
  const int n = split->n, m = split->m, f = n - m;
  const size_t head = (size_t)n * (size_t)m, size = (size_t)n * (size_t)n;
  sunrealtype *T = stf_claim_square(pool, n);
  if (!T) return STEIF_NO_MEMORY;
  diagonal(split, split->N, split->E, out->E);
  diagonal(split, NULL, split->F, out->F);
  fast_rows(split, T);
  sources_of(split, T, true, out->G);
  memcpy(out->back, split->Q, size * sizeof *T);
  stf_gemm('N', 'N', n, f, m, 1, split->Q, n, split->R, m, 1, out->back + head, n);
  for (int j = 0; j < n; j++)
    for (int i = 0; i < n; i++)
      out->to[(size_t)j * (size_t)n + (size_t)i] = split->Q[(size_t)i * (size_t)n + (size_t)j];
  stf_gemm('N', 'T', m, n, f, -1, split->R, m, split->Q + head, n, 1, out->to, n);
  return STEIF_OK;
}

int stf_split_give(stf_pool *pool, const stf_split *split, const stf_pieces *parts)
{
  if (parts->slow) STEIF_TRY(projector(pool, split, parts->slow));
  if (parts->reduction) STEIF_TRY(reduce(pool, split, parts->reduction));
  return parts->decoupling ? decouple(pool, split, parts->decoupling) : STEIF_OK;
}

/* Norms of the rows and columns of Phi = Q_inf T. */
static int largest_rows(stf_split *split, const sunrealtype *Phi, steif_structure *structure)
{
  const int n = split->n;
  sunrealtype *row = split->vector[0], *column = split->vector[1];
  memset(row, 0, (size_t)n * sizeof *row);
  for (int j = 0; j < n; j++) {
    column[j] = stf_length(n, Phi + (size_t)j * (size_t)n);
    for (int i = 0; i < n; i++) row[i] = hypot(row[i], Phi[(size_t)j * (size_t)n + (size_t)i]);
  }
  STEIF_TRY(
    stf_list_large(split->ctx, n, column, &structure->equations_count, &structure->equations));
  return stf_list_large(split->ctx, n, row, &structure->unknowns_count, &structure->unknowns);
}

int stf_split_offenders(stf_pool *pool, stf_split *split, int k, steif_structure *structure)
{
  const int n = split->n, m = split->m;
  sunrealtype *T = stf_claim_square(pool, n), *next = stf_claim_square(pool, n);
  if (!T || !next) return STEIF_NO_MEMORY;
  fast_rows(split, T);
  for (int j = 1; j < k; j++) {
    stf_gemm('N', 'N', m, n, m, 1, split->N, m, T, m, 0, next, m);
    memcpy(T, next, (size_t)m * (size_t)n * sizeof *T);
  }
  stf_gemm('N', 'N', n, n, m, 1, split->Q, n, T, m, 0, next, n);
  return largest_rows(split, next, structure);
}
