/* test_clock.c: kinetics that begin, and begin again at breaks, late on the clock.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "smooth.h"

enum { BREAKS = 3, MOST = 20 };

/* The end of an autonomous problem moved to t0, with a break every hour. */
static int end_of(const char *name, const char *method, double rtol, double t0, double *y,
                  double *floor)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  CU_ASSERT_FATAL(!steif_problem_find(ctx, name, &p));
  CU_ASSERT_FATAL(p.n <= MOST);
  double breaks[BREAKS];
  for (int k = 0; k < BREAKS; k++) breaks[k] = t0 + 3600 * (k + 1);
  p.t0 = t0, p.t1 = t0 + 3600 * (BREAKS + 1);
  p.breaks = breaks, p.break_count = BREAKS;
  steif_options o = steif_defaults();
  o.rtol = rtol;
  *floor = p.rtol_scale > 0 ? p.rtol_scale : 1;
  steif_solver *s = smooth_open(ctx, &p, method, &o);
  const int code = steif_solve_to(s, p.t1), n = (int)p.n;
  if (code) printf("\n  %s %s %g: %s", name, method, rtol, steif_message(ctx));
  memcpy(y, NV_DATA_S(steif_solution(s)), (size_t)n * sizeof *y);
  steif_solver_free(&s);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
  CHECK(code == STEIF_OK);
  return n;
}

/* Clocks that show 2e-12 are no reason to refuse steps of 1e-11, and do not change the solution: that of t0 = 0 by
 * another method. */
static void the_start_may_be_late(void)
{
  static const char *const problems[] = {"hires", "rober", "pollu", "chemakzo"};
  static const double rtol[] = {1e-6, 1e-8, 1e-10};
  for (int i = 0; i < 4; i++) {
    double right[MOST], y[MOST], floor;
    const int n = end_of(problems[i], "radau:s=7", 1e-11, 0, right, &floor);
    for (int k = 0; k < 3; k++) {
      end_of(problems[i], "bdf", rtol[k], 14400, y, &floor);
      for (int j = 0; j < n; j++)
        CHECK(fabs(y[j] - right[j]) <= 10 * rtol[k] * (floor + fabs(right[j])));
    }
  }
}

/* The same by auto, of few digits too against bdf. */
static void auto_starts_late(void)
{
  static const char *const problems[] = {"hires", "rober", "pollu"};
  static const double rtol[] = {1e-4, 1e-6, 1e-8};
  for (int i = 0; i < 3; i++) {
    double right[MOST], y[MOST], floor;
    const int n = end_of(problems[i], "bdf", 1e-10, 0, right, &floor);
    for (int k = 0; k < 3; k++) {
      end_of(problems[i], "auto", rtol[k], 14400, y, &floor);
      for (int j = 0; j < n; j++)
        CHECK(fabs(y[j] - right[j]) <= 10 * rtol[k] * (floor + fabs(right[j])));
    }
  }
}

CU_TestInfo tests_of_clock[] = {{"the start may be late", the_start_may_be_late},
                                {"auto starts late", auto_starts_late},
                                CU_TEST_INFO_NULL};
