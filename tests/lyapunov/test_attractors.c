/* test_attractors.c: exponents and dimensions of attractors by several methods.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "region.h"
#include "suite.h"
#include <nvector/nvector_serial.h>
#include <steif/collection.h>
#include <steif/lyapunov.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

static steif_lyapunov_facts measure(const char *problem, const char *method, double h,
                                    double transient, double t1, double *exponent,
                                    double *error)
{
  steif_context *ctx = steif_context_new(NULL);
  const steif_lyapunov_options o = {.h = h, .transient = transient, .t1 = t1, .error = error};
  steif_lyapunov_facts facts = {.dimension = NAN};
  steif_problem p;
  CU_ASSERT_FATAL(steif_problem_find(ctx, problem, &p) == STEIF_OK);
  const int code = steif_lyapunov(ctx, &p, method, &o, exponent, NULL, &facts);
  if (code) printf("\n  %s, %s: %s", problem, method, steif_message(ctx));
  CHECK(code == STEIF_OK);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
  return facts;
}

/* J. C. Sprott, Chaos and Time-Series Analysis (2003), table A.5: .0714, 0, -5.3943, dimension 2.0132.
 * BDF2 damps the third by its order: h^2. */
static void roessler_has_its_exponents(void)
{
  static const struct {
    const char *method;
    double third;
  } row[] = {{"rk4", 0.05}, {"radau:s=2", 0.05}, {"gauss:s=2", 0.05}, {"bdf:p=2", 0.12}};
  for (int i = 0; i < 4; i++) {
    double x[3] = {NAN, NAN, NAN}, error[3] = {NAN, NAN, NAN};
    const steif_lyapunov_facts f =
      measure("roessler", row[i].method, 0.02, 100, 2000, x, error);
    CHECK(fabs(x[0] - 0.0714) <= 4 * error[0]);
    CHECK(fabs(x[1]) <= 4 * error[1]);
    CHECK(error[0] < 0.01 && error[1] < 0.005);
    CLOSE(x[2], -5.3943, row[i].third / 5);
    CLOSE(f.dimension, 2.0132, 1e-3);
    if (i < 3) CLOSE(f.sum, f.trace, 1e-3);
  }
}

/* A bound of the standard error of the dimension k + (x_0 + .. + x_{k-1}) / |x_k|, from those of the
 * exponents, which fluctuate together: the deviation of a sum is at most the sum of the deviations. */
static double spread(double dimension, const double *x, const double *error)
{
  const int k = (int)dimension;
  double sum = 0;
  for (int j = 0; j <= k; j++) sum += error[j];
  return sum / fabs(x[k]);
}

/* n = 40, F = 8: a dimension of 27.1 (A. Karimi and M. R. Paul, Chaos 20 (2010) 043105), 13 positive
 * exponents, the largest 1.67 to 1.7 (Lorenz and Emanuel, J. Atmos. Sci. 55 (1998): errors double in
 * 2.1 days of 0.2 units, ln 2 / 0.42 = 1.65); the sum is -40 exactly. */
static void lorenz96_has_its_dimension(void)
{
  static const struct {
    const char *method;
    double h, t1, sum;
  } row[] = {{"rk4", 0.05, 150, 1e-3},
             {"gauss:s=2", 0.05, 120, 1e-3},
             {"radau:s=2", 0.05, 120, 1e-2},
             {"bdf:p=2", 0.02, 120, 1e-2}};
  for (int i = 0; i < 4; i++) {
    double x[40], error[40];
    int positive = 0;
    const steif_lyapunov_facts f =
      measure("lorenz96", row[i].method, row[i].h, 10, row[i].t1, x, error);
    for (int j = 0; j < 40; j++) positive += x[j] > 0.03;
    CHECK(fabs(x[0] - 1.68) <= 4 * error[0] && error[0] < 0.2);
    CHECK(positive >= 11 && positive <= 15);
    CHECK(fabs(f.dimension - 27.1) <= 0.05 + 2 * spread(f.dimension, x, error));
    CHECK(spread(f.dimension, x, error) < 1);
    CLOSE(f.trace, -40, 1e-12);
    CLOSE(f.sum, -40, row[i].sum);
  }
}

/* The Oregonator's limit cycle: 0, and -0.5020 on which Radau IIA and Gauss agree for h = 0.003; the
 * third, -24666, is beyond what steps of this length damp. */
static void a_stiff_cycle_has_one_exponent_zero(void)
{
  static const char *const methods[] = {"radau:s=2", "gauss:s=2"};
  for (int i = 0; i < 2; i++) {
    double x[3] = {NAN, NAN, NAN};
    const steif_lyapunov_facts f = measure("orego", methods[i], 0.01, 302.85, 1211.4, x, NULL);
    CLOSE_FLOOR(x[0], 0, 1e-5, 1);
    CLOSE(x[1], -0.5020, 2e-3);
    CHECK(x[2] < -50);
    CLOSE(f.trace, -24666.2, 1e-4);
  }
}

