/* test_conditions.c: conditions that hang on others, whole parts, what stays at 0 or touches it, against closed solutions.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fixture.h"

/* A sawtooth of time, 100 teeth: half the time. floor of t: k e^{-s}-chains by hand, y_{k+1} = k + (y_k - k) e^{-1/3}. Of a
 * state that grows by 2.5: the integral over y from 0.3 to 25.3 of floor(y) - mod(y, 0.7)/2 is 303.11. */
static void whole_parts_jump_at_events(void)
{
  double y = 0;
  for (int k = 0; k < 30; k++) y = k + (y - k) * exp(-1. / 3);
  fixture_reaches("state x = 0\nx' = mod(10*t, 1)\ntime 0 to 10\n", 5, 1e-7);
  fixture_reaches("state y = 0\ny' = floor(3*t) - y\ntime 0 to 10\n", y, 1e-7);
  fixture_reaches("state x = 0\nx' = floor(-t) + noevent(floor(0.5))\ntime 0 to 4\n", -10,
                  1e-7);
  fixture_reaches(
    "state z = 0, y = 0.3\ny' = 2.5\nz' = floor(y) - 0.5*mod(y, 0.7)\ntime 0 to 10\n", 121.244,
    1e-6);
}

/* 1.2e8 teeth from 0: x is known to 1.9e-9, after a thousand steps to 1e-6, which moves 30 jumps of 0.1 by 2e-6 each. In 7 of
 * time x passes 30 teeth, whose mean is 0.05. */
static void teeth_far_from_zero(void)
{
  fixture_reaches(
    "state z = 0 scale 0.1, x = -12345678\nx' = 3/7\nz' = mod(x, 0.1)\ntime 0 to 7\n", 0.35,
    1e-5);
}

/* Where 3 t - 2.1 changes its sign it is -4.4e-16: t itself decides which side it is. */
static void breaks_are_exact(void)
{
  fixture s;
  CU_ASSERT_FATAL(fixture_text(&s, "state x = 0\nx' = step(3*t - 2.1)\ntime 0 to 3\n", "") ==
                  STEIF_OK);
  N_Vector y = N_VNew_Serial(1, steif_sundials(s.ctx)), f = N_VClone(y);
  CU_ASSERT_FATAL(s.p.break_count == 1);
  const double c = s.p.breaks[0];
  CHECK(!s.p.f(c, y, f, s.p.user) && NV_Ith_S(f, 0) == 1);
  CHECK(!s.p.f(nextafter(c, 0), y, f, s.p.user) && NV_Ith_S(f, 0) == 0);
  N_VDestroy(y), N_VDestroy(f);
  fixture_close(&s);
}

/* Conditions that hang on others: |x| < 1 from -5 does not hold, max(min(x, 3), -2) of -5 is -2; |x| < 1 to and fro over 0
 * and 1; a pulse of 30 %, 50 times, by mod and by a counter: x = (1 - e^-0.06) e^-0.14 (1 + e^-0.2 + ...). */
static void conditions_of_conditions_follow(void)
{
  double x = 0;
  for (int k = 0; k < 50; k++) x = (1 + (x - 1) * exp(-0.06)) * exp(-0.14);
  fixture_reaches("state x = -5\nx' = if abs(x) < 1 then 1 else -1\ntime 0 to 1\n", -6, 1e-8);
  fixture_reaches("state x = -5\nx' = max(min(x, 3), -2)\ntime 0 to 1\n", -7, 1e-8);
  fixture_reaches(
    "state z = 0, x = 5\nx' = -2\nz' = if abs(x) < 1 then 1 else 0\ntime 0 to 5\n", 1, 1e-7);
  fixture_reaches(
    "state z = 0, x = -4\nx' = 1\nz' = if max(abs(x) - 1, -abs(x - 0.5)) < 0 then 1 else 0\n"
    "time 0 to 6\n",
    2, 1e-7);
  fixture_reaches(
    "state x = 0\nx' = 10*((if mod(50*t, 1) < 0.3 then 1 else 0) - x)\ntime 0 to 1\n", x, 1e-7);
  fixture_reaches(
    "state x = 0\ndiscrete k = 0\nlet u = 50*t - k\n"
    "x' = 10*((if abs(u - 0.15) < 0.15 then 1 else 0) - x)\nevery 0.02: k = k + 1\n"
    "time 0 to 1\n",
    x, 1e-7);
}

