/* test_statistics.c: quantiles and singular values.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "jacobi_svd.h"
#include "suite.h"
#include <steif/fit.h>

/* dof = 1 is Cauchy's distribution, t = tan(pi p / 2); of two, t = p sqrt(2 / (1 - p^2)); the others, to their digits,
 * of Abramowitz and Stegun, table 26.10. */
static void quantiles_of_student(void)
{
  static const struct {
    long dof;
    double t, digits;
  } known[] = {{5, 2.571, 5e-4},  {10, 2.228, 5e-4},  {30, 2.042, 5e-4},
               {60, 2.000, 5e-4}, {120, 1.980, 5e-4}, {1000000000, 1.959963985, 1e-8}};
  steif_context *ctx = steif_context_new(NULL);
  double t = 0, u = 0;
  CHECK(!steif_student(ctx, 0.95, 1, &t));
  CLOSE(t, tan(0.475 * 3.14159265358979323846), 1e-9);
  CHECK(!steif_student(ctx, 0.95, 2, &t));
  CLOSE(t, 0.95 * sqrt(2 / (1 - 0.95 * 0.95)), 1e-9);
  for (double q = 1e-3; q > 1e-15; q /= 16) {
    const double p = 1 - q, rest = 1 - p; /* which is exact */
    CHECK(!steif_student(ctx, p, 1, &t));
    CLOSE(t, 1 / tan(rest * 3.14159265358979323846 / 2), 1e-9);
    CHECK(!steif_student(ctx, p, 2, &t));
    CLOSE(t, p * sqrt(2 / (rest * (2 - rest))), 1e-9);
    CHECK(!steif_student(ctx, p, 2000, &t) && !steif_student(ctx, p, 2001, &u));
    CHECK(t > u && t - u < 1e-4 * t);
  }
  CHECK(!steif_student(ctx, 1 - 1e-12, 10, &t));
  CHECK(fabs(t - 43.457) < 1e-3); /* SciPy 1.10, t.isf((1 - p)/2, 10) */
  for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
    CHECK(!steif_student(ctx, 0.95, known[i].dof, &t));
    CHECK(fabs(t - known[i].t) <= known[i].digits);
  }
  CHECK(!steif_student(ctx, 0.95, 2000, &t) && !steif_student(ctx, 0.95, 2001, &u));
  CHECK(t > u && t - u < 1e-6); /* the sum and the expansion meet */
  CHECK(steif_student(ctx, 1.5, 3, &t) == STEIF_BAD_INPUT);
  CHECK(steif_student(ctx, 0.5, 0, &t) == STEIF_BAD_INPUT);
  steif_context_free(&ctx);
}

/* Of one, two and four degrees of freedom erfc(sqrt(x)), e^-x and (1 + x) e^-x with x = chi2/2; the others: SciPy 1.10,
 * scipy.stats.chi2.sf. */
static void chi_square(void)
{
  static const struct {
    double chi2;
    long dof;
    double probability;
  } known[] = {{18.307038053275146, 10, 0.05},       {30, 19, 0.05179845889302389},
               {30, 20, 0.06985366069940986},        {1, 30, 1},
               {1200, 1000, 1.2255942330622893e-05}, {999333.3333, 1000000, 0.681193168809064}};
  steif_context *ctx = steif_context_new(NULL);
  double Q = 0;
  for (double x = 1e-30; x < 300; x = x < 1e-3 ? 1000 * x : 1.3 * x) {
    CHECK(!steif_chi_square(ctx, 2 * x, 1, &Q));
    CLOSE(Q, erfc(sqrt(x)), 1e-11);
    CHECK(!steif_chi_square(ctx, 2 * x, 2, &Q));
    CLOSE(Q, exp(-x), 1e-11);
    CHECK(!steif_chi_square(ctx, 2 * x, 4, &Q));
    CLOSE(Q, (1 + x) * exp(-x), 1e-11);
  }
  for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
    CHECK(!steif_chi_square(ctx, known[i].chi2, known[i].dof, &Q));
    CLOSE(Q, known[i].probability, 1e-10);
  }
  CHECK(!steif_chi_square(ctx, 0, 3, &Q) && Q == 1);
  CHECK(!steif_chi_square(ctx, INFINITY, 3, &Q) && Q == 0);
  CHECK(steif_chi_square(ctx, -1, 3, &Q) == STEIF_BAD_INPUT);
  CHECK(steif_chi_square(ctx, NAN, 3, &Q) == STEIF_BAD_INPUT);
  CHECK(steif_chi_square(ctx, 1, 0, &Q) == STEIF_BAD_INPUT);
  steif_context_free(&ctx);
}

/* A = U diag(s) V^T of two rotations and a column that is a multiple of another. */
static void singular_values(void)
{
  double A[] = {3, 0, 4, 0, 1e-9, 0}, sigma[2], V[4];
  stf_jacobi_svd(3, 2, A, sigma, V);
  CLOSE(sigma[0], 5, 1e-15);
  CLOSE(sigma[1], 1e-9, 1e-15);
  double B[] = {1, 2, 2, -2, -4, -4};
  stf_jacobi_svd(3, 2, B, sigma, V);
  CLOSE(sigma[0], sqrt(45), 1e-15);
  CHECK(sigma[1] < 1e-15);
  CLOSE(fabs(V[2] * 2 / V[3]), 4, 1e-14); /* the null vector is (2, 1) / sqrt(5) */
  CHECK(V[2] * V[3] > 0);
}

CU_TestInfo tests_of_statistics[] = {{"quantiles of Student", quantiles_of_student},
                                     {"chi-square distribution", chi_square},
                                     {"singular values", singular_values},
                                     CU_TEST_INFO_NULL};
