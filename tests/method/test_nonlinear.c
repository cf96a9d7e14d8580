/* Van der Pol's oscillator with mu = 10, where backward Euler's equation has several roots at large
 * steps.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"
#include <nvector/nvector_serial.h>
#include <steif/analysis.h>
#include <steif/data.h>
#include <steif/linear.h>
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

CU_TestInfo tests_of_nonlinear[] = {
  {"a stalled iteration is refused", a_stalled_iteration_is_refused}, CU_TEST_INFO_NULL};
