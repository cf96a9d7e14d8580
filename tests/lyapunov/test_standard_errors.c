/* test_standard_errors.c: how often the standard errors of exponents cover the truth. With 16 parts it should lie
 * within 1 of them in 2/3 of all runs and within 2.131 in 19/20 (Student's t, 15 degrees of freedom)
 * where parts are independent; sums that are bounded or anticorrelated make the shares larger.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"
#include <nvector/nvector_serial.h>
#include <steif/collection.h>
#include <steif/lyapunov.h>
#include <sunmatrix/sunmatrix_dense.h>

typedef struct tally {
  int runs, within_one, within_two;
} tally;

static void count(tally *c, double exponent, double truth, double error)
{
  const double off = fabs(exponent - truth);
  c->runs++, c->within_one += off <= error, c->within_two += off <= 2.131 * error;
}

static void covers(const tally *c, double one, double two)
{
  const int good = c->within_one >= one * c->runs && c->within_two >= two * c->runs;
  if (!good)
    printf("\n  of %d runs %d within 1 and %d within 2.131 standard errors", c->runs,
           c->within_one, c->within_two);
  CHECK(good && c->runs > 0);
}

/* -- independent steps ------------------------------------------------------------------------ */

/* Uniform in [-1, 1), by the number of the step: splitmix64 (G. L. Steele, D. Lea and C. H. Flood,
 * OOPSLA 2014). */
static double rate(double t)
{
  unsigned long long x = (unsigned long long)llround(2 * t) * 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return (double)((x ^ (x >> 31)) >> 11) / 4503599627370496.0 - 1;
}

static int f(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  (void)user;
  NV_Ith_S(r, 0) = rate(t) * NV_Ith_S(y, 0);
  return 0;
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
               N_Vector b, N_Vector c)
{
  (void)y, (void)fy, (void)user, (void)a, (void)b, (void)c;
  SM_ELEMENT_D(J, 0, 0) = rate(t);
  return 0;
}

/* Euler's step of h = 1/2 multiplies by 1 + u/2: the mean of the logarithm is
 * (3/2) ln(3/2) - (1/2) ln(1/2) - 1. */
static void independent_steps_give_the_shares_of_t(void)
{
  enum { RUNS = 1000, STEPS = 320 };
  static const double y0[] = {1};
  const double truth = 2 * (1.5 * log(1.5) - 0.5 * log(0.5) - 1);
  steif_context *ctx = steif_context_new(NULL);
  tally c = {0};
  for (int k = 0; k < RUNS; k++) {
    const steif_problem p = {.name = "walk",
                             .n = 1,
                             .t0 = k * STEPS / 2.0,
                             .t1 = (k + 1) * STEPS / 2.0,
                             .y0 = y0,
                             .f = f,
                             .jac = jac};
    double x = NAN, error = NAN;
    const steif_lyapunov_options o = {.h = 0.5, .linear = 1, .error = &error};
    CHECK(steif_lyapunov(ctx, &p, "euler", &o, &x, NULL, NULL) == STEIF_OK);
    count(&c, x, truth, error);
  }
  covers(&c, 0.62, 0.93); /* three standard deviations of the shares below 0.667 and 0.95 */
  CHECK(c.within_one <= 0.72 * RUNS && c.within_two <= 0.975 * RUNS);
  steif_context_free(&ctx);
}

/* -- periodic and chaotic problems ------------------------------------------------------------ */

/* Floquet exponents with h = 2 pi / 64, as in test_lyapunov.c; the runs begin anywhere in a period. */
static void floquet_exponents_are_covered(void)
{
  static const struct {
    const char *problem, *method;
    double exponent[2];
  } row[] = {{"steyer:a=1.2,b1=-0.3,b2=-0.8,beta=1,omega=1",
              "radau:s=2",
              {-0.299914324739, -0.800101906246}},
             {"steyer:a=1.2,b1=-0.3,b2=-0.8,beta=1,omega=0",
              "bdf:p=2",
              {-0.302307969824, -0.808253881601}}};
  steif_context *ctx = steif_context_new(NULL);
  for (int i = 0; i < 2; i++) {
    steif_problem p;
    tally c[2] = {{0}, {0}};
    CU_ASSERT_FATAL(steif_problem_find(ctx, row[i].problem, &p) == STEIF_OK);
    for (int steps = 100; steps < 3000; steps += 37) {
      double x[2] = {NAN, NAN}, error[2] = {NAN, NAN};
      const steif_lyapunov_options o = {
        .h = acos(-1) / 32, .t1 = steps * acos(-1) / 32, .error = error};
      CHECK(steif_lyapunov(ctx, &p, row[i].method, &o, x, NULL, NULL) == STEIF_OK);
      for (int j = 0; j < 2; j++) count(&c[j], x[j], row[i].exponent[j], error[j]);
    }
    for (int j = 0; j < 2; j++) covers(&c[j], 2.0 / 3, 0.95);
    steif_problem_clear(ctx, &p);
  }
  steif_context_free(&ctx);
}

/* (.9056, 0, -14.5723): J. C. Sprott, Chaos and Time-Series Analysis (2003), table A.5. */
static void lorenz_is_covered(void)
{
  static const double truth[] = {0.9056, 0, -14.5723};
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  tally c[3] = {{0}, {0}, {0}};
  CU_ASSERT_FATAL(steif_problem_find(ctx, "lorenz", &p) == STEIF_OK);
  for (int k = 1; k <= 60; k++) {
    double x[3] = {NAN, NAN, NAN}, error[3] = {NAN, NAN, NAN};
    const double start[] = {1 + 3 * sin(k), 1 + 3 * cos(2 * k), 20 + sin(3 * k)};
    const steif_lyapunov_options o = {.h = 0.01, .t1 = 110, .transient = 10, .error = error};
    steif_problem q = p;
    q.y0 = start;
    CHECK(steif_lyapunov(ctx, &q, "rk4", &o, x, NULL, NULL) == STEIF_OK);
    for (int j = 0; j < 3; j++) count(&c[j], x[j], truth[j], error[j]);
  }
  for (int j = 0; j < 3; j++) covers(&c[j], 2.0 / 3, 0.95);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_errors[] = {
  {"independent steps give the shares of Student's t", independent_steps_give_the_shares_of_t},
  {"Floquet exponents are covered", floquet_exponents_are_covered},
  {"the exponents of Lorenz' equations are covered", lorenz_is_covered},
  CU_TEST_INFO_NULL};
