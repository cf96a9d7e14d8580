/* Reactions: what a problem does at an event, and the run behind it.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "watched.h"
#include <sunmatrix/sunmatrix_dense.h>

static int quarter(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  (void)t, (void)user;
  *g = NV_Ith_S(y, 1) - 0.25;
  return 0;
}

static int refill(sunrealtype t, N_Vector y, const int *fired, void *user)
{
  (void)t, (void)user;
  CHECK(fired[0] == -1);
  CLOSE(NV_Ith_S(y, 1), 0.25, 1e-12);
  NV_Ith_S(y, 1) = 0.5;
  return STEIF_RESTART;
}

/* y2 = exp(-t) down to 1/4 at ln 4, from 1/2 again every ln 2. */
static void a_state_is_changed_and_shown_from_both_sides(void)
{
  static const char *const methods[] = {"radau:s=3", "bdf",    "dirk:hw43", "rodas4",
                                        "cvode",     "arkode", "ida",       "radau:s=2"};
  steif_problem p = watched_problem(1, quarter);
  p.handle_event = refill, p.t1 = 3;
  steif_context *ctx = steif_context_new(NULL);
  for (int m = 0; m < 8; m++) {
    watched w;
    CHECK(!watched_run(ctx, &p, methods[m], m == 7 ? 0.01 : 0, &w));
    CHECK(w.count == 3); /* 2, 3, 4 ln 2 */
    for (int k = 0; k < w.count; k++) {
      CLOSE(w.t[k], (k + 2) * log(2), 1e-6);
      int i = 0;
      while (i < w.steps - 1 && w.step_t[i] != w.t[k]) i++;
      CHECK(w.step_t[i] == w.t[k] && w.step_t[i + 1] == w.t[k]);
      CLOSE(w.step_y[i][1], 0.25, 1e-12);
      CHECK(w.step_y[i + 1][1] == 0.5);
    }
    const int last = w.steps - 1;
    CLOSE(w.step_y[last][1], exp(4 * log(2) - w.step_t[last]) / 4 * 2, 1e-5);
  }
  steif_context_free(&ctx);
}

static int finish(sunrealtype t, N_Vector y, const int *fired, void *user)
{
  int *calls = user;
  (void)t, (void)y, (void)fired;
  return ++*calls == 2 ? STEIF_FINISH : STEIF_CONTINUE;
}

static int halves(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  (void)t, (void)user;
  *g = sin(acos(-1) * (NV_Ith_S(y, 0) / 0.5 - 0.5)); /* at 0.25, 0.75, ... */
  return 0;
}

static void a_reaction_may_end_the_run(void)
{
  steif_problem p = watched_problem(1, halves);
  int calls = 0;
  p.handle_event = finish, p.user = &calls;
  steif_context *ctx = steif_context_new(NULL);
  steif_solver *s = smooth_open(ctx, &p, "radau:s=3", NULL);
  CHECK(steif_solve_to(s, 2) == STEIF_EVENT && calls == 2);
  CLOSE(steif_time(s), 0.75, 1e-14);
  CLOSE(NV_Ith_S(steif_solution(s), 0), 0.75, 1e-14);
  steif_solver_free(&s);
  steif_context_free(&ctx);
}

static int slide_f(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  (void)t, (void)y;
  NV_Ith_S(out, 0) = *(int *)user, NV_Ith_S(out, 1) = 0;
  return 0;
}

static int surface(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  (void)t, (void)user;
  *g = NV_Ith_S(y, 0) - 0.6123;
  return 0;
}

static int turn(sunrealtype t, N_Vector y, const int *fired, void *user)
{
  (void)t, (void)y;
  *(int *)user = -fired[0];
  return STEIF_RESTART;
}

/* y' = -sign(y - 0.6123) without hysteresis. */
static void sliding_is_said(void)
{
  static const char *const methods[] = {"radau:s=3", "bdf", "cvode"};
  static const steif_event list[] = {{.name = "relay"}};
  steif_context *ctx = steif_context_new(NULL);
  for (int m = 0; m < 3; m++) {
    int side = 1;
    watched w;
    steif_problem p = watched_problem(1, surface);
    p.f = slide_f, p.jac = NULL, p.handle_event = turn, p.user = &side, p.event_list = list;
    CHECK(watched_run(ctx, &p, methods[m], 0, &w) == STEIF_STEP_SIZE);
    CHECK(strstr(steif_message(ctx),
                 "('relay') of problem 'watched' crowd together at t = 0.6123"));
    CHECK(w.count < 60);
  }
  steif_context_free(&ctx);
}

