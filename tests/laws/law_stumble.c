/* law_stumble.c: callbacks that fail, and values that are not finite.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "laws.h"
#include <stdlib.h>

typedef struct trouble {
  int calls, every, returns; /* every: fail at each such call, from the first after `grace` */
  int grace;
  double value; /* returned instead when returns = 0 */
} trouble;

static int f(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  trouble *x = user;
  const int code = law_problem.f(t, y, r, NULL);
  if (++x->calls <= x->grace || x->calls % x->every) return code;
  if (x->returns == 0) NV_Ith_S(r, 1) = x->value;
  return x->returns;
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
               N_Vector b, N_Vector c)
{
  (void)user;
  return law_problem.jac(t, y, fy, J, NULL, a, b, c);
}

static steif_problem troubled(trouble *x)
{
  steif_problem p = law_problem;
  p.f = f, p.jac = jac, p.user = x;
  return p;
}

static void expect(const char *method, trouble x, double h, int status, const char *words)
{
  steif_context *ctx = steif_context_new(NULL);
  const steif_problem p = troubled(&x);
  steif_options o = steif_defaults();
  o.h = h;
  N_Vector end = law_run(ctx, &p, method, &o);
  const int good = steif_status(ctx) == status && strstr(steif_message(ctx), words) != NULL;
  if (!good) printf("\n  %s: %d %s", method, steif_status(ctx), steif_message(ctx));
  CHECK(good);
  CHECK((end != NULL) == (status == STEIF_OK));
  if (end) N_VDestroy(end);
  steif_context_free(&ctx);
}

static void fatal_callbacks_stop_the_run(void)
{
  for (int m = 0; m < law_method_count; m++)
    expect(law_methods[m], (trouble){.every = 1, .grace = 9, .returns = -3}, 0.1,
           STEIF_CALLBACK, "returned -3");
}

static void given_steps_refuse_recoverable_failures(void)
{
  for (int m = 0; m < law_method_count; m++)
    expect(law_methods[m], (trouble){.every = 1, .grace = 30, .returns = 1}, 0.05,
           STEIF_CALLBACK, "returned 1");
}

static void chosen_steps_survive_recoverable_failures(void)
{
  static const char *const methods[] = {"radau:s=3",   "gauss:s=2", "bdf:p=3",
                                        "dirk:trbdf2", "exprb32",   "exprb43"};
  for (int m = 0; m < 6; m++)
    expect(methods[m], (trouble){.every = 37, .grace = 5, .returns = 1}, 0, STEIF_OK, "ok");
}

static void nan_is_never_accepted(void)
{
  for (int m = 0; m < law_method_count; m++) {
    expect(law_methods[m], (trouble){.every = 1, .grace = 30, .value = NAN}, 0.05,
           STEIF_NOT_FINITE, m < law_implicit_count ? "not finite" : "overflowed");
    expect(law_methods[m], (trouble){.every = 1, .grace = 30, .value = INFINITY}, 0.05,
           STEIF_NOT_FINITE, "");
  }
}

static void nan_in_inputs_is_named(void)
{
  steif_context *ctx = steif_context_new(NULL);
  const double bad[] = {0.3, NAN};
  steif_problem p = law_problem;
  p.y0 = bad;
  CHECK(!steif_solver_new(ctx, &p, "be", NULL) && steif_status(ctx) == STEIF_NOT_FINITE);
  CHECK(strstr(steif_message(ctx), "y0[1]") != NULL);
  p = law_problem, p.t1 = NAN;
  CHECK(!steif_solver_new(ctx, &p, "be", NULL) && steif_status(ctx) == STEIF_BAD_INPUT);
  const double wrong[] = {NAN, INFINITY, -1};
  for (int i = 0; i < 3; i++) {
    steif_options o = steif_defaults();
    o.rtol = wrong[i];
    CHECK(!steif_solver_new(ctx, &law_problem, "be", &o) &&
          steif_status(ctx) == STEIF_BAD_INPUT);
    o = steif_defaults(), o.h = wrong[i];
    CHECK(!steif_solver_new(ctx, &law_problem, "be", &o) &&
          steif_status(ctx) == STEIF_BAD_INPUT);
    o = steif_defaults(), o.atol = wrong[i];
    CHECK(!steif_solver_new(ctx, &law_problem, "be", &o) &&
          steif_status(ctx) == STEIF_BAD_INPUT);
    o = steif_defaults(), o.h0 = wrong[i];
    CHECK(!steif_solver_new(ctx, &law_problem, "be", &o) &&
          steif_status(ctx) == STEIF_BAD_INPUT);
  }
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_law_stumble[] = {
  {"fatal callbacks stop the run", fatal_callbacks_stop_the_run},
  {"given steps refuse recoverable failures", given_steps_refuse_recoverable_failures},
  {"chosen steps survive recoverable failures", chosen_steps_survive_recoverable_failures},
  {"NaN is never accepted", nan_is_never_accepted},
  {"NaN in inputs is named", nan_in_inputs_is_named},
  CU_TEST_INFO_NULL};
