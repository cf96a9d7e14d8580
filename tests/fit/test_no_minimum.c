/* test_no_minimum.c: descents that end elsewhere than at a minimum, and minima that look as if they did.
 * Closed forms: y = p^2 t, c t, b + a t and a e^(-k t).
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <steif/data.h>
#include <steif/fit.h>
#include <steif/model.h>
#include <string.h>

enum { POINTS = 11 };

/* Of the unknown at 0, 0.5, .., 5 (or from the second time on) the values law(t) + error cos(9 t). */
typedef struct fitting {
  const char *text;
  double (*law)(double t);
  double error;
  int first;
  steif_fit_options options;
} fitting;

static const char *method = "auto";

/* The code, with fit and what was said in it. */
static int fit_of(const fitting *q, steif_fit *fit, steif_context **ctx)
{
  double t[POINTS], value[POINTS];
  sunindextype component[POINTS] = {0};
  steif_measurements data = {.t = t, .value = value, .component = component};
  steif_problem p;
  for (int j = q->first; j < POINTS; j++, data.count++) {
    t[data.count] = 0.5 * j;
    value[data.count] = q->law(0.5 * j) + q->error * cos(4.5 * j);
  }
  *ctx = steif_context_new(NULL);
  CU_ASSERT_FATAL(!steif_model_parse(*ctx, q->text, "model", NULL, &p));
  const int code = steif_fit_find(*ctx, &p, method, &data, &q->options, fit);
  steif_problem_clear(*ctx, &p);
  CHECK(fit->p != NULL);
  if (!fit->p) puts(steif_message(*ctx));
  return code;
}

static void end(steif_fit *fit, steif_context *ctx)
{
  steif_fit_free(ctx, fit);
  steif_context_free(&ctx);
}

static double rising(double t) { return 2 * t; }
static double falling(double t) { return -2 * t; }
static double slight(double t) { return 1e-3 * t; }
static double large(double t) { return 1e10 * (1 - 2 * t); }
static double decaying(double t) { return 3 * exp(-0.7 * t); }
static double below(double t) { return -3 * exp(-0.5 * t); }
static double half(double t) { return exp(-0.5 * t); }

static void no_minimum(const fitting *q, const char *part)
{
  steif_fit fit;
  steif_context *ctx;
  CHECK(fit_of(q, &fit, &ctx) == STEIF_NO_CONVERGENCE);
  CHECK(fit.exhausted == 2 && strstr(fit.message, "no minimum") != NULL);
  const int said = strstr(fit.message, part) != NULL;
  if (!said) printf("\n  no '%s' in '%s'", part, fit.message);
  CHECK(said);
  CHECK(!fit.bound[0]);
  end(&fit, ctx);
}

static void starts_without_slope(void)
{
  static const double low[] = {0}, high[] = {5};
  static const char square[] = "param p = 0\nstate y = 0\ny' = p^2\ntime 0 to 5\n";
  const char *said = "chi2 has no slope along p where the fit begins";
  fitting q = {square, rising, 0, 0, {0}};
  no_minimum(&q, said);
  q.options = (steif_fit_options){.low = low, .high = high};
  no_minimum(&q, said);
  q = (fitting){
    "param p = 0, q = 1\nstate y = 0\ny' = p^2 + q*t\ntime 0 to 5\n", rising, 0, 0, {0}};
  no_minimum(&q, said);
  q = (fitting){
    "param p = 100\nstate y = 0\ny' = exp(-(t - p)^2)\ntime 0 to 5\n", rising, 0, 0, {0}};
  no_minimum(&q, said);
  q.law = falling, q.options.scale = STEIF_FIT_LINEAR; /* chi2 is more at 0, the same at 200 */
  no_minimum(&q, said);
  q = (fitting){
    "param a = 1e-6, k = 1e3\nstate y = a\ny' = -k*y\ntime 0 to 5\n", decaying, 0.01, 1, {0}};
  no_minimum(&q, "no slope along a and k");
}

