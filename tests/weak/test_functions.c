/* test_functions.c: other test functions than the usual one: pairings, ends, and what they do not see.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "weak/data.h"
#include <steif/forcing.h>

/* A bump, whose odd derivatives at 0 vanish; what never ends, cut where it is 1e-17; and some g. */
static const struct {
  const char *text;
  double t1;
} function[] = {
  {"exp(-1/(1-t^2))", 1}, {"exp(-t)*cos(5*t)", 40}, {"exp(-t)*(1+sin(3*t))*(1-t/2)^9", 2}};

static const struct {
  const char *method, *start;
  enum steif_convention convention;
} method[] = {{"be", NULL, STEIF_R},
              {"bdf:p=2", "cq", STEIF_C},
              {"bdf:p=3", "cq", STEIF_C},
              {"radau:s=2", NULL, STEIF_STAGE},
              {"radau:s=3", NULL, STEIF_STAGE}};
enum { METHODS = 5 };

/* <x, g> by 40-digit quadrature and exact derivatives; <x_h, g> at h = 1/64 in 113-bit arithmetic: N-inc,
 * component 1. */
static const struct row {
  int g, k;
  double exact, value[METHODS];
} rows[] = {
  {0,
   2,
   1.096529335807788,
   {1.094795096167, 1.09657873557, 1.096530249402, 1.09660169592, 1.096529331038}},
  {0,
   3,
   1.257523255814044,
   {1.207375564005, 1.25759880913, 1.257505771899, 1.211693524741, 1.25752263154}},
  {0,
   4,
   -2.205348420208577,
   {-2.275990415435, -2.201871558806, -2.205381627869, 18.31382706419, -2.199301883662}},
  {0,
   5,
   -3.137366109330941,
   {-3.872434225493, -3.13214163061, -3.137988864068, -7994.259023631, -6.015523650087}},
  {0,
   6,
   -26.43465851068374,
   {-27.38785291697, -26.35820754709, -26.43511670502, 3285686.351853, -1098.81491561}},
  {1,
   2,
   2.524357333643961,
   {2.502993836372, 2.524887997565, 2.52441077443, 2.526665510332, 2.524369202533}},
  {1,
   3,
   -1.569419658738394,
   {-3.04998042799, -1.600382751621, -1.567424785288, -3.008544859209, -1.57657659519}},
  {1,
   4,
   -114.6587278360604,
   {-107.7062506089, -115.0615725867, -114.6838385288, 511.2493253353, -117.4281198155}},
  {1,
   5,
   210.0706136621665,
   {281.494344857, 212.8540945207, 209.967729619, -236114.8417516, 3448.715084131}},
  {1,
   6,
   2605.934358861923,
   {2095.688154043, 2617.75725604, 2607.425755301, 93986794.09788, -536764.9457135}},
  {2,
   2,
   2.694438144457007,
   {2.64507176816, 2.694386644994, 2.694471943002, 2.694867070412, 2.694452053898}},
  {2,
   3,
   -7.1888131494384,
   {-7.503095168266, -7.223370375947, -7.190774694472, -7.437025228256, -7.197972864382}},
  {2,
   4,
   -32.80132336390862,
   {-23.55607268256, -32.51438042478, -32.80933340267, 59.53043513, -34.94907251863}},
  {2,
   5,
   401.8195846346452,
   {349.9865809182, 403.0254828241, 402.1558441011, -28478.11053853, 3828.541788997}},
  {2,
   6,
   -1673.709636445134,
   {-1821.554672994, -1716.068490266, -1677.596877275, 9086271.473429, -900647.1052508}},
};

static int measure(steif_context *ctx, int m, int k, int g, size_t count, steif_weak_row *row,
                   steif_weak_result *result)
{
  char problem[48];
  steif_function *f = steif_function_parse(ctx, function[g].text, 1, NULL);
  const steif_weight weight = {steif_function_taylor, f, function[g].t1, 1e-15};
  snprintf(problem, sizeof problem, "jordan:k=%d,case=N-inc", k);
  const steif_weak_query query = {.method = method[m].method,
                                  .problem = problem,
                                  .convention = method[m].convention,
                                  .start = method[m].start,
                                  .h = 1.0 / 64,
                                  .rows = count,
                                  .g = &weight};
  const int code = steif_weak_measure(ctx, &query, row, result);
  if (code) printf("\n  %s: %s", query.method, steif_message(ctx));
  steif_function_free(&f);
  return code;
}

