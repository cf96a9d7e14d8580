/* test_fits.c: fits whose minima are known, and what is said of bad ones.
 * Minima: Gauss-Newton in two other integrators at rtol 1e-12, which agree in the digits given.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "made_data.h"
#include "suite.h"
#include <steif/collection.h>
#include <steif/model.h>
#include <string.h>

/* A descent ends where a step promises less than rtol = 1e-10 of chi2, or where the errors of the runs hide what it
 * brings, a share e <= 1e-9: p is known to sd sqrt(e chi2) then, 1.3e-6 of p, and what depends on p likewise. */
static void is_least(const steif_fit *fit)
{
  static const double p[] = {1.5022084384, 0.99979448359, 2.9962898094, 0.99749699966};
  static const double sd[] = {4.6379901e-3, 6.3215090e-3, 6.7603838e-3, 7.4394841e-3};
  static const double r[] = {0.68911908,  -0.97587916, -0.98198502,
                             -0.62038997, -0.66984278, 0.94512468};
  CLOSE(fit->chi2, 28.7204189315, 1e-7);
  CHECK(fit->dof == 36 && fit->log && !fit->undetermined && !fit->exhausted);
  for (int i = 0, k = 0; i < 4; i++) {
    CLOSE(fit->p[i], p[i], 4e-6);
    CLOSE(sqrt(fit->covariance_theta[5 * i]), sd[i], 4e-6);
    CLOSE(sqrt(fit->covariance[5 * i]), fit->sd[i], 1e-14);
    CLOSE(fit->sd[i], sd[i] * p[i], 8e-6);
    for (int j = i + 1; j < 4; j++, k++) CLOSE(fit->correlation[4 * i + j], r[k], 4e-6);
  }
}

static void prey_and_predators(void)
{
  static const char *const methods[] = {"radau:s=3", "radau:s=5", "dirk:hw43"};
  steif_context *ctx = steif_context_new(NULL);
  made_data made;
  prey P;
  steif_fit fit;
  prey_data(ctx, &made);
  CLOSE(made.value[0], 1.5581042492, 1e-9);
  CLOSE(made.value[1], 0.37634802336, 1e-9);
  CLOSE(made.value[38], 1.0516252907, 1e-9);
  CLOSE(made.value[39], 0.94719763188, 1e-9);
  steif_options run = steif_defaults();
  run.rtol = 1e-10;
  const steif_fit_options o = {.run = &run};
  for (int m = 0; m < 3; m++) {
    prey_open(&P, 1.6, 0.9, 2.8, 1.1);
    CHECK(steif_fit_find(ctx, &P.problem, methods[m], &made.data, &o, &fit) == STEIF_OK);
    if (!fit.p) puts(steif_message(ctx));
    if (fit.p) is_least(&fit);
    CHECK(strstr(fit.message, "let expect") != NULL);
    CHECK(P.p[0] == 1.6 && P.p[3] == 1.1);
    steif_fit_free(ctx, &fit);
  }
  steif_context_free(&ctx);
}

/* From far away a descent ends at another minimum, and says so; several descents find the least one. */
static void a_local_minimum_is_said(void)
{
  static const double minimum[] = {3.1905, 2.0699, 0.34305, 0.17897};
  static const double low[] = {0.5, 0.5, 1, 0.5}, high[] = {3, 3, 5, 3};
  steif_context *ctx = steif_context_new(NULL);
  made_data made;
  prey P;
  steif_fit fit;
  prey_data(ctx, &made);
  steif_options run = steif_defaults();
  run.rtol = 1e-10;
  steif_fit_options o = {.run = &run};
  prey_open(&P, 1.2, 0.8, 2.4, 0.8);
  CHECK(steif_fit_find(ctx, &P.problem, "radau:s=3", &made.data, &o, &fit) == STEIF_OK);
  CLOSE(fit.chi2, 44890.35, 1e-7);
  for (int i = 0; i < 4; i++) CLOSE(fit.p[i], minimum[i], 1e-4);
  CHECK(strstr(fit.message, "chi2/dof = 1247 is far above 1") != NULL);
  CHECK(strstr(fit.message, "35.3 times as wide") != NULL); /* sqrt(1247) */
  CLOSE(log(fit.high[0] / fit.p[0]), 1.959963985 * fit.sd[0] / fit.p[0], 1e-8);
  steif_fit_free(ctx, &fit);
  o.starts = 6, o.low = low, o.high = high;
  CHECK(steif_fit_find(ctx, &P.problem, "radau:s=3", &made.data, &o, &fit) == STEIF_OK);
  is_least(&fit);
  CHECK(fit.starts == 6 && fit.chi2_of[fit.best] <= fit.chi2 * (1 + 1e-9));
  CHECK(strstr(fit.message, "starts came to this chi2") != NULL);
  steif_fit_free(ctx, &fit);
  steif_context_free(&ctx);
}

