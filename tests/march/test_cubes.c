/* test_cubes.c: stiff equations whose solution is forced: what order a method keeps there is that of its
 * stages.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "smooth.h"

static const double rate = 200;

/* y' = -200 (y - sin(t + phase)^3), by sin(x)^3 = (3 sin x - sin 3 x) / 4. */
static int forced(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  const double g = sin(t + *(const double *)user);
  NV_Ith_S(out, 0) = -rate * (NV_Ith_S(y, 0) - g * g * g);
  return 0;
}

/* The solution that forgets no start: L (L sin x - w x' cos x) / (L^2 + w^2) for each sine. */
static double slow(double t, double phase)
{
  double sum = 0;
  for (int w = 1; w <= 3; w += 2) {
    const double x = w * (t + phase), share = (w == 1 ? 3 : -1) / 4.0;
    sum += share * rate * (rate * sin(x) - w * cos(x)) / (rate * rate + w * w);
  }
  return sum;
}

static void forced_solutions_are_right(void)
{
  static const char *const methods[] = {"radau:s=2", "radau:s=3", "radau:s=5",
                                        "radau:s=7", "radau:s=9", "auto"};
  static const double phases[] = {0, 0.8, 1.5707963267948966}, ends[] = {0.7, 1, 2, 5};
  static const sunrealtype one[] = {1};
  steif_context *ctx = steif_context_new(NULL);
  for (size_t i = 0; i < 6 * 3 * 4; i++) {
    double phase = phases[i / 6 % 3];
    const double t1 = ends[i / 18],
                 known = slow(t1, phase) + (1 - slow(0, phase)) * exp(-rate * t1);
    const steif_problem p = {
      .name = "cubes", .n = 1, .t1 = t1, .y0 = one, .f = forced, .user = &phase};
    for (double rtol = 1e-4; rtol > 5e-11; rtol /= 10) {
      steif_options o = steif_defaults();
      o.rtol = rtol;
      steif_solver *s = smooth_open(ctx, &p, methods[i % 6], &o);
      CHECK(!steif_solve_to(s, t1));
      const double error = fabs(NV_Ith_S(steif_solution(s), 0) - known);
      if (!(error <= 10 * rtol * (1 + fabs(known))))
        printf("\n  %s to %g, phase %g, rtol %g: error %.3g", methods[i % 6], t1, phase, rtol,
               error);
      CHECK(error <= 10 * rtol * (1 + fabs(known)));
      steif_solver_free(&s);
    }
  }
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_cubes[] = {{"forced solutions are right", forced_solutions_are_right},
                                CU_TEST_INFO_NULL};