/* p = 0 is the least of p >= 0 there; and a parameter that has no part in the data is none to begin elsewhere with. */
static void bounds_and_idle_parameters(void)
{
  static const double low[] = {0}, high[] = {5};
  const fitting at_bound = {"param p = 1\nstate y = 0\ny' = p^2\ntime 0 to 5\n",
                            falling,
                            0,
                            0,
                            {.low = low, .high = high}};
  const fitting idle = {
    "param p = 2, q = 1\nstate y = 0\ny' = q + 0*p\ntime 0 to 5\n", rising, 0.01, 0, {0}};
  steif_fit fit;
  steif_context *ctx;
  CHECK(fit_of(&at_bound, &fit, &ctx) == STEIF_OK);
  CHECK(fit.p[0] >= 0 && fit.p[0] < 1e-10);
  CHECK(fit.bound[0] ? strstr(fit.message, "p is at its bound 0") != NULL : isinf(fit.sd[0]));
  end(&fit, ctx);
  static const char *const methods[] = {"radau:s=3", "auto", "bdf"};
  for (int m = 0; m < 6; m++) {
    fitting free = at_bound;
    method = methods[m % 3];
    if (m < 3) free.options = (steif_fit_options){.scale = STEIF_FIT_LINEAR};
    CHECK(fit_of(&free, &fit, &ctx) == STEIF_OK);
    CHECK(fabs(fit.p[0]) < 1e-10);
    if (!fit.bound[0]) CHECK(isinf(fit.sd[0]) && strstr(fit.message, "is more to both sides"));
    end(&fit, ctx);
  }
  method = "auto";
  CHECK(fit_of(&idle, &fit, &ctx) == STEIF_OK);
  CHECK(fit.undetermined == 1 && isinf(fit.sd[0]) && fit.p[0] == 2 && fit.sd[1] < 0.1);
  CHECK(strstr(fit.message, "chi2 has no slope along p where the fit begins") != NULL);
  end(&fit, ctx);
}

static void parameters_that_run_away(void)
{
  static const char line[] = "param c = 1\nstate y = 0\ny' = c\ntime 0 to 5\n",
                    decay[] = "param a = 1, k = 1\nstate y = a\ny' = -k*y\ntime 0 to 5\n";
  static const char saturating[] =
    "param V = 1, K = 1\nstate y = 1\ny' = -V*y/(K + y)\ntime 0 to 5\n";
  fitting q = {line, falling, 0.1, 0, {0}};
  steif_fit fit;
  steif_context *ctx;
  CHECK(fit_of(&q, &fit, &ctx) == STEIF_NO_CONVERGENCE);
  CHECK(strstr(fit.message, "c ran from 1 to ") && strstr(fit.message, "the linear scale"));
  CHECK(fit.log && isinf(fit.sd[0]) && fit.low[0] == 0 && isinf(fit.high[0]));
  end(&fit, ctx);
  q.options.scale = STEIF_FIT_LINEAR;
  CHECK(fit_of(&q, &fit, &ctx) == STEIF_OK);
  CHECK(fabs(fit.p[0] + 2) < 0.01);
  end(&fit, ctx);
  q = (fitting){decay, below, 0, 0, {0}};
  no_minimum(&q, "a ran from 1 to ");
  q = (fitting){saturating, half, 1e-3, 0, {.scale = STEIF_FIT_LINEAR}};
  no_minimum(&q, "V ran from 1 to ");
  q = (fitting){
    "param a = 1e-6, k = 1e3\nstate y = a\ny' = -k*y\ntime 0 to 5\n", decaying, 0.01, 0, {0}};
  no_minimum(&q, "k ran from 1000 to ");
}