static void robertson(void)
{
  static const double sd[] = {0.01, 5e-7, 0.01}, start[] = {0.02, 3e4, 1e7};
  static const double p[] = {0.03849604309, 9468.105434, 29452318.42};
  static const double spread[] = {0.036120358, 0.047459694, 0.021148094};
  steif_context *ctx = steif_context_new(NULL);
  steif_problem rober;
  made_data made;
  steif_fit fit;
  double t[17];
  for (int k = 0; k < 17; k++) t[k] = 0.4 * pow(10, k / 4.0);
  CHECK(steif_problem_find(ctx, "rober", &rober) == STEIF_OK);
  made_data_open(ctx, &rober, 17, t, sd, &made);
  steif_options run = steif_defaults();
  run.rtol = 1e-12, run.atol = 1e-18;
  const steif_fit_options o = {.run = &run, .start = start};
  CHECK(steif_fit_find(ctx, &rober, "radau:s=3", &made.data, &o, &fit) == STEIF_OK);
  if (fit.p) {
    CLOSE(fit.chi2, 37.643177397, 1e-7);
    CHECK(fit.dof == 48 && fit.iterations <= 12);
    for (int i = 0; i < 3; i++) {
      /* Where chi2 may yet fall by its part 1e-12, p is off by sqrt(1e-12 chi2) = 6e-6 standard deviations. */
      CLOSE(fit.p[i], p[i], 1e-5 * spread[i]);
      CLOSE(sqrt(fit.covariance_theta[4 * i]), spread[i], 1e-6);
    }
    CLOSE(fit.correlation[1], 0.96875385, 1e-6);
    CLOSE(fit.correlation[2], 0.73452551, 1e-6);
    CLOSE(fit.correlation[5], 0.77428144, 1e-6);
    const double ratio = fit.singular[0] / fit.singular[2];
    CLOSE(ratio * ratio, 77.957, 1e-4);
  }
  steif_fit_free(ctx, &fit);
  steif_problem_clear(ctx, &rober);
  steif_context_free(&ctx);
}

/* ---- what the data do not tell --------------------------------------------------------------- */

