/* test_low_orders.c: unknowns that a method has to a few digits only are not shown, integrated or differentiated.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fixture.h"
#include <math.h>
#include <steif/gradient.h>
#include <steif/quadrature.h>

/* x = A sin(w t), lam = m A w cos(w t) + A sin(w t), of index 2. */
static const char forced[] =
  "param A = 1.2, w = 2, m = 0.5\nstate x = 0, lam\nm*x' = -x + lam\n"
  "0 = x - A*sin(w*t)\ntime 0 to 3\n";

static int last(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  (void)t, (void)user;
  g[0] = NV_Ith_S(y, NV_LENGTH_S(y) - 1);
  return 0;
}

static int first(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  (void)t, (void)user;
  g[0] = NV_Ith_S(y, 0);
  return 0;
}

/* dJ/dA of what `functional` says; NAN: refused as unsupported. */
static double by_amplitude(fixture *s, const char *method, double rtol,
                           const steif_functional *functional)
{
  steif_options o = steif_defaults();
  o.rtol = rtol;
  steif_gradient g = {0};
  const int code = steif_gradient_find(s->ctx, &s->p, method, &o, functional, &g);
  CHECK(code == STEIF_OK || code == STEIF_UNSUPPORTED);
  const double d = code ? NAN : g.dp[0];
  steif_gradient_free(s->ctx, &g);
  return d;
}

static void gradients_of_ends_and_integrals(void)
{
  static const char *const poor[] = {"dirk:hw43", "gauss:s=2", "gauss:s=3"};
  static const char *const good[] = {"radau:s=3", "radau:s=5", "bdf"};
  const steif_functional lam = {.count = 1, .end = last}, x = {.count = 1, .end = first},
                         sum = {.count = 1, .integrand = last};
  const double dlam = 0.5 * 2 * cos(6) + sin(6), dx = sin(6),
               dsum = 0.5 * sin(6) + (1 - cos(6)) / 2;
  fixture s;
  CU_ASSERT_FATAL(!fixture_text(&s, forced, ""));
  for (int m = 0; m < 3; m++) {
    CHECK(isnan(by_amplitude(&s, poor[m], steif_defaults().rtol, &lam)));
    CLOSE(by_amplitude(&s, poor[m], steif_defaults().rtol, &x), dx, 1e-4);
    CLOSE(by_amplitude(&s, good[m], steif_defaults().rtol, &lam), dlam, 1e-4);
    CLOSE(by_amplitude(&s, good[m], steif_defaults().rtol, &sum), dsum, 1e-4);
  }
  CHECK(isnan(by_amplitude(&s, "dirk:hw43", steif_defaults().rtol, &sum)));
  CLOSE(by_amplitude(&s, "gauss:s=3", steif_defaults().rtol, &sum), dsum,
        1e-3); /* its stages have lam */
  fixture_close(&s);
}

static void integrals_beside_runs(void)
{
  static const steif_quadrature sum = {.count = 1, .value = last},
                                of_x = {.count = 1, .value = first};
  fixture s;
  CU_ASSERT_FATAL(!fixture_text(&s, forced, ""));
  for (int both = 0; both < 2; both++) {
    s.p.quadrature = both ? &of_x : &sum;
    steif_options o = steif_defaults();
    steif_solver *solver = steif_solver_new(s.ctx, &s.p, "dirk:hw43", &o);
    CHECK(solver && steif_solve_to(solver, 3) == (both ? STEIF_OK : STEIF_UNSUPPORTED));
    steif_solver_free(&solver);
  }
  fixture_close(&s);
}

/* lam at times between the steps of two methods with stages of order 2, and of one without. */
static void output_between_steps(void)
{
  static const char *const methods[] = {"dirk:trbdf2", "radau:s=3", "dirk:hw43"};
  fixture s;
  CU_ASSERT_FATAL(!fixture_text(&s, forced, ""));
  for (int m = 0; m < 3; m++) {
    steif_options o = steif_defaults();
    o.recompute = 1;
    steif_solver *solver = steif_solver_new(s.ctx, &s.p, methods[m], &o);
    CU_ASSERT_PTR_NOT_NULL_FATAL(solver);
    const int code = steif_solve_to(solver, 0.75);
    CHECK(code == (m < 2 ? STEIF_OK : STEIF_NOT_CERTIFIED));
    if (m < 2) CLOSE(NV_Ith_S(steif_solution(solver), 1), 1.2 * (cos(1.5) + sin(1.5)), 1e-4);
    steif_solver_free(&solver);
  }
  fixture_close(&s);
}

static int square_and_moment(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  (void)user;
  g[0] = NV_Ith_S(y, 0) * NV_Ith_S(y, 0) + t * NV_Ith_S(y, 0);
  return 0;
}

