/* test_sensitivity_input.c: what is refused, and memory.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "base/failing.h"
#include "forcing.h"
#include <string.h>

static void refused(steif_context *ctx, const steif_problem *p, const char *method,
                    const steif_options *o, int code, const char *part)
{
  steif_solver *s = steif_solver_new(ctx, p, method, o);
  CHECK(!s && steif_status(ctx) == code);
  const int said = strstr(steif_message(ctx), part) != NULL;
  if (!said) printf("\n  %s: no '%s' in '%s'", method, part, steif_message(ctx));
  CHECK(said);
  steif_solver_free(&s);
}

/* 0 = y2 - p y1: with dy0/dp = 0 the derivative of the equation does not hold at the start. */
static int by_p(sunrealtype t, N_Vector y, N_Vector yp, int k, N_Vector out, void *user)
{
  (void)t, (void)yp, (void)k, (void)user;
  NV_Ith_S(out, 0) = 0, NV_Ith_S(out, 1) = NV_Ith_S(y, 0);
  return 0;
}

static int consistent(int k, N_Vector S0, void *user)
{
  (void)user;
  NV_Ith_S(S0, 0) = 0, NV_Ith_S(S0, 1) = k == 0;
  return 0;
}

/* y1 = e^(-p t), so that dy2/dp = (1 - p t) e^(-p t). */
static void inconsistent_derivatives_of_starts_are_refused(void)
{
  static const char *const methods[] = {"radau:s=3", "bdf", "dirk:hw43"};
  steif_context *ctx = steif_context_new(NULL);
  sunrealtype p[] = {2}, S[2];
  const sunrealtype y0[] = {1, 2};
  steif_parameters q = {.count = 1, .value = p, .dFdp = by_p};
  const steif_problem problem = {.name = "constrained",
                                 .n = 2,
                                 .t1 = 1,
                                 .y0 = y0,
                                 .f = constrained_f,
                                 .E = constrained_mass,
                                 .user = p,
                                 .dae_index = 1,
                                 .parameters = &q};
  steif_options o = steif_defaults();
  o.sensitivities = 1, o.rtol = 1e-8;
  o.h = 0.01;
  refused(ctx, &problem, "radau:s=3", &o, STEIF_UNSUPPORTED, "algebraic equation");
  o.h = 0;
  for (int m = 0; m < 6; m++) { /* adaptive runs follow the jump of S */
    q.start = m < 3 ? NULL : consistent;
    sensitivity_at(ctx, &problem, methods[m % 3], &o, 0, 1, S, NULL);
    CLOSE(S[0], -exp(-2), 1e-6);
    CLOSE(S[1], -exp(-2), 1e-6);
  }
  steif_context_free(&ctx);
}

static int handler(sunrealtype t, N_Vector y, const int *fired, void *user)
{
  (void)t, (void)y, (void)fired, (void)user;
  return STEIF_CONTINUE;
}

static int values(sunrealtype t, N_Vector y, sunrealtype *value, void *user)
{
  (void)t, (void)user;
  value[0] = NV_Ith_S(y, 0) - 1;
  return 0;
}

static int begin(sunrealtype t, void *user)
{
  (void)t, (void)user;
  return 0;
}

static void other_families_are_refused(void)
{
  static const char *const methods[] = {"exp-euler", "cvode", "exprb43"};
  steif_context *ctx = steif_context_new(NULL);
  struct forcing F;
  steif_options o = steif_defaults();
  forcing_open(&F, 0);
  o.sensitivities = 1;
  for (int i = 0; i < 3; i++)
    refused(ctx, &F.problem, methods[i], &o, STEIF_UNSUPPORTED, methods[i]);
  steif_context_free(&ctx);
}