/* What stays at 0, touches it or is constant in pieces: expected by hand. sign(0) = 0, step(0) = 1, and <= holds there. */
static void plateaus_and_touches(void)
{
  fixture_reaches("state z = 0, x = -1\nx' = 1\nz' = sign(ramp(x))\ntime 0 to 3\n", 2, 1e-7);
  fixture_reaches("state z = 0, x = -1\nx' = 1\nz' = sign(ramp(-x))\ntime 0 to 3\n", 1, 1e-7);
  fixture_reaches("state z = 0, w = 0.1\nw' = 1\nz' = step(ramp(sin(3*w)))\ntime 0 to 3\n", 3,
                  1e-7);
  fixture_reaches("state z = 0\nz' = mod(floor(t), 2)\ntime 0 to 5\n", 2, 1e-7);
  fixture_reaches("state z = 0, x = 0.5\nx' = 1\nz' = mod(floor(x), 2)\ntime 0 to 5\n", 2.5,
                  1e-7);
  fixture_reaches(
    "let source = if t < 1 then 5 else 0\nstate z = 0\nz' = if source > 0 then 1 else 0\n"
    "time 0 to 3\n",
    1, 1e-7);
  fixture_reaches(
    "state z = 0, x = 0\nx' = 1\nz' = if min(x, 1) <= 1 then 1 else 0\ntime 0 to 3\n", 3, 1e-7);
  fixture_reaches("state z = 0, x = 0\nx' = 1\nz' = step(-abs(t - 1)*(2 + x))\ntime 0 to 3\n",
                  0, 1e-7);
  fixture_reaches(
    "state z = 0\nz' = if noevent(floor(t - 0.5)) < 0.5 then 1 else 0\ntime 0 to 3\n", 1.5,
    1e-7);
  fixture_reaches(
    "table f = (0, 1), (1, -1), (2, 1) steps\nstate z = 0\n"
    "z' = (if f(t - 0.25) > 0 then 1 else 0) + sign(sign(step(t - 1)))\ntime 0 to 3\n",
    2 + 2, 1e-7);
  fixture_reaches("state z = 0\nz' = if t - 2 + step(t - 1) < 0 then 1 else 0\ntime 0 to 3\n",
                  1, 1e-7);
  fixture_reaches("state z = 0, v = 0\nv' = cos(2*t)\nz' = sign(v)\ntime 0 to 1.5\n", 1.5,
                  1e-7);
}

/* How often a condition becomes true while x = 0.37 + sin t and z = 0.11 + 1.3 sin 0.61 t: by 4e5 points of these. The
 * parts of a condition cross, touch and leave 0 together: the branch of max stays at 0, that of abs turns there. */
static bool over(double x, double z) { return (void)z, fmax(x, 0) > 0; }
static bool beyond(double x, double z) { return fmin(fmax(x, 0), z + 1) > 0; }
static bool jumped(double x, double z) { return fmax(x, z >= 0) <= 0.38 - z; }
static bool within(double x, double z) { return fabs(fmin(x >= 0, x + z)) < (z + 0.47 >= 0); }
static bool between(double x, double z)
{
  return (fmin(fabs(x), z) > fmax(-0.41, z) ? fmax(-0.72 - z, fabs(x)) : 2 * z >= 0) >=
         2 * z + x;
}

