/* test_irks.c: inherent Runge-Kutta stability: what defines it, and the stability function it
 * gives.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "general.h"
#include "suite.h"
#include <complex.h>
#include <string.h>

static steif_table *make(steif_context *ctx, int p)
{
  char spec[16];
  snprintf(spec, sizeof spec, "irks:p=%d", p);
  steif_table *t = steif_table_new(ctx, spec);
  CU_ASSERT_FATAL(t != NULL && t->general != NULL);
  return t;
}

/* X of the methods irks: the doubly companion matrix with all eigenvalues lambda, from the
 * betas. */
static void doubly_companion(int p, double lambda, const double *beta, double *X)
{
  const int n = p + 1;
  double alpha[6], binomial = 1;
  memset(X, 0, (size_t)(n * n) * sizeof *X);
  for (int i = 0; i <= n; i++) { /* (1 - lambda w)^n / beta(w) */
    alpha[i] = binomial;
    for (int j = 1; j <= i && j < p; j++) alpha[i] -= beta[j - 1] * alpha[i - j];
    binomial *= -lambda * (n - i) / (i + 1);
  }
  for (int j = 0; j < n; j++) X[j] = -alpha[j + 1];
  for (int i = 1; i < n; i++) X[i * n + i - 1] = 1;
  for (int i = 2; i < n; i++) X[i * n + n - 1] -= beta[n - i - 1];
}

static void times(int n, const double *A, const double *B, double *AB)
{
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      AB[i * n + j] = 0;
      for (int m = 0; m < n; m++) AB[i * n + j] += A[i * n + m] * B[m * n + j];
    }
}

static const struct {
  double lambda, beta[3];
} inherent[] = {
  {0.5, {0}}, {0.25, {0.425}}, {0.25, {0.474, 0.0707}}, {0.25, {0.594, 0.1378, 0.00817}}};

/* B A = X B, and B U = X V - V X but for the first row. */
static void stability_is_inherent(void)
{
  steif_context *ctx = steif_context_new(NULL);
  for (int p = 1; p <= 4; p++) {
    const int n = p + 1;
    double X[25], Y[25], Z[25], S[25];
    steif_table *t = make(ctx, p);
    const steif_glm *g = t->general;
    doubly_companion(p, inherent[p - 1].lambda, inherent[p - 1].beta, X);
    times(n, g->D, g->C, Y), times(n, X, g->D, Z);
    for (int i = 0; i < n * n; i++) CLOSE_FLOOR(Y[i], Z[i], 2e-14, 10);
    times(n, g->D, g->U, Y), times(n, X, g->V, Z), times(n, g->V, X, S);
    for (int i = n; i < n * n; i++) CLOSE_FLOOR(Y[i], Z[i] - S[i], 2e-14, 10);
    steif_table_free(ctx, &t);
  }
  steif_context_free(&ctx);
}

/* The trace of M(z) is R(z), the only eigenvalue besides 0. */
static void inherent_methods_have_one_root(void)
{
  static const double z[][2] = {{-1.7, 0.4}, {0.3, -2.9}, {-40, 3}, {-1e6, 0}};
  steif_context *ctx = steif_context_new(NULL);
  for (int p = 1; p <= 4; p++) {
    double M[50];
    steif_table *t = make(ctx, p);
    CHECK(t->general->order == p && t->general->stage_order == p);
    for (int m = 0; m < 4; m++) {
      const double complex w = z[m][0] + I * z[m][1];
      double complex N = 0, power = 1, trace = 0;
      double a[6] = {1}, e = 1;
      for (int i = 1; i <= p + 1; i++)
        a[i] = -a[i - 1] * inherent[p - 1].lambda * (p + 2 - i) / i;
      for (int j = 0; j <= p; j++, power *= w) {
        double sum = 0;
        e = 1;
        for (int i = j; i >= 0; i--, e /= j - i) sum += a[i] * e; /* a_i / (j - i)! */
        N += sum * power;
      }
      CHECK(steif_glm_propagator(ctx, t->general, z[m], M) == STEIF_OK);
      for (int i = 0; i <= p; i++) trace += M[2 * i * (p + 2)] + I * M[2 * i * (p + 2) + 1];
      const double complex R = N / cpow(1 - inherent[p - 1].lambda * w, p + 1);
      CLOSE_FLOOR(cabs(trace - R), 0, 1e-12, 1);
    }
    steif_table_free(ctx, &t);
  }
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_irks[] = {
  {"inherent Runge-Kutta stability", stability_is_inherent},
  {"inherent methods have one root", inherent_methods_have_one_root},
  CU_TEST_INFO_NULL};