static void other_problems_are_refused(void)
{
  steif_context *ctx = steif_context_new(NULL);
  struct forcing F;
  const int positive[] = {1};
  steif_options o = steif_defaults();
  o.sensitivities = 1;
  forcing_open(&F, 0);
  F.problem.events = 1, F.problem.event = values, F.problem.handle_event = handler;
  F.problem.begin = begin;
  refused(ctx, &F.problem, "radau:s=3", &o, STEIF_UNSUPPORTED, "save and restore");
  forcing_open(&F, 0);
  F.problem.constraint = positive;
  refused(ctx, &F.problem, "radau:s=3", &o, STEIF_UNSUPPORTED, "constraints");
  forcing_open(&F, 0);
  F.problem.parameters = NULL;
  refused(ctx, &F.problem, "radau:s=3", &o, STEIF_BAD_INPUT, "no parameters");
  forcing_open(&F, 0);
  F.p[2] = NAN;
  refused(ctx, &F.problem, "radau:s=3", &o, STEIF_NOT_FINITE, "parameter 3");
  steif_context_free(&ctx);
}

/* df/dp where dF/dp = -df/dp is asked for. */
static int sign_of_f(sunrealtype t, N_Vector y, N_Vector yp, int k, N_Vector out, void *user)
{
  (void)yp, (void)user;
  NV_Ith_S(out, 0) = k == 0 ? -NV_Ith_S(y, 0) : k == 1 ? sin(10 * t) : 0;
  return 0;
}

static void wrong_signs_are_named(void)
{
  steif_context *ctx = steif_context_new(NULL);
  struct forcing F;
  steif_options o = steif_defaults();
  forcing_open(&F, 0);
  F.y0[0] = 1, F.parameters.dFdp = sign_of_f, o.sensitivities = 1;
  refused(ctx, &F.problem, "radau:s=3", &o, STEIF_BAD_INPUT, "wrong sign");
  steif_context_free(&ctx);
}

/* dF/dp of x' = -a x + b sin 10t with `factor` times the entry of a, or one of b where there is none at the start. */
static sunrealtype factor_of_a, more_of_b;

static int one_entry_off(sunrealtype t, N_Vector y, N_Vector yp, int k, N_Vector out,
                         void *user)
{
  (void)yp, (void)user;
  NV_Ith_S(out, 0) = k == 0   ? factor_of_a * NV_Ith_S(y, 0)
                     : k == 1 ? -sin(10 * t) + more_of_b * t
                              : 0;
  return 0;
}

static void wrong_entries_are_named(void)
{
  const struct {
    sunrealtype a, b;
    const char *said;
  } trial[] = {{1, 0, NULL},          {1 + 1e-5, 0, NULL},     {1.01, 0, "parameter 1"},
               {0, 0, "parameter 1"}, {1, 0.1, "parameter 2"}, {2, 0, "equation e1"}};
  steif_context *ctx = steif_context_new(NULL);
  struct forcing F;
  steif_options o = steif_defaults();
  forcing_open(&F, 0);
  F.y0[0] = 1, F.parameters.dFdp = one_entry_off, o.sensitivities = 1;
  for (size_t i = 0; i < sizeof trial / sizeof *trial; i++) {
    factor_of_a = trial[i].a, more_of_b = trial[i].b;
    if (trial[i].said)
      refused(ctx, &F.problem, "radau:s=3", &o, STEIF_BAD_INPUT, trial[i].said);
    else {
      steif_solver *s = steif_solver_new(ctx, &F.problem, "radau:s=3", &o);
      CHECK(s != NULL);
      steif_solver_free(&s);
    }
  }
  steif_context_free(&ctx);
}

/* Terms of 1e14 that cancel, parameters that are lost in them, and corners: true derivatives are not refused. */
static int hard_f(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const sunrealtype *p = user, x = NV_Ith_S(y, 0), large = 1e14 * x;
  (void)t;
  NV_Ith_S(ydot, 0) = (large + p[0] * x) - large + fmax(p[1], 0) + 1e-9 * p[2] * x * x - x;
  return 0;
}

