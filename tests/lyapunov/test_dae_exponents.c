/* test_dae_exponents.c: as many exponents as degrees of freedom, at index 1 to 3.
 *
 * Three masses in a chain, M = I, K = D = tridiag(-1, 2, -1), q1 = q3: index 3, unknowns q, v, lambda. The
 * constraint takes the mode (1, 0, -1) away; the others have K-eigenvalues k = 2 -+ sqrt 2 and finite
 * eigenvalues s = (-k +- sqrt(k^2 - 4 k))/2, so the exponents are -k/2, twice each. A method has
 * ln |R(h s)| / h; BDF2 the root (2 + sqrt(1 + 2 z))/(3 - 2 z).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"
#include <complex.h>
#include <nvector/nvector_serial.h>
#include <steif/analysis.h>
#include <steif/data.h>
#include <steif/steif.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

enum { N = 7 };

static void fill(double A[N][N])
{
  static const double K[3][3] = {{2, -1, 0}, {-1, 2, -1}, {0, -1, 2}}, G[3] = {1, 0, -1};
  memset(A, 0, N * N * sizeof(double));
  for (int i = 0; i < 3; i++) {
    A[i][3 + i] = 1;
    for (int j = 0; j < 3; j++) A[3 + i][j] = A[3 + i][3 + j] = -K[i][j];
    A[3 + i][6] = -G[i], A[6][i] = G[i];
  }
}

static int f(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  double A[N][N];
  (void)t, (void)user;
  fill(A);
  for (int i = 0; i < N; i++) {
    NV_Ith_S(r, i) = 0;
    for (int j = 0; j < N; j++) NV_Ith_S(r, i) += A[i][j] * NV_Ith_S(y, j);
  }
  return 0;
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
               N_Vector b, N_Vector c)
{
  double A[N][N];
  (void)t, (void)y, (void)fy, (void)user, (void)a, (void)b, (void)c;
  fill(A);
  for (int i = 0; i < N; i++)
    for (int j = 0; j < N; j++) SM_ELEMENT_D(J, i, j) = A[i][j];
  return 0;
}

static int mass(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  for (int i = 0; i < 6; i++) SM_ELEMENT_D(E, i, i) = 1;
  return 0;
}

static const double y0[N] = {0};

static steif_problem chain(void)
{
  return (steif_problem){.name = "chain",
                         .n = N,
                         .t1 = 60,
                         .y0 = y0,
                         .f = f,
                         .jac = jac,
                         .E = mass,
                         .dae_index = 3,
                         .linear = 1};
}

/* |R(z)| or the root of BDF2. */
static double size(const char *method, double complex z)
{
  if (!strcmp(method, "be")) return 1 / cabs(1 - z);
  if (!strcmp(method, "bdf:p=2")) return cabs((2 + csqrt(1 + 2 * z)) / (3 - 2 * z));
  if (!strcmp(method, "radau:s=2")) return cabs((1 + z / 3) / (1 - 2 * z / 3 + z * z / 6));
  return cabs((1 + 2 * z / 5 + z * z / 20) / (1 - 3 * z / 5 + 3 * z * z / 20 - z * z * z / 60));
}

static void linear_index_3(void)
{
  static const char *const methods[] = {"be", "bdf:p=2", "radau:s=2", "radau:s=3"};
  const double h = 0.1;
  steif_context *ctx = steif_context_new(NULL);
  const steif_problem p = chain();
  for (int i = 0; i < 4; i++) {
    const steif_lyapunov_options o = {.h = h, .transient = 30};
    steif_lyapunov_facts facts;
    double x[N];
    const int code = steif_lyapunov(ctx, &p, methods[i], &o, x, NULL, &facts);
    if (code) printf("\n  %s", steif_message(ctx));
    CU_ASSERT_FATAL(code == STEIF_OK);
    CHECK(facts.count == 4);
    /* Pairs turn: what is exact from step to step is the growth of their plane. */
    for (int k = 0; k < 2; k++) {
      const double kappa = 2 + (k ? sqrt(2) : -sqrt(2));
      const double complex s = (-kappa + csqrt(kappa * kappa - 4 * kappa)) / 2;
      CLOSE((x[2 * k] + x[2 * k + 1]) / 2, log(size(methods[i], h * s)) / h, 1e-9);
      CHECK(fabs(x[2 * k] - x[2 * k + 1]) < 0.1);
    }
  }
  steif_context_free(&ctx);
}

