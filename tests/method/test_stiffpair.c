/* The components of the stiff linear pair x' = diag(-1, -1000) x, x(0) = (1, 1), at T = 4 with h = 1/2.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"
#include <nvector/nvector_serial.h>
#include <steif/analysis.h>
#include <steif/data.h>
#include <steif/linear.h>
#include <steif/steif.h>

static void fast_component_of_crank_nicolson_stays(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  steif_options o = steif_defaults();
  o.h = 0.5;
  CU_ASSERT_FATAL(!steif_problem_find(ctx, "stiffpair", &p));
  steif_solver *s = steif_solver_new(ctx, &p, "dirk:cranknicolson", &o);
  CU_ASSERT_FATAL(s && !steif_solve_to(s, 4));
  CLOSE(NV_Ith_S(steif_solution(s), 1), 0.9380046794, 1e-9);
  steif_solver_free(&s);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* The components at T = 4 for h = 1/2 ... 1/32: (1 + h)^{-n} and (1 + 1000 h)^{-n}, and the
 * recurrence of BDF of order 2 after a step of backward Euler, in 50 digits. */
static void components_are_the_closed_ones(void)
{
  static const struct {
    const char *method;
    double slow[5], fast[5];
  } rows[] = {
    {"be",
     {0.039018442311, 0.028147497671, 0.023073808382, 0.020651325015, 0.019472105799},
     {2.519406e-22, 4.029215e-39, 6.139635e-68, 4.192582e-116, 8.094611e-194}},
    {"bdf:p=2",
     {0.014322916667, 0.017483416689, 0.018129627059, 0.018271599900, 0.018304921612},
     {8.644605e-13, 3.451536e-23, -2.224676e-39, 1.373474e-68, 4.910216e-117}},
  };
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  CU_ASSERT_FATAL(!steif_problem_find(ctx, "stiffpair", &p));
  for (int k = 0; k < 10; k++) {
    steif_options o = steif_defaults();
    o.h = ldexp(0.5, -(k % 5));
    steif_solver *s = steif_solver_new(ctx, &p, rows[k / 5].method, &o);
    CU_ASSERT_FATAL(s && !steif_solve_to(s, 4));
    CLOSE(NV_Ith_S(steif_solution(s), 0), rows[k / 5].slow[k % 5], 1e-10);
    CLOSE(NV_Ith_S(steif_solution(s), 1), rows[k / 5].fast[k % 5], 1e-6);
    steif_solver_free(&s);
  }
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_stiffpair[] = {
  {"the fast component of Crank-Nicolson stays", fast_component_of_crank_nicolson_stays},
  {"components are the closed ones", components_are_the_closed_ones},
  CU_TEST_INFO_NULL};
