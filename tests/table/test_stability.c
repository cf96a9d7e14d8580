/* test_stability.c: R(z) against closed forms, R(inf) against published values.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"
#include "table.h"
#include <complex.h>
#include <string.h>

static double complex R(steif_context *ctx, const char *spec, double complex z)
{
  steif_table *t = steif_table_new(ctx, spec);
  CU_ASSERT_FATAL(t != NULL);
  const double at[2] = {creal(z), cimag(z)};
  double value[2] = {NAN, NAN};
  CHECK(steif_table_stability(ctx, t, at, value) == STEIF_OK);
  steif_table_free(ctx, &t);
  return value[0] + value[1] * I;
}

static const double complex points[] = {0.31 - 0.42 * I, -3.7 + 2.9 * I, 41.3 * I,
                                        -812.5 + 17 * I, 1e-9 + 2e-9 * I};
enum { POINTS = sizeof points / sizeof *points };

#define AGREE(spec, form)                                                                      \
  for (int k = 0; k < POINTS; k++) {                                                           \
    const double complex z = points[k], e = (form);                                            \
    CHECK(cabs(R(ctx, spec, z) - e) <= 2e-15 * cabs(e) + STF_EPS);                             \
  }

/* Pade approximants of exp: Hairer, Wanner: Solving ODEs II, table IV.3.1. */
static void closed_forms(void)
{
  steif_context *ctx = steif_context_new(NULL);
  AGREE("radau:s=1", 1 / (1 - z))
  AGREE("radau:s=2", (6 + 2 * z) / (6 - 4 * z + z * z))
  AGREE("radau1a:s=2", (6 + 2 * z) / (6 - 4 * z + z * z))
  AGREE("radau:s=3", (60 + 24 * z + 3 * z * z) / (60 - 36 * z + 9 * z * z - z * z * z))
  AGREE("gauss:s=1", (2 + z) / (2 - z))
  AGREE("cranknicolson", (2 + z) / (2 - z))
  AGREE("gauss:s=2", (12 + 6 * z + z * z) / (12 - 6 * z + z * z))
  AGREE("lobatto3c:s=2", 2 / (2 - 2 * z + z * z))
  AGREE("lobatto3c:s=3", (24 + 6 * z) / (24 - 18 * z + 6 * z * z - z * z * z))
  AGREE("euler", 1 + z)
  AGREE("rk4", 1 + z * (1 + z / 2 * (1 + z / 3 * (1 + z / 4))))
  steif_context_free(&ctx);
}

/* alexander2 and alexander2b share (1 + (1-2g) z)/(1 - g z)^2. */
static void two_forms_of_one_function(void)
{
  steif_context *ctx = steif_context_new(NULL);
  const double g = 1 - 1 / sqrt(2.0);
  AGREE("alexander2", (1 + (1 - 2 * g) * z) / ((1 - g * z) * (1 - g * z)))
  AGREE("alexander2b", (1 + (1 - 2 * g) * z) / ((1 - g * z) * (1 - g * z)))
  steif_context_free(&ctx);
}

/* At z = -1e12, where 1 + z b^T (..) 1 would keep 4 digits of a stiffly accurate method. */
static void decay_keeps_its_digits(void)
{
  steif_context *ctx = steif_context_new(NULL);
  const double z = -1e12, g = 2 - sqrt(2.0);
  const double radau3 = (60 + 24 * z + 3 * z * z) / (60 - 36 * z + 9 * z * z - z * z * z);
  CLOSE(creal(R(ctx, "radau:s=3", z)), radau3, 1e-14);
  /* order 2, a double pole at 1/d and R(inf) = 0 leave one function; 1e-4 = rounding of A times
   * z */
  const double d = g / 2, trbdf2 = (1 + (1 - 2 * d) * z) / ((1 - d * z) * (1 - d * z));
  CLOSE(creal(R(ctx, "trbdf2", z)), trbdf2, 3e-4);
  steif_context_free(&ctx);
}