/* x = 1 - c t down to L at t = 1/c, and 0 from then on with L = b = 0: what an integral of x^2 + t x is by L and b is not in
 * its value. In closed form (T^2 - 1/c^2)/2, and the integral of t (t - 1/c). */
static void integrals_of_what_is_zero(void)
{
  static const char text[] = "param c=0.7, L=0, b=0\nstate x=1\ndiscrete s=0\n"
                             "x'=if s>0.5 then b else -c\nwhen x<L:\n s=1\n x=x+b^2\nend\n"
                             "time 0 to 2.987\n";
  const double T = 2.987, e = 1 / 0.7;
  const steif_functional J = {.count = 1, .integrand = square_and_moment};
  fixture s;
  CU_ASSERT_FATAL(!fixture_text(&s, text, ""));
  steif_options o = steif_defaults();
  steif_gradient g = {0};
  CHECK(steif_gradient_find(s.ctx, &s.p, "bdf", &o, &J, &g) == STEIF_NOT_CERTIFIED);
  steif_gradient_free(s.ctx, &g);
  CHECK(!steif_gradient_find(s.ctx, &s.p, "radau:s=3", &o, &J, &g));
  CLOSE(g.dp[1], (T * T - e * e) / 2, 1e-6);
  CLOSE(g.dp[2], (T * T * T - e * e * e) / 3 - e * (T * T - e * e) / 2, 1e-6);
  steif_gradient_free(s.ctx, &g);
  fixture_close(&s);
}

/* x' = -x + p sin 10 t from x = 0 with p = 0 does not move, and its error test sees nothing: dx(20)/dp in closed form. BDF, of
 * order 1 there, is right or says that it is not. */
static void gradients_of_what_stands_still(void)
{
  static const char *const methods[] = {"auto", "radau:s=3", "dirk:hw43", "gauss:s=3", "bdf"};
  const steif_functional J = {.count = 1, .end = first};
  fixture s;
  CU_ASSERT_FATAL(
    !fixture_text(&s, "param p=0\nstate x=0\nx'=-x+p*sin(10*t)\ntime 0 to 20\n", ""));
  for (int m = 0; m < 5; m++) {
    steif_gradient g = {0};
    const int code = steif_gradient_find(s.ctx, &s.p, methods[m], NULL, &J, &g);
    CHECK(code == STEIF_OK || (m == 4 && code == STEIF_NOT_CERTIFIED));
    if (!code) CLOSE(g.dp[0], (sin(200) - 10 * cos(200) + 10 * exp(-20)) / 101, 1e-4);
    steif_gradient_free(s.ctx, &g);
  }
  fixture_close(&s);
}

/* The same by the start of x' = -x, without parameters and of a DAE: exp(-2). */
static void by_starts_that_stand_still(void)
{
  static const char *const text[] = {"state x=0\nx'=-x\ntime 0 to 2\n",
                                     "state x=0, z=0\nx'=-z\n0=z-x\ntime 0 to 2\n"};
  static const char *const methods[] = {"radau:s=2", "radau:s=3", "dirk:hw43"};
  const steif_functional J = {.count = 1, .end = first};
  for (int k = 0; k < 2; k++)
    for (int m = 0; m < 3; m++) {
      fixture s;
      steif_gradient g = {0};
      CU_ASSERT_FATAL(!fixture_text(&s, text[k], ""));
      CHECK(!steif_gradient_find(s.ctx, &s.p, methods[m], NULL, &J, &g));
      if (g.dy0) CLOSE(g.dy0[0], exp(-2), 1e-3);
      steif_gradient_free(s.ctx, &g);
      fixture_close(&s);
    }
}

/* Backward Euler, of one stage, has lam to its order. */
static void one_stage_is_not_low(void)
{
  const steif_functional lam = {.count = 1, .end = last}, sum = {.count = 1, .integrand = last};
  fixture s;
  CU_ASSERT_FATAL(!fixture_text(&s, forced, ""));
  CLOSE(by_amplitude(&s, "radau:s=1", 1e-3, &lam), 0.5 * 2 * cos(6) + sin(6), 1e-2);
  CLOSE(by_amplitude(&s, "radau:s=1", 1e-3, &sum), 0.5 * sin(6) + (1 - cos(6)) / 2, 1e-2);
  fixture_close(&s);
}

CU_TestInfo tests_of_low_orders[] = {
  {"by starts that stand still", by_starts_that_stand_still},
  {"one stage is not low", one_stage_is_not_low},
  {"gradients of what stands still", gradients_of_what_stands_still},
  {"integrals of what is zero", integrals_of_what_is_zero},
  {"gradients of ends and integrals", gradients_of_ends_and_integrals},
  {"integrals beside runs", integrals_beside_runs},
  {"output between steps", output_between_steps},
  CU_TEST_INFO_NULL};