static int rises(bool (*holds)(double x, double z))
{
  enum { POINTS = 400000 };
  int count = 0;
  bool last = holds(0.37, 0.11);
  for (int i = 1; i <= POINTS; i++) {
    const double t = 20. * i / POINTS;
    const bool now = holds(0.37 + sin(t), 0.11 + 1.3 * sin(0.61 * t));
    count += now && !last;
    last = now;
  }
  return count;
}

/* Where x and z are algebraic unknowns, u and v, y' is what the step says at the event. */
static void counted_in_a_dae(const char *condition, int count)
{
  static const char *const methods[] = {"radau:s=3", "bdf", "auto"};
  char text[500];
  double y[8];
  fixture s;
  snprintf(text, sizeof text,
           "state n = 0, X = 0.37, p = 1, Z = 0.11, s = 1, x ~ 0.37, z ~ 0.11\n0 = x - X\n"
           "0 = z - Z\nn' = 0\nX' = p\np' = 0.37 - X\nZ' = 0.793*s\n"
           "s' = -0.61*(Z - 0.11)/1.3\nwhen %s: n = n + 1\ntime 0 to 20\n",
           condition);
  CU_ASSERT_FATAL(fixture_text(&s, text, "") == STEIF_OK);
  for (int k = 0; k < 3; k++) {
    CHECK(fixture_run(&s, methods[k], 1e-8, y) == STEIF_OK);
    CLOSE_FLOOR(y[0], count, 1e-9, 1);
  }
  fixture_close(&s);
}

static void conditions_are_counted_once(void)
{
  static const struct {
    bool (*holds)(double x, double z);
    const char *text;
  } list[] = {{over, "max(x, 0) > 0"},
              {over, "noevent(max(x, 0)) > 0"},
              {jumped, "noevent(max(x, step(z))) <= 0.38 - z"},
              {beyond, "min(max(x, 0), z + 1) > 0"},
              {within, "abs(min(step(x), x + z)) < step(z + 0.47)"},
              {between, "(if min(abs(x), z) > max(-0.41, z) then max(-0.72 - z, abs(x)) else "
                        "step(z + z)) >= z + (z + x)"}};
  for (size_t i = 0; i < sizeof list / sizeof *list; i++) {
    char text[400];
    const int count = rises(list[i].holds);
    CHECK(count > 0);
    snprintf(text, sizeof text,
             "state n = 0, x = 0.37, p = 1, z = 0.11, s = 1\nn' = 0\nx' = p\np' = 0.37 - x\n"
             "z' = 0.793*s\ns' = -0.61*(z - 0.11)/1.3\nwhen %s: n = n + 1\ntime 0 to 20\n",
             list[i].text);
    fixture_reaches(text, count, 1e-9);
    counted_in_a_dae(list[i].text, count);
  }
}

/* What stays at 0 without an event of its own, beside one that crosses: x = sin t + 0.5 is above 0 for 4 pi/3 of 2 pi, in
 * [0, 20] for 13.716814692820414. */
static void plateaus_without_events(void)
{
  const double up = 13.716814692820414;
  static const char *const relation[] = {"<", "<=", ">", ">="};
  const double expected[] = {0, 20 - up, up, 20};
  for (int i = 0; i < 4; i++) {
    char text[400];
    snprintf(text, sizeof text,
             "state y = 0, n = 0, x = 0.5, p = 1, q = 0\nx' = p\np' = 0.5 - x\nn' = 0\n"
             "y' = if noevent(max(x, 0)) %s 0 then 1 else 0\nq' = if x > 0 then 1 else 0\n"
             "when noevent(max(x, 0)) %s 0: n = n + 1\ntime 0 to 20\n",
             relation[i], relation[i]);
    fixture_reaches(text, expected[i], 1e-6);
  }
}

/* The ball of 1 m with e = 0.8 is slower than 0.01 m/s after 28 bounces, 4.42945 0.8^28 = 0.00857; what is true of the
 * speed it leaves with is no reason to stop at the first. It comes down at T + 2 T (e + ... + e^28), T = sqrt(2/g). */
