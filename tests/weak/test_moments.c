/* test_moments.c: binomial moments give the impulse coefficients for any step.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "weak/data.h"

/* (N + hI) x_i = N x_{i-1} by back substitution. */
static void euler(int k, double h, const double *before, double *x)
{
  for (int m = k; m-- > 0;) x[m] = m + 1 < k ? (before[m + 1] - x[m + 1]) / h : 0;
}

static void check_moments(steif_context *ctx, int k, double h, unsigned *seed)
{
  double x0[MOST], x[MOST * MOST], c[MOST * MOST], exact[MOST * MOST];
  for (int m = 0; m < k; m++) {
    *seed = *seed * 1103515245u + 12345u;
    x0[m] = (double)(*seed >> 8) / (1 << 23) - 1;
  }
  for (int i = 0; i + 1 < k; i++) euler(k, h, i ? x + (i - 1) * k : x0, x + i * k);
  CHECK(steif_binomial_moments(ctx, k, h, x, c) == STEIF_OK);
  CHECK(steif_jordan_exact(ctx, k, NULL, NULL, x0, 0, NULL, exact) == STEIF_OK);
  for (int q = 0; q + 1 < k; q++)
    for (int m = 0; m < k; m++) {
      /* rounding is relative to the terms of the sum: h^{q+1} |x_i|, at most h^{q+2-k} */
      const double size = fmax(1, pow(h, q + 2 - k));
      CLOSE_FLOOR(c[q * k + m], exact[q * k + m], 1e-13, size);
    }
}

static void moments_are_exact(void)
{
  steif_context *ctx = steif_context_new(NULL);
  unsigned seed = 20241u;
  for (int k = 2; k <= 6; k++)
    for (int trial = 0; trial < 20; trial++) {
      seed = seed * 1103515245u + 12345u;
      check_moments(ctx, k, 0.05 + (double)(seed >> 8) / (1 << 23), &seed);
    }
  steif_context_free(&ctx);
}

static void nonsense_is_refused(void)
{
  steif_context *ctx = steif_context_new(NULL);
  double x[4] = {0}, c[4];
  CHECK(steif_binomial_moments(ctx, 1, 0.3, x, c) == STEIF_BAD_INPUT);
  CHECK(strstr(steif_message(ctx), "k = 1") != NULL);
  CHECK(steif_binomial_moments(ctx, 2, -0.3, x, c) == STEIF_BAD_INPUT);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_moments[] = {
  {"impulse coefficients are exact for random steps, k <= 6", moments_are_exact},
  {"index 1 and negative steps are refused", nonsense_is_refused},
  CU_TEST_INFO_NULL};
