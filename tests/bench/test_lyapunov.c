/* test_lyapunov.c: the benchmarks of Lyapunov exponents.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"
#include "attractor.h"
#include "kernels.h"

/* (.9056, 0, -14.5723): J. C. Sprott, Chaos and Time-Series Analysis (2003), table A.5. */
static void a_long_run_has_the_exponents_of_lorenz(void)
{
  static const double expected[] = {0.9056, 0, -14.5723};
  steif_context *ctx = steif_context_new(NULL);
  steif_bench_attractor row;
  CHECK(steif_bench_lorenz(ctx, 0, &row) == STEIF_OK);
  CHECK(row.time == 2e4 && row.cpu_s > 0);
  for (int i = 0; i < 3; i++) CHECK(fabs(row.exponent[i] - expected[i]) < 0.005);
  for (int i = 0; i < 3; i++) CHECK(row.error[i] > 0 && row.error[i] < 0.005);
  CHECK(row.defect < 1.2e-4);
  CLOSE(row.exponent[0] + row.exponent[1] + row.exponent[2], row.sum, 1e-5);
  CHECK(steif_bench_lorenz(ctx, 2, &row) == STEIF_BAD_INPUT);
  steif_context_free(&ctx);
}

static void a_step_with_exponents_is_measured(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_bench_row row;
  CHECK(steif_bench_lyapunov(ctx, 0, &row) == STEIF_OK);
  CHECK(row.n == 2 && row.step_s >= 0 && row.floor_s >= 0);
  CHECK(steif_bench_lyapunov(ctx, 1000, &row) == STEIF_BAD_INPUT);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_lyapunov[] = {
  {"a long run has the exponents of Lorenz' equations", a_long_run_has_the_exponents_of_lorenz},
  {"a step with exponents is measured", a_step_with_exponents_is_measured},
  CU_TEST_INFO_NULL};