static void asked_for(steif_context *ctx, const steif_problem *p, const char *method, int count,
                      int code, const char *words)
{
  const steif_lyapunov_options o = {.h = 0.1, .t1 = 2, .count = count};
  double x[N];
  CHECK(steif_lyapunov(ctx, p, method, &o, x, NULL, NULL) == code);
  if (!strstr(steif_message(ctx), words)) printf("\n  %s", steif_message(ctx));
  CHECK(strstr(steif_message(ctx), words) != NULL);
}

/* E x' = A x + g of index 3, eigenvalues -1/2 +- 3 i: |R(h s)| as before. */
static void descriptor_forms(void)
{
  static const char *const methods[] = {"be", "bdf:p=2", "radau:s=2", "radau:s=3"};
  const double h = 0.1;
  const double complex s = -0.5 + 3 * I;
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  CU_ASSERT_FATAL(!steif_problem_find(ctx, "ut5", &p));
  for (int i = 0; i < 4; i++) {
    const steif_lyapunov_options o = {.h = h, .t1 = 60, .transient = 30};
    steif_lyapunov_facts facts;
    double x[5] = {0};
    CHECK(!steif_lyapunov(ctx, &p, methods[i], &o, x, NULL, &facts) && facts.count == 2);
    CLOSE((x[0] + x[1]) / 2, log(size(methods[i], h * s)) / h, 1e-9);
  }
  steif_decay d;
  const steif_lyapunov_options o = {.h = h, .t1 = 60, .transient = 30};
  CHECK(!steif_decay_find(ctx, &p, "be", &o, 0, 0, &d));
  CHECK(fabs(d.lambda + 0.5) <= d.lambda_error + 1e-9 && d.verdict == STEIF_DECAY_LOST);
  CHECK(!steif_decay_find(ctx, &p, "radau:s=3", &o, 0, 0, &d));
  CHECK(fabs(d.lambda + 0.5) <= d.lambda_error + 1e-9 && d.verdict == STEIF_DECAY_KEPT);
  steif_problem_clear(ctx, &p);
  CU_ASSERT_FATAL(!steif_problem_find(ctx, "jordan:k=3", &p));
  asked_for(ctx, &p, "be", 0, STEIF_BAD_INPUT, "no degree of freedom");
  steif_problem_clear(ctx, &p), steif_context_free(&ctx);
}

static void more_than_the_freedom_is_rejected(void)
{
  steif_context *ctx = steif_context_new(NULL);
  const steif_problem p = chain();
  asked_for(ctx, &p, "radau:s=2", 5, STEIF_BAD_INPUT,
            "index 3 with 4 degrees of freedom: 4 exponents");
  asked_for(ctx, &p, "gauss:s=2", 0, STEIF_UNSUPPORTED, "keeps |M(inf)| = 1");
  steif_context_free(&ctx);
}

/* The pendulum neither grows nor decays: growth of a plane of directions in its phase space is that of an
 * area, which stays within bounds. Finite times leave ln T / T. */
static void pendulum_in_three_forms(void)
{
  static const struct {
    const char *name;
    int freedom;
  } rows[] = {{"pendulum3", 2}, {"pendulum3:index=2", 3}, {"pendulum3:index=1", 4}};
  steif_context *ctx = steif_context_new(NULL);
  for (int i = 0; i < 3; i++) {
    steif_problem p;
    CU_ASSERT_FATAL(steif_problem_find(ctx, rows[i].name, &p) == STEIF_OK);
    double most[2];
    for (int k = 0; k < 2; k++) {
      const steif_lyapunov_options o = {.h = 0.02, .t1 = k ? 200 : 25};
      steif_lyapunov_facts facts;
      double x[5], sum = 0;
      CHECK(steif_lyapunov(ctx, &p, "radau:s=3", &o, x, NULL, &facts) == STEIF_OK);
      CHECK(facts.count == rows[i].freedom);
      most[k] = 0;
      for (int j = 0; j < facts.count; j++) sum += x[j], most[k] = fmax(most[k], fabs(x[j]));
      CHECK(fabs(sum) < 4 / o.t1);
    }
    CHECK(most[1] < most[0] / 3 && most[1] < 0.08);
    steif_problem_clear(ctx, &p);
  }
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_dae_exponents[] = {
  {"a linear DAE of index 3 has ln |R(h s)| / h", linear_index_3},
  {"descriptor forms have ln |R(h s)| / h", descriptor_forms},
  {"more exponents than degrees of freedom are rejected", more_than_the_freedom_is_rejected},
  {"the pendulum at index 3, 2 and 1", pendulum_in_three_forms},
  CU_TEST_INFO_NULL};