static void a_bounce_is_over_for_other_conditions(void)
{
  static const char *const bounce[] = {"v = -e*v", "\n  h = 0\n  v = -e*v\nend"};
  const double T = sqrt(2 / 9.81);
  double end = T, power = 1;
  for (int k = 1; k <= 28; k++) end += 2 * T * (power *= 0.8);
  for (int i = 0; i < 4; i++) {
    char text[400];
    const char *stop = "when h < 0 and v > -0.01: s = t\n";
    snprintf(
      text, sizeof text,
      "param g = 9.81, e = 0.8\nstate z = 0, h = 1, v = 0\ndiscrete s = 0, over = 0\n"
      "z' = 0\nh' = v\nv' = -g\n%swhen h < 0: %s\n%swhen s > 1 and over < 0.5:\n  z = s\n"
      "  over = 1\nend\ntime 0 to 4.063\n",
      i / 2 ? "" : stop, bounce[i % 2], i / 2 ? stop : "");
    fixture_reaches(text, end, 1e-6);
  }
}

/* From exactly 0: x = 2 - t, n counts; a speed that an assignment has made 0, and friction after that. */
static void what_leaves_zero_fires(void)
{
  fixture_reaches("state k = 0, v = 0\ndiscrete a = 0\nk' = 0\nv' = -a\nat 1: a = 1\n"
                  "when v < 0: k = k + 1\ntime 0 to 2\n",
                  1, 1e-12);
  fixture_reaches(
    "state k = 0, x = 1, v = -1\ndiscrete a = 0, m = 0\nk' = 0\nx' = v\nv' = -a\n"
    "when x < 0: v = 0\nat 2: a = 1\nwhen v < 0 and a > 0.5:\n  k = k + 1\n  a = 0\n"
    "  v = 0\nend\ntime 0 to 3\n",
    1, 1e-12);
}

/* Pulses of one unit, whatever the argument of the table: the integral is their number, in units of the argument. The daily
 * profile has 3 + 2 + 3 + 5 in four hours. */
static void tables_have_events_for_any_argument(void)
{
#define PULSES "table p = (0, 0), (10, 1), (11, 0), (20, 1), (21, 0) steps\nstate e = 0"
  fixture_reaches(PULSES "\ne' = p(t/60)\ntime 0 to 3000\n", 120, 1e-7);
  fixture_reaches(PULSES "\ne' = p(t - 1)\ntime 0 to 50\n", 2, 1e-7);
  fixture_reaches(PULSES "\ne' = p(50 - t)\ntime 0 to 50\n", 2, 1e-7);
  fixture_reaches(PULSES ", x = 0\nx' = 1\ne' = p(x)\ntime 0 to 50\n", 2, 1e-7);
  fixture_reaches(PULSES "\ne' = p(mod(t, 24))\ntime 0 to 240\n", 20, 1e-7);
  fixture_reaches(PULSES ", x[i in 1:5] = i/10\nfor i in 1:5\nx[i]' = 1 + p(x[i])\nend\n"
                         "e' = p(x[3])\ntime 0 to 50\n",
                  1, 1e-7);
  fixture_reaches(
    "table q = (0, 0), (5, 0), (5.05, 4.5), (5.1, 0), (24, 0) linear\nstate e = 0\n"
    "e' = q(mod(t, 24))\ntime 0 to 239\n",
    2.25, 1e-6); /* ten peaks, each far narrower than the steps around it */
  fixture_reaches("table q = (0, 3), (1, 1), (2, 5) linear\nstate e = 0\n"
                  "e' = q(mod(t, 4) - 1)\ntime 0 to 40\n",
                  130, 1e-6);
#undef PULSES
}

