/* test_bdf.c: BDF and its starting procedures at h = 1/128.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "weak/data.h"

/* Errors at h = 2^-7 and orders between 2^-6 and 2^-7. Constant history and ramp: H-inc in R; CQ:
 * N-cons and N-inc in C, H-inc from k = 3 on (0: exact for k = 2). p = 6, k = 4 is left out but for
 * the ramp: errors of 4e-9 to 9e-9 lie below rounding(). */
static const struct row {
  int p, k;
  double flat, flat_order, ramp, ramp_order, cq, cq_order, cons, cons_order, inc, inc_order;
} rows[] = {
  {1, 2, -0.0613739, 0.9739, -0.0613739, 0.9739, 0, 0, -0.0306952, 0.9649, -0.0306952, 0.9649},
  {1, 3, 1.21583, 0.9603, 1.21583, 0.9603, 0.646096, 0.9776, 0.383669, 0.9299, 1.24297, 0.963},
  {1, 4, -14.031, 0.9528, -14.031, 0.9528, -9.61783, 0.9666, -0.868824, 0.9001, -11.7877,
   0.9616},
  {2, 2, -0.00219998, 1.949, -0.971513, -0.03501, 0, 0, -0.000482135, 1.936, -0.000482135,
   1.936},
  {2, 3, 0.0376233, 1.957, 196.844, -0.9663, 0.0199157, 1.958, 0.00443693, 1.943, 0.0309247,
   1.956},
  {2, 4, -0.362927, 1.966, -33666.5, -1.957, -0.24715, 1.966, 0.00130773, 1.979, -0.277888,
   1.966},
  {3, 2, -7.64341e-5, 2.932, -0.402079, 0.2042, 0, 0, -1.96311e-5, 2.923, -1.96311e-5, 2.923},
  {3, 3, 0.00108086, 2.946, -93.2359, -1.63, 0.000578648, 2.946, 0.000139803, 2.941,
   0.000909404, 2.945},
  {3, 4, -0.00826473, 2.961, 62328.5, -2.208, -0.00565174, 2.96, 0.000113846, 2.92, -0.00621909,
   2.962},
  {4, 2, -2.37582e-6, 3.924, -0.802679, -0.03716, 0, 0, -6.82826e-7, 3.916, -6.82826e-7, 3.916},
  {4, 3, 2.65084e-5, 3.944, 294.499, -1.169, 1.44421e-5, 3.943, 3.47113e-6, 3.945, 2.26791e-5,
   3.943},
  {4, 4, -0.000149076, 3.965, -145185.0, -2.249, -0.000102614, 3.964, 5.34075e-6, 3.923,
   -0.000107993, 3.968},
  {5, 2, -6.19777e-8, 4.926, -0.502222, 0.1542, 0, 0, -2.0058e-8, 4.917, -2.0058e-8, 4.917},
  {5, 3, 5.05289e-7, 4.954, -218.003, -1.714, 2.83634e-7, 4.951, 6.3571e-8, 4.962, 4.40803e-7,
   4.952},
  {5, 4, -1.80235e-6, 4.981, 266014.0, -2.406, -1.25479e-6, 4.981, 1.52748e-7, 4.941,
   -1.18829e-6, 4.989},
  {6, 2, -1.25655e-9, 5.939, -0.736837, -0.03047, 0, 0, -4.72684e-10, 5.928, -4.72684e-10,
   5.928},
  {6, 3, 6.44034e-9, 5.975, 468.76, -1.387, 3.84844e-9, 5.969, 6.82561e-10, 6.006, 5.80098e-9,
   5.974},
  {6, 4, 0, 0, -526538.0, -2.484, 0, 0, 0, 0, 0, 0},
};
enum { ROWS = sizeof rows / sizeof *rows };

/* Rounding of a weak value at h = 2^-7: the layer holds terms of size h^-(k-1), and its p (k-1)
 * steps amplify the rounding of the coefficients by a few times p each. */
static double rounding(int p, int k) { return 2.2e-16 * pow(128, k - 2) * pow(4 * p, k - 1); }

