/* lyapunov_equation.c: P = X^{-T} Q X^{-1} solves A^T P + P A = 0 where the blocks of Q solve
 * T_j^T Q_jk + Q_jk T_k = 0: not 0 for clusters of opposite means only.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "hamiltonian_thresholds.h"
#include "lyapunov_equation.h"
#include "lapack.h"
#include <math.h>
#include <string.h>

/* P = Re op(Y) Q Y; work: n x n. */
static void carry(const stf_spectrum *s, const char *op, const stf_number *Q, stf_number *work,
                  double *P)
{
  const int n = s->n;
  const size_t square = (size_t)n * (size_t)n;
  stf_number *product = work + square;
  stf_times(n, "N", Q, "N", s->Y, work);
  stf_times(n, op, s->Y, "N", work, product);
  for (size_t i = 0; i < square; i++) P[i] = creal(product[i]);
}

/* Rounding aside P = sign P^T. */
static void mend(int n, int sign, double *P)
{
  for (int j = 0; j < n; j++)
    for (int i = 0; i <= j; i++) {
      const double half = (P[i + n * j] + sign * P[j + n * i]) / 2;
      P[i + n * j] = half;
      P[j + n * i] = sign * half;
    }
}

int stf_canonical_solution(const stf_spectrum *s, double *P)
{
  const int n = s->n;
  const size_t square = (size_t)n * (size_t)n;
  stf_number *Q = stf_allocate(s->ctx, 3 * square, sizeof *Q);
  if (!Q) return STEIF_NO_MEMORY;
  for (int k = 0; k < s->count; k++) {
    const int first = s->cluster[k].first, end = first + s->cluster[k].size;
    for (int a = first; a < end; a++)
      for (int b = first; b < end; b++)
        for (int i = 0; i < n; i++) Q[a + n * b] += conj(s->X[i + n * a]) * s->X[i + n * b];
  }
  carry(s, "C", Q, Q + square, P);
  mend(n, 1, P);
  stf_release(s->ctx, Q);
  return STEIF_OK;
}

/* -- random solutions ---------------------------------------------------------------------------- */

static stf_number draw(unsigned *seed)
{
  double part[2];
  for (int i = 0; i < 2; i++) {
    *seed = *seed * 1664525u + 1013904223u;
    part[i] = (double)(*seed >> 8) / 8388608.0 - 1;
  }
  return part[0] + part[1] * I;
}

/* Solutions of N_j^T Q + Q N_k = 0 as null vectors of 1 (x) N_j^T + N_k^T (x) 1. */
static int pair(const stf_spectrum *s, int j, int k, int count, unsigned *seed, stf_number *Q)
{
  const int a = s->cluster[j].size, b = s->cluster[k].size, m = a * b;
  stf_number *L = stf_allocate(s->ctx, (size_t)(m * (m + count) + a * a + b * b), sizeof *L);
  if (!L) return STEIF_NO_MEMORY;
  stf_number *V = L + m * m, *Nj = V + m * count, *Nk = Nj + a * a;
  stf_spectrum_block(s, j, Nj);
  stf_spectrum_block(s, k, Nk);
  for (int c = 0; c < b; c++)
    for (int r = 0; r < a; r++) {
      const int row = r + a * c;
      for (int p = 0; p < a; p++) L[row + m * (p + a * c)] += Nj[p + a * r];
      for (int p = 0; p < b; p++) L[row + m * (r + a * p)] += Nk[p + b * c];
    }
  const int code = stf_null_vectors(s->ctx, m, L, count, V);
  for (int v = 0; code == STEIF_OK && v < count; v++) {
    const stf_number weight = draw(seed);
    for (int i = 0; i < m; i++) Q[i] += weight * V[i + m * v];
  }
  stf_release(s->ctx, L);
  return code;
}

/* Q_jk, a x b; semisimple clusters take any. */
static int block(const stf_spectrum *s, const stf_partner *p, int j, int k, unsigned *seed,
                 stf_number *Q, bool *found)
{
  const int a = s->cluster[j].size, b = s->cluster[k].size;
  int count = 0;
  for (int i = 0; i < a && i < b; i++) count += p[j].weyr[i] * p[k].weyr[i];
  if (count == a * b) {
    for (int i = 0; i < count; i++) Q[i] = draw(seed);
    return STEIF_OK;
  }
  *found = a <= STF_JORDAN_LARGEST && b <= STF_JORDAN_LARGEST;
  return *found ? pair(s, j, k, count, seed, Q) : STEIF_OK;
}

