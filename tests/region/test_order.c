/* test_order.c: errors and slopes of x' = diag(-1, -1000) x, x(0) = (1, 1), at t = 4.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "region.h"
#include "suite.h"
#include <steif/data.h>
#include <nvector/nvector_serial.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

static int f(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  (void)t, (void)user;
  NV_Ith_S(r, 0) = -NV_Ith_S(y, 0);
  NV_Ith_S(r, 1) = -1000 * NV_Ith_S(y, 1);
  return 0;
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
               N_Vector b, N_Vector c)
{
  (void)t, (void)y, (void)fy, (void)user, (void)a, (void)b, (void)c;
  SM_ELEMENT_D(J, 0, 0) = -1;
  SM_ELEMENT_D(J, 1, 1) = -1000;
  return 0;
}

static int exact(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  NV_Ith_S(y, 0) = exp(-t);
  NV_Ith_S(y, 1) = exp(-1000 * t);
  return yp ? f(t, y, yp, user) : 0;
}

static const sunrealtype start[] = {1, 1};
static const steif_problem pair = {.name = "pair",
                                   .n = 2,
                                   .t1 = 4,
                                   .y0 = start,
                                   .f = f,
                                   .jac = jac,
                                   .linear = 1,
                                   .exact = exact};

/* Largest component error at t = 4 for h = 1/2 .. 1/32, from closed forms in 50 digits. */
static const struct row {
  const char *method, *start;
  double error[5];
} rows[] = {
  {"be",
   NULL,
   {2.0702803422e-02, 9.8318587823e-03, 4.7581694934e-03, 2.3356861264e-03, 1.1564669106e-03}},
  {"bdf:p=2",
   "ramp",
   {3.9927222221e-03, 8.3222219986e-04, 1.8601182957e-04, 4.4038988300e-05, 1.0717276289e-05}},
  {"radau:s=3",
   NULL,
   {2.9523378511e-07, 9.5472066641e-09, 3.0415989172e-10, 9.6023675e-12, 3.01e-13}},
  {"gauss:s=2",
   NULL,
   {8.2530686856e-01, 4.6394002372e-01, 4.6328422126e-02, 4.6068015e-06, 9.7046e-11}},
};

static void errors_of_a_stiff_pair(void)
{
  steif_context *ctx = steif_context_new(NULL);
  for (size_t r = 0; r < sizeof rows / sizeof *rows; r++) {
    steif_options o = steif_defaults();
    steif_order_row row[5];
    o.start = rows[r].start;
    const int code = steif_order_measure(ctx, &pair, rows[r].method, &o, 0.5, 5, row);
    if (code != STEIF_OK) printf("\n  %s: %s", rows[r].method, steif_message(ctx));
    CHECK(code == STEIF_OK);
    for (int i = 0; i < 5; i++) {
      const double error = rows[r].error[i];
      /* eight digits, and rounding of a solution near 1/50 */
      CLOSE(row[i].error, error, 1e-8 + 1e-15 / error);
      CHECK(row[i].h == ldexp(0.5, -i));
      if (i > 0) CLOSE_FLOOR(row[i].order, log2(rows[r].error[i - 1] / error), 1e-2, 1);
    }
    CHECK(isnan(row[0].order));
  }
  steif_context_free(&ctx);
}

/* A reference value in place of a closed solution, of one component: exp(-4). */
static void reference_serves_as_well(void)
{
  static const sunrealtype value[] = {1.8315638888734180e-02};
  const steif_reference reference = {.t = 4, .count = 1, .value = value, .digits = 17};
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p = pair;
  steif_order_row row[2];
  p.exact = NULL, p.reference = &reference;
  CHECK(steif_order_measure(ctx, &p, "be", NULL, 0.0625, 2, row) == STEIF_OK);
  CLOSE(row[1].error, 1.1564669106e-03, 1e-9);
  p.t1 = 3;
  CHECK(steif_order_measure(ctx, &p, "be", NULL, 0.0625, 2, row) == STEIF_UNSUPPORTED);
  CHECK(strstr(steif_message(ctx), "pair") != NULL);
  p.reference = NULL;
  CHECK(steif_order_measure(ctx, &p, "be", NULL, 0.0625, 2, row) == STEIF_UNSUPPORTED);
  steif_context_free(&ctx);
}

/* 1/16 for order 1, 1/4 from 3 on, 1/2 above 5. */
static void without_a_step_the_order_decides(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_order_row row[1];
  CHECK(steif_order_measure(ctx, &pair, "be", NULL, 0, 1, row) == STEIF_OK);
  CLOSE(row[0].h, 0.0625, 1e-15);
  CHECK(steif_order_measure(ctx, &pair, "gauss:s=2", NULL, 0, 1, row) == STEIF_OK);
  CLOSE(row[0].h, 0.25, 1e-15);
  CHECK(steif_order_measure(ctx, &pair, "gauss:s=3", NULL, 0, 1, row) == STEIF_OK);
  CLOSE(row[0].h, 0.5, 1e-15);
  steif_context_free(&ctx);
}

