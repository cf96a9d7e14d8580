/* expm.c: the exponential and the phi functions of a dense matrix by scaling and doubling.
 *
 *   phi_l(2A) = 2^{-l} (e^A phi_l(A) + sum_{j=1}^{l} phi_j(A)/(l-j)!),   e^{2A} = (e^A)^2
 *
 * (A. H. Al-Mohy and N. J. Higham, SIAM J. Matrix Anal. Appl. 31, 2009; B. Skaflestad and
 * W. M. Wright, Appl. Numer. Math. 59, 2009).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "matfun.h"
#include "lapack.h"
#include <string.h>

int stf_core_expm(stf_core *c, const double *A, double *X)
{
  const int n = c->n;
  if (n == 0) return STEIF_OK;
  stf_core_prepare(c, A);
  STEIF_TRY(stf_pade_expm(c));
  double *now = c->U, *next = c->W;
  stf_corners_fix(c, 0, now);
  for (int k = 0; k < c->s; k++) {
    stf_multiply(n, n, now, now, 0, next);
    double *const t = now;
    now = next, next = t;
    stf_corners_double(c);
    stf_corners_fix(c, 0, now);
  }
  stf_balance_undo(&c->balance, now, X);
  return STEIF_OK;
}

/* From phi_0 .. phi_p of some matrix to those of its double; the powers of A are lost. */
static void twice(stf_core *c, double *phi)
{
  const size_t count = (size_t)c->n * (size_t)c->n;
  double *product = c->A;
  stf_multiply(c->n, c->n * c->p, phi, phi + count, 0, product);
  for (int l = c->p; l > 0; l--) {
    double *f = phi + count * (size_t)l;
    const double *e = product + count * (size_t)(l - 1);
    const double factor = ldexp(1, -l);
    for (size_t i = 0; i < count; i++) f[i] = factor * (e[i] + f[i]);
    for (int j = 1; j < l; j++) {
      const double *g = phi + count * (size_t)j, k = factor * stf_inverse_factorial(l - j).hi;
      for (size_t i = 0; i < count; i++) f[i] += k * g[i];
    }
  }
  stf_multiply(c->n, c->n, phi, phi, 0, product);
  memcpy(phi, product, count * sizeof *phi);
}

static void fix(const stf_core *c, double *phi)
{
  for (int l = 0; l <= c->p; l++)
    stf_corners_fix(c, l, phi + (size_t)c->n * (size_t)c->n * (size_t)l);
}

int stf_core_phi(stf_core *c, const double *A, double *phi)
{
  const size_t count = (size_t)c->n * (size_t)c->n;
  if (c->p == 0) return stf_core_expm(c, A, phi);
  if (c->n == 0) return STEIF_OK;
  c->A8 = phi;
  stf_core_prepare(c, A);
  STEIF_TRY(stf_pade_phi(c, phi));
  fix(c, phi);
  for (int k = 0; k < c->s; k++) {
    twice(c, phi);
    stf_corners_double(c);
    fix(c, phi);
  }
  if (!stf_balance_trivial(&c->balance))
    for (int l = 0; l <= c->p; l++) {
      memcpy(c->A, phi + count * (size_t)l, count * sizeof *phi);
      stf_balance_undo(&c->balance, c->A, phi + count * (size_t)l);
    }
  return STEIF_OK;
}

static int check_order(steif_context *ctx, int p)
{
  STEIF_CHECK(p >= 0 && p <= STEIF_PHI_MOST, ctx, STEIF_BAD_INPUT,
              "p = %d: phi functions from 0 to %d are at hand", p, STEIF_PHI_MOST);
  return STEIF_OK;
}

int steif_phi_matrix(steif_context *ctx, int n, int p, const double *A, double *phi)
{
  if (!ctx) return STEIF_BAD_INPUT;
  STEIF_TRY(check_order(ctx, p));
  STEIF_TRY(stf_check_matrix(ctx, "A", n, n, A));
  STEIF_CHECK(phi || n == 0, ctx, STEIF_BAD_INPUT, "there is no array for the result");
  void *memory = stf_allocate(ctx, stf_core_bytes(n, p), 1);
  if (!memory) return STEIF_NO_MEMORY;
  stf_core c;
  stf_core_open(&c, ctx, n, p, memory);
  int code = stf_core_phi(&c, A, phi);
  if (!code)
    code = stf_check_result(ctx, p > 0 ? "a phi function" : "exp(A)",
                            (size_t)n * (size_t)n * (size_t)(p + 1), phi, stf_norm1(n, A));
  stf_release(ctx, memory);
  return code;
}