static void bounces_without_end_are_said(void)
{
  steif_problem p;
  steif_context *ctx = steif_context_new(NULL);
  CU_ASSERT_FATAL(!steif_problem_find(ctx, "bounce:e=0.5", &p));
  steif_options o = steif_defaults();
  o.t1 = 2; /* over at sqrt(2/g) 3 = 1.3546 */
  steif_solver *s = smooth_open(ctx, &p, "radau:s=3", &o);
  CHECK(steif_solve_to(s, 2) == STEIF_STEP_SIZE);
  CHECK(strstr(steif_message(ctx), "bounces without end"));
  CLOSE(steif_time(s), 3 * sqrt(2 / 9.81), 1e-8);
  steif_solver_free(&s);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* Bounces too low to be seen by steps within the tolerance are no way through the floor: every method stops near
 * the time (1 + e)/(1 - e) sqrt(2/g) at which they are over, and says why. */
static void nothing_falls_through_the_floor(void)
{
  static const char *const methods[] = {"radau:s=3", "bdf", "rodas4", "cvode", "ida", "arkode"};
  for (int m = 0; m < 6; m++)
    for (double rtol = 1e-3; rtol > 0.9e-9; rtol *= 1e-2) {
      steif_context *ctx = steif_context_new(NULL);
      steif_problem p;
      CU_ASSERT_FATAL(!steif_problem_find(ctx, "bounce", &p));
      steif_options o = steif_defaults();
      o.rtol = rtol, o.t1 = 5;
      steif_solver *s = steif_solver_new(ctx, &p, methods[m], &o);
      CU_ASSERT_FATAL(s != NULL);
      CHECK(steif_solve_to(s, 5) == STEIF_STEP_SIZE);
      CHECK(strstr(steif_message(ctx), "'ground'") && strstr(steif_message(ctx), "crowd"));
      CHECK(steif_time(s) > 3.5 && steif_time(s) < 4.0638);
      CHECK(NV_Ith_S(steif_solution(s), 0) > -1e-3);
      steif_solver_free(&s);
      steif_problem_clear(ctx, &p);
      steif_context_free(&ctx);
    }
}

static int wild(sunrealtype t, N_Vector y, const int *fired, void *user)
{
  (void)t, (void)fired;
  if (user) return 7;
  NV_Ith_S(y, 0) = NAN;
  return STEIF_RESTART;
}

static void wrong_reactions_are_refused(void)
{
  steif_problem p = watched_problem(1, quarter);
  int any;
  watched w;
  steif_context *ctx = steif_context_new(NULL);
  p.handle_event = wild;
  CHECK(watched_run(ctx, &p, "radau:s=3", 0, &w) == STEIF_NOT_FINITE);
  CHECK(strstr(steif_message(ctx), "left a component that is not finite"));
  p.user = &any;
  CHECK(watched_run(ctx, &p, "cvode", 0, &w) == STEIF_CALLBACK);
  CHECK(strstr(steif_message(ctx), "returned 7 at the event g1"));
  steif_context_free(&ctx);
}

/* Multistep methods with given steps: the rest of the step and the next one of BDF have order 1, h^2 in
 * the sum. */
static void multistep_methods_begin_anew_on_their_grid(void)
{
  static const char *const methods[] = {"be", "bdf:p=2", "bdf:p=4", "glm:ab,p=2"};
  static const double ratio[] = {2, 4, 4, 4};
  steif_problem p = watched_problem(1, quarter);
  p.handle_event = refill, p.t1 = 3;
  steif_context *ctx = steif_context_new(NULL);
  for (int m = 0; m < 4; m++) {
    double error[2];
    for (int k = 0; k < 2; k++) {
      watched w;
      CHECK(!watched_run(ctx, &p, methods[m], k ? 0.005 : 0.01, &w) && w.count == 3);
      const int last = w.steps - 1;
      CHECK(w.step_t[last] == 3);
      error[k] = fabs(w.step_y[last][1] - exp(4 * log(2) - 3) / 2);
    }
    CLOSE(error[0] / error[1], ratio[m], 0.2);
  }
  steif_context_free(&ctx);
}

/* A charged capacitor and its current: C v' = -i, v = R i; index 1. The current follows. */
static int circuit(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  (void)t, (void)user;
  NV_Ith_S(out, 0) = -NV_Ith_S(y, 1), NV_Ith_S(out, 1) = NV_Ith_S(y, 0) - 4 * NV_Ith_S(y, 1);
  return 0;
}

static int mass(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  SM_ELEMENT_D(E, 0, 0) = 1;
  return 0;
}

static int low(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  (void)t, (void)user;
  *g = NV_Ith_S(y, 0) - 0.5;
  return 0;
}

static int charge(sunrealtype t, N_Vector y, const int *fired, void *user)
{
  (void)t, (void)fired, (void)user;
  NV_Ith_S(y, 0) = 1; /* y2 is left where it was, inconsistent now */
  return STEIF_RESTART;
}

static int settle(steif_context *ctx, const steif_problem *p, sunrealtype t, sunrealtype rtol,
                  N_Vector y, N_Vector yp)
{
  (void)ctx, (void)p, (void)t, (void)rtol;
  NV_Ith_S(y, 1) = NV_Ith_S(y, 0) / 4;
  NV_Ith_S(yp, 0) = -NV_Ith_S(y, 1), NV_Ith_S(yp, 1) = NV_Ith_S(yp, 0) / 4;
  return STEIF_OK;
}

static void algebraic_components_are_settled(void)
{
  static const sunrealtype y0[] = {1, 0.25}, yp0[] = {-0.25, -0.0625};
  static const char *const methods[] = {"radau:s=3", "bdf", "ida", "dirk:hw43",
                                        "dirk:esdirk43"};
  const steif_problem p = {.name = "circuit",
                           .n = 2,
                           .t1 = 7,
                           .y0 = y0,
                           .yp0 = yp0,
                           .f = circuit,
                           .E = mass,
                           .events = 1,
                           .event = low,
                           .handle_event = charge};
  steif_context *ctx = steif_context_new(NULL);
  for (int m = 0; m < 5; m++) {
    steif_options o = steif_defaults();
    o.rtol = o.atol = 1e-9, o.reinitialise = m ? steif_reinitialise : settle;
    steif_solver *s = smooth_open(ctx, &p, methods[m], &o);
    CHECK(!steif_solve_to(s, 7)); /* charged at 4 ln 2 and 8 ln 2 */
    CLOSE(NV_Ith_S(steif_solution(s), 0), exp(-(7 - 8 * log(2)) / 4), 1e-6);
    CLOSE(NV_Ith_S(steif_solution(s), 1), exp(-(7 - 8 * log(2)) / 4) / 4, 1e-6);
    steif_solver_free(&s);
  }
  steif_context_free(&ctx);
}

static int midway(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  (void)y, (void)user;
  *g = t - 5e-4;
  return 0;
}

static double current; /* i_L before the event */
static int open_and_close(sunrealtype t, N_Vector y, const int *fired, void *user)
{
  (void)t, (void)fired, (void)user;
  NV_Ith_S(y, 0) = 5, NV_Ith_S(y, 1) = 1; /* charged anew while the switch was open */
  current = NV_Ith_S(y, 2);
  return STEIF_RESTART;
}

/* Joined again, both capacitors are at (2 5 + 3 1)/5 = 2.6 V (switchrlc.c); e = V - R i_L. */
static void linear_problems_jump(void)
{
  static const char *const methods[] = {"radau:s=3", "bdf"};
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  CU_ASSERT_FATAL(!steif_problem_find(ctx, "switchrlc:v1=2,v2=2", &p));
  p.events = 1, p.event = midway, p.handle_event = open_and_close;
  for (int m = 0; m < 2; m++) {
    steif_options o = steif_defaults();
    o.reinitialise = steif_reinitialise, o.rtol = o.atol = 1e-8;
    steif_solver *s = smooth_open(ctx, &p, methods[m], &o);
    int code = steif_solve_step(s);
    while (!code && steif_time(s) < 5e-4) code = steif_solve_step(s);
    CHECK(!code);
    const double *x = N_VGetArrayPointer(steif_solution(s));
    CLOSE(steif_time(s), 5e-4, 1e-15);
    CLOSE(x[0], 2.6, 1e-12);
    CLOSE(x[1], 2.6, 1e-12);
    CHECK(fabs(current) > 1e-3);
    CLOSE(x[2], current, 1e-12);
    CLOSE(x[3], 6 - 10 * x[2], 1e-12);
    CHECK(!steif_solve_to(s, p.t1));
    steif_solver_free(&s);
  }
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

static int below_level(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  (void)t;
  *g = NV_Ith_S(y, 1) - *(const sunrealtype *)user;
  return 0;
}

static int halve_level(sunrealtype t, N_Vector y, const int *fired, void *user)
{
  (void)t, (void)y;
  CHECK(fired[0] == -1);
  *(sunrealtype *)user /= 2;
  return STEIF_RESTART;
}

/* y2 = exp(-t) falls below 1/2, and then below the next half, since that is what the handler makes of g; the change of g
 * itself is no crossing. */
static void levels_may_be_moved_by_the_handler(void)
{
  static const char *const methods[] = {"radau:s=3", "bdf", "rodas4", "cvode", "arkode"};
  steif_context *ctx = steif_context_new(NULL);
  for (int m = 0; m < 5; m++) {
    sunrealtype level = 0.5;
    steif_problem p = watched_problem(1, below_level);
    p.handle_event = halve_level, p.user = &level, p.t1 = 3;
    watched w;
    CHECK(!watched_run(ctx, &p, methods[m], 0, &w));
    CHECK(w.count == 4);
    for (int k = 0; k < w.count; k++) CLOSE(w.t[k], (k + 1) * log(2), 1e-5);
  }
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_reactions[] = {
  {"a state is changed and shown from both sides",
   a_state_is_changed_and_shown_from_both_sides},
  {"a reaction may end the run", a_reaction_may_end_the_run},
  {"levels may be moved by the handler", levels_may_be_moved_by_the_handler},
  {"sliding along a surface is said", sliding_is_said},
  {"bounces without end are said", bounces_without_end_are_said},
  {"nothing falls through the floor", nothing_falls_through_the_floor},
  {"wrong reactions are refused", wrong_reactions_are_refused},
  {"multistep methods begin anew on their grid", multistep_methods_begin_anew_on_their_grid},
  {"algebraic components are settled", algebraic_components_are_settled},
  {"linear problems jump", linear_problems_jump},
  CU_TEST_INFO_NULL};