/* The least squares of c t are c = sum t d / sum t^2, about 1e-3 and by its sd of no sure sign: a minimum all the same. */
static void a_minimum_near_zero(void)
{
  const fitting q = {"param c = 1\nstate y = 0\ny' = c\ntime 0 to 5\n", slight, 0.1, 0, {0}};
  steif_fit fit;
  steif_context *ctx;
  double above = 0, under = 0;
  for (int j = 0; j < POINTS; j++)
    above += 0.5 * j * (slight(0.5 * j) + 0.1 * cos(4.5 * j)), under += 0.25 * j * j;
  CHECK(fit_of(&q, &fit, &ctx) == STEIF_OK);
  CHECK(above > 0 && fit.sd[0] > fit.p[0]);
  CLOSE(fit.p[0], above / under, 1e-4);
  end(&fit, ctx);
}

/* Steps of the size of the start values change chi2 by 1e-10 of it. */
static void data_far_above_the_start_values(void)
{
  const fitting q = {
    "param a = 0, b = 0\nstate y = b\ny' = a\ntime 0 to 5\n", large, 1e8, 0, {0}};
  steif_fit fit;
  steif_context *ctx;
  double mean = 0, cross = 0, square = 0;
  for (int j = 0; j < POINTS; j++) mean += (large(0.5 * j) + 1e8 * cos(4.5 * j)) / POINTS;
  for (int j = 0; j < POINTS; j++) {
    const double t = 0.5 * j - 2.5;
    cross += t * (large(0.5 * j) + 1e8 * cos(4.5 * j)), square += t * t;
  }
  CHECK(fit_of(&q, &fit, &ctx) == STEIF_OK);
  CLOSE(fit.p[0], cross / square, 1e-6);
  CLOSE(fit.p[1], mean - 2.5 * cross / square, 1e-6);
  end(&fit, ctx);
}

/* Runs end at k = 0.6, before the minimum 0.7. */
static void runs_that_fail_are_a_wall(void)
{
  const fitting q = {"param a = 2, k = 0.5\nstate y = a\n"
                     "y' = -k*y*sqrt(0.6 - k)/sqrt(0.6 - k)\ntime 0 to 5\n",
                     decaying,
                     0.01,
                     0,
                     {0}};
  no_minimum(&q, "to where runs fail");
}

/* ---- derivatives that are wrong, where no look at the start and at the end can see it ------------------------- */

static int f(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  (void)t;
  NV_Ith_S(ydot, 0) = -*(double *)user * NV_Ith_S(y, 0);
  return 0;
}

static int wrong_later(sunrealtype t, N_Vector y, N_Vector yp, int k, N_Vector out, void *user)
{
  (void)yp, (void)k, (void)user;
  NV_Ith_S(out, 0) = (t > 0.3 && t < 2.2 ? -5 : 1) * NV_Ith_S(y, 0);
  return 0;
}

static void wrong_derivatives(void)
{
  double k = 0.5, t[POINTS], value[POINTS];
  const double y0[] = {3};
  sunindextype component[POINTS] = {0};
  const steif_measurements data = {
    .count = POINTS, .t = t, .value = value, .component = component};
  const steif_parameters parameters = {.count = 1, .value = &k, .dFdp = wrong_later};
  steif_problem p = {
    .name = "decay", .n = 1, .t1 = 5, .y0 = y0, .f = f, .user = &k, .parameters = &parameters};
  steif_context *ctx = steif_context_new(NULL);
  steif_fit fit;
  for (int j = 0; j < POINTS; j++) t[j] = 0.5 * j, value[j] = decaying(t[j]);
  CHECK(steif_fit_find(ctx, &p, "radau:s=3", &data, NULL, &fit) == STEIF_NO_CONVERGENCE);
  CHECK(strstr(fit.message, "does not go down along its derivatives") != NULL);
  end(&fit, ctx);
}

CU_TestInfo tests_of_no_minimum[] = {
  {"starts without slope", starts_without_slope},
  {"bounds and idle parameters", bounds_and_idle_parameters},
  {"parameters that run away", parameters_that_run_away},
  {"a minimum near zero", a_minimum_near_zero},
  {"data far above the start values", data_far_above_the_start_values},
  {"runs that fail are a wall", runs_that_fail_are_a_wall},
  {"wrong derivatives", wrong_derivatives},
  CU_TEST_INFO_NULL};
