/* The components of the stiff linear pair x' = diag(-1, -1000) x, x(0) = (1, 1), at T = 4 with h = 1/2.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"
#include <nvector/nvector_serial.h>
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
  s = steif_solver_new(ctx, &p, "be", &o);
  CU_ASSERT_FATAL(s && !steif_solve_to(s, 4));
  CLOSE(NV_Ith_S(steif_solution(s), 1), 2.519406e-22, 1e-6); /* (1/501)^8 */
  CLOSE(NV_Ith_S(steif_solution(s), 0), 0.039018442311, 1e-10);
  steif_solver_free(&s);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_stiffpair[] = {
  {"Crank-Nicolson does not damp, backward Euler does", fast_component_of_crank_nicolson_stays},
  CU_TEST_INFO_NULL};
