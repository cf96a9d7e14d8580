/* test_events.c: conditions, kinks and reactions of models, against closed solutions.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fixture.h"

/* h = (1 - t/2)^2, empty at 2: the frozen branch is evaluated below zero. */
static void a_tank_runs_empty(void)
{
  fixture_reaches("state h = 1\nh' = if h > 0 then -sqrt(h) else 0\ntime 0 to 3\n", 0, 1e-7);
}

/* x' = |sin t| has integral 2 over each half period: 2 * 3 over 3 pi; the integrand in y makes it an event
 * of the state. max(c, 0) of c' = -s likewise: integral of the positive half waves of cos over 0 .. 2 pi is 2. */
static void kinks_are_events(void)
{
  fixture_reaches("state x = 0, s = 0, c = 1\nx' = abs(s)\ns' = c\nc' = -s\ntime 0 to 3*pi\n",
                  6, 1e-6);
  fixture_reaches(
    "state x = 0, s = 0, c = 1\nx' = max(c, 0)\ns' = c\nc' = -s\ntime 0 to 2*pi\n", 2, 1e-6);
  fixture_reaches(
    "state x = 0, s = 0, c = 1\nx' = ramp(-c) - min(s, 0)\ns' = c\nc' = -s\ntime 0 to 2*pi\n",
    4, 1e-6);
  fixture_reaches(
    "state x = 0, s = 0, c = 1\nx' = sign(c + 0.5) + step(c - 2)\ns' = c\nc' = -s\ntime "
    "0 to 2*pi\n",
    2 * 3.14159265358979 / 3, 1e-6);
}

/* t^2/2 up to 1, then t: (3^2 - 1)/... of conditions in time alone, which are breaks. */
static void conditions_of_time_are_breaks(void)
{
  fixture s;
  const char *text = "param c = 1\nstate x = 0\nx' = if t < c and t >= 0 then t else 1 + "
                     "step(t - 2*c)\ntime 0 to 3\n";
  CU_ASSERT_FATAL(fixture_text(&s, text, "") == STEIF_OK);
  CHECK(s.p.break_count == 2 && s.p.breaks[0] == 1 && s.p.breaks[1] == 2 && s.p.events == 0);
  fixture_close(&s);
  fixture_reaches(text, 0.5 + 1 + 2, 1e-8);
}

/* A pulse of 1e-3 in 1e3, which steps would pass over. */
static void a_short_pulse_is_seen(void)
{
  fixture_reaches(
    "state x = 0\nx' = -x + (if t > 5 and t < 5.001 then 1e3 else 0)\ntime 0 to 6\n",
    1e3 * (1 - exp(-0.001)) * exp(-0.999), 1e-7);
}

static void times_come(void)
{
  fixture_reaches("state x = 0\nx' = 1\nevery 0.1: x = 0\ntime 0 to 100.05\n", 0.05, 1e-9);
  fixture_reaches("state x = 0\ndiscrete a = 1\nx' = a\nat 3, 1, 2: a = 2*a\ntime 0 to 4\n",
                  1 + 2 + 4 + 8, 1e-9);
  fixture_reaches("param a = 1\nstate x = 0\nx' = a\nevery 1 from 0.5:\n a = a + 1\n x = x + "
                  "1\nend\ntime 0 to 3\n",
                  0.5 + 2 + 3 + 0.5 * 4 + 3, 1e-9);
}

/* At x = 1: x = 0.5, y = 5 at once; k makes x = 5.5, so that x > 1 becomes true again: x = 4.5. */
static void events_cause_events(void)
{
  fixture_reaches("state x = 0, y = 1\ndiscrete k = 0\nx' = 1\ny' = 0\n"
                  "when x > 1:\n x = y - 0.5\n y = x + 4\n k = 1\nend\n"
                  "when k > 0.5: x = x + y\ntime 0 to 2\n",
                  5.5, 1e-8);
}

static void a_condition_true_at_the_start_does_not_fire(void)
{
  fixture_reaches(
    "state x = 5\nx' = -1\nwhen x > 3: x = 100\nwhen x < -1: x = 4\ntime 0 to 7\n", 3 + 100 - 3,
    110);
  fixture s;
  double y[2];
  CU_ASSERT_FATAL(
    fixture_text(
      &s, "state x = 5\nx' = -1\nwhen x > 3: x = 100\nwhen x falling: stop\ntime 0 to 7\n",
      "") == STEIF_OK);
  const int code = fixture_run(&s, "radau:s=3", 1e-8, y);
  CHECK(code == STEIF_OK || code == STEIF_EVENT);
  CLOSE_FLOOR(y[0], 0, 1e-9, 1);
  fixture_close(&s);
}

