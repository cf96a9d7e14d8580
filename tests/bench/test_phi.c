/* test_phi.c: what is timed is what was asked for.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"
#include <math.h>
#include "phi_cost.h"
#include <steif/phi.h>
#include <string.h>

/* det e^A = e^{tr A}: the triangular matrix of row 3 shows it on the diagonal. */
static void exponentials(void)
{
  enum { N = 16, SIZE = STEIF_BENCH_EXPM * STEIF_BENCH_EXPM };
  static double A[SIZE], X[SIZE];
  double trace = 0, log_det = 0;
  steif_context *ctx = steif_context_new(NULL);
  steif_bench_expm row;
  CHECK(steif_bench_exponential(ctx, 3, &row, A, X) == STEIF_OK);
  CHECK(row.n == N && row.norm == 20 && !strcmp(row.matrix, "triangular"));
  CHECK(row.cpu_s > 0);
  for (int i = 0; i < N; i++) trace += A[i * (N + 1)], log_det += log(X[i * (N + 1)]);
  CLOSE_FLOOR(log_det, trace, 1e-14, 20);
  CHECK(steif_bench_exponential(ctx, 15, &row, A, X) == STEIF_BAD_INPUT);
  CHECK(steif_status(ctx) == STEIF_OK);
  steif_context_free(&ctx);
}

/* One action of a tolerance that reaches the digits; without time no solver does. */
static void actions(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_bench_phi row;
  CHECK(steif_bench_functions(ctx, 0, 1e-6, &row) == STEIF_OK);
  CHECK(!strcmp(row.problem, "heat:n=1000") && !strcmp(row.method, "action"));
  CHECK(row.n == 1000 && row.digits == 4 && row.cpu_s > 0);
  CHECK(steif_bench_functions(ctx, 8, 1e-6, &row) == STEIF_OK);
  CHECK(!strcmp(row.problem, "bruss2d:n=32") && row.digits == 10);
  CHECK(isnan(row.cpu_s) && isnan(row.radau_s) && isnan(row.cvode_s));
  CHECK(steif_bench_functions(ctx, 9, 1e-6, &row) == STEIF_BAD_INPUT);
  CHECK(steif_status(ctx) == STEIF_OK);
  steif_context_free(&ctx);
}

/* Twelve applications, one factorisation at most. */
static void squares(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_bench_square row[STEIF_BENCH_SQUARE];
  long factors = 0;
  CHECK(!steif_bench_squares(ctx, 0, row));
  for (int k = 0; k < STEIF_BENCH_SQUARE; k++) {
    CHECK(row[k].n == 1024 && row[k].error > 0 && row[k].error < 1e-10);
    factors += row[k].factors;
  }
  CHECK(factors == 1);
  CHECK(steif_bench_squares(ctx, 2, row) == STEIF_BAD_INPUT && !steif_status(ctx));
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_phi[] = {{"exponentials of dense matrices", exponentials},
                              {"actions against implicit methods", actions},
                              {"phi functions of a square Laplacian", squares},
                              CU_TEST_INFO_NULL};
