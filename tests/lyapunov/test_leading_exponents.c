/* test_leading_exponents.c: the first exponents of problems with band and sparse Jacobians.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "base/failing.h"
#include "region.h"
#include "suite.h"
#include <nvector/nvector_serial.h>
#include <stdlib.h>
#include <steif/collection.h>
#include <steif/lyapunov.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

enum { LEADING = 5 };

static int leading(steif_context *ctx, const char *problem, const char *method,
                   steif_lyapunov_options o, double *exponent, steif_lyapunov_facts *facts)
{
  steif_problem p;
  o.count = LEADING;
  int code = steif_problem_find(ctx, problem, &p);
  if (code) return code;
  code = steif_lyapunov(ctx, &p, method, &o, exponent, NULL, facts);
  if (code) printf("\n  %s, %s: %s", problem, method, steif_message(ctx));
  steif_problem_clear(ctx, &p);
  return code;
}

/* u_t = u_xx on n points has the eigenvalues lambda_k = -4 (n+1)^2 sin^2(k pi / (2 (n+1))), and a step
 * multiplies the k-th eigenvector by R(h lambda_k): an exponent is ln |R(h lambda_k)| / h. */
static void heat_has_the_logarithms_of_R(void)
{
  static const char *const methods[] = {"radau:s=2", "dirk:alexander2", "gauss:s=2",
                                        "bdf:p=3",   "dirk:trbdf2",     "radau:s=3"};
  static const char *const problems[] = {"heat:n=200", "heat:n=200,storage=sparse"};
  const steif_lyapunov_options o = {.h = 0.0005, .t1 = 0.6, .transient = 0.4};
  steif_context *ctx = steif_context_new(NULL);
  for (size_t i = 0; i < sizeof methods / sizeof *methods; i++)
    for (int storage = 0; storage < 2; storage++) {
      double x[LEADING] = {0};
      steif_lyapunov_facts facts = {0};
      CHECK(leading(ctx, problems[storage], methods[i], o, x, &facts) == STEIF_OK);
      for (int k = 1; k <= LEADING; k++) {
        const double s = sin(k * acos(-1) / 402), z[2] = {-4 * 201 * 201 * s * s * o.h, 0};
        double radius = NAN;
        CHECK(steif_spectral_radius(ctx, methods[i], z, &radius) == STEIF_OK);
        CLOSE(x[k - 1], log(radius) / o.h, 1e-9);
      }
      CLOSE(facts.trace, -2.0 * 201 * 201 * 200, 1e-12);
    }
  steif_context_free(&ctx);
}

/* The same trajectory and the same directions in another storage; roundings part in chaos, which has no
 * time to make them large. */
static void storage_changes_nothing(void)
{
  static const struct {
    const char *problem[2], *method;
    double h;
  } row[] = {
    {{"lorenz96", "lorenz96:storage=sparse"}, "rk4", 0.01},
    {{"lorenz96", "lorenz96:storage=sparse"}, "radau:s=2", 0.01},
    {{"lorenz96", "lorenz96:storage=sparse"}, "bdf:p=2", 0.01},
    {{"lorenz96", "lorenz96:storage=sparse"}, "glm:dimsim2", 0.01},
    {{"allencahn:n=30,storage=dense", "allencahn:n=30"}, "radau:s=2", 0.02},
    {{"allencahn:n=30,storage=dense", "allencahn:n=30,storage=sparse"}, "dirk:hw43", 0.02},
  };
  const steif_lyapunov_options plain = {.t1 = 4, .transient = 1};
  steif_context *ctx = steif_context_new(NULL);
  for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
    double a[LEADING] = {NAN}, b[LEADING] = {NAN};
    steif_lyapunov_options o = plain;
    o.h = row[i].h;
    CHECK(leading(ctx, row[i].problem[0], row[i].method, o, a, NULL) == STEIF_OK);
    CHECK(leading(ctx, row[i].problem[1], row[i].method, o, b, NULL) == STEIF_OK);
    for (int k = 0; k < LEADING; k++) CLOSE_FLOOR(b[k], a[k], 1e-8, 1);
  }
  steif_context_free(&ctx);
}

