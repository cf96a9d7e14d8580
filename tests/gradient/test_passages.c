/* test_passages.c: gradients through events and breaks.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "subjects.h"
#include "base/failing.h"
#include <steif/collection.h>
#include <steif/model.h>
#include <stdbool.h>
#include <string.h>

static const char *const methods[] = {"radau:s=3", "radau:s=5",     "gauss:s=3",
                                      "dirk:hw43", "dirk:esdirk43", "bdf"};
enum { METHODS = sizeof methods / sizeof *methods };

static int ends(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  (void)t, (void)user;
  g[0] = NV_Ith_S(y, 0), g[1] = NV_Ith_S(y, NV_LENGTH_S(y) - 1);
  return 0;
}

static int product(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  (void)user;
  g[0] = NV_Ith_S(y, 0) * NV_Ith_S(y, NV_LENGTH_S(y) - 1) + t;
  return 0;
}

static void found(steif_context *ctx, const steif_problem *p, const char *method,
                  const steif_options *o, const steif_functional *J, steif_gradient *g)
{
  const int code = steif_gradient_find(ctx, p, method, o, J, g);
  if (code) printf("\n  %s: %s", method, steif_message(ctx));
  CU_ASSERT_FATAL(code == STEIF_OK);
}

static void parsed(steif_context *ctx, const char *text, steif_problem *p)
{
  const int code = steif_model_parse(ctx, text, "model", NULL, p);
  if (code) printf("\n  %s", steif_message(ctx));
  CU_ASSERT_FATAL(!code);
}

/* ---- the ball: derivatives by H, g and e of (y, v) at 1 and 2, closed forms in 40 digits ------------ */

static const sunrealtype ball[2][2][3] = {
  {{1.386502226263018, -0.09362872311284219, 2.42944691807002},
   {3.986502226263018, -0.5936287231128422, 4.42944691807002}},
  {{0.4266108641635286, -0.01690816879066987, 2.499324113317087},
   {9.727065432081764, -1.008454084395335, 31.53766205665854}}};