static int hard_slope(sunrealtype t, N_Vector y, N_Vector yp, int k, N_Vector out, void *user)
{
  const sunrealtype x = NV_Ith_S(y, 0);
  (void)t, (void)yp, (void)user;
  NV_Ith_S(out, 0) = k == 0 ? -x : k == 1 ? -1 : -1e-9 * x * x;
  return 0;
}

static void true_entries_are_not_refused(void)
{
  steif_context *ctx = steif_context_new(NULL);
  struct forcing F;
  steif_options o = steif_defaults();
  forcing_open(&F, 0);
  F.problem.f = hard_f, F.problem.jac = NULL, F.problem.linear = 0;
  F.y0[0] = 0.7, F.p[0] = 0.3, F.p[1] = 0, F.p[2] = 1;
  F.parameters.dFdp = hard_slope, o.sensitivities = 1;
  steif_solver *s = steif_solver_new(ctx, &F.problem, "radau:s=3", &o);
  CHECK(s != NULL);
  if (!s) puts(steif_message(ctx));
  steif_solver_free(&s);
  steif_context_free(&ctx);
}

/* Differences by p at a tolerance of their rounding: the run ends in as many steps as with dFdp, or a few times that. */
static void noise_does_not_shorten_steps(void)
{
  steif_context *ctx = steif_context_new(NULL);
  long steps[2];
  for (int differences = 0; differences < 2; differences++) {
    struct forcing F;
    steif_options o = steif_defaults();
    steif_sensitivity_cost cost;
    forcing_open(&F, differences);
    F.y0[0] = 1e3, F.p[1] = 1, F.problem.linear = 0;
    o.sensitivities = 1, o.rtol = 1e-11, o.t1 = 1, o.max_steps = 100000;
    steif_solver *s = steif_solver_new(ctx, &F.problem, "radau:s=3", &o);
    CU_ASSERT_FATAL(s && !steif_solve_to(s, 1));
    steps[differences] = steif_statistics(s)->steps;
    CHECK(!steif_sensitivity_costs(s, &cost));
    CHECK(differences ? cost.noise > 0 : cost.noise == 0);
    steif_solver_free(&s);
  }
  CHECK(steps[1] <= 3 * steps[0]);
  steif_context_free(&ctx);
}

/* From t = 1 on no number: named with parameter, equation and time, by methods that ask in different places. */
static int late_nan(sunrealtype t, N_Vector y, N_Vector yp, int k, N_Vector out, void *user)
{
  (void)yp, (void)user;
  NV_Ith_S(out, 0) = k == 0 ? NV_Ith_S(y, 0) : k == 1 ? -sin(10 * t) : t > 1 ? NAN : 0;
  return 0;
}

static void no_numbers_are_named(void)
{
  static const char *const methods[] = {"radau:s=3", "bdf",     "dirk:hw43",
                                        "rodas4",    "dopri87", "glm:irks,p=2"};
  static const char *const names[] = {"a", "b", "c"}, *const few[] = {"a", NULL, "c"};
  steif_context *ctx = steif_context_new(NULL);
  struct forcing F;
  steif_options o = steif_defaults();
  forcing_open(&F, 0);
  F.p[1] = 1, F.parameters.dFdp = late_nan, F.parameters.name = names, o.sensitivities = 1;
  for (size_t m = 0; m < sizeof methods / sizeof *methods; m++) {
    steif_solver *s = steif_solver_new(ctx, &F.problem, methods[m], &o);
    CHECK(s && steif_solve_to(s, 2) == STEIF_NOT_FINITE);
    const char *said = steif_message(ctx);
    CHECK(strstr(said, "'c'") && strstr(said, "equation e1") && strstr(said, "t = 1."));
    steif_solver_free(&s);
  }
  F.parameters.name = few;
  refused(ctx, &F.problem, "radau:s=3", &o, STEIF_BAD_INPUT, "parameter 2 of 3");
  steif_context_free(&ctx);
}