/* -- a DAE ------------------------------------------------------------------------------------ */

/* x' = -x + 2 p, 0 = p - x / 4, q' = -3 q + x: x' = -x / 2, so the exponents of the recurrence are
 * ln |R| / h at -h/2 and -3 h. */
static int f(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  const double *x = NV_DATA_S(y);
  (void)t, (void)user;
  NV_Ith_S(r, 0) = -x[0] + 2 * x[1];
  NV_Ith_S(r, 1) = x[1] - x[0] / 4;
  NV_Ith_S(r, 2) = -3 * x[2] + x[0];
  return 0;
}

static void set(SUNMatrix M, const sunindextype *column, const sunindextype *row,
                const double *value)
{
  memcpy(SM_INDEXPTRS_S(M), column, 4 * sizeof *column);
  memcpy(SM_INDEXVALS_S(M), row, (size_t)column[3] * sizeof *row);
  memcpy(SM_DATA_S(M), value, (size_t)column[3] * sizeof *value);
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
               N_Vector b, N_Vector c)
{
  static const sunindextype column[] = {0, 3, 5, 6}, row[] = {0, 1, 2, 0, 1, 2};
  static const double value[] = {-1, -0.25, 1, 2, 1, -3};
  (void)t, (void)y, (void)fy, (void)user, (void)a, (void)b, (void)c;
  set(J, column, row, value);
  return 0;
}

static int mass(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  static const sunindextype column[] = {0, 1, 1, 2}, row[] = {0, 2};
  static const double value[] = {1, 1};
  (void)t, (void)y, (void)yp, (void)user;
  set(E, column, row, value);
  return 0;
}

static const double start[] = {0.8, 0.2, -0.7};

static void a_sparse_dae_has_the_exponents_of_its_ode(void)
{
  static const char *const methods[] = {"radau:s=2", "bdf:p=3", "dirk:alexander2"};
  const steif_problem dae = {.name = "sparse3",
                             .n = 3,
                             .t1 = 40,
                             .y0 = start,
                             .f = f,
                             .jac = jac,
                             .E = mass,
                             .storage = STEIF_SPARSE,
                             .nnz = 6,
                             .nnz_E = 2};
  steif_context *ctx = steif_context_new(NULL);
  for (int linear = -1; linear <= 1; linear += 2) /* along a trajectory, and without one */
    for (int i = 0; i < 3; i++) {
      const steif_lyapunov_options o = {
        .h = 0.05, .transient = 20, .count = 2, .linear = linear};
      double x[2] = {NAN, NAN}, radius[2] = {NAN, NAN};
      const int code = steif_lyapunov(ctx, &dae, methods[i], &o, x, NULL, NULL);
      if (code) printf("\n  %s: %s", methods[i], steif_message(ctx));
      CHECK(code == STEIF_OK);
      for (int k = 0; k < 2; k++) {
        const double z[2] = {(k ? -3 : -0.5) * o.h, 0};
        CHECK(steif_spectral_radius(ctx, methods[i], z, &radius[k]) == STEIF_OK);
        CLOSE(x[k], log(radius[k]) / o.h, 1e-11);
      }
    }
  steif_context_free(&ctx);
}

/* -- rejections --------------------------------------------------------------------------------- */

