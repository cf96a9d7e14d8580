/* test_events.c: S through events and breaks, and the times of events.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "forcing.h"
#include <string.h>

static const char *const methods[] = {"radau:s=3", "radau:s=5",     "gauss:s=3",
                                      "dirk:hw43", "dirk:esdirk43", "bdf"};
enum { METHODS = sizeof methods / sizeof *methods };

/* ---- the ball ------------------------------------------------------------------------------- */

/* Derivatives by H, g and e of (y, v) at 1 and 2, and of the first three impacts: closed forms in 40
 * digits. */
static const sunrealtype ball[2][2][3] = {
  {{1.386502226263018, -0.09362872311284219, 2.42944691807002},
   {3.986502226263018, -0.5936287231128422, 4.42944691807002}},
  {{0.4266108641635286, -0.01690816879066987, 2.499324113317087},
   {9.727065432081764, -1.008454084395335, 31.53766205665854}}};
static const sunrealtype impact[3][3] = {
  {0.2257618204928655, -0.02301343735910963, 0},
  {0.5869807332814502, -0.05983493713368503, 0.9030472819714618},
  {0.875955863512318, -0.08929213695334536, 2.347922933125801}};

struct seen {
  int count;
  sunrealtype tau[8][4];
};

static int note(steif_solver *s, sunrealtype t, N_Vector y, const int *fired, void *user)
{
  struct seen *seen = user;
  (void)t, (void)y, (void)fired;
  for (int k = 0; k < 3 && seen->count < 8; k++)
    CHECK(!steif_sensitivity_event(s, k, &seen->tau[seen->count][k], NULL));
  seen->count++;
  return 0;
}

/* `first`: parameters before the ones that matter are not there; models have g and e, and no H. */
static void bounces(const char *name, const char *method, int first, sunrealtype error)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  steif_options o = steif_defaults();
  struct seen seen = {0};
  sunrealtype S[2];
  CU_ASSERT_FATAL(!steif_problem_find(ctx, name, &p));
  o.rtol = 1e-10, o.sensitivities = 1;
  for (int i = 0; i < 2; i++)
    for (int k = first; k < 3; k++) {
      o.on_event = first ? NULL : note, o.observer = &seen, seen.count = 0;
      o.t1 = i + 1;
      sensitivity_at(ctx, &p, method, &o, k - first, i + 1, S, NULL);
      for (int j = 0; j < 2; j++) CLOSE(S[j], ball[i][j][k], error);
    }
  CHECK(first || seen.count == 3);
  for (int i = 0; i < 3 && !first; i++)
    for (int k = 0; k < 3; k++) CLOSE_FLOOR(seen.tau[i][k], impact[i][k], error, 0.01);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

static void balls_bounce(void)
{
  for (int m = 0; m < METHODS; m++) {
    bounces("bounce", methods[m], 0, 1e-8);
    bounces(EXAMPLES "/bounce.steif", methods[m], 1, 1e-8);
  }
}