static void wrong_columns_are_refused(void)
{
  steif_context *ctx = steif_context_new(NULL);
  struct forcing F;
  const int twice[] = {1, 1}, beyond[] = {3}, one[] = {2};
  steif_options o = steif_defaults();
  forcing_open(&F, 0);
  o.sensitivities = 1, o.active = twice, o.active_count = 2;
  refused(ctx, &F.problem, "radau:s=3", &o, STEIF_BAD_INPUT, "twice");
  o.active = beyond, o.active_count = 1;
  refused(ctx, &F.problem, "radau:s=3", &o, STEIF_BAD_INPUT, "0 .. 2");
  o.active = one, o.rtol = 1e-8;
  steif_solver *s = steif_solver_new(ctx, &F.problem, "radau:s=3", &o);
  CU_ASSERT_FATAL(s && !steif_solve_to(s, 1));
  N_Vector d = N_VClone(steif_solution(s));
  CHECK(!steif_sensitivity(s, 1, 2, d));
  CLOSE(NV_Ith_S(d, 0), exp(-1), 1e-6);
  CHECK(steif_sensitivity(s, 1, 0, d) == STEIF_BAD_INPUT);
  CHECK(steif_sensitivity(s, 19, 2, d) == STEIF_BAD_INPUT);
  CHECK(steif_sensitivity(s, 1, 2, NULL) == STEIF_BAD_INPUT);
  CHECK(steif_sensitivity(NULL, 1, 2, d) == STEIF_BAD_INPUT);
  CHECK(steif_checkpoint_save(s, "never.steif", NULL, 0) == STEIF_UNSUPPORTED);
  CHECK(steif_solver_restart(s, 0, d, NULL, NULL, NULL) == STEIF_UNSUPPORTED);
  N_VDestroy(d);
  steif_solver_free(&s);
  steif_context_free(&ctx);
}

static int life(steif_context *ctx, const char *method, failing *memory)
{
  struct forcing F;
  steif_options o = steif_defaults();
  forcing_open(&F, strcmp(method, "rodas4") != 0);
  F.p[1] = 1, F.problem.linear = 0;
  o.sensitivities = 1, o.t1 = 1;
  steif_solver *s = steif_solver_new(ctx, &F.problem, method, &o);
  int code = s ? steif_solve_step(s) : steif_status(ctx);
  const long before = memory->served;
  if (!code) code = steif_solve_to(s, 1);
  if (!code) CHECK(memory->served == before);
  steif_solver_free(&s);
  return code;
}

static void memory_may_fail_anywhere(void)
{
  static const char *const methods[] = {"radau:s=3",     "bdf",          "dirk:hw43",
                                        "dirk:esdirk43", "glm:irks,p=2", "glm:ab,p=3",
                                        "dopri87",       "rodas4"};
  for (size_t m = 0; m < sizeof methods / sizeof *methods; m++)
    for (long k = 1;; k++) {
      failing memory = {.refuse_at = k};
      steif_setup setup = failing_setup(&memory);
      setup.threads = 1;
      steif_context *ctx = steif_context_new(&setup);
      const int code = ctx ? life(ctx, methods[m], &memory) : STEIF_NO_MEMORY;
      steif_context_free(&ctx);
      CHECK(memory.alive == 0);
      if (memory.served < k) {
        CHECK(code == STEIF_OK && k > 20);
        break;
      }
      CHECK(code == STEIF_NO_MEMORY);
    }
}

CU_TestInfo tests_of_sensitivity_input[] = {
  {"other families are refused", other_families_are_refused},
  {"other problems are refused", other_problems_are_refused},
  {"inconsistent derivatives of starts are refused",
   inconsistent_derivatives_of_starts_are_refused},
  {"wrong signs are named", wrong_signs_are_named},
  {"wrong entries are named", wrong_entries_are_named},
  {"true entries are not refused", true_entries_are_not_refused},
  {"noise does not shorten steps", noise_does_not_shorten_steps},
  {"no numbers are named", no_numbers_are_named},
  {"wrong columns are refused", wrong_columns_are_refused},
  {"memory may fail anywhere, and none is taken while stepping", memory_may_fail_anywhere},
  CU_TEST_INFO_NULL};
