/* prepare.c: memory, checks and preparation that the dense functions share.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "matfun.h"
#include <string.h>

enum { LINE = 64, MATRICES = 7 };

static size_t padded(size_t bytes) { return (bytes + LINE - 1) / LINE * LINE; }

static size_t matrices(int p) { return p > MATRICES ? (size_t)p : MATRICES; }

size_t stf_core_bytes(int n, int p)
{
  const size_t N = (size_t)n;
  return padded(matrices(p) * N * N * sizeof(double)) + padded(3 * N * sizeof(double)) +
         2 * padded(N * sizeof(int)) + padded(2 * N * sizeof(stf_corner));
}

static void *part(char **at, size_t bytes)
{
  void *here = *at;
  *at += padded(bytes);
  return here;
}

void stf_core_open(stf_core *c, steif_context *ctx, int n, int p, void *memory)
{
  const size_t N = (size_t)n;
  char *at = memory;
  double *A = part(&at, matrices(p) * N * N * sizeof(double));
  double *vectors = part(&at, 3 * N * sizeof(double));
  *c = (stf_core){.ctx = ctx, .n = n, .p = p, .A = A, .sums = vectors};
  c->A2 = A + N * N, c->A4 = c->A2 + N * N, c->A6 = c->A4 + N * N;
  c->U = c->A6 + N * N, c->V = c->U + N * N, c->W = c->A8 = c->V + N * N;
  c->pivot = part(&at, N * sizeof(int));
  c->balance = (stf_scaling){.n = n, .d = vectors + 2 * N};
  c->balance.perm = part(&at, N * sizeof(int));
  c->corner = part(&at, 2 * N * sizeof(stf_corner));
}

int stf_check_matrix(steif_context *ctx, const char *name, int rows, int columns,
                     const double *A)
{
  STEIF_CHECK(rows >= 0, ctx, STEIF_BAD_INPUT, "n = %d: a size is at least 0", rows);
  if (rows == 0 || columns == 0) return STEIF_OK;
  STEIF_CHECK(A, ctx, STEIF_BAD_INPUT, "%s is NULL: a %d x %d array is needed", name, rows,
              columns);
  const size_t count = (size_t)rows * (size_t)columns;
  if (stf_all_finite(A, count)) return STEIF_OK;
  size_t k = 0;
  while (isfinite(A[k])) k++;
  return STEIF_FAIL(ctx, STEIF_NOT_FINITE, "%s(%zu, %zu) = %g: all entries must be finite",
                    name, k % (size_t)rows + 1, k / (size_t)rows + 1, A[k]);
}

int stf_check_result(steif_context *ctx, const char *name, size_t count, const double *X,
                     double norm)
{
  STEIF_CHECK(stf_all_finite(X, count), ctx, STEIF_NOT_FINITE,
              "%s exceeds the range of double precision (||A||_1 = %.3g): shorten the step, or "
              "subtract a multiple of the identity and keep its exponential apart",
              name, norm);
  return STEIF_OK;
}

/* Subtract mu = tr(A)/n where that brings the norm down by a quarter; e^mu is multiplied in
 * before the squarings, where it cannot overflow or underflow alone. */
static void shift(stf_core *c)
{
  const int n = c->n;
  double trace = 0, most = 0;
  for (int i = 0; i < n; i++) trace += c->A[(size_t)i * (size_t)(n + 1)] / n;
  for (int j = 0; j < n; j++) {
    const double a = c->A[(size_t)j * (size_t)(n + 1)];
    most = fmax(most, c->sums[j] + (fabs(a - trace) - fabs(a)));
  }
  if (!(most <= 0.75 * c->norm)) return;
  c->mu = trace;
  for (int i = 0; i < n; i++) c->A[(size_t)i * (size_t)(n + 1)] -= trace;
  c->norm = most;
}

/* Sums of moduli of the columns, and ||A||_1. */
static void measure(stf_core *c)
{
  const size_t n = (size_t)c->n;
  c->norm = 0;
  for (size_t j = 0; j < n; j++) {
    double even = 0, odd = 0;
    size_t i = 0;
    for (const double *a = c->A + n * j; i + 2 <= n; i += 2)
      even += fabs(a[i]), odd += fabs(a[i + 1]);
    if (i < n) even += fabs(c->A[n * j + i]);
    c->sums[j] = even + odd;
    if (c->sums[j] > c->norm) c->norm = c->sums[j];
  }
}

void stf_core_prepare(stf_core *c, const double *A)
{
  memcpy(c->A, A, (size_t)c->n * (size_t)c->n * sizeof *A);
  stf_balance_open(&c->balance, c->A);
  stf_corners_find(c);
  measure(c);
  c->mu = 0;
  if (c->p == 0) shift(c);
  stf_core_choose(c);
  stf_corners_open(c, c->s);
}
