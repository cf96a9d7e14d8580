/* Constraints on the sign of components.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "smooth.h"

static const char *const methods[] = {"radau:s=3", "bdf", "dirk:hw43", "rodas4",
                                      "cvode",     "ida", "arkode",    "gauss:s=3"};
enum { METHODS = 8 };

/* y1' = -1 leaves y >= 0 at 1/2; y2' = -y2. */
static int leave(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  (void)t, (void)user;
  NV_Ith_S(out, 0) = -1, NV_Ith_S(out, 1) = -NV_Ith_S(y, 1);
  return 0;
}

static void a_solution_that_leaves_is_told(void)
{
  static const sunrealtype y0[] = {0.5, 1};
  static const int both[] = {1, 2};
  const steif_problem p = {
    .name = "leave", .n = 2, .t1 = 2, .y0 = y0, .f = leave, .constraint = both};
  for (int m = 0; m < METHODS; m++) {
    const int ours = m < 4 || m == 7;
    steif_context *ctx = steif_context_new(NULL);
    steif_options o = steif_defaults();
    o.max_steps = 20000; /* IDA goes on for a million along the constraint */
    steif_solver *s = smooth_open(ctx, &p, methods[m], &o);
    const int code = steif_solve_to(s, 2);
    CHECK(ours ? code == STEIF_INFEASIBLE : code < 0);
    CHECK(!ours || strstr(steif_message(ctx), "component 1 of problem 'leave' becomes -"));
    CHECK(!ours || NV_Ith_S(steif_solution(s), 0) >= 0);
    if (ours) CLOSE(steif_time(s), 0.5, 1e-3);
    steif_solver_free(&s);
    steif_context_free(&ctx);
  }
}

/* y' = -300 (y - c(t)), c = max(0, cos 3t)^2: coarse steps pass below zero. */
static int rest(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  (void)user;
  const double c = fmax(0, cos(3 * t));
  NV_Ith_S(out, 0) = -300 * (NV_Ith_S(y, 0) - c * c);
  return 0;
}

static double lowest;
static int watch(steif_solver *s, sunrealtype t, N_Vector y, void *user)
{
  (void)s, (void)t, (void)user;
  lowest = fmin(lowest, NV_Ith_S(y, 0));
  return 0;
}

static void steps_end_where_they_may(void)
{
  static const sunrealtype y0[] = {1};
  static const int positive[] = {1};
  int below = 0;
  steif_problem p = {.name = "rest", .n = 1, .t1 = 6, .y0 = y0, .f = rest};
  steif_context *ctx = steif_context_new(NULL);
  for (int m = 0; m < METHODS; m++)
    for (int kept = 0; kept < 2; kept++) {
      steif_options o = steif_defaults();
      o.rtol = o.atol = 1e-3, o.observe = watch;
      p.constraint = kept ? positive : NULL, lowest = 1;
      steif_solver *s = smooth_open(ctx, &p, methods[m], &o);
      CHECK(!steif_solve_to(s, 6));
      CLOSE_FLOOR(NV_Ith_S(steif_solution(s), 0), pow(cos(18), 2), 1e-1, 1);
      below += !kept && lowest < 0;
      CHECK(!kept || lowest >= (strcmp(methods[m], "ida") ? 0 : -1e-3)); /* IDA: up to atol */
      steif_solver_free(&s);
    }
  CHECK(below >= 4); /* the constraint had something to do */
  steif_context_free(&ctx);
}

static void bad_constraints_are_refused(void)
{
  static const sunrealtype y0[] = {0.5, -1e-9};
  static const int wrong[] = {0, 3}, sign[] = {0, 1};
  steif_problem p = {.name = "p", .n = 2, .t1 = 2, .y0 = y0, .f = leave, .constraint = wrong};
  smooth_refused(&p, "radau:s=3", NULL, STEIF_BAD_INPUT, "constraint[1] = 3 of problem 'p'");
  p.constraint = sign;
  smooth_refused(&p, "radau:s=3", NULL, STEIF_INFEASIBLE,
                 "component 2 of problem 'p' is -1e-09 at the start, t = 0, and is declared to "
                 "be >= 0");
  smooth_refused(&p, "rk4", &(steif_options){.h = 0.1}, STEIF_INFEASIBLE,
                 "declared to be >= 0");
  smooth_refused(&p, "cvode", NULL, STEIF_INFEASIBLE, "declared to be >= 0");
}

static void given_steps_cannot_be_smaller(void)
{
  static const sunrealtype y0[] = {0.5, 1};
  static const int both[] = {1, 2};
  const steif_problem p = {
    .name = "leave", .n = 2, .t1 = 2, .y0 = y0, .f = leave, .constraint = both};
  steif_context *ctx = steif_context_new(NULL);
  steif_options o = steif_defaults();
  o.h = 0.2;
  steif_solver *s = smooth_open(ctx, &p, "rk4", &o);
  CHECK(steif_solve_to(s, 2) == STEIF_INFEASIBLE);
  CHECK(strstr(steif_message(ctx), "becomes -0.1 in the step of 0.2 from t = 0.4"));
  steif_solver_free(&s);
  steif_context_free(&ctx);
}

/* y1 = 3 - t and y2 stay positive: the run of no constraint, bit by bit. */
static void constraints_that_hold_change_nothing(void)
{
  static const sunrealtype y0[] = {3, 1};
  static const int both[] = {1, 2}, none[] = {0, 0};
  steif_problem p = {.name = "leave", .n = 2, .t1 = 2, .y0 = y0, .f = leave};
  for (int m = 0; m < METHODS; m++) {
    steif_context *ctx = steif_context_new(NULL);
    const steif_options o = {.rtol = 1e-6, .atol = 1e-9};
    const int *const signs[] = {NULL, both, none};
    steif_stats n[3];
    double y[3];
    for (int k = 0; k < 3; k++) {
      p.constraint = signs[k];
      steif_solver *s = smooth_open(ctx, &p, methods[m], &o);
      CHECK(!steif_solve_to(s, 2));
      n[k] = *steif_statistics(s), y[k] = NV_Ith_S(steif_solution(s), 1);
      steif_solver_free(&s);
    }
    CHECK(n[1].steps == n[0].steps && n[1].nfe == n[0].nfe && y[1] == y[0]);
    CHECK(n[2].steps == n[0].steps && n[2].nfe == n[0].nfe && y[2] == y[0]);
    steif_context_free(&ctx);
  }
}

CU_TestInfo tests_of_constraints[] = {
  {"a solution that leaves is told", a_solution_that_leaves_is_told},
  {"steps end where they may", steps_end_where_they_may},
  {"bad constraints are refused", bad_constraints_are_refused},
  {"constraints that hold change nothing", constraints_that_hold_change_nothing},
  {"given steps cannot be made smaller", given_steps_cannot_be_smaller},
  CU_TEST_INFO_NULL};