/* All bounces are over at 4.0637: S stays bounded, and no run goes beyond. */
static void what_never_ends_is_refused(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  steif_options o = steif_defaults();
  CU_ASSERT_FATAL(!steif_problem_find(ctx, "bounce", &p));
  o.sensitivities = 1, o.t1 = 4.2;
  steif_solver *s = steif_solver_new(ctx, &p, "radau:s=3", &o);
  const int code = steif_solve_to(s, 4.2);
  CHECK(code == STEIF_STEP_SIZE || code == STEIF_UNSUPPORTED);
  CHECK(strstr(steif_message(ctx), "'ground'") && steif_time(s) < 4.0638);
  steif_solver_free(&s);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* ---- models as text ------------------------------------------------------------------------- */

static void parsed(steif_context *ctx, const char *text, steif_problem *p)
{
  const int code = steif_model_parse(ctx, text, "model", NULL, p);
  if (code) printf("\n  %s", steif_message(ctx));
  CU_ASSERT_FATAL(!code);
}

/* First passage of a pendulum, figures of 60 digits (Taylor series): tau, and the angular velocity there. */
static void pendulums_pass(void)
{
  static const char text[] = "model \"pendulum\"\n"
                             "param L = 1, g = 9.81, phi0 = 0.970796326794897, w0 = 0.7\n"
                             "state phi = phi0, w = w0\n"
                             "phi' = w\nw' = -g/L*sin(phi)\n"
                             "when phi < 0: stop \"below\"\ntime 0 to 2\n";
  static const sunrealtype tau[] = {0.3537317741004, -0.03605828482165, 0.01415943862228,
                                    0.1247336899326},
                           rate[] = {1.421117409939, -0.1448641600345, -2.694104821242,
                                     -0.2329233005685};
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  steif_options o = steif_defaults();
  o.rtol = 1e-10, o.sensitivities = 1;
  parsed(ctx, text, &p);
  for (int m = 0; m < METHODS; m++) {
    const sunrealtype error = 1e-6; /* of dense output */
    steif_solver *s = steif_solver_new(ctx, &p, methods[m], &o);
    CU_ASSERT_FATAL(s && steif_solve_to(s, 2) == STEIF_EVENT);
    N_Vector d = N_VClone(steif_solution(s));
    CLOSE(steif_time(s), 0.620149965247908, 1e-8);
    for (int k = 0; k < 4; k++) {
      sunrealtype dt;
      CHECK(!steif_sensitivity_event(s, k, &dt, d));
      CLOSE(dt, tau[k], error);
      CLOSE(NV_Ith_S(d, 1), rate[k], error);
      CLOSE_FLOOR(NV_Ith_S(d, 0), 0, 1e-8, 1);
    }
    N_VDestroy(d);
    steif_solver_free(&s);
  }
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

static void at_end(steif_context *ctx, const char *text, int k, const sunrealtype *expected)
{
  steif_problem p;
  sunrealtype S[4];
  steif_options o = steif_defaults();
  o.rtol = 1e-10, o.sensitivities = 1;
  parsed(ctx, text, &p);
  for (int m = 0; m < METHODS; m++) {
    sensitivity_at(ctx, &p, methods[m], &o, k, p.t1, S, NULL);
    for (sunindextype i = 0; i < p.n; i++)
      CLOSE_FLOOR(S[i], expected[i], strcmp(methods[m], "bdf") ? 1e-8 : 1e-6, 1e-3);
  }
  steif_problem_clear(ctx, &p);
}

/* x' = 1 before T, then -x: x(2) = T e^(T-2), by a break, a timer and a relation; a heater that a threshold
 * switches, x' = 1 until x = c, then x' = -1: x(2) = 2 c - 2; and an assignment of t^2 + c x at x = c. */
static void times_depend_on_parameters(void)
{
  static const char by_break[] = "param T = 0.7\nstate x = 0\nx' = if t < T then 1 else -x\n"
                                 "time 0 to 2\n",
                    by_timer[] = "param T = 0.7\nstate x = 0\ndiscrete on = 1\n"
                                 "x' = on + (on - 1)*x\nat T: on = 0\ntime 0 to 2\n",
                    heater[] = "param c = 0.7\nstate x = 0\ndiscrete on = 1\nx' = on\n"
                               "when x > c: on = -1\ntime 0 to 1\n",
                    assigned[] =
                      "param c = 0.7\nstate x = 0\ndiscrete done = 0\nx' = 1 + done\n"
                      "when x > c and done < 0.5:\n  x = t^2 + c*x\n  done = 1\nend\n"
                      "time 0 to 1\n";
  const sunrealtype moved[] = {1.7 * exp(-1.3)}, two[] = {2}, reset[] = {4 * 0.7 - 2};
  steif_context *ctx = steif_context_new(NULL);
  at_end(ctx, by_break, 0, moved);
  at_end(ctx, by_timer, 0, moved);
  at_end(ctx, heater, 0, two);
  at_end(ctx, assigned, 0, reset); /* x = 2 c^2 + 2 (t - c) */
  steif_context_free(&ctx);
}

/* ---- what is refused ------------------------------------------------------------------------- */

static void stops(const char *text, const char *method, const char *part)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  steif_options o = steif_defaults();
  o.sensitivities = 1, o.rtol = 1e-9;
  parsed(ctx, text, &p);
  steif_solver *s = steif_solver_new(ctx, &p, method, &o);
  int code = s ? steif_solve_to(s, p.t1) : steif_status(ctx);
  const int said = strstr(steif_message(ctx), part) != NULL;
  CHECK(code == STEIF_UNSUPPORTED && said);
  if (!said) printf("\n  no '%s' in '%s'", part, steif_message(ctx));
  steif_solver_free(&s);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* A ball that comes up to 2e-13 above the ceiling; two balls hit the ground together, of different gravity
 * in general; a sampled control is a discrete value with derivatives of its own. */
static void what_has_no_derivative_is_refused(void)
{
  static const char grazes[] = "param c = 0.4999999999998\nstate x = -c, u = 1\n"
                               "x' = u\nu' = -1\nwhen x > 0: u = -u\ntime 0 to 2\n",
                    together[] = "param g = 2, h = 2\nstate x = 1, u = 0, y = 1, v = 0\n"
                                 "x' = u\nu' = -g\ny' = v\nv' = -h\nwhen x < 0: u = -u\n"
                                 "when y < 0: v = -0.5*v\ntime 0 to 2\n",
                    sampled[] = "param k = 2\nstate x = 1\ndiscrete u = 0\nx' = u\n"
                                "every 0.1: u = -k*x\ntime 0 to 1\n",
                    level[] = "param k = 2\nstate x = 1\ndiscrete u = k\nx' = u\n"
                              "when x > 2: u = 0\ntime 0 to 1\n";
  for (int m = 0; m < METHODS; m += 3) {
    stops(together, methods[m], "two events");
    stops(sampled, methods[m], "'u'");
    stops(level, methods[m], "'u'");
  }
  stops(grazes, "radau:s=3", "grazes");
}

CU_TestInfo tests_of_events[] = {
  {"balls bounce", balls_bounce},
  {"what never ends is refused", what_never_ends_is_refused},
  {"pendulums pass", pendulums_pass},
  {"times depend on parameters", times_depend_on_parameters},
  {"what has no derivative is refused", what_has_no_derivative_is_refused},
  CU_TEST_INFO_NULL};