/* The sum of 15 stages loses seven digits unless it is compensated. */
static void gauss_of_order_30_reaches_rounding(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  steif_order_row row[2];
  CHECK(!steif_problem_find(ctx, "harmonic", &p));
  CHECK(steif_order_measure(ctx, &p, "gauss:s=15", NULL, 0.75, 2, row) == STEIF_OK);
  CHECK(row[0].error < 4e-15 && row[1].error < 4e-15 && row[0].compensated &&
        row[1].end == 1.5);
  CHECK(steif_order_measure(ctx, &p, "gauss:s=15,compensated=0", NULL, 0.75, 1, row) ==
        STEIF_OK);
  CHECK(row[0].error > 1e-12 && !row[0].compensated);
  CHECK(steif_order_measure(ctx, &p, "radau:s=8", NULL, 0.75, 1, row) == STEIF_OK);
  CHECK(row[0].error < 1e-13 && !row[0].compensated);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* Steps are used as they are: 0.3 makes 13 in 4, and 0.15 makes 26. */
static void steps_that_do_not_fit_end_before(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_order_row row[2];
  CHECK(steif_order_measure(ctx, &pair, "gauss:s=2", NULL, 0.3, 2, row) == STEIF_OK);
  CHECK(row[0].h == 0.3 && row[1].h == 0.15);
  CLOSE(row[0].end, pair.t0 + floor((pair.t1 - pair.t0) / 0.3) * 0.3, 1e-15);
  steif_context_free(&ctx);
}

static void bad_questions_are_rejected(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_order_row row[2];
  CHECK(steif_order_measure(ctx, &pair, "be", NULL, -0.3, 2, row) == STEIF_BAD_INPUT);
  CHECK(steif_order_measure(ctx, &pair, "be", NULL, 7.1, 2, row) == STEIF_BAD_INPUT);
  CHECK(steif_order_measure(ctx, &pair, "be", NULL, 0.3, 0, row) == STEIF_BAD_INPUT);
  CHECK(steif_order_measure(ctx, NULL, "be", NULL, 0.3, 2, row) == STEIF_BAD_INPUT);
  CHECK(steif_order_measure(ctx, &pair, "badau", NULL, 0.3, 2, row) == STEIF_UNKNOWN_NAME);
  steif_context_free(&ctx);
}

static int slow(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  (void)t, (void)user;
  N_VScale(-1, y, r);
  return 0;
}

static int slow_jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
                    N_Vector b, N_Vector c)
{
  (void)t, (void)y, (void)fy, (void)user, (void)a, (void)b, (void)c;
  SM_ELEMENT_D(J, 0, 0) = SM_ELEMENT_D(J, 1, 1) = -1;
  return 0;
}

static int slow_exact(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  (void)yp, (void)user;
  N_VConst(exp(-t), y);
  return 0;
}

/* x' = -x by RK4: (1 - h + h^2/2 - h^3/6 + h^4/24)^n in more digits tells what a run in double makes of it. */
static void rounding_is_told(void)
{
  static const double y0[] = {1, 1};
  steif_context *ctx = steif_context_new(NULL);
  const steif_problem p = {
    .name = "p", .n = 2, .t1 = 4, .y0 = y0, .f = slow, .jac = slow_jac, .exact = slow_exact};
  steif_order_row row[4];
  CHECK(steif_order_measure(ctx, &p, "rk4", NULL, 1. / 8, 4, row) == STEIF_OK);
  CHECK(isnan(row[0].rounding));
  CHECK(steif_order_rounding(ctx, &p, "rk4", NULL, 4, row) == STEIF_OK);
  for (int i = 0; i < 4; i++) {
    const double h = row[i].h,
                 e = pow(1 - h + h * h / 2 - h * h * h / 6 + h * h * h * h / 24, 4 / h);
    CHECK(row[i].rounding < 1e-14 && row[i].error > 1e3 * row[i].rounding);
    CLOSE(row[i].error, e - exp(-4), 1e-4);
  }
  /* (h = 1/4096)^4/30 e^-4 is 2e-18: these errors are rounding alone. */
  CHECK(steif_order_measure(ctx, &p, "rk4", NULL, 1. / 4096, 2, row) == STEIF_OK);
  CHECK(steif_order_rounding(ctx, &p, "rk4", NULL, 2, row) == STEIF_OK);
  for (int i = 0; i < 2; i++)
    CHECK(row[i].rounding > 0 && row[i].rounding > 0.01 * row[i].error);
  CHECK(steif_order_rounding(ctx, &p, "rk4", NULL, 2, NULL) == STEIF_BAD_INPUT);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_order[] = {
  {"errors of a stiff pair at t = 4 are the closed ones", errors_of_a_stiff_pair},
  {"a reference value serves as well as a closed solution", reference_serves_as_well},
  {"without a step size the order decides", without_a_step_the_order_decides},
  {"Gauss of order 30 reaches rounding", gauss_of_order_30_reaches_rounding},
  {"steps that do not fit end before t1", steps_that_do_not_fit_end_before},
  {"bad questions are rejected", bad_questions_are_rejected},
  {"rounding is told", rounding_is_told},
  CU_TEST_INFO_NULL};
