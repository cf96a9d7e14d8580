/* law_propagator.c: one step of a method on y' = lambda y is its propagator M(h lambda), so a wrong
 * coefficient in either place shows.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "laws.h"
#include <complex.h>

static const double points[][2] = {{-1.37, 0}, {-0.41, 2.63}, {-53.1, 17.9}, {0.23, -0.71}};

static double complex value(N_Vector y) { return NV_Ith_S(y, 0) + I * NV_Ith_S(y, 1); }

/* Runs r + 3 equal steps and compares the last with M applied to the r values before it. */
static void one(steif_context *ctx, const char *method, const double z[2])
{
  char spec[64];
  steif_problem p;
  sunrealtype M[2 * 36];
  double complex y[12];
  int r = 0;
  snprintf(spec, sizeof spec, "dahlquist:re=%.17g,im=%.17g", z[0], z[1]);
  CU_ASSERT_FATAL(!steif_problem_find(ctx, spec, &p));
  CHECK(!steif_method_propagator(ctx, method, z, &r, M));
  steif_options o = steif_defaults();
  const int steps = r + 3;
  o.h = 1, o.t1 = steps;
  steif_solver *s = steif_solver_new(ctx, &p, method, &o);
  CU_ASSERT_FATAL(s != NULL);
  y[0] = value(steif_solution(s));
  for (int i = 1; i <= steps; i++) {
    CHECK(!steif_solve_step(s));
    y[i] = value(steif_solution(s));
  }
  double complex next = 0;
  double size = cabs(y[steps]);
  for (int j = 0; j < r; j++) {
    next += (M[2 * j] + I * M[2 * j + 1]) * y[steps - 1 - j];
    size = fmax(size, cabs(y[steps - 1 - j]));
  }
  if (cabs(next - y[steps]) > 4e-12 * size) printf("\n  %s at z = %g%+gi", method, z[0], z[1]);
  CLOSE_FLOOR(cabs(next - y[steps]), 0, 4e-12, size); /* the 12-stage split costs 2 digits */
  steif_solver_free(&s);
  steif_problem_clear(ctx, &p);
}

static void steps_are_propagators(void)
{
  steif_context *ctx = steif_context_new(NULL);
  for (int m = 0; m < law_method_count; m++)
    for (int i = 0; i < 4; i++) one(ctx, law_methods[m], points[i]);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_law_propagator[] = {
  {"a step on the test equation is M(h lambda)", steps_are_propagators}, CU_TEST_INFO_NULL};
