/* frechet.c: the derivative of the exponential and its condition number.
 *
 * The [13/13] approximant and all squarings are differentiated with the parts that depend on A
 * only kept: d(A^2) = A E + E A, and so on (A. H. Al-Mohy and N. J. Higham, SIAM J. Matrix
 * Anal. Appl. 30, 2009, algorithm 6.4). The adjoint of E -> L(A, E) is L(A^T, E) = L(A, E^T)^T.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "matfun.h"
#include "lapack.h"
#include "lu.h"
#include <string.h>

enum { M = 13 };

typedef struct derivative {
  stf_core c;
  stf_pool *pool;
  double k[M + 1];
  double *W1, *Z1;          /* inner sums of the odd and the even part */
  double *E, *M2, *M4, *M6; /* direction, derivatives of the powers */
  double *LW, *LZ, *T;      /* derivatives of the parts; scratch */
  double *X;                /* s + 1 matrices, from the scaled exponential to e^A */
  double factor;            /* e^{mu/2^s} */
} derivative;

static size_t size_of(const derivative *d) { return (size_t)d->c.n * (size_t)d->c.n; }

/* out = a M2 + b M4 + c M6 */
static void three(size_t count, const double *k, const double *M2, const double *M4,
                  const double *M6, double *out)
{
  for (size_t i = 0; i < count; i++) out[i] = k[0] * M2[i] + k[2] * M4[i] + k[4] * M6[i];
}

static int claim(derivative *d, int n)
{
  void *core = stf_pool_array(d->pool, stf_core_bytes(n, 0), 1);
  double **matrix[] = {&d->W1, &d->Z1, &d->E, &d->M2, &d->M4, &d->M6, &d->LW, &d->LZ, &d->T};
  enum { COUNT = sizeof matrix / sizeof *matrix };
  const size_t count = (size_t)n * (size_t)n;
  double *all = core ? stf_pool_array(d->pool, COUNT * count, sizeof *all) : NULL;
  if (!all) return STEIF_NO_MEMORY;
  for (int i = 0; i < COUNT; i++) *matrix[i] = all + count * (size_t)i;
  stf_core_open(&d->c, d->c.ctx, n, 0, core);
  return STEIF_OK;
}

static int squarings(derivative *d)
{
  stf_core *c = &d->c;
  const size_t count = size_of(d);
  d->X = stf_pool_array(d->pool, count * (size_t)(c->s + 1), sizeof *d->X);
  if (!d->X) return STEIF_NO_MEMORY;
  memcpy(d->X, c->U, count * sizeof *c->U);
  stf_corners_fix(c, 0, d->X);
  for (int k = 0; k < c->s; k++) {
    double *now = d->X + count * (size_t)k;
    stf_multiply(c->n, c->n, now, now, 0, now + count);
    stf_corners_double(c);
    stf_corners_fix(c, 0, now + count);
  }
  return STEIF_OK;
}

/* All that depends on A alone. Afterwards c.V holds the factors of the denominator, c.W the odd
 * part. */
static int open(derivative *d, steif_context *ctx, int n, const double *A)
{
  d->c.ctx = ctx;
  d->pool = stf_pool_new(ctx);
  if (!d->pool) return STEIF_NO_MEMORY;
  STEIF_TRY(claim(d, n));
  stf_core *c = &d->c;
  stf_core_prepare(c, A);
  if (c->m < 5) stf_multiply(n, n, c->A2, c->A2, 0, c->A4);
  if (c->m < 7) stf_multiply(n, n, c->A2, c->A4, 0, c->A6);
  c->m = M;
  STEIF_TRY(stf_pade_expm(c));
  stf_pade_coefficients(M, 0, NULL, d->k);
  for (int i = 1; i <= M; i += 2) d->k[i] = -d->k[i];
  three(size_of(d), d->k + 9, c->A2, c->A4, c->A6, d->W1);
  three(size_of(d), d->k + 8, c->A2, c->A4, c->A6, d->Z1);
  d->factor = exp(ldexp(c->mu, -c->s));
  return squarings(d);
}

/* out = A F + G B, or out + A F + G B */
static void pair(const derivative *d, const double *A, const double *F, const double *G,
                 const double *B, double beta, double *out)
{
  const int n = d->c.n;
  stf_multiply(n, n, A, F, beta, out);
  stf_multiply(n, n, G, B, 1, out);
}

/* Derivative of the even or odd part: A6 (inner sum)' + A6' (inner sum) + (outer sum)'. */
static void part(const derivative *d, int odd, const double *inner, double *out)
{
  three(size_of(d), d->k + 8 + odd, d->M2, d->M4, d->M6, d->T);
  three(size_of(d), d->k + 2 + odd, d->M2, d->M4, d->M6, out);
  pair(d, d->c.A6, d->T, d->M6, inner, 1, out);
}

/* d->T = derivative of the scaled approximant X = (V - U)^{-1} (V + U) in the direction d->E.
 */
static int approximant(derivative *d)
{
  stf_core *c = &d->c;
  const int n = c->n;
  pair(d, c->A, d->E, d->E, c->A, 0, d->M2);
  pair(d, c->A2, d->M2, d->M2, c->A2, 0, d->M4);
  pair(d, c->A2, d->M4, d->M2, c->A4, 0, d->M6);
  part(d, 1, d->W1, d->LW);
  part(d, 0, d->Z1, d->LZ);
  double *LU = d->M2, *minus = d->M4;
  pair(d, c->A, d->LW, d->E, c->W, 0, LU);
  for (size_t i = 0; i < size_of(d); i++) {
    d->T[i] = d->factor * (LU[i] + d->LZ[i]);
    minus[i] = LU[i] - d->LZ[i];
  }
  stf_multiply(n, n, minus, d->X, 1, d->T);
  stf_dense_solve('N', n, n, c->V, c->pivot, d->T);
  return STEIF_OK;
}