/* 20 cells with a switch each, in a loop: x_i = i e^-t while it is above 3, then it stays. */
static void switches_in_loops(void)
{
  fixture s;
  double y[20];
  CU_ASSERT_FATAL(fixture_text(&s,
                               "state x[i in 1:20] = i\nfor i in 1:20\n"
                               "x[i]' = if x[i] > 3 then -x[i] else 0\nend\ntime 0 to 1\n",
                               "") == STEIF_OK);
  CHECK(s.p.events == 20);
  CHECK(fixture_run(&s, "radau:s=3", 1e-9, y) == STEIF_OK);
  for (int i = 0; i < 20; i++) {
    const double start = i + 1, wanted = start <= 3 ? start : fmax(3, start * exp(-1));
    CLOSE(y[i], wanted, 1e-7);
  }
  fixture_close(&s);
}

/* Names of events, with what they have become when their functions rise and fall, in the order of the text. */
static void are_named_by_what_they_are(void)
{
  static const char text[] =
    "param n = 2 whole\ntable p = (0, 1), (5, 2), (9, 0) steps\n"
    "state u[i in 1:n] = 0.5, h = 2, v = 0\nfunction lim(w) = if w >= 9 then 9 else w\n"
    "for i in 1:n\n  u[i]' = if not (u[i] - h < 1.5*(v + 1)) then 1 else 0\nend\n"
    "h' = v + 0*p(h) + 0*floor(h)\nv' = -1 + 0*lim(h) + 0*min(h,\n  v) + sign(v)*0\n"
    "when h < 1 or (v>5 and h <= 2): v = v/2\nwhen h - 2*(v) rising: v = v\n"
    "when abs(h) - 3 falling: v = v\nwhen h < 0: stop \"on the ground\"\nat 1, 2: v = v\n"
    "every 3 from 4: v = v\ntime 0 to 9\n";
  static const struct {
    const char *name, *rises, *falls;
  } e[] = {{"u[i] - h < 1.5*(v + 1) (line 6, i = 1)", "false", "true"},
           {"u[i] - h < 1.5*(v + 1) (line 6, i = 2)", "false", "true"},
           {"p(h) (line 8)", "changes", "changes"},
           {"floor(h) (line 8)", "changes", "changes"},
           {"w >= 9 (line 4)", "true", "false"},
           {"min(h, v) (line 9)", "rising", "falling"},
           {"sign(v) (line 10)", "falling", "rising"}, /* g = -v, and v */
           {"sign(v) (line 10)", "rising", "falling"},
           {"h < 1 (line 11)", "false", "true"},
           {"v>5 (line 11)", "false", "true"},
           {"h <= 2 (line 11)", "true", "false"},
           {"h - 2*(v) (line 12)", "falling", "rising"},
           {"on the ground", "false", "true"}, /* and where abs(h) has its kink */
           {"abs(h) - 3 (line 13)", "rising", "falling"},
           {"at 1, 2 (line 15)", "time", "time"},
           {"every 3 from 4 (line 16)", "time", "time"}};
  const int count = sizeof e / sizeof *e;
  fixture s;
  CU_ASSERT_FATAL(!fixture_text(&s, text, ""));
  CU_ASSERT_EQUAL_FATAL(s.p.events, count);
  for (int i = 0; i < count; i++) {
    CU_ASSERT_STRING_EQUAL(s.p.event_list[i].name, e[i].name);
    CU_ASSERT_STRING_EQUAL(steif_model_turn(&s.p, i, 1), e[i].rises);
    CU_ASSERT_STRING_EQUAL(steif_model_turn(&s.p, i, -1), e[i].falls);
  }
  CHECK(!steif_model_turn(&s.p, count, 1) && !steif_model_turn(&s.p, -1, 1));
  fixture_close(&s);
}

/* Event k is at the number that is written k/10, and at none beside it. */
static int is_where_it_is_written(steif_solver *solver, sunrealtype t, N_Vector y,
                                  const int *fired, void *user)
{
  (void)solver, (void)y, (void)fired;
  CHECK(t == ++*(int *)user / 10.0);
  return 0;
}

