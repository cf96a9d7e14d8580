/* test_weights.c: error weights of the caller. SPDX-License-Identifier: BSD-3-Clause */
#include "smooth.h"

static int returned;
static double sign = 1;

/* What rtol = 1e-5, atol = 1e-8 stand for. */
static int weights(N_Vector y, N_Vector ewt, void *user)
{
  (void)user;
  for (int i = 0; i < 2; i++) NV_Ith_S(ewt, i) = sign / (1e-5 * fabs(NV_Ith_S(y, i)) + 1e-8);
  return returned;
}

static double last(const char *method, int own, steif_stats *cost)
{
  steif_context *ctx = steif_context_new(NULL);
  const steif_options o = {.rtol = 1e-5, .atol = 1e-8, .ewt = own ? weights : NULL};
  steif_solver *s = smooth_open(ctx, &smooth, method, &o);
  CHECK(steif_solve_to(s, 2) == STEIF_OK);
  const double y = NV_Ith_S(steif_solution(s), 1);
  *cost = *steif_statistics(s);
  steif_solver_free(&s);
  steif_context_free(&ctx);
  return y;
}

static void the_same_weights_make_the_same_run(void)
{
  static const char *const methods[] = {"radau:s=3", "bdf",   "dirk:hw43", "rodas4",
                                        "gauss:s=9", "cvode", "ida",       "arkode"};
  for (size_t i = 0; i < sizeof methods / sizeof *methods; i++) {
    steif_stats given, own;
    const double a = last(methods[i], 0, &given), b = last(methods[i], 1, &own);
    CLOSE(b, a, 1e-15);
    CHECK(own.steps == given.steps && own.nfe == given.nfe);
  }
}

static void stopped(const char *method, const char *words)
{
  steif_context *ctx = steif_context_new(NULL);
  const steif_options o = {.rtol = 1e-5, .ewt = weights};
  steif_solver *s = smooth_open(ctx, &smooth, method, &o);
  CHECK(steif_solve_to(s, 2) == STEIF_CALLBACK);
  CHECK(strstr(steif_message(ctx), words));
  steif_solver_free(&s);
  steif_context_free(&ctx);
}

static void failures_are_told(void)
{
  returned = -3;
  stopped("radau:s=3", "ewt of problem 'smooth' returned -3 at t = 0.25");
  returned = 0, sign = -1;
  stopped("bdf", "weights are positive");
  smooth_refused(&smooth, "cvode", &(steif_options){.ewt = weights}, STEIF_CALLBACK,
                 "with the smallest weight -");
  sign = 1;
}

CU_TestInfo tests_of_weights[] = {
  {"the same weights make the same run", the_same_weights_make_the_same_run},
  {"failures are told", failures_are_told},
  CU_TEST_INFO_NULL};