static void balls(const char *name, int first, int checkpoints)
{
  steif_context *ctx = steif_context_new(NULL);
  const steif_functional J = {.count = 2, .end = ends};
  steif_problem p;
  steif_options o = steif_defaults();
  o.rtol = 1e-10;
  CU_ASSERT_FATAL(!steif_problem_find(ctx, name, &p));
  for (int m = 0; m < METHODS; m++)
    for (int i = 0; i < 2; i++) {
      steif_gradient g = {.checkpoints = checkpoints};
      o.t1 = i + 1;
      found(ctx, &p, methods[m], &o, &J, &g);
      for (int j = 0; j < 2; j++) {
        for (int k = first; k < 3; k++)
          CLOSE(g.dp[j * g.parameters + k - first], ball[i][j][k], 1e-8);
        CLOSE(g.dy0[2 * j], ball[i][j][0], 1e-8);
      }
      CHECK((g.cost.recomputed_steps > 0) == (checkpoints > 0));
      steif_gradient_free(ctx, &g);
    }
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

static void balls_bounce(void)
{
  balls("bounce", 0, 0);
  balls("bounce", 0, 3);
  balls(EXAMPLES "/bounce.steif", 1, 0);
}

/* With images the same bits. */
static void images_change_nothing(void)
{
  steif_context *ctx = steif_context_new(NULL);
  const steif_functional J = {.count = 1, .integrand = product, .end = product};
  steif_problem p;
  steif_options o = steif_defaults();
  o.t1 = 2;
  CU_ASSERT_FATAL(!steif_problem_find(ctx, EXAMPLES "/bounce.steif", &p));
  for (int m = 0; m < METHODS; m++) {
    steif_gradient a = {0}, b = {.checkpoints = 4};
    if (!strcmp(methods[m], "bdf")) {
      /* Free flight: BDF of order 2 and more has no error in y, whatever its steps are, but in integrals. */
      CHECK(steif_gradient_find(ctx, &p, "bdf", &o, &J, &a) == STEIF_NOT_CERTIFIED);
      CHECK(strstr(steif_message(ctx), "along its dense output") && !a.value);
      o.h_max = 2e-3;
    }
    found(ctx, &p, methods[m], &o, &J, &a);
    found(ctx, &p, methods[m], &o, &J, &b);
    CHECK(a.value[0] == b.value[0]);
    CHECK(!memcmp(a.dp, b.dp, (size_t)a.parameters * sizeof *a.dp));
    CHECK(!memcmp(a.dy0, b.dy0, 2 * sizeof *a.dy0));
    steif_gradient_free(ctx, &a);
    steif_gradient_free(ctx, &b);
  }
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* ---- forward and back ------------------------------------------------------------------------------- */

/* A nonlinear swing against a wall that moves, with a reaction that is not linear. */
static const char wall[] =
  "param L = 1.2, c = 0.3, r = 0.7, a = 0.1\nstate x = 0.9, u = 0.2*c\n"
  "x' = u\nu' = -9.81/L*sin(x) - c*u*abs(u)\n"
  "when x < -0.4 + a*t*u/10:\n  u = -r*u*(1 + a*x^2)\nend\ntime 0 to 2\n";

/* Forward, integrals take S between stages from dense output, which is that of the stages for collocation only. */
static void forward_and_adjoint_agree(void)
{
  steif_context *ctx = steif_context_new(NULL);
  const steif_quadrature q = {.count = 1, .value = product};
  steif_problem p;
  parsed(ctx, wall, &p);
  for (int m = 0; m < METHODS; m++) {
    steif_options o = steif_defaults();
    o.h = 1.0 / 64, o.newton = 1e-8;
    for (int part = 0; part < 2; part++) {
      const steif_functional J = {
        .count = part ? 1 : 2, .integrand = part ? product : NULL, .end = part ? NULL : ends};
      if (part && !strstr(methods[m], "s=")) continue;
      steif_gradient g = {0};
      p.quadrature = NULL;
      found(ctx, &p, strcmp(methods[m], "bdf") ? methods[m] : "bdf:p=3", &o, &J, &g);
      p.quadrature = &q, o.sensitivities = 1;
      steif_solver *s =
        steif_solver_new(ctx, &p, strcmp(methods[m], "bdf") ? methods[m] : "bdf:p=3", &o);
      CU_ASSERT_FATAL(s && steif_solve_to(s, 2) == STEIF_OK);
      o.sensitivities = 0;
      N_Vector S = N_VClone(steif_solution(s));
      for (int k = 0; k < 4; k++) {
        sunrealtype dq;
        CHECK(!steif_sensitivity(s, 2, k, S) && !steif_quadrature_sensitivity(s, 2, k, &dq));
        if (part) CLOSE_FLOOR(g.dp[k], dq, 1e-9, 1);
        for (int i = 0; i < 2 && !part; i++)
          CLOSE_FLOOR(g.dp[i * 4 + k], NV_Ith_S(S, i), 1e-9, 1);
      }
      N_VDestroy(S);
      steif_solver_free(&s);
      steif_gradient_free(ctx, &g);
    }
  }
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* ---- times that depend on parameters: closed forms ---------------------------------------------------- */

static void at_end(steif_context *ctx, const char *text, sunrealtype expected)
{
  const steif_functional J = {.count = 2, .end = ends};
  steif_problem p;
  steif_options o = steif_defaults();
  o.rtol = 1e-10;
  parsed(ctx, text, &p);
  for (int m = 0; m < METHODS; m++) {
    steif_gradient g = {0};
    found(ctx, &p, methods[m], &o, &J, &g);
    CLOSE(g.dp[0], expected, strcmp(methods[m], "bdf") ? 1e-8 : 1e-6);
    steif_gradient_free(ctx, &g);
  }
  steif_problem_clear(ctx, &p);
}

/* x' = 1 before T, then -x: x(2) = T e^(T-2), by a break and a timer; a heater that a threshold switches, x' = 1
 * until x = c, then x' = -1: x(1) = 2 c - 1; and an assignment of t^2 + c x at x = c: 2 c^2 + 2 (1 - c). */
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
  steif_context *ctx = steif_context_new(NULL);
  at_end(ctx, by_break, 1.7 * exp(-1.3));
  at_end(ctx, by_timer, 1.7 * exp(-1.3));
  at_end(ctx, heater, 2);
  at_end(ctx, assigned, 4 * 0.7 - 2);
  steif_context_free(&ctx);
}

/* ---- runs that an event ends ----------------------------------------------------------------------------- */

static const char passage[] = "model \"pendulum\"\n"
                              "param L = 1, g = 9.81, phi0 = 0.970796326794897, w0 = 0.7\n"
                              "state phi = phi0, w = w0\n"
                              "phi' = w\nw' = -g/L*sin(phi)\n"
                              "when phi < 0: stop \"below\"\ntime 0 to 2\n";

static int one(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  (void)t, (void)y, (void)user;
  g[0] = 1;
  return 0;
}

static int now(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  (void)y, (void)user;
  g[0] = t;
  return 0;
}

static int rate(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  (void)t, (void)user;
  g[0] = NV_Ith_S(y, 1);
  return 0;
}

/* First passage of a pendulum, figures of 60 digits (Taylor series): its time, as an integral of 1 and as t at the
 * end, and the angular velocity there, whose integral is minus the angle at the start. */
static void pendulums_pass(void)
{
  static const sunrealtype tau[] = {0.3537317741004, -0.03605828482165, 0.01415943862228,
                                    0.1247336899326},
                           end[] = {1.421117409939, -0.1448641600345, -2.694104821242,
                                    -0.2329233005685},
                           angle[] = {0, 0, -1, 0};
  const steif_functional J[] = {{.count = 1, .integrand = one},
                                {.count = 1, .end = now},
                                {.count = 1, .end = rate},
                                {.count = 1, .integrand = rate}};
  const sunrealtype *expected[] = {tau, tau, end, angle};
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  steif_options o = steif_defaults();
  o.rtol = 1e-10;
  parsed(ctx, passage, &p);
  for (int m = 0; m < METHODS; m++)
    for (int f = 0; f < 4; f++) {
      steif_gradient g = {0};
      found(ctx, &p, methods[m], &o, &J[f], &g);
      for (int k = 0; k < 4; k++) CLOSE_FLOOR(g.dp[k], expected[f][k], 1e-6, 1);
      steif_gradient_free(ctx, &g);
    }
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* ---- what is refused ------------------------------------------------------------------------------------- */

static void stops(const char *text, const char *method, const char *part)
{
  steif_context *ctx = steif_context_new(NULL);
  const steif_functional J = {.count = 1, .end = one};
  steif_gradient g = {0};
  steif_problem p;
  parsed(ctx, text, &p);
  const int code = steif_gradient_find(ctx, &p, method, NULL, &J, &g);
  const bool said = strstr(steif_message(ctx), part) != NULL;
  CHECK(code == STEIF_UNSUPPORTED && said);
  if (!said) printf("\n  no '%s' in '%s'", part, steif_message(ctx));
  CHECK(!g.value && !g.dp && !g.dy0);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* A ball that comes up to 2e-13 above the ceiling; two balls that hit the ground together, which other starts would
 * not let; a sampled control. */
static void what_has_no_derivative_is_refused(void)
{
  static const char grazes[] = "param c = 0.4999999999998\nstate x = -c, u = 1\n"
                               "x' = u\nu' = -1\nwhen x > 0: u = -u\ntime 0 to 2\n",
                    together[] = "param g = 2\nstate x = 1, u = 0, y = 1, v = 0\n"
                                 "x' = u\nu' = -g\ny' = v\nv' = -g\nwhen x < 0: u = -u\n"
                                 "when y < 0: v = -0.5*v\ntime 0 to 2\n",
                    sampled[] = "param k = 2\nstate x = 1\ndiscrete u = 0\nx' = u\n"
                                "every 0.1: u = -k*x\ntime 0 to 1\n";
  for (int m = 0; m < METHODS; m += 3) {
    stops(together, methods[m], "two events");
    stops(sampled, methods[m], "'u'");
  }
  stops(grazes, "radau:s=3", "grazes");
}

static void second_derivatives_are_refused(void)
{
  steif_context *ctx = steif_context_new(NULL);
  const steif_functional J = {.count = 1, .end = now};
  const sunrealtype v[] = {1, 0, 0};
  steif_problem p;
  CU_ASSERT_FATAL(!steif_problem_find(ctx, "bounce", &p));
  steif_direction *d = steif_direction_new(ctx, &p, v, NULL);
  steif_gradient g = {0};
  sunrealtype Hp[3];
  CHECK(steif_hessian_product(ctx, d, "radau:s=3", NULL, &J, &g, Hp, NULL) ==
        STEIF_UNSUPPORTED);
  CHECK(strstr(steif_message(ctx), "events") != NULL);
  steif_direction_free(&d);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* The k-th request for memory fails, with events and integrals: a code, and nothing is lost. */
static void failing_requests(void)
{
  const steif_functional J = {.count = 1, .integrand = product, .end = rate};
  steif_options o = steif_defaults();
  o.rtol = 1e-4, o.t1 = 0.6;
  for (int images = 0; images < 4; images += 3) {
    bool done = false;
    for (long k = 2; !done && k < 2000; k++) {
      failing f = {.refuse_at = 0};
      const steif_setup setup = failing_setup(&f);
      steif_context *ctx = steif_context_new(&setup);
      steif_problem p;
      CU_ASSERT_FATAL(!steif_problem_find(ctx, "bounce", &p));
      f.served = 0, f.refuse_at = k;
      steif_gradient g = {.checkpoints = images};
      const int code = steif_gradient_find(ctx, &p, "radau:s=3", &o, &J, &g);
      CHECK(code == STEIF_OK || code == STEIF_NO_MEMORY);
      done = code == STEIF_OK && f.served < k;
      steif_gradient_free(ctx, &g);
      steif_problem_clear(ctx, &p);
      steif_context_free(&ctx);
      CHECK(f.alive == 0);
    }
    CHECK(done);
  }
}

CU_TestInfo tests_of_passages[] = {
  {"balls bounce", balls_bounce},
  {"images change nothing", images_change_nothing},
  {"forward and adjoint agree", forward_and_adjoint_agree},
  {"times depend on parameters", times_depend_on_parameters},
  {"pendulums pass", pendulums_pass},
  {"what has no derivative is refused", what_has_no_derivative_is_refused},
  {"second derivatives are refused", second_derivatives_are_refused},
  {"failing requests for memory", failing_requests},
  CU_TEST_INFO_NULL};
