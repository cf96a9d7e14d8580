/* test_nulls.c: NULL where a pointer is needed is an error, or nothing, and never a crash.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"
#include <steif/analysis.h>
#include <steif/data.h>
#include <steif/linear.h>
#include <steif/extension.h>
#include <steif/steif.h>
#include <stdbool.h>
#include <string.h>

static void no_solver(void)
{
  int count = 7;
  sunrealtype x = 7;
  const sunrealtype *c, *b;
  N_Vector *X;
  CHECK(steif_solution(NULL) == NULL);
  CHECK(isnan(steif_time(NULL)) || steif_time(NULL) == 0);
  CHECK(steif_solve_to(NULL, 1) == STEIF_BAD_INPUT);
  CHECK(steif_solve_step(NULL) == STEIF_BAD_INPUT);
  CHECK(steif_statistics(NULL) != NULL && steif_statistics(NULL)->steps == 0);
  CHECK(steif_hidden_error(NULL, NULL) == STEIF_BAD_INPUT);
  CHECK(steif_drift_now(NULL, NULL, NULL) == STEIF_BAD_INPUT);
  CHECK(steif_drift_now(NULL, &count, &x) == STEIF_OK && count == 0);
  CHECK(steif_stages(NULL, NULL, &c, &b, &X) == STEIF_BAD_INPUT);
  CHECK(steif_record_step(NULL, 0, NULL, NULL) == STEIF_BAD_INPUT);
  CHECK(steif_record_at(NULL, 0, &x, NULL) == STEIF_BAD_INPUT);
  CHECK(steif_record_steps(NULL, &c) == 0 && c == NULL);
  CHECK(steif_record_steps(NULL, NULL) == 0);
  CHECK(steif_record_values(NULL) == NULL);
}

static void no_context(void)
{
  steif_measurements data;
  steif_fit fit;
  CHECK(steif_allocate(NULL, 2, 8) == NULL);
  CHECK(steif_report_new(NULL) == NULL);
  CHECK(steif_rows_new(NULL, "rows.csv", 0, NULL) == NULL);
  CHECK(steif_solver_new(NULL, NULL, NULL, NULL) == NULL);
  CHECK(steif_measurements_read(NULL, NULL, NULL, 1, 0, 0, NULL, &data) == STEIF_BAD_INPUT);
  CHECK(steif_fit_find(NULL, NULL, NULL, NULL, NULL, &fit) == STEIF_BAD_INPUT);
  CHECK(steif_plot_components(NULL, NULL, 0, 0, NULL, NULL, NULL, NULL) == STEIF_BAD_INPUT);
}

/* Each leaves a sentence that says what is missing. */
static void said(steif_context *ctx, int code)
{
  const bool good = code == STEIF_BAD_INPUT && strstr(steif_message(ctx), "NULL");
  if (!good) printf("\n  code %d: %s", code, steif_message(ctx));
  CHECK(good);
  steif_forget(ctx);
}

static void no_arguments(void)
{
  steif_context *ctx = steif_context_new(NULL);
  enum steif_convention convention;
  said(ctx, steif_c2d(ctx, NULL, "zoh", 0.1, NULL));
  said(ctx, steif_method_at(ctx, 0, NULL));
  said(ctx, steif_region_find(ctx, NULL, NULL));
  said(ctx, steif_convention_usual(ctx, NULL, NULL, &convention));
  said(ctx, steif_weak_measure(ctx, NULL, NULL, NULL));
  said(ctx, steif_weak_measure_ball(ctx, NULL, 2, NULL, NULL));
  said(ctx, steif_layer_measure(ctx, "be", "jordan:k=2", NULL, 0.1, 4, NULL, NULL, NULL, NULL,
                                NULL));
  said(ctx,
       steif_layer_linear(ctx, "be", NULL, NULL, NULL, 0.1, 4, NULL, NULL, NULL, NULL, NULL));
  said(ctx, steif_measurements_read(ctx, NULL, NULL, 1, 0, 0, NULL, NULL));
  said(ctx, steif_fit_find(ctx, NULL, NULL, NULL, NULL, NULL));
  said(ctx, steif_reinitialise(ctx, NULL, 0, 1e-6, NULL, NULL));
  said(ctx, steif_reinitialise_stages(ctx, NULL, 0, 1e-6, NULL, NULL));
  CHECK(steif_solver_new(ctx, NULL, NULL, NULL) == NULL);
  said(ctx, steif_status(ctx));
  steif_context_free(&ctx);
}

static void no_function(void)
{
  sunrealtype x = 7;
  CHECK(steif_function_count(NULL) == 0);
  CHECK(steif_function_inputs(0, NULL, &x) == STEIF_BAD_INPUT);
  CHECK(steif_function_smooth(NULL, 0, 1, &x) == 0);
  CHECK(steif_function_accuracy(NULL, 0, 0, &x) == STEIF_BAD_INPUT);
  steif_output_value(NULL, NULL, NULL, NULL, &x);
  CHECK(x == 7);
  CHECK(steif_report_array_at(NULL, 0, NULL, NULL, NULL) == NULL);
}

static int decay(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  (void)t, (void)user;
  N_VScale(-1, y, r);
  return 0;
}

/* A problem without a name is run and spoken of. */
static void no_name(void)
{
  static const sunrealtype y0[] = {1};
  steif_context *ctx = steif_context_new(NULL);
  const steif_problem p = {.n = 1, .t1 = 1, .y0 = y0, .f = decay};
  steif_options o = steif_defaults();
  steif_solver *s = steif_solver_new(ctx, &p, "radau:s=3", &o);
  CHECK(s && steif_solve_to(s, 1) == STEIF_OK);
  steif_solver_free(&s);
  o.max_steps = 1;
  s = steif_solver_new(ctx, &p, "bdf", &o);
  CHECK(s && steif_solve_to(s, 1) == STEIF_STEP_LIMIT);
  CHECK(!strstr(steif_message(ctx), "(null)"));
  steif_solver_free(&s);
  o.t1 = -1, o.h = 2;
  s = steif_solver_new(ctx, &p, "rk4", &o);
  CHECK(!strstr(steif_message(ctx), "(null)"));
  steif_solver_free(&s), steif_context_free(&ctx);
}

CU_TestInfo tests_of_nulls[] = {{"no solver", no_solver},       {"no context", no_context},
                                {"no arguments", no_arguments}, {"no function", no_function},
                                {"no name", no_name},           CU_TEST_INFO_NULL};