static void limits(void)
{
  const struct {
    const char *spec;
    double value;
  } all[] = {{"radau:s=1", 0},
             {"radau:s=2", 0},
             {"radau:s=3", 0},
             {"gauss:s=1", -1},
             {"gauss:s=2", 1},
             {"gauss:s=3", -1},
             {"lobatto3c", 0},
             {"lobatto3c:s=2", 0},
             {"alexander2", 0},
             {"alexander2b", 0},
             {"alexander3", 0},
             {"radau1a:s=2", 0},
             {"trbdf2", 0},
             {"esdirk43", 0},
             {"hw43", 0},
             {"cranknicolson", -1},
             {"gauss:s=12", 1},
             {"gauss:s=15", -1},
             {"crouzeix23", -0.73205080756887729353}}; /* 1 - sqrt(3) */
  steif_context *ctx = steif_context_new(NULL);
  for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
    const double complex v = R(ctx, all[i].spec, -INFINITY);
    CLOSE_FLOOR(creal(v), all[i].value, 1e-14, 1);
    CHECK(fabs(cimag(v)) < 1e-14);
    const double complex near = R(ctx, all[i].spec, -1e13);
    CLOSE_FLOOR(creal(near), all[i].value, 1e-10, 1);
  }
  CHECK(isinf(creal(R(ctx, "euler", -INFINITY))));
  CHECK(isinf(creal(R(ctx, "rk4", -INFINITY))));
  steif_context_free(&ctx);
}

static int ask(steif_context *ctx, const steif_table *t, double re, double im, double *value)
{
  const double z[2] = {re, im};
  value[0] = value[1] = NAN;
  return steif_table_stability(ctx, t, z, value);
}

static void poles_and_singular_tables(void)
{
  steif_context *ctx = steif_context_new(NULL);
  double v[2];
  steif_table *t = steif_table_new(ctx, "gauss:s=1");
  CHECK(ask(ctx, t, 2, 0, v) == STEIF_OK && isinf(v[0]));
  CHECK(ask(ctx, t, NAN, 0, v) == STEIF_BAD_INPUT);
  CHECK(steif_table_stability(ctx, t, v, NULL) == STEIF_BAD_INPUT);
  steif_table_free(ctx, &t);
  CHECK(ask(ctx, NULL, 1, 0, v) == STEIF_BAD_INPUT);

  /* first row 0 and b off the last row: R = 1 + z (0.7 + 0.3 (2 + z)/(2 - z)), unbounded */
  const double trapezium[] = {0, 0, 0.5, 0.5}, skew[] = {0.7, 0.3};
  const steif_table grows = {
    .name = "skew", .kind = STEIF_DIRK, .s = 2, .A = trapezium, .b = skew};
  CHECK(ask(ctx, &grows, -INFINITY, 0, v) == STEIF_OK && isinf(v[0]));
  /* Lobatto IIIB with two stages: A is singular by its last column, R(inf) unknown to us */
  const double lobatto3b[] = {0.5, 0, 0.5, 0}, half[] = {0.5, 0.5};
  const steif_table b3 = {
    .name = "b3", .kind = STEIF_COLLOCATION, .s = 2, .A = lobatto3b, .b = half};
  CHECK(ask(ctx, &b3, -INFINITY, 0, v) == STEIF_UNSUPPORTED);
  CHECK(strstr(steif_message(ctx), "'b3'"));
  CHECK(ask(ctx, &b3, -1.7, 0, v) == STEIF_OK);
  CLOSE(v[0], (2 - 1.7) / (2 + 1.7), 1e-15); /* R is that of the trapezoidal rule */
  /* two explicit stages */
  const double twice[] = {0, 0, 0, 0.5, 0, 0, 0.2, 0.3, 0.5};
  const steif_table two = {
    .name = "two", .kind = STEIF_DIRK, .s = 3, .A = twice, .b = twice + 6};
  CHECK(ask(ctx, &two, -INFINITY, 0, v) == STEIF_UNSUPPORTED);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_stability[] = {
  {"R(z) equals Pade's and Taylor's closed forms", closed_forms},
  {"both forms of Alexander's method share one function", two_forms_of_one_function},
  {"stiffly accurate methods decay without cancellation", decay_keeps_its_digits},
  {"R(inf) has the published value and is the limit", limits},
  {"poles, unbounded and undecided limits are told apart", poles_and_singular_tables},
  CU_TEST_INFO_NULL};
