/* test_step.c: steps against their kernels.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"
#include "kernels.h"
#include <string.h>

/* The first rows are of a problem of 3 to 30 unknowns at two tolerances. */
static void costs_are_accounted_for(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_bench_row row, next;
  CHECK(steif_bench_cost_accounting(ctx, 0, &row) == STEIF_OK);
  CHECK(steif_bench_cost_accounting(ctx, 1, &next) == STEIF_OK);
  CHECK(row.n >= 3 && row.n <= 30 && row.floor_s >= 0);
  CHECK(!strcmp(row.problem, next.problem) && strcmp(row.kind, next.kind));
  CHECK(steif_bench_cost_accounting(ctx, 1000, &row) == STEIF_BAD_INPUT);
  steif_context_free(&ctx);
}

/* Through steif as many steps as in a direct program, else the price is STEIF_NOT_CERTIFIED. A clock may tick too
 * slowly for a time above 0. */
static void a_baseline_does_what_a_direct_program_does(void)
{
  static const char *const problem[] = {"vdpol", "hires", "bruss2d:n=8"};
  static const char *const method[] = {"cvode", "ida"};
  steif_context *ctx = steif_context_new(NULL);
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 2; k++) {
      steif_bench_row row = {.rtol = 1e-5};
      CHECK(stf_bench_price(ctx, problem[i], method[k], &row) == STEIF_OK);
      CHECK(row.floor_s >= 0);
    }
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_step[] = {
  {"a baseline against a direct program", a_baseline_does_what_a_direct_program_does},
  {"whole runs of auto less their kernels", costs_are_accounted_for},
  CU_TEST_INFO_NULL};
