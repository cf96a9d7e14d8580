/* Starts of models: which solution a slope says.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fixture.h"
#include <math.h>

static const char *const methods[] = {"auto",      "bdf",       "radau:s=2",    "radau:s=3",
                                      "radau:s=7", "gauss:s=3", "dirk:esdirk43"};
enum { METHODS = sizeof methods / sizeof *methods };

static void ends_at(const char *text, double expected)
{
  fixture s;
  double y[3];
  CU_ASSERT_FATAL(fixture_text(&s, text, "") == STEIF_OK);
  for (int k = 0; k < METHODS; k++) {
    CHECK(fixture_run(&s, methods[k], 1e-7, y) == STEIF_OK);
    CLOSE_FLOOR(y[0], expected, 1e-6, 1);
  }
  fixture_close(&s);
}

/* x'^2 = x has x = (1 +- t/2)^2 from 1; x'^3 = x only x = (1 + 2 t/3)^(3/2). */
static void the_slope_of_a_square(void)
{
  ends_at("state x = 1, x' = 1\nx'^2 = x\ntime 0 to 1\n", 2.25);
  ends_at("state x = 1, x' = -1\nx'^2 = x\ntime 0 to 1\n", 0.25);
  ends_at("state x = 1, x' ~ 0.5\nx'^3 = x\ntime 0 to 1\n", pow(5.0 / 3, 1.5));
}

/* x'^2 + x' = 2 x: x' = (-1 +- sqrt(1 + 8 x))/2; with w = sqrt(1 + 8 x), w' = 4 x'/w = 2 (-1 +- w)/w, so that
 * t = (w - 3 +- log((w -+ 1)/(3 -+ 1)))/2 for both signs, w(0) = 3. By bisection. */
static double of_branch(double sign, double t)
{
  double low = 1.2, high = 6;
  for (int k = 0; k < 200; k++) {
    const double w = (low + high) / 2;
    const double at = sign * (w - 3 + sign * log((w - sign) / (3 - sign))) / 2;
    (at < t) == (sign > 0) ? (low = w) : (high = w);
  }
  return (low * low - 1) / 8;
}

static void two_branches(void)
{
  ends_at("state x = 1, x' = -2\nx'^2 + x' = 2*x\ntime 0 to 0.1\n", of_branch(-1, 0.1));
  ends_at("state x = 1, x' = 1\nx'^2 + x' = 2*x\ntime 0 to 0.1\n", of_branch(1, 0.1));
}

/* Slopes of arrays, by their indices, and of second order: x'' = -1 or 2 of x''^2 - x'' = 2. */
static void slopes_of_arrays(void)
{
  ends_at("state u[i in 1:3] = i, u[i in 1:3]' = if abs(i - 2) < 0.5 then -1 else 1\n"
          "for i in 1:3\n u[i]'^2 = 1\nend\ntime 0 to 1\n",
          2);
  ends_at("state x = 1, x' = 0, x'' = -1\nx''^2 - x'' = 2\ntime 0 to 1\n", 0.5);
  ends_at("state x = 1, x' = 0, x'' = 2\nx''^2 - x'' = 2\ntime 0 to 1\n", 2);
}

CU_TestInfo tests_of_starts[] = {
  {"the slope of a square", the_slope_of_a_square},
  {"two branches", two_branches},
  {"slopes of arrays and of second order", slopes_of_arrays},
  CU_TEST_INFO_NULL,
};
