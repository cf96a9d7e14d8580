/* test_integrands.c: integrals of expressions with kinks and jumps, and their derivatives, forward and back, in closed form.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fixture.h"
#include <math.h>
#include <steif/gradient.h>
#include <steif/quadrature.h>

enum { PARAMETERS = 3, COUNT = 5 };

/* x = 1 - c t to T = 3. With u = c T - 1 the integrals are (1 + u^2)/2c, T b + (1 - b)(1 - L)/c, b c + T - c, 1/2c and
 * (1 - u)/c, x changing its sign at 1/c. */
static const char text[] = "param c = 0.7, L = 0.3, b = 2\nstate x = 1\nx' = -c\ntime 0 to 3\n";
static const char *const expression[COUNT] = {"abs(x)", "if x < L then b else 1",
                                              "if t < c then b else 1", "ramp(x)", "sign(x)"};
static const double value[COUNT] = {2.21 / 1.4, 5, 3.7, 1 / 1.4, -1 / 7.0};
static const double slope[COUNT][PARAMETERS] = {{3.3 / 0.7 - 2.21 / 0.98, 0, 0},
                                                {1 / 0.7, 1 / 0.7, 2},
                                                {1, 0, 0.7},
                                                {-1 / 0.98, 0, 0},
                                                {-2 / 0.49, 0, 0}};

static const char *const methods[] = {"radau:s=3", "gauss:s=2", "dirk:hw43", "bdf"};
static const int backwards =
  3; /* of these; integrals of BDF by steps of y alone are not certified */

static const steif_quadrature all = {
  .count = COUNT, .value = steif_model_integrand_values, .slope = steif_model_integrand_along};

static void forward(fixture *s, const steif_problem *p, const char *method)
{
  double q[COUNT], dq[COUNT];
  steif_options o = steif_defaults();
  o.rtol = 1e-8, o.sensitivities = 1;
  steif_solver *solver = steif_solver_new(s->ctx, p, method, &o);
  CU_ASSERT_PTR_NOT_NULL_FATAL(solver);
  CHECK(!steif_solve_to(solver, p->t1) && !steif_quadrature_values(solver, p->t1, q));
  for (int i = 0; i < COUNT; i++) CLOSE(q[i], value[i], 1e-7);
  for (int k = 0; k < PARAMETERS; k++) {
    CHECK(!steif_quadrature_sensitivity(solver, p->t1, k, dq));
    for (int i = 0; i < COUNT; i++) CLOSE_FLOOR(dq[i], slope[i][k], 1e-7, 1);
  }
  steif_solver_free(&solver);
}

static const steif_problem *asked;

static int slopes(sunrealtype t, N_Vector y, int i, int at_end, N_Vector dy, sunrealtype *dp,
                  void *user)
{
  (void)at_end, (void)user;
  return steif_model_integrand_slopes(asked, t, y, i, dy, dp);
}

static void back(fixture *s, const steif_problem *p, const char *method)
{
  const steif_functional J = {
    .count = COUNT, .integrand = steif_model_integrand_values, .slopes = slopes};
  steif_options o = steif_defaults();
  steif_gradient g = {0};
  o.rtol = 1e-8, asked = p;
  const int code = steif_gradient_find(s->ctx, p, method, &o, &J, &g);
  if (code) printf("\n  %s: %s", method, steif_message(s->ctx));
  CU_ASSERT_FATAL(code == STEIF_OK);
  for (int i = 0; i < COUNT; i++) {
    CLOSE(g.value[i], value[i], 1e-7);
    for (int k = 0; k < PARAMETERS; k++)
      CLOSE_FLOOR(g.dp[i * PARAMETERS + k], slope[i][k], 1e-7, 1);
  }
  steif_gradient_free(s->ctx, &g);
}

static void kinks_and_jumps(void)
{
  fixture s;
  steif_problem p;
  CU_ASSERT_FATAL(!fixture_text(&s, text, ""));
  CU_ASSERT_FATAL(!steif_model_integrands(s.ctx, &s.p, COUNT, expression, &p));
  for (int m = 0; m < 4; m++) {
    steif_problem with = p;
    with.quadrature = &all;
    forward(&s, &with, methods[m]);
    if (m < backwards) back(&s, &p, methods[m]);
  }
  steif_problem_clear(s.ctx, &p);
  fixture_close(&s);
}

/* Of other values of parameters: c = 0.5 makes x(3) = -0.5 and the integral of abs(x) 1.25. */
static void parameters_follow(void)
{
  fixture s;
  steif_problem p;
  CU_ASSERT_FATAL(!fixture_text(&s, text, ""));
  CU_ASSERT_FATAL(!steif_model_integrands(s.ctx, &s.p, 1, expression, &p));
  const steif_quadrature one = {.count = 1, .value = steif_model_integrand_values};
  for (int set = 0; set < 2; set++) {
    double q = 0;
    CHECK(
      !(set ? steif_parameter_set(s.ctx, &p, 0, 0.8) : steif_model_set(s.ctx, &p, "c", 0.5)));
    p.quadrature = &one;
    steif_solver *solver = steif_solver_new(s.ctx, &p, "radau:s=3", NULL);
    CU_ASSERT_PTR_NOT_NULL_FATAL(solver);
    CHECK(!steif_solve_to(solver, 3) && !steif_quadrature_values(solver, 3, &q));
    CLOSE(q, set ? (1 + 1.96) / 1.6 : 1.25, 1e-9);
    steif_solver_free(&solver);
  }
  steif_problem_clear(s.ctx, &p);
  fixture_close(&s);
}

static void refused(const char *of, const char *integrand, const char *word)
{
  fixture s;
  steif_problem p;
  CU_ASSERT_FATAL(!fixture_text(&s, of, ""));
  CHECK(steif_model_integrands(s.ctx, &s.p, 1, &integrand, &p) != STEIF_OK);
  CHECK(strstr(steif_message(s.ctx), word) != NULL);
  fixture_close(&s);
}

static void wrong_expressions(void)
{
  refused(text, "x'", "without slopes");
  refused(text, "x + z", "unknown name 'z'");
  refused(text, "x +", "expected");
  refused("state x = 0, x' = 1\nx'' = -x\ntime 0 to 1\n", "x''^2", "without slopes");
}

CU_TestInfo tests_of_integrands[] = {{"kinks and jumps", kinks_and_jumps},
                                     {"parameters follow", parameters_follow},
                                     {"wrong expressions", wrong_expressions},
                                     CU_TEST_INFO_NULL};