static void dimensions_wait_for_enough_exponents(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  steif_lyapunov_facts f;
  double x[3], error[3];
  steif_lyapunov_options o = {.h = 0.01, .t1 = 20, .count = 1, .error = error};
  CU_ASSERT_FATAL(steif_problem_find(ctx, "lorenz", &p) == STEIF_OK);
  CHECK(steif_lyapunov(ctx, &p, "rk4", &o, x, NULL, &f) == STEIF_OK);
  CHECK(x[0] > 0 && isnan(f.dimension) && error[0] > 0);
  o.count = 3, o.t1 = 0.3; /* 30 steps: too few for a standard error */
  CHECK(steif_lyapunov(ctx, &p, "rk4", &o, x, NULL, &f) == STEIF_OK);
  CHECK(isnan(error[0]) && !isnan(f.dimension));
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* -- DAEs of index 1 ---------------------------------------------------------------------- */

/* Lorenz' equations with p = x y as an algebraic unknown: M = diag(1, 1, 1, 0). */
static int f4(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  const double *x = NV_DATA_S(y);
  (void)t, (void)user;
  NV_Ith_S(r, 0) = 10 * (x[1] - x[0]);
  NV_Ith_S(r, 1) = 28 * x[0] - x[1] - x[0] * x[2];
  NV_Ith_S(r, 2) = x[3] - 8.0 / 3 * x[2];
  NV_Ith_S(r, 3) = x[0] * x[1] - x[3];
  return 0;
}

static int jac4(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
                N_Vector b, N_Vector c)
{
  const double *x = NV_DATA_S(y);
  const double row[4][4] = {
    {-10, 10, 0, 0}, {28 - x[2], -1, -x[0], 0}, {0, 0, -8.0 / 3, 1}, {x[1], x[0], 0, -1}};
  (void)t, (void)fy, (void)user, (void)a, (void)b, (void)c;
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) SM_ELEMENT_D(J, i, j) = row[i][j];
  return 0;
}

static int mass4(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  for (int i = 0; i < 3; i++) SM_ELEMENT_D(E, i, i) = 1;
  return 0;
}

static const double start4[] = {1, 1, 20, 1};

/* A stiffly accurate method eliminates p exactly: the same numbers as on the ode, until chaos parts the
 * roundings. */
static void a_dae_has_the_exponents_of_its_ode(void)
{
  static const char *const methods[] = {"radau:s=2", "bdf:p=2", "dirk:alexander2"};
  const steif_problem dae = {
    .name = "lorenz4", .n = 4, .t1 = 10, .y0 = start4, .f = f4, .jac = jac4, .E = mass4};
  steif_context *ctx = steif_context_new(NULL);
  steif_problem ode;
  CU_ASSERT_FATAL(steif_problem_find(ctx, "lorenz", &ode) == STEIF_OK);
  for (int i = 0; i < 3; i++) {
    const steif_lyapunov_options o = {.h = 0.005, .t1 = 300, .transient = 20, .count = 3};
    double a[3] = {NAN, NAN, NAN}, b[3] = {NAN, NAN, NAN};
    steif_lyapunov_facts f;
    CHECK(steif_lyapunov(ctx, &ode, methods[i], &o, a, NULL, NULL) == STEIF_OK);
    const int code = steif_lyapunov(ctx, &dae, methods[i], &o, b, NULL, &f);
    if (code) printf("\n  %s: %s", methods[i], steif_message(ctx));
    CHECK(code == STEIF_OK && isnan(f.trace));
    for (int j = 0; j < 3; j++) CLOSE_FLOOR(b[j], a[j], 0.04, 1);
    CLOSE(f.sum, a[0] + a[1] + a[2], 2e-3);
    CLOSE(f.dimension, 2 + (b[0] + b[1]) / -b[2], 1e-12);
  }
  steif_lyapunov_options o = {.h = 0.005, .t1 = 3, .count = 4};
  double x[4];
  CHECK(steif_lyapunov(ctx, &dae, "radau:s=2", &o, x, NULL, NULL) == STEIF_BAD_INPUT);
  CHECK(strstr(steif_message(ctx), "index 1 with 3 degrees of freedom: 3 exponents"));
  o.count = 3;
  CHECK(steif_lyapunov(ctx, &dae, "gauss:s=2", &o, x, NULL, NULL) == STEIF_UNSUPPORTED);
  CHECK(strstr(steif_message(ctx), "M(inf)"));
  CHECK(steif_lyapunov(ctx, &dae, "dirk:trbdf2", &o, x, NULL, NULL) == STEIF_UNSUPPORTED);
  CHECK(strstr(steif_message(ctx), "explicit stages"));
  steif_problem_clear(ctx, &ode);
  steif_context_free(&ctx);
}

/* The pendulum with its acceleration constraint, index 1: x^2 + y^2 and x u + y v keep what they are,
 * and so does the energy: the exponents of a quasiperiodic flow, all zero, and of its ode alike. */
static void the_pendulum_of_index_one_neither_grows_nor_decays(void)
{
  steif_context *ctx = steif_context_new(NULL);
  const steif_lyapunov_options o = {.h = 0.01, .t1 = 200, .count = 4};
  steif_problem p;
  double x[4] = {NAN, NAN, NAN, NAN};
  CU_ASSERT_FATAL(steif_problem_find(ctx, "pendulum3:index=1", &p) == STEIF_OK);
  const int code = steif_lyapunov(ctx, &p, "radau:s=3", &o, x, NULL, NULL);
  if (code) printf("\n  %s", steif_message(ctx));
  CHECK(code == STEIF_OK);
  for (int j = 0; j < 4; j++) CLOSE_FLOOR(x[j], 0, 0.06, 1); /* ln t / t */
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_attractors[] = {
  {"Roessler's band has its exponents", roessler_has_its_exponents},
  {"Lorenz' circle has its dimension", lorenz96_has_its_dimension},
  {"a stiff cycle has one exponent zero", a_stiff_cycle_has_one_exponent_zero},
  {"dimensions wait for enough exponents", dimensions_wait_for_enough_exponents},
  {"a DAE has the exponents of its ode", a_dae_has_the_exponents_of_its_ode},
  {"the pendulum of index 1 neither grows nor decays",
   the_pendulum_of_index_one_neither_grows_nor_decays},
  CU_TEST_INFO_NULL};