static void times_are_as_written(void)
{
  fixture s;
  int count = 0;
  CU_ASSERT_FATAL(
    !fixture_text(&s, "state x = 0\nx' = 1\nevery 0.1: x = 0\ntime 0 to 40.05\n", ""));
  steif_options o = steif_defaults();
  o.on_event = is_where_it_is_written;
  o.observer = &count;
  steif_solver *solver = steif_solver_new(s.ctx, &s.p, "bdf", &o);
  CU_ASSERT_PTR_NOT_NULL_FATAL(solver);
  CHECK(!steif_solve_to(solver, 40.05));
  CHECK(count == 400);
  steif_solver_free(&solver);
  fixture_close(&s);
}

/* The current i at t: as the method leaves it, or recomputed from what it must fulfil. */
static double current_at(fixture *s, const char *method, double rtol, int recompute, double *y)
{
  steif_options o = steif_defaults();
  o.rtol = rtol;
  o.recompute = recompute;
  steif_solver *solver = steif_solver_new(s->ctx, &s->p, method, &o);
  CU_ASSERT_PTR_NOT_NULL_FATAL(solver);
  CHECK(steif_solve_to(solver, s->p.t1) == STEIF_OK);
  for (int i = 0; i < 3; i++) y[i] = NV_Ith_S(steif_solution(solver), i);
  steif_solver_free(&solver);
  return y[2];
}

/* A capacitor whose charge has a corner in its voltage u = sin t, index 2: q = u up to 0.2 and 3 u - 0.4 from there on, and
 * the current i = q' jumps from cos t to 3 cos t. What methods keep of the matrices of the old branch is worth nothing on
 * the new one. Recomputed, i has the accuracy of u and q. As the steps leave it, it has an order of its own: none at all
 * for Gauss methods of two stages (Hairer and Wanner II, table VII.4.1: s - 2 for even s), a low one for dirk. */
static void a_corner_of_a_constraint_is_crossed(void)
{
  static const char *const methods[] = {
    "auto",      "bdf",     "radau:s=2", "radau:s=3",     "radau:s=5",   "radau:s=7",
    "gauss:s=3", "rodas4p", "bdf:p=3",   "dirk:esdirk43", "dirk:trbdf2", "gauss:s=2"};
  static const double rtols[] = {1e-4, 1e-6, 1e-8};
  fixture s;
  double y[3];
  CU_ASSERT_FATAL(!fixture_text(&s,
                                "state u = 0, q = 0, i\nq' = i\n"
                                "0 = q - (if u > 0.2 then 3*u - 0.4 else u)\n0 = u - sin(t)\n"
                                "time 0 to 1\n",
                                ""));
  for (int m = 0; m < 12; m++)
    for (int k = 0; k < 6; k++) {
      const double rtol = rtols[k % 3], t = k < 3 ? 1 : 7, u = sin(t), q = 3 * u - 0.4,
                   i = 3 * cos(t);
      s.p.t1 = t;
      CLOSE_FLOOR(current_at(&s, methods[m], rtol, 1, y), i, 10 * rtol, 1);
      const double raw = current_at(&s, methods[m], rtol, 0, y);
      if (m < 11) CLOSE_FLOOR(raw, i, (m < 9 ? 100 : 2000) * rtol, 1);
      CLOSE_FLOOR(y[0], u, 10 * rtol, 1);
      CLOSE_FLOOR(y[1], q, 10 * rtol, 1);
    }
  fixture_close(&s);
}

/* A pendulum of index 3 strikes a wall: x = sin a, y = -cos a, a'' = -g sin a, radau:s=7 and gauss:s=5 at 1e-12. */
static void a_pendulum_strikes_a_wall(void)
{
  static const char *const methods[] = {"auto", "bdf", "radau:s=3", "radau:s=5"};
  static const double rtols[] = {1e-4, 1e-6, 1e-8};
  const double a = 0.429682865137, w = 0.446285262324;
  fixture s;
  double y[5];
  CU_ASSERT_FATAL(!fixture_text(&s,
                                "state x ~ 1, y = 0, u ~ 0, v = 0, lam\nx' = u\ny' = v\n"
                                "u' = -lam*x\nv' = -lam*y - 9.81\n0 = x^2 + y^2 - 1\n"
                                "when x < 0.3:\n u = -0.7*u\n v = -0.7*v\nend\ntime 0 to 3\n",
                                ""));
  for (int m = 0; m < 4; m++)
    for (int k = 0; k < 3; k++) {
      CHECK(fixture_run(&s, methods[m], rtols[k], y) == STEIF_OK);
      CLOSE_FLOOR(y[0], sin(a), 10 * rtols[k], 1);
      CLOSE_FLOOR(y[1], -cos(a), 10 * rtols[k], 1);
      CLOSE_FLOOR(y[2], w * cos(a), 20 * rtols[k], 1);
    }
  fixture_close(&s);
}

