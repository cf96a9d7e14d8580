/* test_layer.c: the layer of BDF step by step, its length, and the error behind it.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "weak/data.h"

enum { STEPS = 128 };
static sunrealtype t[STEPS + 1], x[MOST * (STEPS + 1)], exact[MOST * (STEPS + 1)],
  error[STEPS + 1];

static steif_layer_result measure(const char *method, int k, const char *name,
                                  const char *start, double h, size_t steps)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_layer_result result = {.layer_steps = -1, .threshold = NAN};
  char problem[48];
  snprintf(problem, sizeof problem, "jordan:k=%d,case=%s", k, name);
  const int code =
    steif_layer_measure(ctx, method, problem, start, h, steps, t, x, exact, error, &result);
  if (code != STEIF_OK) printf("\n  %s on %s: %s", method, problem, steif_message(ctx));
  CHECK(code == STEIF_OK);
  steif_context_free(&ctx);
  return result;
}

static void constant_history_forgets_in_p_times_index_minus_one(void)
{
  for (int p = 1; p <= 6; p++)
    for (int k = 2; k <= 4; k++) {
      char method[16];
      snprintf(method, sizeof method, "bdf:p=%d", p);
      CHECK(measure(method, k, "H-inc", "constant", 1.0 / 64, 30).layer_steps == p * (k - 1));
      CHECK(error[p * (k - 1)] > 0 && error[p * (k - 1) + 1] <= 1e-9 * error[1]);
      CHECK(measure(method, k, "N-inc", "constant", 1.0 / 64, 30).layer_steps == p * (k - 1));
    }
}

/* k = 3, h = 2^-8, component 1, five digits: inconsistent starts are clean from step k, consistent
 * ones from step k - 1 with an error of order one at step 1. */
static void backward_euler_step_by_step(void)
{
  static const double inc[] = {-1.4396, -2.6091e5, 2.6149e5, 3.1652e-4, 3.3855e-4};
  static const double cons[] = {0, -0.49463, 2.9449e-4, 3.1652e-4, 3.3855e-4};
  CHECK(measure("be", 3, "N-inc", NULL, 1.0 / 256, 20).layer_steps == 2);
  for (int i = 0; i < 5; i++) CLOSE(x[3 * i] - exact[3 * i], inc[i], 3e-5);
  CHECK(measure("be", 3, "N-cons", NULL, 1.0 / 256, 20).layer_steps == 1);
  for (int i = 1; i < 5; i++) CLOSE(x[3 * i] - exact[3 * i], cons[i], 3e-5);
  CHECK(x[0] == exact[0] && error[1] >= 0.49463 * 0.9999);
}

/* x_1(1) of N-inc at h = 2^-7 and the order from 2^-6: the start leaves no trace outside the layer.
 * p = 5, 6 and p = 4, k > 2 are below eps h^-(k-1) and left out. */
static void error_behind_the_layer_has_order_p(void)
{
  static const struct {
    int p, k;
    double error, order;
  } rows[] = {{1, 2, 0.003866, 0.9994}, {1, 3, 0.009755, 0.9963}, {1, 4, 0.01301, 0.989},
              {2, 2, 2.989e-6, 2.056},  {2, 3, 2.977e-5, 2.014},  {2, 4, 8.84e-5, 2.006},
              {3, 2, -1.179e-7, 2.998}, {3, 3, -2.968e-7, 2.992}, {4, 2, -1.147e-10, 4.116}};
  static const char *const start[] = {"constant", "ramp", "cq"};
  for (size_t r = 0; r < sizeof rows / sizeof *rows; r++)
    for (int s = 0; s < 3; s++) {
      char method[16];
      double last[2];
      snprintf(method, sizeof method, "bdf:p=%d", rows[r].p);
      for (size_t j = 0; j < 2; j++) {
        const size_t steps = (size_t)(STEPS / 2) << j, end = steps * (size_t)rows[r].k;
        measure(method, rows[r].k, "N-inc", start[s], 1 / (double)steps, steps);
        last[j] = x[end] - exact[end];
      }
      const double noise = 1e-15 * pow(STEPS, rows[r].k - 1) / fabs(rows[r].error);
      CLOSE(last[1], rows[r].error, 5e-4 + noise);
      CLOSE(log2(fabs(last[0] / last[1])), rows[r].order, 6e-4 + noise);
    }
}

static void bad_questions_are_refused(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_layer_result result;
  const char *block = "jordan:k=3,case=H-inc";
  CHECK(steif_layer_measure(ctx, "be", block, NULL, -0.1, 5, t, x, exact, error, &result) ==
        STEIF_BAD_INPUT);
  CHECK(steif_layer_measure(ctx, "be", block, NULL, 0.1, 0, t, x, exact, error, &result) ==
        STEIF_BAD_INPUT);
  CHECK(steif_layer_measure(ctx, "be", "rober", NULL, 0.1, 5, t, x, exact, error, &result) ==
        STEIF_UNSUPPORTED);
  CHECK(strstr(steif_message(ctx), "rober") != NULL);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_layer[] = {
  {"constant history is forgotten in p (k-1) steps",
   constant_history_forgets_in_p_times_index_minus_one},
  {"backward Euler step by step, consistent or not", backward_euler_step_by_step},
  {"behind the layer the error has order p for every start",
   error_behind_the_layer_has_order_p},
  {"bad questions are refused", bad_questions_are_refused},
  CU_TEST_INFO_NULL};