int steif_expm(steif_context *ctx, int n, const double *A, double *X)
{
  return steif_phi_matrix(ctx, n, 0, A, X);
}

/* [A W; 0 J] of size n + p, with W = eta [b_p .. b_1] in the balanced basis and J the shift:
 * the exponential applied to (b_0, e_p/eta) holds the combination (Al-Mohy and Higham, 2011).
 * eta is a power of two so small that W does not raise the norm. */
static double augment(const stf_scaling *b, int p, const double *A, const double *W, double *M)
{
  const size_t n = (size_t)b->n, N = n + (size_t)p;
  double most = 0;
  int e = 0;
  for (int k = 1; k <= p; k++)
    for (size_t i = 0; i < n; i++) most = fmax(most, fabs(W[i + n * (size_t)k]));
  frexp(most * b->n, &e);
  const double eta = ldexp(1, most > 0 ? -e : 0);
  for (size_t j = 0; j < n; j++) memcpy(M + N * j, A + n * j, n * sizeof *M);
  for (size_t k = 0; k < (size_t)p; k++) {
    double *column = M + N * (n + k);
    for (size_t i = 0; i < n; i++) column[i] = eta * W[i + n * ((size_t)p - k)];
    if (k > 0) column[n + k - 1] = 1;
  }
  return eta;
}

/* The memory of one combination. */
typedef struct blend {
  double *A, *b, *M, *X;
  stf_scaling balance;
  void *core;
} blend;

static int claim(steif_context *ctx, stf_pool *pool, int n, int p, blend *m)
{
  const size_t N = (size_t)n, big = N + (size_t)p;
  m->A = stf_pool_array(pool, N * N + N * (size_t)(p + 1) + 2 * big * big + N, sizeof(double));
  m->balance = (stf_scaling){.n = n, .perm = stf_pool_array(pool, N, sizeof(int))};
  m->core = stf_pool_array(pool, stf_core_bytes(n + p, 0), 1);
  if (!m->A || !m->balance.perm || !m->core) return steif_status(ctx);
  m->b = m->A + N * N, m->M = m->b + N * (size_t)(p + 1);
  m->X = m->M + big * big, m->balance.d = m->X + big * big;
  return STEIF_OK;
}

static int combine(steif_context *ctx, blend *m, int p, const double *A, const double *b,
                   double *w)
{
  const int n = m->balance.n;
  const size_t N = (size_t)n, big = N + (size_t)p;
  const int *perm = m->balance.perm;
  const double *d = m->balance.d;
  memcpy(m->A, A, N * N * sizeof *A);
  stf_balance_open(&m->balance, m->A);
  for (size_t k = 0; k <= (size_t)p; k++)
    for (size_t i = 0; i < N; i++) m->b[i + N * k] = b[(size_t)perm[i] + N * k] / d[i];
  const double eta = augment(&m->balance, p, m->A, m->b, m->M);
  stf_core c;
  stf_core_open(&c, ctx, n + p, 0, m->core);
  STEIF_TRY(stf_core_expm(&c, m->M, m->X));
  for (size_t i = 0; i < N; i++) {
    double sum = p > 0 ? m->X[i + big * (big - 1)] / eta : 0;
    for (size_t j = 0; j < N; j++) sum += m->X[i + big * j] * m->b[j];
    w[perm[i]] = sum * d[i];
  }
  return stf_check_result(ctx, "the combination", N, w, stf_norm1(n, A));
}

int steif_phi_combine(steif_context *ctx, int n, int p, const double *A, const double *b,
                      double *w)
{
  if (!ctx) return STEIF_BAD_INPUT;
  STEIF_TRY(check_order(ctx, p));
  STEIF_TRY(stf_check_matrix(ctx, "A", n, n, A));
  STEIF_TRY(stf_check_matrix(ctx, "b", n, p + 1, b));
  STEIF_CHECK(w || n == 0, ctx, STEIF_BAD_INPUT, "there is no array for the result");
  if (n == 0) return STEIF_OK;
  stf_pool *pool = stf_pool_new(ctx);
  if (!pool) return STEIF_NO_MEMORY;
  blend m;
  int code = claim(ctx, pool, n, p, &m);
  if (!code) code = combine(ctx, &m, p, A, b, w);
  stf_pool_free(&pool);
  return code;
}