/* Only a b is told: log a - log b is not, and c is. */
static void a_product_alone_is_named(void)
{
  steif_context *ctx = steif_context_new(NULL);
  made_data made;
  steif_problem p;
  steif_fit fit;
  decay(&made, 1.3);
  CHECK(steif_model_parse(ctx, product, "product", NULL, &p) == STEIF_OK);
  CHECK(steif_fit_find(ctx, &p, "radau:s=3", &made.data, NULL, &fit) == STEIF_OK);
  if (fit.p) {
    CLOSE(fit.p[0] * fit.p[1], 1.3, 1e-3);
    CLOSE(fit.p[0] / fit.p[1], 4, 1e-2); /* it stays where it began */
    CHECK(fit.dof == 6);
    CLOSE(fit.p[2], 3, 1e-3);
    CHECK(fit.undetermined == 1 && fit.singular[2] < 1e-8 * fit.singular[0]);
    CLOSE(fabs(fit.direction[6]), sqrt(0.5), 1e-6);
    CLOSE(fit.direction[7], -fit.direction[6], 1e-6);
    CHECK(isinf(fit.sd[0]) && isinf(fit.sd[1]) && fit.sd[2] > 0 && fit.sd[2] < 0.01);
    CHECK(fit.low[0] == 0 && isinf(fit.high[0]));
    CHECK(isinf(fit.covariance[0]) && isnan(fit.covariance[1]) && isnan(fit.covariance[5]));
    CLOSE(sqrt(fit.covariance[8]), fit.sd[2], 1e-14);
    CHECK(strstr(fit.message, "do not determine the direction") != NULL);
    CHECK(strstr(fit.message, "of a,") && strstr(fit.message, "of b)"));
    CHECK(!strstr(fit.message, "of c"));
  }
  steif_fit_free(ctx, &fit);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* The least squares on the bound a b = 1 have c = sum d e / sum e^2, e = exp(-t). */
static void bounds_hold(void)
{
  static const int which[] = {0, 2};
  static const double start[] = {1, 2}, low[] = {0.5, 0.1}, high[] = {2, 10};
  const steif_fit_options o = {
    .count = 2, .parameter = which, .start = start, .low = low, .high = high};
  steif_context *ctx = steif_context_new(NULL);
  made_data made;
  steif_problem p;
  steif_fit fit;
  double above = 0, below = 0;
  decay(&made, 1.3);
  for (size_t j = 0; j < 8; j++)
    above += made.value[j] * exp(-made.t[j]), below += exp(-2 * made.t[j]);
  CHECK(steif_model_parse(ctx, product, "product", NULL, &p) == STEIF_OK);
  CHECK(steif_fit_find(ctx, &p, "radau:s=3", &made.data, &o, &fit) == STEIF_OK);
  if (fit.p) {
    CHECK(fit.p[0] == 2 && fit.bound[0] == 1 && fit.bound[1] == 0);
    CLOSE(fit.p[1], above / below, 1e-6);
    CHECK(fit.dof == 7 && fit.sd[0] == 0 && fit.undetermined == 0);
    CLOSE(fit.sd[1], 1e-3 / sqrt(below), 1e-6);
    CHECK(strstr(fit.message, "a is at its bound 2") != NULL);
  }
  steif_fit_free(ctx, &fit);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* A linear model: c of c exp(-t), linear scale, sd not known: the formulas of linear regression. */
static void linear_regression(void)
{
  static const int which[] = {2};
  const steif_fit_options o = {.count = 1, .parameter = which, .scale = STEIF_FIT_LINEAR};
  steif_context *ctx = steif_context_new(NULL);
  made_data made;
  steif_problem p;
  steif_fit fit;
  double above = 0, below = 0, rest = 0, t;
  decay(&made, 1);
  made.data.sd = NULL;
  for (size_t j = 0; j < 8; j++)
    above += made.value[j] * exp(-made.t[j]), below += exp(-2 * made.t[j]);
  for (size_t j = 0; j < 8; j++)
    rest += pow(made.value[j] - above / below * exp(-made.t[j]), 2);
  CHECK(steif_model_parse(ctx, product, "product", NULL, &p) == STEIF_OK);
  CHECK(steif_fit_find(ctx, &p, "radau:s=3", &made.data, &o, &fit) == STEIF_OK);
  CHECK(!steif_student(ctx, 0.95, 7, &t));
  if (fit.p) {
    CHECK(!fit.log && fit.dof == 7);
    CLOSE(fit.p[0], above / below, 1e-8);
    CLOSE(fit.sd[0], sqrt(rest / 7 / below), 1e-4);
    CLOSE(fit.high[0] - fit.p[0], t * fit.sd[0], 1e-8);
    CLOSE(fit.p[0] - fit.low[0], t * fit.sd[0], 1e-8);
    CHECK(strstr(fit.message, "comes out as") != NULL);
  }
  steif_fit_free(ctx, &fit);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* From exp(30 t) the residuals fall by 60 decades on the way to exp(-t): what keeps directions without data in place
 * must follow J down. */
static void far_starts_arrive(void)
{
  static const int which[] = {0};
  static const double start[] = {-40};
  steif_fit_options o = {.count = 1,
                         .parameter = which,
                         .start = start,
                         .scale = STEIF_FIT_LINEAR,
                         .evaluations = 600};
  steif_context *ctx = steif_context_new(NULL);
  made_data made;
  steif_problem p;
  steif_fit fit;
  decay(&made, 1);
  CHECK(steif_model_parse(ctx, product, "product", NULL, &p) == STEIF_OK);
  CHECK(steif_fit_find(ctx, &p, "radau:s=3", &made.data, &o, &fit) == STEIF_OK);
  if (fit.p) CLOSE(fit.p[0] * 0.5, 1, 1e-3);
  if (fit.p) CHECK(fit.chi2 < 30);
  steif_fit_free(ctx, &fit);
  o.evaluations = 20;
  CHECK(steif_fit_find(ctx, &p, "radau:s=3", &made.data, &o, &fit) == STEIF_NO_CONVERGENCE);
  CHECK(fit.runs <= 25);
  steif_fit_free(ctx, &fit);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* Measured is an output, in which parameters stand, one of them by another that follows it. Reference: SciPy 1.10,
 * least_squares on the closed form with tolerances of 1e-14. */
static void an_output_is_measured(void)
{
  static const char text[] =
    "param k = 1, gain = 2, off = 0.1, two = 2*gain\nstate x = 1\nx' = -k*x\n"
    "output other = x, signal = gain*x + off + two*x^2\n";
  static const double value[] = {5.42041, 3.27770, 2.11827, 1.41928, 1.01131, 0.76443, 0.59049,
                                 0.50836, 0.43637, 0.43425, 0.37329, 0.34677, 0.33299},
                      p[] = {1.31458289, 1.7033429, 0.30518757},
                      sd[] = {0.00624257, 0.00329825, 0.00468731};
  enum { COUNT = sizeof value / sizeof *value };
  static const int fitted[] = {0, 1, 2};
  double t[COUNT], width[COUNT];
  sunindextype which[COUNT];
  for (int j = 0; j < COUNT; j++) t[j] = 0.25 * j, width[j] = 0.01, which[j] = 2;
  const steif_measurements data = {
    .count = COUNT, .t = t, .value = (double *)value, .sd = width, .component = which};
  steif_context *ctx = steif_context_new(NULL);
  steif_problem problem;
  steif_options run = steif_defaults();
  run.rtol = 1e-11;
  const steif_fit_options o = {
    .run = &run, .count = 3, .parameter = fitted, .scale = STEIF_FIT_LINEAR};
  steif_fit fit;
  CU_ASSERT_FATAL(!steif_model_parse(ctx, text, "m.steif", NULL, &problem));
  CHECK(steif_fit_find(ctx, &problem, "radau:s=3", &data, &o, &fit) == STEIF_OK);
  for (int i = 0; fit.p && i < 3; i++) {
    CLOSE(fit.p[i], p[i], 1e-6);
    CLOSE(fit.sd[i], sd[i], 1e-5);
  }
  if (fit.p) CLOSE(fit.chi2, 21.494110646, 1e-8);
  steif_fit_free(ctx, &fit);
  which[3] = 3; /* past the last output */
  CHECK(steif_fit_find(ctx, &problem, "radau:s=3", &data, &o, &fit) == STEIF_BAD_INPUT);
  steif_fit_free(ctx, &fit);
  steif_problem_clear(ctx, &problem);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_fits[] = {{"prey and predators", prey_and_predators},
                               {"a local minimum is said", a_local_minimum_is_said},
                               {"Robertson's reaction", robertson},
                               {"a product alone is named", a_product_alone_is_named},
                               {"bounds hold", bounds_hold},
                               {"an output is measured", an_output_is_measured},
                               {"linear regression", linear_regression},
                               {"far starts arrive", far_starts_arrive},
                               CU_TEST_INFO_NULL};
