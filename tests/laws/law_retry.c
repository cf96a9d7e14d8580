/* law_retry.c: an attempt is pure, and reopening at an accepted point continues the same run.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "laws.h"
#include "integrator.h"

/* The same attempt twice, with a different one between, gives the same trial bit for bit, and
 * the accepted solution stays as it was. */
static void attempt_is_pure(steif_context *ctx, const char *method)
{
  steif_options o = steif_defaults();
  o.h = 0.05;
  steif_problem p = law_problem;
  p.linear = 0;
  steif_solver *s = steif_solver_new(ctx, &p, method, &o);
  CU_ASSERT_FATAL(s != NULL);
  for (int i = 0; i < 7; i++) CHECK(!steif_solve_step(s));
  stf_step *step = &s->step;
  step->h_equal = 0; /* any h may be tried */
  stf_weights(&step->system.space, 1e-10, 1e-10, NULL, step->y, step->weights);
  const double before[] = {NV_Ith_S(step->y, 0), NV_Ith_S(step->y, 1)};
  step->newton.jacobian_wanted = false, step->newton.jacobian_new = true;
  CHECK(!step->method->attempt(step, 0.025));
  const double first[] = {NV_Ith_S(step->next, 0), NV_Ith_S(step->next, 1)};
  CHECK(!step->method->attempt(step, 0.05));
  CHECK(NV_Ith_S(step->next, 0) != first[0]);
  CHECK(!step->method->attempt(step, 0.025));
  for (int i = 0; i < 2; i++) {
    CLOSE(NV_Ith_S(step->next, i), first[i], 2e-12);
    CHECK(NV_Ith_S(step->y, i) == before[i]);
  }
  steif_solver_free(&s);
}

static void attempts_are_pure(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_method_info info;
  for (int m = 0; m < law_method_count; m++) attempt_is_pure(ctx, law_methods[m]);
  for (size_t m = 0; steif_method_at(ctx, m, &info) == STEIF_OK; m++)
    if (!strcmp(info.family, "glm")) attempt_is_pure(ctx, info.name);
  steif_context_free(&ctx);
}

/* One-step methods have no memory but the solution: a linear problem restarted half-way ends in
 * the same place to rounding. */
static void one_step_methods_restart(void)
{
  static const char *const methods[] = {
    "be",          "dirk:alexander3", "dirk:hw43", "gauss:s=3", "radau:s=3",
    "radau1a:s=2", "lobatto3c:s=3",   "rk4",       "exprb43"};
  steif_context *ctx = steif_context_new(NULL);
  for (size_t m = 0; m < sizeof methods / sizeof *methods; m++) {
    steif_options o = steif_defaults();
    o.h = 0.0625, o.t1 = 1;
    N_Vector whole = law_run(ctx, &law_problem, methods[m], &o);
    o.t1 = 0.5;
    N_Vector half = law_run(ctx, &law_problem, methods[m], &o);
    CU_ASSERT_FATAL(whole && half);
    steif_problem rest = law_problem;
    rest.t0 = 0.5, rest.y0 = N_VGetArrayPointer(half), o.t1 = 1;
    N_Vector again = law_run(ctx, &rest, methods[m], &o);
    CU_ASSERT_FATAL(again != NULL);
    CLOSE_FLOOR(law_distance(whole, again), 0, 1e-11, 1);
    N_VDestroy(whole), N_VDestroy(half), N_VDestroy(again);
  }
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_law_retry[] = {{"an attempt is pure", attempts_are_pure},
                                    {"one-step methods restart", one_step_methods_restart},
                                    CU_TEST_INFO_NULL};
