/* test_intervals.c: intervals of a mean, the parameter of x' = 0, where the standard deviation of the data is known and
 * where it is not: closed forms, and how often they hold what is true.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"
#include <math.h>
#include <steif/fit.h>
#include <steif/collection.h>
#include <steif/model.h>

enum { VALUES = 3, SETS = 1000 };
static const double spread = 0.5,
                    student =
                      4.302652729911275, /* of 2 degrees of freedom: p sqrt(2/(1 - p^2)) */
  normal = 1.959963984540054;
static const char text[] = "param m = 5\nstate x = m\nx' = 0\ntime 0 to 1\n";

static double uniform(unsigned long *x)
{
  *x = (1103515245UL * *x + 12345UL) % 2147483648UL;
  return ((double)*x + 0.5) / 2147483648.0;
}

/* Box and Muller. */
static double deviate(unsigned long *x)
{
  const double u = uniform(x), v = uniform(x);
  return sqrt(-2 * log(u)) * cos(6.283185307179586 * v);
}

static void fit_mean(steif_context *ctx, steif_problem *p, double *value, int known,
                     steif_fit *fit)
{
  double t[VALUES] = {0, 0.5, 1}, sd[VALUES] = {spread, spread, spread};
  sunindextype component[VALUES] = {0};
  const steif_measurements data = {
    .count = VALUES, .t = t, .value = value, .sd = known ? sd : NULL, .component = component};
  const steif_fit_options o = {.scale = STEIF_FIT_LINEAR};
  CU_ASSERT_FATAL(!steif_fit_find(ctx, p, "radau:s=3", &data, &o, fit));
}

static void closed_forms(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  steif_fit fit;
  double value[VALUES] = {4, 5.5, 7}, Q;
  const double mean = 5.5, rest = 2 * 1.5 * 1.5;
  CU_ASSERT_FATAL(!steif_model_parse(ctx, text, "mean", NULL, &p));
  fit_mean(ctx, &p, value, 1, &fit);
  CHECK(fit.known && fit.dof == 2);
  CLOSE(fit.p[0], mean, 1e-9);
  CLOSE(fit.sd[0], spread / sqrt(3), 1e-9);
  CLOSE(fit.covariance[0], spread * spread / 3, 1e-9);
  CLOSE(fit.high[0] - mean, normal * spread / sqrt(3), 1e-7);
  CLOSE(mean - fit.low[0], normal * spread / sqrt(3), 1e-7);
  CLOSE(fit.quantile, normal, 1e-12);
  CHECK(!steif_chi_square(ctx, rest / spread / spread, 2, &Q));
  CLOSE(fit.probability, Q, 1e-7);
  CLOSE(fit.probability, exp(-rest / spread / spread / 2), 1e-7);
  steif_fit_free(ctx, &fit);
  fit_mean(ctx, &p, value, 0, &fit);
  CHECK(!fit.known && fit.dof == 2 && isnan(fit.probability));
  CLOSE(fit.sd[0], sqrt(rest / 2 / 3), 1e-7);
  CLOSE(fit.high[0] - mean, student * sqrt(rest / 2 / 3), 1e-7);
  CLOSE(fit.quantile, student, 1e-9);
  steif_fit_free(ctx, &fit);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* One value and one parameter: a given standard deviation is that of the parameter, else nothing is known of it. */
static void no_degree_of_freedom(void)
{
  static const char one[] = "param m = 5\nstate x = m\nx' = 0\ntime 0 to 1\n";
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  double t = 1, value = 4, sd = spread;
  sunindextype component = 0;
  CU_ASSERT_FATAL(!steif_model_parse(ctx, one, "mean", NULL, &p));
  for (int known = 0; known < 2; known++) {
    const steif_measurements data = {
      .count = 1, .t = &t, .value = &value, .sd = known ? &sd : NULL, .component = &component};
    steif_fit fit;
    CU_ASSERT_FATAL(!steif_fit_find(ctx, &p, "radau:s=3", &data, NULL, &fit));
    CHECK(fit.dof == 0 && fit.log && isnan(fit.probability));
    if (known) CLOSE(fit.sd[0], spread, 1e-7);
    if (known) CLOSE(fit.high[0], 4 * exp(normal * spread / 4), 1e-7);
    if (!known) CHECK(isinf(fit.sd[0]) && isinf(fit.high[0]) && isinf(fit.covariance[0]));
    steif_fit_free(ctx, &fit);
  }
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* Of 1000 intervals of 95 % 950 hold the mean, give or take 7: 4 of these standard deviations are allowed. Student's
 * quantile in place of the normal one makes it 1000, the normal one in place of Student's 810. */
static void intervals_hold_as_often_as_they_say(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  CU_ASSERT_FATAL(!steif_model_parse(ctx, text, "mean", NULL, &p));
  for (int known = 0; known < 2; known++) {
    unsigned long x = 12345;
    int hold = 0;
    for (int k = 0; k < SETS; k++) {
      double value[VALUES];
      steif_fit fit;
      for (int j = 0; j < VALUES; j++) value[j] = 5 + spread * deviate(&x);
      fit_mean(ctx, &p, value, known, &fit);
      hold += fit.low[0] <= 5 && 5 <= fit.high[0];
      steif_fit_free(ctx, &fit);
    }
    CHECK(hold > 950 - 28 && hold < 950 + 28);
    if (!(hold > 950 - 28 && hold < 950 + 28)) printf("\n  %d of 1000 hold the mean", hold);
  }
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_intervals[] = {
  {"closed forms", closed_forms},
  {"no degree of freedom", no_degree_of_freedom},
  {"intervals hold as often as they say", intervals_hold_as_often_as_they_say},
  CU_TEST_INFO_NULL};
