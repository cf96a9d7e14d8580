/* test_duality.c: stage quadrature equals the adjoint method run backwards, to rounding.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "adjoint.h"
#include "weak/data.h"

static void identity_holds(const char *method, const char *name, int k)
{
  enum { n = 20 };
  static const sunrealtype w[] = {0.731, -1.618, 0.577, 2.236, -0.915, 1.202};
  steif_context *ctx = steif_context_new(NULL);
  steif_problem problem;
  char text[32];
  sunrealtype adjoint;
  long double stage[MOST] = {0}, sum = 0;
  snprintf(text, sizeof text, "jordan:k=%d,case=H-inc", k);
  CU_ASSERT_FATAL(steif_problem_find(ctx, text, &problem) == STEIF_OK);
  steif_table *table = steif_table_new(ctx, name);
  CU_ASSERT_FATAL(table != NULL);
  const stf_weight g = stf_weight_of(ctx, NULL);
  stf_pairing pairing = {
    .g = &g, .convention = STEIF_STAGE, .steps = n, .h = 1.0L / n, .n = k, .sum = stage};
  stf_trace trace = {.steps = n, .pairing = &pairing};
  CHECK(stf_trace_run(ctx, &problem, method, NULL, 1.0 / n, &trace) == STEIF_OK);
  for (int m = 0; m < k; m++) sum += w[m] * stage[m];
  CHECK(adjoint_value(ctx, table, k, 1.0 / n, n, w, problem.y0, &adjoint) == STEIF_OK);
  CHECK(fabs(adjoint) > 0.1);
  CLOSE_FLOOR((double)sum, adjoint, 1e-12, pow(n, name[0] == 'g' ? 2 * k - 4 : k - 2));
  steif_table_free(ctx, &table);
  steif_problem_clear(ctx, &problem);
  steif_context_free(&ctx);
}

static void adjoint_gives_the_weak_value(void)
{
  static const char *const table[] = {"radau:s=1",     "radau:s=2", "radau:s=3",  "radau1a:s=2",
                                      "lobatto3c:s=3", "gauss:s=2", "alexander2", "alexander2b",
                                      "alexander3",    "crouzeix23"};
  for (int i = 0; i < 10; i++)
    for (int k = 2; k <= 5; k++) {
      char method[32];
      snprintf(method, sizeof method, "%s%s", i < 6 ? "" : "dirk:", table[i]);
      identity_holds(method, table[i], k);
    }
}

/* b_1 of the trapezoidal rule is not zero, but its A is singular; classical Runge-Kutta too. */
static void singular_tables_are_refused(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_table *table = steif_table_new(ctx, "rk4");
  const sunrealtype w[] = {1.7, -0.3}, x0[] = {0.4, 2.9};
  sunrealtype value;
  CU_ASSERT_FATAL(table != NULL);
  CHECK(adjoint_value(ctx, table, 2, 0.1, 10, w, x0, &value) == STEIF_SINGULAR);
  CHECK(strstr(steif_message(ctx), "rk4") != NULL);
  steif_table_free(ctx, &table);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_duality[] = {
  {"the adjoint method run backwards gives the weak value", adjoint_gives_the_weak_value},
  {"tables with a singular matrix have no adjoint", singular_tables_are_refused},
  CU_TEST_INFO_NULL};
