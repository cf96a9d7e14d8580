/* Limits on a run: time by the clock, a flag from outside.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "smooth.h"
#include <time.h>

static int slow(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  (void)user;
  nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
  return smooth.f(t, y, out, NULL);
}

static void the_clock_is_kept(void)
{
  static const char *const methods[] = {"radau:s=3", "cvode", "rk4"};
  steif_problem p = smooth;
  p.f = slow;
  for (int m = 0; m < 3; m++) {
    steif_context *ctx = steif_context_new(NULL);
    steif_options o = steif_defaults();
    o.max_seconds = 0.02, o.h = m == 2 ? 1e-3 : 0, o.rtol = 1e-9;
    steif_solver *s = smooth_open(ctx, &p, methods[m], &o);
    CHECK(steif_solve_to(s, 2) == STEIF_TIME_LIMIT);
    CHECK(strstr(steif_message(ctx), "max_seconds is 0.02: raise it"));
    const double t = steif_time(s);
    CHECK(t > 0.25 && t < 2 && steif_statistics(s)->steps > 0);
    CHECK(steif_solve_to(s, 2) == STEIF_TIME_LIMIT && steif_time(s) > t); /* it goes on */
    steif_solver_free(&s);
    steif_context_free(&ctx);
  }
}

typedef struct button {
  volatile int pressed;
  int steps;
} button;

static int press(steif_solver *s, sunrealtype t, N_Vector y, void *user)
{
  button *b = user;
  (void)s, (void)t, (void)y;
  b->pressed = ++b->steps == 3;
  return 0;
}

static void a_flag_stops_between_steps(void)
{
  static const char *const methods[] = {"radau:s=3", "bdf", "arkode"};
  for (int m = 0; m < 3; m++) {
    steif_context *ctx = steif_context_new(NULL);
    steif_options o = steif_defaults();
    button b = {0};
    o.stop = &b.pressed, o.observe = press, o.observer = &b;
    steif_solver *s = smooth_open(ctx, &smooth, methods[m], &o);
    CHECK(steif_solve_to(s, 2) == STEIF_STOPPED && b.steps == 3);
    CHECK(strstr(steif_message(ctx), "stopped from outside at t = "));
    CHECK(strstr(steif_message(ctx), "after 3 steps"));
    CHECK(steif_solve_step(s) == STEIF_STOPPED && b.steps == 3);
    b.pressed = 0;
    CHECK(!steif_solve_to(s, 2) && steif_time(s) == 2);
    CLOSE_FLOOR(smooth_error(2, steif_solution(s)), 0, 1e-4, 1);
    steif_solver_free(&s);
    steif_context_free(&ctx);
  }
}

static void a_limit_must_be_a_time(void)
{
  steif_options o = steif_defaults();
  o.max_seconds = -1;
  smooth_refused(&smooth, "radau:s=3", &o, STEIF_BAD_INPUT, "max_seconds = -1");
  o.max_seconds = NAN;
  smooth_refused(&smooth, "radau:s=3", &o, STEIF_BAD_INPUT, "max_seconds = nan");
}

/* Of low orders the limit is a matter of order, of others it is not said to be. */
static void a_limit_of_steps_tells_the_order(void)
{
  static const struct {
    const char *method, *says;
    long steps;
  } known[] = {{"glm:nord22", "has order 2", 10000},
               {"bdf:p=2", "has order 2", 10000},
               {"glm:nord22", "loosen the tolerance", 100},
               {"bdf", "loosen the tolerance", 100}};
  for (int i = 0; i < 4; i++) {
    steif_context *ctx = steif_context_new(NULL);
    steif_problem p;
    CU_ASSERT_FATAL(!steif_problem_find(ctx, "vdpol", &p));
    steif_options o = steif_defaults();
    o.rtol = 1e-8, o.max_steps = known[i].steps;
    steif_solver *s = steif_solver_new(ctx, &p, known[i].method, &o);
    CU_ASSERT_FATAL(s != NULL);
    CHECK(steif_solve_to(s, p.t1) == STEIF_STEP_LIMIT);
    CHECK(strstr(steif_message(ctx), known[i].says) != NULL);
    steif_solver_free(&s);
    steif_problem_clear(ctx, &p);
    steif_context_free(&ctx);
  }
}

CU_TestInfo tests_of_limits[] = {
  {"a limit of steps tells the order", a_limit_of_steps_tells_the_order},
  {"the clock is kept", the_clock_is_kept},
  {"a flag stops between steps", a_flag_stops_between_steps},
  {"a limit must be a time", a_limit_must_be_a_time},
  CU_TEST_INFO_NULL};