static void too_many_are_rejected(void)
{
  steif_context *ctx = steif_context_new(NULL);
  const steif_lyapunov_options o = {.h = 0.01, .t1 = 0.1};
  double x[1];
  steif_problem p;
  steif_growth_facts g;
  CU_ASSERT_FATAL(steif_problem_find(ctx, "heat:n=3000", &p) == STEIF_OK);
  CHECK(steif_lyapunov(ctx, &p, "radau:s=2", &o, x, NULL, NULL) == STEIF_UNSUPPORTED);
  CHECK(strstr(steif_message(ctx), "ask for up to 1000") != NULL);
  CHECK(steif_growth_measure(ctx, &p, "radau:s=2", &o, &g) == STEIF_UNSUPPORTED);
  CHECK(strstr(steif_message(ctx), "n = 3000") != NULL);
  steif_underlying u = {.Phi_w = x, .Phi_f = x, .exact = x};
  CHECK(steif_underlying_find(ctx, &p, "radau:s=2", 0.01, NULL, &u) == STEIF_UNSUPPORTED);
  p.storage = STEIF_KRYLOV;
  CHECK(steif_lyapunov(ctx, &p, "radau:s=2", &o, x, NULL, NULL) == STEIF_UNSUPPORTED);
  steif_problem_clear(ctx, &p);
  CU_ASSERT_FATAL(steif_problem_find(ctx, "heat:n=3000,storage=dense", &p) == STEIF_OK);
  CHECK(steif_lyapunov(ctx, &p, "radau:s=2", &o, x, NULL, NULL) == STEIF_UNSUPPORTED);
  CHECK(strstr(steif_message(ctx), "dense Jacobian") != NULL);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* E - h c J of x' = A x is singular where 1/(h c) is an eigenvalue. */
static int shift_jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user,
                     N_Vector a, N_Vector b, N_Vector c)
{
  static const sunindextype column[] = {0, 1, 2, 3}, row[] = {0, 1, 2};
  static const double value[] = {-1, 20, -3};
  (void)t, (void)y, (void)fy, (void)user, (void)a, (void)b, (void)c;
  set(J, column, row, value);
  return 0;
}

static void singular_stages_are_named(void)
{
  const steif_problem p = {.name = "shifted",
                           .n = 3,
                           .t1 = 1,
                           .y0 = start,
                           .f = f,
                           .jac = shift_jac,
                           .storage = STEIF_SPARSE,
                           .nnz = 3,
                           .linear = 1};
  const steif_lyapunov_options o = {.h = 0.05, .count = 2};
  steif_context *ctx = steif_context_new(NULL);
  double x[2];
  CHECK(steif_lyapunov(ctx, &p, "be", &o, x, NULL, NULL) == STEIF_SINGULAR);
  CHECK(strstr(steif_message(ctx), "change h a little") != NULL);
  steif_context_free(&ctx);
}

static void failed_allocations_are_reported(void)
{
  const steif_problem dae = {.name = "sparse3",
                             .n = 3,
                             .t1 = 0.5,
                             .y0 = start,
                             .f = f,
                             .jac = jac,
                             .E = mass,
                             .storage = STEIF_SPARSE,
                             .nnz = 6,
                             .nnz_E = 2};
  const steif_lyapunov_options o = {.h = 0.05, .count = 2, .linear = 1};
  double x[2];
  int code = STEIF_NO_MEMORY;
  long k = 0, failures = 0;
  while (code != STEIF_OK && k < 1000) {
    failing memory = {0};
    steif_setup setup = failing_setup(&memory);
    setup.threads = 1;
    steif_context *ctx = steif_context_new(&setup);
    memory.refuse_at = memory.served + ++k;
    code = steif_lyapunov(ctx, &dae, "radau:s=2", &o, x, NULL, NULL);
    CHECK(code == STEIF_OK || code == STEIF_NO_MEMORY);
    CHECK(code == STEIF_OK || strlen(steif_message(ctx)) > 10);
    failures += code == STEIF_NO_MEMORY;
    steif_context_free(&ctx);
    CHECK(memory.alive == 0);
  }
  CHECK(code == STEIF_OK && failures > 20);
}

CU_TestInfo tests_of_leading[] = {
  {"the heat equation has ln |R(h lambda)| / h", heat_has_the_logarithms_of_R},
  {"band and sparse storage change nothing", storage_changes_nothing},
  {"a sparse DAE has the exponents of its ode", a_sparse_dae_has_the_exponents_of_its_ode},
  {"too many exponents are rejected", too_many_are_rejected},
  {"singular stages are named", singular_stages_are_named},
  {"a failing allocation is reported and leaves nothing", failed_allocations_are_reported},
  CU_TEST_INFO_NULL};
