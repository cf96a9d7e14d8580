/* test_frechet.c: derivative and condition number of the exponential.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "gear.h"
#include "reference.h"
#include "suite.h"
#include <string.h>

static steif_context *ctx;

/* L(A, E) for E = all ones, by rows; mpmath, 17 digits. */
static void values(void)
{
  static const struct {
    const char *id;
    double L[9];
  } rows[] = {
    {"T03",
     {0.61313240195240387, 0.87371367278217551, 0.95342088503598802, 0.55181916175716348,
      0.79707212253812503, 0.87371367278217551, 0.36787944117144232, 0.55181916175716348,
      0.61313240195240387}},
    {"T06",
     {0.81623297713586155, -0.63229302885356586, 1.7704204393906072, -1.3680519939952049}},
    {"T02",
     {-0.26885103370346195, 0.2016871996420571, -0.57580955158200359, -0.34660070882586801}}};
  ctx = steif_context_new(NULL);
  for (int r = 0; r < 3; r++) {
    const reference *T = reference_find(rows[r].id);
    double A[9], E[9] = {1, 1, 1, 1, 1, 1, 1, 1, 1}, X[9], L[9];
    reference_turn(T->n, T->A, A);
    CHECK(!steif_expm_frechet(ctx, T->n, A, E, X, L));
    const double tolerance = fmax(10, 10 * T->condition) * U;
    CHECK(reference_error(T->n, L, rows[r].L) <= tolerance);
    CHECK(reference_error(T->n, X, T->f[0]) <= tolerance);
  }
  steif_context_free(&ctx);
}

/* e^{[A E; 0 A]} = [e^A L; 0 e^A], at norms from 0.05 to 50. */
static void block_form(void)
{
  enum { N = 20, B = 2 * N };
  static double A[N * N], E[N * N], L[N * N], M[B * B], X[B * B], block[N * N];
  ctx = steif_context_new(NULL);
  for (double size = 5e-2; size < 60; size *= 4.7) {
    gear_fill(N, size / N, 811, A), gear_fill(N, 7.3, 1213, E);
    memset(M, 0, sizeof M);
    for (int j = 0; j < N; j++)
      for (int i = 0; i < N; i++) {
        M[i + B * j] = M[i + N + B * (j + N)] = A[i + N * j];
        M[i + B * (j + N)] = E[i + N * j];
      }
    CHECK(!steif_expm(ctx, B, M, X));
    CHECK(!steif_expm_frechet(ctx, N, A, E, NULL, L));
    for (int j = 0; j < N; j++) memcpy(block + N * j, X + B * (j + N), N * sizeof *X);
    CHECK(gear_distance(N, L, block) <= 1e3 * (1 + size) * U);
  }
  steif_context_free(&ctx);
}

/* Relative, Frobenius norm; the two digits of the reference, or three. */
static void condition_numbers(void)
{
  ctx = steif_context_new(NULL);
  for (const reference *r = references; r < references + reference_count; r++) {
    double A[16], cond;
    reference_turn(r->n, r->A, A);
    CHECK(!steif_expm_condition(ctx, r->n, A, &cond));
    if (r->condition > 0) CLOSE(cond, r->condition, strncmp(r->name, "T19", 3) ? 5e-3 : 2e-2);
  }
  steif_context_free(&ctx);
}

/* The relative change of e^A under a small change of A stays below the condition number, and
 * comes near it in the worst direction of a symmetric matrix, which is that of its largest
 * eigenvalue. */
static void condition_bounds_changes(void)
{
  enum { N = 6 };
  double A[N * N], X[N * N], Y[N * N], E[N * N], cond, norm = 0, change = 0, size = 0;
  ctx = steif_context_new(NULL);
  gear_fill(N, 1.9, 5077, A), gear_fill(N, 1e-7, 31, E);
  CHECK(!steif_expm_condition(ctx, N, A, &cond));
  CHECK(!steif_expm(ctx, N, A, X));
  double step = 0;
  for (int k = 0; k < N * N; k++) norm += A[k] * A[k], step += E[k] * E[k], A[k] += E[k];
  CHECK(!steif_expm(ctx, N, A, Y));
  for (int k = 0; k < N * N; k++) change += (Y[k] - X[k]) * (Y[k] - X[k]), size += X[k] * X[k];
  const double ratio = sqrt(change / size) / sqrt(step / norm);
  CHECK(ratio <= cond * 1.0001);
  CHECK(ratio >= cond / 50);
  CHECK(!steif_expm_condition(ctx, 2, (double[]){-0.7, 0, 0, -0.7}, &cond));
  CLOSE(cond, 0.7, 1e-6); /* e^{mu I}: ||L|| = e^mu, ||A||/||e^A|| = |mu|/e^mu */
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_frechet[] = {
  {"derivatives meet their references", values},
  {"the derivative is the corner of the block exponential", block_form},
  {"condition numbers meet their references", condition_numbers},
  {"the condition number bounds the effect of a change", condition_bounds_changes},
  CU_TEST_INFO_NULL};