/* The lines of events in every order: x = 1 + t passes 2.1, 2.2 and 4.1; 4 whole seconds and two times pass before 4.5. */
static void events_in_any_order(void)
{
  static const char *const line[] = {"when x > 2.2: k = k + 1\n", "at 2.5, 3.5: k = k + 10\n",
                                     "when x > 2.1: k = k + 100\n", "every 1: k = k + 10000\n"};
  for (int order = 0; order < 24; order++) {
    char text[400] = "state k = 0, x = 1\nk' = 0\nx' = 1\n";
    int left[] = {0, 1, 2, 3}, code = order;
    for (int count = 4; count > 0; count--) {
      const int take = code % count;
      code /= count;
      strcat(text, line[left[take]]);
      for (int i = take; i + 1 < count; i++) left[i] = left[i + 1];
    }
    strcat(text, "time 0 to 4.5\n");
    fixture_reaches(text, 40121, 1e-12);
  }
}

/* A sign that is 0 at the start, as that of friction, and one that touches 0 where mod jumps, in algebraic equations. */
static void algebraic_signs_leave_zero(void)
{
  static const char *const methods[] = {"radau:s=3", "auto", "rodas4"};
  fixture s;
  double y[8];
  const char *text[] = {"state z = 0, x = 0, u ~ 0\nx' = 1\nz' = u\n0 = u - sign(mod(x, 0.7))\n"
                        "time 0 to 3\n",
                        "state z = 0, x = 0, u ~ 0\nx' = 1\nz' = u\n0 = u - 3/2*sign(x)\n"
                        "time 0 to 2\n"};
  for (int i = 0; i < 2; i++) {
    CU_ASSERT_FATAL(fixture_text(&s, text[i], "") == STEIF_OK);
    for (int k = 0; k < 3; k++) {
      CHECK(fixture_run(&s, methods[k], 1e-7, y) == STEIF_OK);
      CLOSE_FLOOR(y[0], 3, 1e-5, 1);
    }
    fixture_close(&s);
  }
}

/* What old factors leave of a correction in u, which stays at 1, grew from step to step until steps vanished. */
static void constant_algebraic_unknowns_stay(void)
{
  fixture s;
  steif_options o = steif_defaults();
  o.rtol = 1e-8, o.atol = 1e-9;
  const char *text = "state z = 0, x = -1.29, w = 0.3, u ~ 0\nx' = 1.26 + 1e-9*x^2\nz' = u\n"
                     "w' = 1 + 0.5*cos(t)\n0 = u - 1\ntime 0 to 3\n";
  CU_ASSERT_FATAL(fixture_text(&s, text, "") == STEIF_OK);
  steif_solver *solver = steif_solver_new(s.ctx, &s.p, "bdf", &o);
  CU_ASSERT_FATAL(solver && steif_solve_to(solver, 3) == STEIF_OK);
  CLOSE_FLOOR(NV_Ith_S(steif_solution(solver), 0), 3, 1e-7, 1);
  CHECK(steif_statistics(solver)->steps < 400); /* w, without u, takes about 180 */
  steif_solver_free(&solver);
  fixture_close(&s);
}

CU_TestInfo tests_of_conditions[] = {
  {"whole parts jump at events", whole_parts_jump_at_events},
  {"teeth far from zero", teeth_far_from_zero},
  {"breaks are exact", breaks_are_exact},
  {"conditions of conditions follow", conditions_of_conditions_follow},
  {"conditions are counted once", conditions_are_counted_once},
  {"plateaus without events", plateaus_without_events},
  {"plateaus and touches", plateaus_and_touches},
  {"a bounce is over for other conditions", a_bounce_is_over_for_other_conditions},
  {"what leaves zero fires", what_leaves_zero_fires},
  {"tables have events for any argument", tables_have_events_for_any_argument},
  {"events in any order", events_in_any_order},
  {"algebraic signs leave zero", algebraic_signs_leave_zero},
  {"constant algebraic unknowns stay", constant_algebraic_unknowns_stay},
  CU_TEST_INFO_NULL};
