/* test_algebra.c: LU, the triangle of Q R and right division, in loops and by LAPACK.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"
#include "variation.h"
#include <stdlib.h>
#include <string.h>

enum { MOST = 140 };
static const int orders[] = {1, 2, 3, 5, 16, 17, 33, 63, 64, 65, 90, 128, 140};
enum { ORDERS = sizeof orders / sizeof *orders };

static void fill(size_t count, unsigned seed, double *x)
{
  for (size_t i = 0; i < count; i++) {
    seed = (unsigned)(seed * 48271ull % 2147483647);
    x[i] = 2 * (double)seed / 2147483647 - 1;
  }
}

/* The largest entry of op(A) B - C, A n x k or its transpose, B k x m. */
static double miss(int n, int m, int k, int transposed, const double *A, const double *B,
                   const double *C)
{
  double most = 0;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < m; j++) {
      double sum = -C[i * m + j];
      for (int l = 0; l < k; l++)
        sum += (transposed ? A[l * n + i] : A[i * k + l]) * B[l * m + j];
      most = fmax(most, fabs(sum));
    }
  return most;
}

static void systems_are_solved(void)
{
  static double A[MOST * MOST], LU[MOST * MOST], B[MOST * MOST], X[MOST * MOST];
  steif_context *ctx = steif_context_new(NULL);
  stf_pool *pool = stf_pool_new(ctx);
  for (int k = 0; k < ORDERS; k++) {
    const int n = orders[k], m = n > 4 ? n - 3 : n;
    const size_t square = (size_t)(n * n), block = (size_t)(n * m);
    stf_algebra room;
    CU_ASSERT_FATAL(stf_algebra_open(pool, n, n, m, &room) == STEIF_OK);
    fill(square, 17, A), fill(block, 23, B);
    if (n > 1) A[0] = 0; /* rows have to be exchanged */
    memcpy(LU, A, sizeof A), memcpy(X, B, sizeof B);
    CHECK(stf_factor(n, LU, &room));
    stf_substitute(n, m, LU, X, &room);
    CHECK(miss(n, m, n, 0, A, X, B) < 1e-11);
    memset(A + square - (size_t)n, 0, (size_t)n * sizeof *A); /* the last row */
    CHECK(!stf_factor(n, A, &room));
  }
  stf_pool_free(&pool), steif_context_free(&ctx);
}

/* R^T R = W^T W, and W R^{-1} is orthonormal; `spread`: ratio of the lengths of the first column and
 * the last, which decides between squares and reflections. */
static void triangle(stf_pool *pool, int d, int m, double spread)
{
  static double W[MOST * MOST], X[MOST * MOST], spare[MOST * MOST], R[MOST * MOST],
    G[MOST * MOST];
  stf_algebra room;
  CU_ASSERT_FATAL(stf_algebra_open(pool, d, d, m, &room) == STEIF_OK);
  fill((size_t)(d * m), 31, W);
  for (int i = 0; i < d; i++)
    for (int j = 0; j < m; j++) {
      W[i * m + j] = (i == j ? 1 : 0) + W[i * m + j] / (2 * d);
      W[i * m + j] *= m > 1 ? pow(spread, -j / (m - 1.0)) : 1;
    }
  memcpy(X, W, sizeof W);
  CHECK(stf_triangle(d, m, W, spare, R, &room));
  for (int j = 0; j < m; j++) {
    CHECK(R[j * m + j] > 0);
    for (int l = 0; l < j; l++) R[j * m + l] = 0;
  }
  memset(G, 0, sizeof G);
  for (int i = 0; i < d; i++)
    for (int a = 0; a < m; a++)
      for (int b = 0; b < m; b++) G[a * m + b] += W[i * m + a] * W[i * m + b];
  CHECK(miss(m, m, m, 1, R, R, G) < 1e-14 * d);
  stf_renormalise(d, m, R, X, &room);
  memset(G, 0, sizeof G);
  for (int a = 0; a < m; a++) G[a * m + a] = 1;
  CHECK(miss(m, m, d, 1, X, X, G) < 1e-13 * d);
}

static void triangles_are_found(void)
{
  steif_context *ctx = steif_context_new(NULL);
  stf_pool *pool = stf_pool_new(ctx);
  for (int k = 0; k < ORDERS; k++) {
    const int d = orders[k];
    for (int m = 1; m <= d; m += d > 20 ? 11 : 1)
      for (int bad = 0; bad < 2; bad++) triangle(pool, d, m, bad ? 1e8 : 3);
    triangle(pool, d, d, 3), triangle(pool, d, d, 1e8);
  }
  stf_pool_free(&pool), steif_context_free(&ctx);
}

/* Squares overflow or vanish where lengths do not; a column of zeros has no direction. */
static void lengths_may_be_extreme(void)
{
  static const double size[] = {1e200, 1e-200};
  steif_context *ctx = steif_context_new(NULL);
  stf_pool *pool = stf_pool_new(ctx);
  stf_algebra room;
  CU_ASSERT_FATAL(stf_algebra_open(pool, 3, 3, 2, &room) == STEIF_OK);
  for (int i = 0; i < 2; i++) {
    const double s = size[i], W[] = {3 * s, s, 4 * s, s, 0, s};
    double spare[6], R[4];
    CHECK(stf_triangle(3, 2, W, spare, R, &room));
    CLOSE(R[0], 5 * s, 1e-14);
    CLOSE(R[1], 1.4 * s, 1e-14);
    CLOSE(R[3], sqrt(3 - 1.96) * s, 1e-14);
  }
  const double flat[] = {1, 0, 2, 0, 3, 0};
  double spare[6], R[4];
  CHECK(!stf_triangle(3, 2, flat, spare, R, &room));
  stf_pool_free(&pool), steif_context_free(&ctx);
}

CU_TestInfo tests_of_algebra[] = {{"systems are solved", systems_are_solved},
                                  {"triangles are found", triangles_are_found},
                                  {"lengths may be extreme", lengths_may_be_extreme},
                                  CU_TEST_INFO_NULL};
