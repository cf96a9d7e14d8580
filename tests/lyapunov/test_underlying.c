/* test_underlying.c: underlying one-step maps: their orders in both coordinates, and that they
 * forget the columns they were found with. Expected orders: local error O(h^{p+1}) of the
 * solution; O(h^2) of the principal coordinate, O(h^3) where ell has no weight on slopes
 * (nord22).
 * SPDX-License-Identifier: BSD-3-Clause */
#include "region.h"
#include "suite.h"
#include <steif/collection.h>
#include <steif/lyapunov.h>
#include <string.h>

static const char problem_spec[] = "steyer:a=1.2,b1=-0.3,b2=-0.8,beta=1,omega=1";

static double distance(const double *x, const double *y)
{
  double most = 0;
  for (int i = 0; i < 4; i++) most = fmax(most, fabs(x[i] - y[i]));
  return most;
}

/* Errors of both maps at t = 4.8. */
static void errors(steif_context *ctx, const steif_problem *p, const char *method, double h,
                   double error[2])
{
  double w[4], f[4], exact[4];
  steif_underlying u = {.burn_in = lround(4.8 / h), .Phi_w = w, .Phi_f = f, .exact = exact};
  const int code = steif_underlying_find(ctx, p, method, h, NULL, &u);
  if (code) printf("\n  %s: %s", method, steif_message(ctx));
  CHECK(code == STEIF_OK);
  error[0] = distance(w, exact), error[1] = distance(f, exact);
}

static void orders_of_both_maps(void)
{
  static const struct {
    const char *method;
    double w, f;
  } row[] = {{"bdf:p=2", 2, 3},     {"bdf:p=3", 2, 4},    {"bdf:p=4", 2, 5},
             {"bdf:p=5", 2, 6},     {"glm:ab,p=2", 2, 3}, {"glm:ab,p=3", 2, 4},
             {"glm:am,p=3", 2, 4},  {"glm:nord22", 3, 3}, {"glm:dimsim1", 2, 3},
             {"glm:dimsim2", 2, 3}, {"gauss:s=1", 3, 3},  {"glm:nordsieck,of=bdf,p=3", 2, 4}};
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  CU_ASSERT_FATAL(steif_problem_find(ctx, problem_spec, &p) == STEIF_OK);
  for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
    double one[2], half[2];
    errors(ctx, &p, row[i].method, 0.02, one), errors(ctx, &p, row[i].method, 0.01, half);
    const double w = log2(one[0] / half[0]), f = log2(one[1] / half[1]);
    const int good = fabs(w - row[i].w) < 0.15 && fabs(f - row[i].f) < 0.15;
    if (!good) printf("\n  %s: %.3f and %.3f", row[i].method, w, f);
    CHECK(good);
  }
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* From the columns u_j I and from arbitrary ones the maps are the same to rounding, after as
 * many steps as the parasitic roots ask for. */
static void maps_forget_their_start(void)
{
  static const struct {
    const char *method;
    long burn_in;
  } row[] = {{"bdf:p=2", 32},    {"bdf:p=5", 101},  {"bdf:p=6", 236},
             {"glm:dimsim2", 0}, {"glm:ab,p=4", 0}, {"glm:nord22", 0}};
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  CU_ASSERT_FATAL(steif_problem_find(ctx, problem_spec, &p) == STEIF_OK);
  for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
    double start[6 * 4], w[2][4], f[2][4], exact[4];
    for (int j = 0; j < 24; j++) start[j] = (j % 4 == 0 || j % 4 == 3) + 0.3 * sin(j * j + 0.7);
    for (int m = 0; m < 2; m++) {
      steif_underlying u = {.Phi_w = w[m], .Phi_f = f[m], .exact = exact};
      CHECK(steif_underlying_find(ctx, &p, row[i].method, 0.05, m ? start : NULL, &u) ==
            STEIF_OK);
      CHECK(u.burn_in == (row[i].burn_in > 32 ? 2 * row[i].burn_in : 64));
    }
    CHECK(distance(w[0], w[1]) < 1e-13 && distance(f[0], f[1]) < 1e-13);
    CHECK(distance(f[0], exact) > 1e-10);
  }
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* Numerical minus exact is (1/3) h^3 x''' for BDF2; on x' = -0.9 x: -0.9^3 h^3 / 3. */
static void bdf2_runs_ahead_by_a_third(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  double w[4], f[4], exact[4];
  steif_underlying u = {.Phi_w = w, .Phi_f = f, .exact = exact};
  CU_ASSERT_FATAL(steif_problem_find(ctx, "dahlquist:re=-0.9,im=0", &p) == STEIF_OK);
  CHECK(steif_underlying_find(ctx, &p, "bdf:p=2", 1e-3, NULL, &u) == STEIF_OK);
  CLOSE((f[0] - exact[0]) / 1e-9, -0.729 / 3, 0.01);
  CLOSE(exact[0], exp(-0.9e-3), 1e-15);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

static void bad_questions_are_rejected(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  double w[9], f[9], exact[9];
  steif_underlying u = {.Phi_w = w, .Phi_f = f, .exact = exact}, none = {0};
  CU_ASSERT_FATAL(steif_problem_find(ctx, "lorenz", &p) == STEIF_OK);
  CHECK(steif_underlying_find(ctx, &p, "rk4", 0.01, NULL, &u) == STEIF_UNSUPPORTED);
  CHECK(strstr(steif_message(ctx), "depends on y") != NULL);
  CHECK(steif_underlying_find(ctx, &p, "rk4", 0.01, NULL, &none) == STEIF_BAD_INPUT);
  CHECK(steif_underlying_find(ctx, &p, "rk4", -1, NULL, &u) == STEIF_BAD_INPUT);
  CHECK(steif_underlying_find(ctx, NULL, "rk4", 0.1, NULL, &u) == STEIF_BAD_INPUT);
  steif_problem_clear(ctx, &p);
  CU_ASSERT_FATAL(steif_problem_find(ctx, problem_spec, &p) == STEIF_OK);
  static const double zero[8];
  CHECK(steif_underlying_find(ctx, &p, "bdf:p=2", 0.1, zero, &u) == STEIF_NOT_FINITE);
  CHECK(steif_underlying_find(ctx, &p, "cvode", 0.1, NULL, &u) == STEIF_UNSUPPORTED);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_underlying[] = {
  {"orders of both maps", orders_of_both_maps},
  {"maps forget their start", maps_forget_their_start},
  {"BDF2 runs ahead by a third of h^3 x'''", bdf2_runs_ahead_by_a_third},
  {"bad questions are rejected", bad_questions_are_rejected},
  CU_TEST_INFO_NULL};