/* Infinitely many bounces in a finite time, with and without drag: whatever the method and the tolerance, the ball
 * never falls through the ground, and the run ends near the time that the sum of the bounces has. */
static void a_ball_does_not_sink_into_the_ground(void)
{
  static const char *const methods[] = {"auto", "radau:s=3", "dopri87", "bdf", "cvode"};
  static const double rtols[] = {1e-4, 1e-6, 1e-7, 1e-8, 1e-10};
  static const char *const values[] = {":e=0.5,c=0", ":e=0.7,c=0.02", ":e=0.8,c=0.1"};
  const char *text =
    "param e = 0.7, c = 0.02, g = 9.81\nstate h = 1.5, v = 0, x = 0, u = 3\n"
    "let w = sqrt(u^2 + v^2)\nh' = v\nv' = -g - c*w*v\nx' = u\nu' = -c*w*u\n"
    "when h < 0:\n u = u - 0.2*(1 + e)*abs(v)*sign(u)\n v = -e*v\nend\ntime 0 to 8\n";
  for (int k = 0; k < 3; k++) {
    fixture s;
    CU_ASSERT_FATAL(!fixture_text(&s, text, values[k]));
    for (int m = 0; m < 5; m++)
      for (int r = 0; r < 5; r++) {
        steif_options o = steif_defaults();
        o.rtol = rtols[r];
        steif_solver *solver = steif_solver_new(s.ctx, &s.p, methods[m], &o);
        CHECK(steif_solve_to(solver, 8) == STEIF_STEP_SIZE);
        CHECK(strstr(steif_message(s.ctx), "crowd together") != NULL);
        CHECK(NV_Ith_S(steif_solution(solver), 0) > -1e-9);
        if (k == 0) CHECK(fabs(steif_time(solver) - 3 * sqrt(3 / 9.81)) < 0.05);
        steif_solver_free(&solver);
      }
    fixture_close(&s);
  }
}

/* Without loss it bounces for ever from the same height, and the ground stays where it is: after the n-th bounce
 * the time is (2n + 1) sqrt(2 h/g). */
static void a_thousand_bounces_find_the_ground_where_it_is(void)
{
  fixture s;
  double y[2];
  CU_ASSERT_FATAL(!fixture_text(&s,
                                "state h = 0.5, v = 0\ndiscrete n = 0\nh' = v\nv' = -1\n"
                                "when h < 0:\n v = -v\n n = n + 1\nend\n"
                                "when n > 999.5: stop \"enough\"\ntime 0 to 3000\n",
                                ""));
  steif_options o = steif_defaults();
  o.rtol = 1e-10;
  steif_solver *solver = steif_solver_new(s.ctx, &s.p, "radau:s=3", &o);
  CHECK(steif_solve_to(solver, 3000) == STEIF_EVENT);
  CLOSE_FLOOR(steif_time(solver), 1999, 1e-11, 1);
  y[0] = NV_Ith_S(steif_solution(solver), 0);
  CHECK(fabs(y[0]) < 1e-11);
  steif_solver_free(&solver);
  fixture_close(&s);
}

CU_TestInfo tests_of_events[] = {
  {"a ball does not sink", a_ball_does_not_sink_into_the_ground},
  {"a thousand bounces", a_thousand_bounces_find_the_ground_where_it_is},
  {"a tank runs empty", a_tank_runs_empty},
  {"a pendulum strikes a wall", a_pendulum_strikes_a_wall},
  {"a corner of a constraint", a_corner_of_a_constraint_is_crossed},
  {"kinks", kinks_are_events},
  {"conditions of time", conditions_of_time_are_breaks},
  {"a short pulse", a_short_pulse_is_seen},
  {"at and every", times_come},
  {"times as they are written", times_are_as_written},
  {"events cause events", events_cause_events},
  {"true at the start", a_condition_true_at_the_start_does_not_fire},
  {"switches in loops", switches_in_loops},
  {"are named by what they are", are_named_by_what_they_are},
  CU_TEST_INFO_NULL};