int stf_random_solution(const stf_spectrum *s, const stf_partner *p, int sign, unsigned *seed,
                        double *P, bool *found)
{
  const int n = s->n;
  const size_t square = (size_t)n * (size_t)n;
  stf_number *Q = stf_allocate(s->ctx, 4 * square, sizeof *Q);
  if (!Q) return STEIF_NO_MEMORY;
  stf_number *B = Q + 3 * square;
  int code = STEIF_OK;
  *found = true;
  for (int j = 0; code == STEIF_OK && *found && j < s->count; j++) {
    const int k = p[j].other;
    if (p[j].matched != 1 || k < j) continue;
    const int a = s->cluster[j].size, b = s->cluster[k].size, row = s->cluster[j].first,
              column = s->cluster[k].first;
    memset(B, 0, (size_t)(a * b) * sizeof *B);
    code = block(s, p, j, k, seed, B, found);
    for (int c = 0; c < b; c++)
      for (int r = 0; r < a; r++) {
        Q[row + r + n * (column + c)] += B[r + a * c];
        Q[column + c + n * (row + r)] += sign * B[r + a * c];
      }
  }
  carry(s, "T", Q, Q + square, P);
  mend(n, sign, P);
  stf_release(s->ctx, Q);
  return code;
}

/* -- how good it is ------------------------------------------------------------------------------ */

static double norm(int n, const double *A)
{
  double size = 0;
  for (int i = 0; i < n * n; i++) size = hypot(size, A[i]);
  return size;
}

static int condition(steif_context *ctx, int n, double *copy, double *work, steif_form_found *f)
{
  const int room = 8 * n;
  double none;
  int info = 0;
  dgesvd_("N", "N", &n, &n, copy, &n, work, &none, &n, &none, &n, work + n, &room, &info, 1, 1);
  STEIF_CHECK(info == 0, ctx, STEIF_NO_CONVERGENCE,
              "singular values of P were not found (dgesvd: %d); rescale A", info);
  f->condition = work[0] / work[n - 1];
  return STEIF_OK;
}

/* M = A^T P + P A; work: 2 n^2 + 9 n. */
static int check(steif_context *ctx, int n, const double *A, bool singular, double *M,
                 double *work, steif_form_found *f)
{
  const double one = 1, zero = 0, size = norm(n, A);
  const size_t bytes = (size_t)n * (size_t)n * sizeof *M;
  dgemm_("T", "N", &n, &n, &n, &one, A, &n, f->P, &n, &zero, M, &n, 1, 1);
  dgemm_("N", "N", &n, &n, &n, &one, f->P, &n, A, &n, &one, M, &n, 1, 1);
  f->residual = size > 0 ? norm(n, M) / (2 * size * norm(n, f->P)) : 0;
  f->condition = INFINITY;
  f->distance = NAN;
  if (singular) return STEIF_OK;
  memcpy(work, f->P, bytes);
  STEIF_TRY(condition(ctx, n, work, work + n * n, f));
  memcpy(work, f->P, bytes);
  int info = 0, *pivot = (int *)(work + n * n);
  dgetrf_(&n, &n, work, &n, pivot, &info);
  if (info) return STEIF_OK;
  dgetrs_("N", &n, &n, work, &n, pivot, M, &n, &info, 1);
  f->distance = size > 0 ? norm(n, M) / (2 * size) : 0;
  return STEIF_OK;
}

int stf_solution_check(steif_context *ctx, int n, const double *A, bool singular,
                       steif_form_found *f)
{
  const size_t square = (size_t)n * (size_t)n;
  double *M = stf_allocate(ctx, 2 * square + 9 * (size_t)n, sizeof *M);
  if (!M) return STEIF_NO_MEMORY;
  const int code = check(ctx, n, A, singular, M, M + square, f);
  stf_release(ctx, M);
  return code;
}
