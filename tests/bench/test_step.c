/* test_step.c: steps against their kernels.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"
#include "kernels.h"
#include <string.h>

/* The first rows are of a problem of 3 to 30 unknowns at two tolerances. Kernels take most of the time
 * there, whatever else the machine does. */
static void costs_are_accounted_for(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_bench_row row, next;
  CHECK(steif_bench_cost_accounting(ctx, 0, &row) == STEIF_OK);
  CHECK(steif_bench_cost_accounting(ctx, 1, &next) == STEIF_OK);
  CHECK(row.n >= 3 && row.n <= 30 && row.floor_s > 0 && row.ratio < 3);
  CHECK(!strcmp(row.problem, next.problem) && strcmp(row.kind, next.kind));
  CHECK(steif_bench_cost_accounting(ctx, 1000, &row) == STEIF_BAD_INPUT);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_step[] = {
  {"whole runs of auto less their kernels", costs_are_accounted_for}, CU_TEST_INFO_NULL};
