/* test_gain.c: what the estimate of collocation says about the error.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "integrator.h"
#include "step_error.h"
#include "suite.h"
#include <nvector/nvector_serial.h>
#include <steif/steif.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

static int decay(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  (void)t, (void)user;
  NV_Ith_S(out, 0) = -NV_Ith_S(y, 0);
  return 0;
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
               N_Vector b, N_Vector c)
{
  (void)t, (void)y, (void)fy, (void)user, (void)a, (void)b, (void)c;
  if (SUNMatGetID(J) == SUNMATRIX_DENSE) return SM_ELEMENT_D(J, 0, 0) = -1, 0;
  SM_INDEXPTRS_S(J)[0] = 0, SM_INDEXPTRS_S(J)[1] = 1;
  SM_INDEXVALS_S(J)[0] = 0, SM_DATA_S(J)[0] = -1;
  return 0;
}

/* On y' = -y the error of a short step is the estimate times gain h^(p-s), p the order: by methods whose
 * first eigenvalue is real and by those where it is one of a pair, with matrices for all shifts and with one. */
static void gain_makes_errors_of_estimates(void)
{
  static const struct {
    const char *method;
    double h;
  } row[] = {{"gauss:s=2", 0.02}, {"gauss:s=3", 0.1}, {"gauss:s=4", 0.4},
             {"radau:s=2", 0.02}, {"radau:s=3", 0.1}, {"radau:s=4", 0.4}};
  static const sunrealtype start[] = {1};
  const steif_problem p = {
    .name = "decay", .n = 1, .t1 = 10, .y0 = start, .f = decay, .jac = jac, .nnz = 1};
  steif_context *ctx = steif_context_new(NULL);
  for (size_t i = 0; i < 2 * (sizeof row / sizeof *row); i++) {
    const bool sparse = i % 2;
    steif_options o = steif_defaults();
    o.rtol = 1e-2, o.h0 = row[i / 2].h, o.newton = 1e-13, o.iterations = 50;
    if (sparse) o.force_storage = 1, o.storage = STEIF_SPARSE;
    steif_solver *s = steif_solver_new(ctx, &p, row[i / 2].method, &o);
    CU_ASSERT_FATAL(s && !steif_solve_step(s));
    const stf_step *step = &s->step;
    CHECK(sparse == (step->system.storage == STEIF_SPARSE));
    CHECK(sparse == (step->newton.gamma > 0));
    stf_transform split;
    stf_estimate e;
    CHECK(!stf_transform_build(s->pool, ctx, step->table, &split));
    stf_estimate_open(&e, step->table, &split, o.rtol);
    const double error = fabs(NV_Ith_S(step->y, 0) - exp(-step->h));
    const double told =
      fabs(NV_Ith_S(step->error, 0)) * e.gain * pow(step->h, step->table->order - e.s);
    CHECK(step->h == row[i / 2].h && step->table->order > e.s);
    if (!(fabs(told / error - 1) < 0.2))
      printf("\n  %s%s: error %.4g, by the estimate %.4g", row[i / 2].method,
             sparse ? ", sparse" : "", error, told);
    CHECK(fabs(told / error - 1) < 0.2);
    steif_solver_free(&s);
  }
  steif_context_free(&ctx);
}

/* y_i' = -y_i + cos t, y(0) = 1/2: (sin t + cos t)/2. */
static int moved(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  (void)user;
  for (int i = 0; i < NV_LENGTH_S(y); i++) NV_Ith_S(out, i) = cos(t) - NV_Ith_S(y, i);
  return 0;
}

/* Stages one by one of many unknowns, and all at once of few: f depends on time, and the order is 4. */
static void rosenbrock_sees_time(void)
{
  enum { MANY = 12 };
  sunrealtype start[MANY];
  steif_context *ctx = steif_context_new(NULL);
  for (int i = 0; i < MANY; i++) start[i] = 0.5;
  for (int n = 2; n <= MANY; n += MANY - 2) {
    const steif_problem p = {.name = "moved", .n = n, .t1 = 2, .y0 = start, .f = moved};
    double error[2];
    for (int k = 0; k < 2; k++) {
      steif_options o = steif_defaults();
      o.h = k ? 0.05 : 0.1;
      steif_solver *s = steif_solver_new(ctx, &p, "rodas4", &o);
      CU_ASSERT_FATAL(s && !steif_solve_to(s, 2));
      error[k] = fabs(NV_Ith_S(steif_solution(s), n - 1) - (sin(2) + cos(2)) / 2);
      steif_solver_free(&s);
    }
    CHECK(error[1] < error[0] / 10 && error[0] < 1e-6);
  }
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_gain[] = {
  {"the gain makes errors of estimates", gain_makes_errors_of_estimates},
  {"Rosenbrock methods see time", rosenbrock_sees_time},
  CU_TEST_INFO_NULL};
