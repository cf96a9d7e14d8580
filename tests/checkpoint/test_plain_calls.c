/* test_plain_calls.c: the functions behind the macros, which callers of other languages take; restarts with constant
 * steps, with tolerances of components, and with a callback that fails.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "oscillator.h"
#include "suite.h"
#include <string.h>

static int same(steif_solver *a, steif_solver *b)
{
  return steif_time(a) == steif_time(b) &&
         !memcmp(NV_DATA_S(steif_solution(a)), NV_DATA_S(steif_solution(b)),
                 2 * sizeof(sunrealtype));
}

/* Structs of the sizes of this library are what the plain functions take. */
static void functions_do_what_their_macros_do(void)
{
  steif_context *ctx = steif_context_new(NULL);
  const steif_problem p = oscillator();
  const steif_options o = steif_defaults();
  steif_solver *s = under_way(ctx, &p, "radau:s=3", &o);
  CU_ASSERT_FATAL(s != NULL);
  const char *path = scratch("plain");
  CHECK(!steif_checkpoint_save(s, path, NULL, 0));
  steif_solver *copy = (steif_solver_copy)(s, NULL),
               *read = (steif_checkpoint_load)(ctx, path, &p, NULL);
  CU_ASSERT_FATAL(copy != NULL && read != NULL);
  for (int k = 0; k < 10; k++) {
    CHECK(!steif_solve_step(s) && !steif_solve_step(copy) && !steif_solve_step(read));
    CHECK(same(s, copy) && same(s, read));
  }
  N_Vector y0 = N_VClone(steif_solution(s));
  N_VGetArrayPointer(y0)[0] = 2, N_VGetArrayPointer(y0)[1] = -0.66;
  CHECK(!(steif_solver_restart)(s, 0, y0, NULL, NULL, NULL));
  CHECK(!steif_solver_restart(copy, 0, y0, NULL, NULL, NULL));
  CHECK(!steif_solve_to(s, p.t1) && !steif_solve_to(copy, p.t1) && same(s, copy));
  N_VDestroy(y0);
  remove(path);
  steif_solver_free(&s), steif_solver_free(&copy), steif_solver_free(&read);
  steif_context_free(&ctx);
}

/* A restarted run is a new one, with constant steps and with tolerances of components, too. */
static void restarts_are_new_runs(void)
{
  static const sunrealtype atols[] = {1e-6, 1e-4};
  for (int i = 0; i < 2; i++) {
    steif_context *ctx = steif_context_new(NULL);
    const steif_problem p = oscillator();
    steif_options o = steif_defaults();
    if (i)
      o.atols = atols, o.h0 = 1e-5;
    else
      o.h = 0.01;
    steif_solver *s = under_way(ctx, &p, "radau:s=3", &o),
                 *fresh = steif_solver_new(ctx, &p, "radau:s=3", &o);
    CU_ASSERT_FATAL(s != NULL && fresh != NULL);
    N_Vector y0 = N_VClone(steif_solution(fresh));
    N_VScale(1, steif_solution(fresh), y0);
    CHECK(!steif_solver_restart(s, 0, y0, NULL, NULL, NULL));
    CHECK(!steif_solve_to(s, p.t1) && !steif_solve_to(fresh, p.t1));
    CHECK(same(s, fresh));
    N_VDestroy(y0);
    steif_solver_free(&s), steif_solver_free(&fresh);
    steif_context_free(&ctx);
  }
}

static int refusals; /* of the callback below: none at the first start */

static int begin(sunrealtype t, void *user)
{
  (void)t, (void)user;
  return refusals++;
}

static void a_start_that_fails_is_told(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p = oscillator();
  const steif_options o = steif_defaults();
  refusals = 0, p.begin = begin;
  steif_solver *s = under_way(ctx, &p, "radau:s=3", &o);
  CU_ASSERT_FATAL(s != NULL && refusals == 1);
  CHECK(steif_solver_restart(s, 0, steif_solution(s), NULL, NULL, NULL) == STEIF_CALLBACK);
  CHECK(strstr(steif_message(ctx), "begin of problem") != NULL);
  CHECK(steif_solve_step(s) == STEIF_CALLBACK); /* it stays so */
  steif_solver_free(&s);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_plain_calls[] = {
  {"functions do what their macros do", functions_do_what_their_macros_do},
  {"restarts are new runs", restarts_are_new_runs},
  {"a start that fails is told", a_start_that_fails_is_told},
  CU_TEST_INFO_NULL};
