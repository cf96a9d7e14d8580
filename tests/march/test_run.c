/* A run and its ends: observers, limits, failures, times asked for.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "smooth.h"

typedef struct watch {
  int calls, stop_at;
  double last;
} watch;

static int look(steif_solver *s, sunrealtype t, N_Vector y, void *user)
{
  watch *w = user;
  w->calls++;
  CHECK(t > w->last && t == steif_time(s) && y == steif_solution(s));
  CHECK(steif_statistics(s)->steps == w->calls);
  w->last = t;
  return w->calls == w->stop_at;
}

static void an_observer_sees_every_step_and_may_stop(void)
{
  static const char *const methods[] = {"radau:s=3", "bdf:p=4", "cvode"};
  for (int m = 0; m < 3; m++) {
    steif_context *ctx = steif_context_new(NULL);
    steif_options o = steif_defaults();
    watch w = {.stop_at = 5};
    o.observe = look, o.observer = &w;
    steif_solver *s = smooth_open(ctx, &smooth, methods[m], &o);
    CHECK(steif_solve_to(s, 2) == STEIF_CALLBACK);
    CHECK(w.calls == 5 && steif_time(s) == w.last);
    CHECK(strstr(steif_message(ctx), "the observer stopped the run at t = "));
    CHECK(!steif_solve_to(s, 2)); /* no failure: the run may go on */
    CHECK(w.calls > 5 && steif_statistics(s)->steps == w.calls && w.last == 2);
    steif_solver_free(&s);
    steif_context_free(&ctx);
  }
}

static int stumble(steif_solver *s, sunrealtype t, N_Vector y, void *user)
{
  (void)t;
  return steif_dense(s, 77, y) && *(int *)user;
}

/* A failure within the observer is told, not replaced; where it goes on, the run does. */
static void a_failure_of_the_observer_is_kept(void)
{
  for (int stops = 0; stops < 2; stops++) {
    steif_context *ctx = steif_context_new(NULL);
    steif_options o = steif_defaults();
    o.observe = stumble, o.observer = &stops;
    steif_solver *s = smooth_open(ctx, &smooth, "radau:s=3", &o);
    CHECK(steif_solve_to(s, 2) == (stops ? STEIF_BAD_INPUT : STEIF_OK));
    CHECK(!stops || strstr(steif_message(ctx), "77") != NULL);
    steif_solver_free(&s);
    steif_context_free(&ctx);
  }
}

static void the_limit_of_steps_is_kept(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_options o = steif_defaults();
  for (int chosen = 0; chosen < 2; chosen++) {
    o.max_steps = 7, o.h = chosen ? 0 : 0.01;
    steif_solver *s = smooth_open(ctx, &smooth, "radau:s=2", &o);
    CHECK(steif_solve_to(s, 2) == STEIF_STEP_LIMIT);
    CHECK(steif_statistics(s)->steps == 7);
    CHECK(strstr(steif_message(ctx), "7 steps made at t = ") &&
          strstr(steif_message(ctx), "raise max_steps"));
    steif_solver_free(&s);
    o.max_steps = 175, o.h = 0.01;
    s = smooth_open(ctx, &smooth, "radau:s=2", &o);
    CHECK(!steif_solve_to(s, 2)); /* as many as allowed */
    steif_solver_free(&s);
  }
  steif_context_free(&ctx);
}

static int stop_at(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  if (t > *(double *)user) return -9;
  return smooth.f(t, y, out, NULL);
}

static void a_failure_is_final(void)
{
  static const char *const methods[] = {"radau:s=3", "be", "rk4", "bdf:p=3", "cvode"};
  static const double h[] = {0.01, 0.01, 0.01, 0, 0};
  double limit = 1.1;
  steif_problem p = smooth;
  p.f = stop_at, p.user = &limit;
  for (int m = 0; m < 5; m++) {
    steif_context *ctx = steif_context_new(NULL);
    steif_options o = steif_defaults();
    o.h = h[m];
    steif_solver *s = smooth_open(ctx, &p, methods[m], &o);
    CHECK(steif_solve_to(s, 2) == STEIF_CALLBACK);
    CHECK(strstr(steif_message(ctx), "-9") != NULL);
    const double reached = steif_time(s), y = NV_Ith_S(steif_solution(s), 0);
    const long steps = steif_statistics(s)->steps;
    CHECK(reached > 0.9 && reached <= 1.1);
    steif_forget(ctx), limit = 7; /* f would serve now: the run does not go on all the same */
    CHECK(steif_solve_to(s, 2) == STEIF_CALLBACK && steif_solve_step(s) == STEIF_CALLBACK);
    CHECK(strstr(steif_message(ctx), "failed before") &&
          strstr(steif_message(ctx), "-9") != NULL); /* the first sentence is in the second */
    CHECK(steif_time(s) == reached && NV_Ith_S(steif_solution(s), 0) == y);
    CHECK(steif_statistics(s)->steps == steps);
    limit = 1.1;
    steif_solver_free(&s);
    steif_context_free(&ctx);
  }
}