static void check(steif_context *ctx, const struct row *r, const char *name,
                  enum steif_convention c, const char *start, double error, double order)
{
  char method[16];
  steif_weak_row row[2];
  steif_weak_result result;
  if (error == 0) return;
  snprintf(method, sizeof method, "bdf:p=%d", r->p);
  CHECK(weak_rows(ctx, method, r->k, name, c, start, 1.0 / 64, 2, row, &result) == STEIF_OK);
  const double blur = rounding(r->p, r->k) / fabs(error);
  CLOSE(row[1].error, error, 1e-5 + blur);
  CLOSE_FLOOR(row[1].order, order, 6e-4 + 2 * blur, 1);
}

static void constant_history_has_order_p(void)
{
  steif_context *ctx = steif_context_new(NULL);
  for (int i = 0; i < ROWS; i++)
    check(ctx, rows + i, "H-inc", STEIF_R, "constant", rows[i].flat, rows[i].flat_order);
  steif_context_free(&ctx);
}

static void ramp_start_does_not_converge(void)
{
  steif_context *ctx = steif_context_new(NULL);
  for (int i = 0; i < ROWS; i++)
    check(ctx, rows + i, "H-inc", STEIF_R, "ramp", rows[i].ramp, rows[i].ramp_order);
  steif_context_free(&ctx);
}

static void convolution_quadrature_has_order_p(void)
{
  steif_context *ctx = steif_context_new(NULL);
  for (int i = 0; i < ROWS; i++) {
    check(ctx, rows + i, "H-inc", STEIF_C, "cq", rows[i].cq, rows[i].cq_order);
    check(ctx, rows + i, "N-cons", STEIF_C, "cq", rows[i].cons, rows[i].cons_order);
    check(ctx, rows + i, "N-inc", STEIF_C, "cq", rows[i].inc, rows[i].inc_order);
  }
  steif_context_free(&ctx);
}

/* k = 2, H-inc: N x0 / h at t = 0 is a perfect discrete delta. */
static void convolution_quadrature_is_exact_for_one_delta(void)
{
  steif_context *ctx = steif_context_new(NULL);
  for (int p = 1; p <= 6; p++) {
    char method[16];
    steif_weak_row row[3];
    steif_weak_result result;
    snprintf(method, sizeof method, "bdf:p=%d", p);
    CHECK(weak_rows(ctx, method, 2, "H-inc", STEIF_C, "cq", 1.0 / 20, 3, row, &result) ==
          STEIF_OK);
    for (int i = 0; i < 3; i++) CLOSE(row[i].value, 2.0, 2e-14);
    CHECK(result.converges == 1);
    CHECK(!strcmp(result.verdict, "exact to rounding at every h measured"));
  }
  steif_context_free(&ctx);
}

/* BDF2, k = 2, x(0-) = (1, 2): constant history gives 3a/(2h), -a/(2h), 0, ... with a = 2; the ramp
 * gives a/h, -a/(2h), 0, ...: half of the impulse is lost. */
static void ramp_loses_half_of_the_impulse(void)
{
  steif_context *ctx = steif_context_new(NULL);
  enum { n = 5 };
  const double h = 1.0 / 32, flat[] = {3 / h, -1 / h, 0, 0, 0},
               ramp[] = {2 / h, -1 / h, 0, 0, 0};
  for (int i = 0; i < 2; i++) {
    sunrealtype t[n + 1], x[2 * n + 2], exact[2 * n + 2], error[n + 1];
    steif_layer_result result;
    CHECK(steif_layer_measure(ctx, "bdf:p=2", "jordan:k=2,case=H-inc", i ? "ramp" : "constant",
                              h, n, t, x, exact, error, &result) == STEIF_OK);
    double strength = 0;
    for (int j = 0; j < n; j++) {
      CLOSE_FLOOR(x[2 * j + 2], (i ? ramp : flat)[j], 1e-13, 2 / h);
      strength += h * x[2 * j + 2];
    }
    CLOSE(strength, i ? 1.0 : 2.0, 1e-13);
    CHECK(result.layer_steps == 2);
  }
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_bdf[] = {
  {"constant history: weak order p on H-inc", constant_history_has_order_p},
  {"ramp start: no weak convergence for p >= 2", ramp_start_does_not_converge},
  {"CQ-BDF-p: weak order p for every f and x(0-)", convolution_quadrature_has_order_p},
  {"CQ-BDF-p: exact for one delta", convolution_quadrature_is_exact_for_one_delta},
  {"BDF2 with a ramp start loses half of the impulse", ramp_loses_half_of_the_impulse},
  CU_TEST_INFO_NULL};
