/* test_deviation.c: how far a run comes from values that are known at some times.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "region.h"
#include "suite.h"
#include <steif/collection.h>
#include <string.h>

/* On q' = p, p' = -q the numbers of backward Euler have turned by n atan h and shrunk by
 * (1 + h^2)^{-n/2} after n steps. */
static void backward_euler_on_a_circle(void)
{
  enum { STEPS = 3 };
  const double h = 0.25;
  double t[STEPS], known[2 * STEPS], deviation, expected = 0;
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  steif_options o = steif_defaults();
  CU_ASSERT_FATAL(steif_problem_find(ctx, "harmonic", &p) == STEIF_OK);
  const double q0 = p.y0[0], p0 = p.y0[1];
  for (int k = 0; k < STEPS; k++) {
    const double angle = (k + 1) * h, turned = (k + 1) * atan(h),
                 shrunk = pow(1 + h * h, -(k + 1) / 2.);
    t[k] = angle;
    known[2 * k] = q0 * cos(angle) + p0 * sin(angle);
    known[2 * k + 1] = p0 * cos(angle) - q0 * sin(angle);
    const double q = shrunk * (q0 * cos(turned) + p0 * sin(turned));
    const double v = shrunk * (p0 * cos(turned) - q0 * sin(turned));
    expected = fmax(expected, fmax(fabs(q - known[2 * k]), fabs(v - known[2 * k + 1])));
  }
  o.h = h;
  o.t1 = STEPS * h;
  CHECK(steif_deviation(ctx, &p, "be", &o, STEPS, t, known, &deviation) == STEIF_OK);
  CLOSE(deviation, expected, 1e-9);
  known[3] = NAN;
  CHECK(steif_deviation(ctx, &p, "be", &o, STEPS, t, known, &deviation) == STEIF_OK);
  CHECK(isnan(deviation));
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

static void failures_are_passed_on(void)
{
  static const double t[] = {1, 2}, known[4] = {0};
  double deviation;
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  const steif_options few = {.rtol = 1e-6, .max_steps = 3};
  CU_ASSERT_FATAL(steif_problem_find(ctx, "harmonic", &p) == STEIF_OK);
  CHECK(steif_deviation(ctx, &p, "bdf", &few, 2, t, known, &deviation) == STEIF_STEP_LIMIT);
  CHECK(steif_deviation(ctx, &p, "bdg", NULL, 2, t, known, &deviation) == STEIF_UNKNOWN_NAME);
  CHECK(steif_deviation(ctx, &p, "bdf", NULL, 2, t, NULL, &deviation) == STEIF_BAD_INPUT);
  CHECK(strstr(steif_message(ctx), "known values") != NULL);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_deviation[] = {
  {"backward Euler on a circle is off by a closed form", backward_euler_on_a_circle},
  {"failures are passed on", failures_are_passed_on},
  CU_TEST_INFO_NULL};