static void times_outside_are_refused(void)
{
  static const double bad[] = {0.2, 2.0001, NAN, INFINITY, -INFINITY};
  static const char *const methods[] = {"radau:s=3", "cvode"};
  for (int m = 0; m < 2; m++) {
    steif_context *ctx = steif_context_new(NULL);
    steif_solver *s = smooth_open(ctx, &smooth, methods[m], NULL);
    for (int i = 0; i < 5; i++) {
      CHECK(steif_solve_to(s, bad[i]) == STEIF_BAD_INPUT);
      CHECK(strstr(steif_message(ctx), "outside the interval [0.25, 2]"));
    }
    CHECK(steif_time(s) == 0.25 && steif_statistics(s)->steps == 0);
    CHECK(!steif_solve_to(s, 0.25) && steif_statistics(s)->steps == 0);
    CHECK(!steif_solve_to(s, 2 * (1 + 4e-15))); /* the end, a little rounded */
    CHECK(steif_time(s) == 2 && steif_status(ctx) == STEIF_OK);
    CHECK(steif_solve_to(s, 0.26) == STEIF_BAD_INPUT); /* before the last step */
    CHECK(strstr(steif_message(ctx), "outside the last step"));
    steif_solver_free(&s);
    steif_context_free(&ctx);
  }
}

/* The same run asked for in pieces takes the same steps. */
static void asking_does_not_move_the_steps(void)
{
  static const char *const methods[] = {"radau:s=3", "dirk:trbdf2", "bdf:p=4"};
  steif_context *ctx = steif_context_new(NULL);
  for (int m = 0; m < 3; m++) {
    steif_solver *one = smooth_open(ctx, &smooth, methods[m], NULL),
                 *two = smooth_open(ctx, &smooth, methods[m], NULL);
    CHECK(!steif_solve_to(one, 2));
    for (int k = 1; k <= 35; k++) CHECK(!steif_solve_to(two, 0.25 + 0.05 * k));
    CHECK(steif_statistics(one)->steps == steif_statistics(two)->steps);
    for (int i = 0; i < 2; i++)
      CHECK(NV_Ith_S(steif_solution(one), i) == NV_Ith_S(steif_solution(two), i));
    steif_solver_free(&one), steif_solver_free(&two);
  }
  steif_context_free(&ctx);
}

/* Euler's steps of 0.1 multiply the energy (q^2 + p^2)/2 of the oscillator, 1/2 at the start, by 1.01 each. */
static void drifts_are_from_the_start(void)
{
  steif_context *own = steif_context_new(NULL);
  steif_problem p;
  steif_options o = steif_defaults();
  sunrealtype drift;
  o.h = 0.1;
  CU_ASSERT_FATAL(!steif_problem_find(own, "harmonic", &p) && p.invariants == 1);
  steif_solver *s = steif_solver_new(own, &p, "euler", &o);
  CU_ASSERT_FATAL(s != NULL);
  for (int k = 0; k <= 10; k++) {
    int count = 1;
    CHECK(!steif_drift_now(s, &count, &drift) && count == 1);
    CLOSE_FLOOR(drift, 0.5 * (pow(1.01, k) - 1), 1e-13, 1);
    CHECK(!steif_solve_step(s));
  }
  steif_solver_free(&s);
  steif_problem_clear(own, &p);
  steif_context_free(&own);
}

CU_TestInfo tests_of_run[] = {
  {"an observer sees every step and may stop", an_observer_sees_every_step_and_may_stop},
  {"a failure of the observer is kept", a_failure_of_the_observer_is_kept},
  {"the limit of steps is kept", the_limit_of_steps_is_kept},
  {"a failure is final and keeps its sentence", a_failure_is_final},
  {"times outside the interval are refused", times_outside_are_refused},
  {"asking does not move the steps", asking_does_not_move_the_steps},
  {"drifts are from the start", drifts_are_from_the_start},
  CU_TEST_INFO_NULL};