/* L = L(A, E). */
static int apply(derivative *d, const double *E, double *L)
{
  stf_core *c = &d->c;
  const size_t count = size_of(d);
  const double scale = ldexp(1, -c->s);
  stf_balance_redo(&c->balance, E, d->E);
  for (size_t i = 0; i < count; i++) d->E[i] *= scale;
  STEIF_TRY(approximant(d));
  double *now = d->T, *next = d->LW;
  for (int k = 0; k < c->s; k++) {
    const double *X = d->X + count * (size_t)k;
    pair(d, X, now, now, X, 0, next);
    double *const t = now;
    now = next, next = t;
  }
  stf_balance_undo(&c->balance, now, L);
  return STEIF_OK;
}

static void exponential(const derivative *d, double *X)
{
  stf_balance_undo(&d->c.balance, d->X + size_of(d) * (size_t)d->c.s, X);
}

int steif_expm_frechet(steif_context *ctx, int n, const double *A, const double *E, double *X,
                       double *L)
{
  if (!ctx) return STEIF_BAD_INPUT;
  STEIF_TRY(stf_check_matrix(ctx, "A", n, n, A));
  STEIF_TRY(stf_check_matrix(ctx, "E", n, n, E));
  STEIF_CHECK(L || n == 0, ctx, STEIF_BAD_INPUT, "there is no array for the derivative");
  if (n == 0) return STEIF_OK;
  derivative d = {.pool = NULL};
  const size_t count = (size_t)n * (size_t)n;
  int code = open(&d, ctx, n, A);
  if (!code) code = apply(&d, E, L);
  if (!code && X) exponential(&d, X);
  if (!code && X) code = stf_check_result(ctx, "exp(A)", count, X, stf_norm1(n, A));
  if (!code) code = stf_check_result(ctx, "the derivative", count, L, stf_norm1(n, A));
  stf_pool_free(&d.pool);
  return code;
}

static double frobenius(size_t count, const double *A)
{
  double most = 0, sum = 0;
  for (size_t i = 0; i < count; i++) most = fmax(most, fabs(A[i]));
  for (size_t i = 0; i < count && most > 0; i++) sum += (A[i] / most) * (A[i] / most);
  return most * sqrt(sum);
}

static void transpose(size_t n, double c, const double *A, double *B)
{
  for (size_t j = 0; j < n; j++)
    for (size_t i = 0; i < n; i++) B[j + n * i] = c * A[i + n * j];
}

/* The largest singular value of E -> L(A, E), from a direction without zeros. */
static int largest(derivative *d, double *F, double *G, double *sigma)
{
  enum { MOST = 200 };
  const size_t n = (size_t)d->c.n, count = n * n;
  double last = 0, norm;
  for (size_t i = 0; i < count; i++) G[i] = 1 + 0.3 * sin(1.7 * (double)i);
  norm = frobenius(count, G);
  for (int k = 0; k < MOST; k++) {
    for (size_t i = 0; i < count; i++) F[i] = G[i] / norm;
    STEIF_TRY(apply(d, F, G));
    *sigma = frobenius(count, G);
    if (!(*sigma > 0) || !(fabs(*sigma - last) > 1e-5 * *sigma)) return STEIF_OK;
    last = *sigma;
    transpose(n, 1 / *sigma, G, F);
    STEIF_TRY(apply(d, F, G));
    transpose(n, 1, G, F);
    memcpy(G, F, count * sizeof *G);
    norm = frobenius(count, G);
    if (!(norm > 0)) return STEIF_OK;
  }
  return STEIF_OK;
}

static int condition(derivative *d, steif_context *ctx, int n, const double *A, double *cond)
{
  const size_t count = (size_t)n * (size_t)n;
  STEIF_TRY(open(d, ctx, n, A));
  double *F = stf_pool_array(d->pool, 2 * count, sizeof *F), sigma = 0;
  if (!F) return STEIF_NO_MEMORY;
  exponential(d, F);
  const double size = frobenius(count, F), norm = frobenius(count, A);
  STEIF_TRY(largest(d, F, F + count, &sigma));
  *cond = norm == 0 ? 0 : sigma * (norm / size);
  STEIF_CHECK(isfinite(*cond), ctx, STEIF_NOT_FINITE,
              "||exp(A)|| = %g and ||L|| = %g with ||A|| = %g: there is no relative condition",
              size, sigma, norm);
  return STEIF_OK;
}

int steif_expm_condition(steif_context *ctx, int n, const double *A, double *cond)
{
  if (!ctx) return STEIF_BAD_INPUT;
  STEIF_TRY(stf_check_matrix(ctx, "A", n, n, A));
  STEIF_CHECK(cond, ctx, STEIF_BAD_INPUT, "there is no place for the result");
  *cond = 0;
  if (n == 0) return STEIF_OK;
  derivative d = {.pool = NULL};
  const int code = condition(&d, ctx, n, A, cond);
  stf_pool_free(&d.pool);
  return code;
}
