/* Nonlinear experiments with known figures: van der Pol's oscillator (mu = 10), where backward
 * Euler's equation has several roots at large steps, the pendulum, and the harmonic oscillator.
 * Reference figures: recomputation of the book chapter's experiments (numpy, scipy, mpmath).
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"
#include <nvector/nvector_serial.h>
#include <steif/steif.h>
#include <string.h>

/* End value at t1 with equal steps h; NAN in both when the run failed. */
static int end(steif_context *ctx, const char *problem, const char *method, double h, double t1,
               double y[2])
{
  steif_problem p;
  steif_options o = steif_defaults();
  o.h = h, o.t1 = t1;
  y[0] = y[1] = NAN;
  int code = steif_problem_find(ctx, problem, &p);
  if (code) return code;
  steif_solver *s = steif_solver_new(ctx, &p, method, &o);
  code = s ? steif_solve_to(s, t1) : steif_status(ctx);
  if (!code) y[0] = NV_Ith_S(steif_solution(s), 0), y[1] = NV_Ith_S(steif_solution(s), 1);
  steif_solver_free(&s);
  steif_problem_clear(ctx, &p);
  return code;
}

static void backward_euler_follows_the_nearest_root(void)
{
  steif_context *ctx = steif_context_new(NULL);
  double y[2];
  CHECK(!end(ctx, "vdpol:mu=10", "be", 0.005, 50, y));
  CLOSE(y[0], -1.6373497471, 1e-8);
  CLOSE(y[1], 0.0966848201, 1e-8);
  CHECK(!end(ctx, "vdpol:mu=10", "be", 0.05, 50, y));
  CLOSE(y[0], -1.6038949137, 1e-8);
  CLOSE(y[1], 0.1011119250, 1e-8);
  CHECK(!end(ctx, "vdpol:mu=30", "be", 0.005, 50, y));
  CLOSE(y[0], 1.8456569816, 1e-8);
  CLOSE(y[1], -0.0255564585, 1e-8);
  steif_context_free(&ctx);
}

/* With h = 0.2 the cubic of a step has three real roots in most steps and none near in some: a
 * method that accepts a stalled iteration locks onto a spurious oscillation. */
static void a_stalled_iteration_is_refused(void)
{
  steif_context *ctx = steif_context_new(NULL);
  double y[2];
  CHECK(end(ctx, "vdpol:mu=10", "be", 0.2, 50, y) == STEIF_NO_CONVERGENCE);
  CHECK(strstr(steif_message(ctx), "t = ") && strstr(steif_message(ctx), "h = 0.2"));
  steif_context_free(&ctx);
}

static void rk4_loses_van_der_pol_beyond_its_limit(void)
{
  steif_context *ctx = steif_context_new(NULL);
  double y[2];
  CHECK(!end(ctx, "vdpol:mu=10", "rk4", 0.005, 50, y));
  CLOSE(y[0], -1.83790745, 1e-8);
  CLOSE(y[1], 0.07704401, 1e-6);
  CHECK(!end(ctx, "vdpol:mu=10", "rk4", 0.0500, 50, y));
  CLOSE(y[0], -1.8444585, 1e-7);
  CHECK(end(ctx, "vdpol:mu=10", "rk4", 0.2, 50, y) == STEIF_NOT_FINITE);
  steif_context_free(&ctx);
}

static void pendulum_errors_are_those_of_the_chapter(void)
{
  static const struct {
    const char *method;
    double error[4], tolerance;
  } rows[] = {
    {"gauss:s=1",
     {4.9574815327e-03, 1.2399603018e-03, 3.1002675104e-04, 7.7508976943e-05},
     1e-7},
    {"rk4", {4.4575692708e-06, 2.8930852799e-07, 1.8406173620e-08, 1.1603547290e-09}, 1e-5},
  };
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  CU_ASSERT_FATAL(!steif_problem_find(ctx, "pendulum", &p));
  for (int m = 0; m < 2; m++) {
    steif_order_row row[4];
    CHECK(!steif_order_measure(ctx, &p, rows[m].method, NULL, 0.1, 4, row));
    for (int i = 0; i < 4; i++) CLOSE(row[i].error, rows[m].error[i], rows[m].tolerance);
  }
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

static void oscillator_errors_are_those_of_the_chapter(void)
{
  static const struct {
    const char *method;
    double error[5], tolerance;
  } rows[] = {
    {"gauss:s=1",
     {1.2449463422e-03, 3.1159688509e-04, 7.7921774860e-05, 1.9481853861e-05, 4.8705516079e-06},
     1e-8},
    {"rk4",
     {1.2350590929e-06, 7.7629534759e-08, 4.8622985777e-09, 3.0416906494e-10, 1.9018689e-11},
     1e-5},
    {"gauss:s=2",
     {2.0768775660e-07, 1.2986282966e-08, 8.1173355537e-10, 5.0734999e-11, 3.1707e-12},
     1e-4},
  };
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  CU_ASSERT_FATAL(!steif_problem_find(ctx, "harmonic", &p));
  for (int m = 0; m < 3; m++) {
    steif_order_row row[5];
    CHECK(!steif_order_measure(ctx, &p, rows[m].method, NULL, 0.1, 5, row));
    for (int i = 0; i < 5; i++)
      CLOSE(row[i].error, rows[m].error[i], rows[m].error[i] > 1e-9 ? 1e-6 : rows[m].tolerance);
  }
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_nonlinear[] = {
  {"backward Euler follows the nearest root", backward_euler_follows_the_nearest_root},
  {"a stalled iteration is refused", a_stalled_iteration_is_refused},
  {"RK4 loses van der Pol beyond its limit", rk4_loses_van_der_pol_beyond_its_limit},
  {"pendulum errors are those of the chapter", pendulum_errors_are_those_of_the_chapter},
  {"oscillator errors are those of the chapter", oscillator_errors_are_those_of_the_chapter},
  CU_TEST_INFO_NULL};