static void pairings_with_other_functions(void)
{
  steif_context *ctx = steif_context_new(NULL);
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
    for (int m = 0; m < METHODS; m++) {
      steif_weak_row row;
      steif_weak_result result;
      CHECK(!measure(ctx, m, rows[i].k, rows[i].g, 1, &row, &result));
      CLOSE(result.exact, rows[i].exact, 2e-14);
      CHECK(fabs(row.value - rows[i].value[m]) <=
            2e-12 * fabs(rows[i].value[m]) + 4 * row.rounding);
      CHECK(row.rounding <= 1e-6 * fabs(row.value));
    }
  steif_context_free(&ctx);
}

/* Radau IIA with 3 stages does not converge at index 5, but the first term of its error is an odd derivative
 * of g at 0: with the bump it seems to, order 1. Impulses of order 3 by themselves tell. */
static void what_is_not_seen_does_not_converge(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_weak_row row[4];
  steif_weak_result result;
  CHECK(!measure(ctx, 4, 5, 0, 4, row, &result));
  CHECK(fabs(row[3].order - 1) < 0.05);
  CHECK(result.converges == 0 && strstr(result.verdict, "impulses of order 3") != NULL);
  CHECK(!measure(ctx, 4, 5, 2, 4, row, &result) && result.converges == 0);
  CHECK(!measure(ctx, 4, 4, 2, 4, row, &result) && result.converges == 1);
  CHECK(!measure(ctx, 0, 2, 0, 4, row, &result) && result.converges == 1);
  CHECK(!*result.note);
  steif_context_free(&ctx);
}

/* Convolution quadrature of BDF3 has order 3 for every g. Steps of 0.6 to 0.04 beside cos 5t: the errors
 * change their sign, and log2 of their sizes comes to 2.1. */
static void errors_of_either_sign_show_no_order(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_weak_row row[5];
  steif_weak_result result;
  steif_function *f = steif_function_parse(ctx, function[1].text, 1, NULL);
  const steif_weight weight = {steif_function_taylor, f, function[1].t1, 1e-15};
  const steif_weak_query query = {.method = "bdf:p=3",
                                  .problem = "jordan:k=3,case=N-cons",
                                  .convention = STEIF_C,
                                  .start = "cq",
                                  .rows = 5,
                                  .g = &weight};
  CHECK(!steif_weak_measure(ctx, &query, row, &result));
  CHECK(row[2].error * row[4].error < 0 && fabs(row[4].order - 3) > 0.5);
  CHECK(result.converges == 1 && fabs(result.order - 3) < 0.1);
  steif_function_free(&f), steif_context_free(&ctx);
}

static int flat(long double t, int order, long double *c, void *user)
{
  (void)t;
  for (int j = 0; j <= order; j++) c[j] = j ? 0 : 1;
  return user != NULL && order > 0;
}

static void ends_and_missing_derivatives_are_told(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_weak_row row[3];
  steif_weak_result result;
  steif_weight g = {flat, NULL, 1, 0};
  steif_weak_query query = {.method = "be",
                            .problem = "jordan:k=3,case=N-inc",
                            .convention = STEIF_R,
                            .h = 1.0 / 64,
                            .rows = 3,
                            .g = &g};
  CHECK(!steif_weak_measure(ctx, &query, row, &result));
  CHECK(strstr(result.note, "cut off") != NULL && result.converges == -1);
  g.user = &g;
  CHECK(steif_weak_measure(ctx, &query, row, &result) == STEIF_BAD_INPUT);
  CHECK(strstr(steif_message(ctx), "no derivatives") != NULL);
  g.t1 = NAN;
  CHECK(steif_weak_measure(ctx, &query, row, &result) == STEIF_BAD_INPUT);
  g = (steif_weight){flat, NULL, 1e-3, 0}, query.h = 0;
  CHECK(!steif_weak_measure(ctx, &query, row, &result) && row[0].h == 1e-3 / 64);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_functions[] = {
  {"bump, decaying cosine and a user's function pair to 12 digits",
   pairings_with_other_functions},
  {"what g does not see does not converge", what_is_not_seen_does_not_converge},
  {"errors of either sign show no order", errors_of_either_sign_show_no_order},
  {"ends and missing derivatives are told", ends_and_missing_derivatives_are_told},
  CU_TEST_INFO_NULL};
