/* test_gain.c: what the estimate of collocation says about the error.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "integrator.h"
#include "suite.h"
#include <nvector/nvector_serial.h>
#include <steif/steif.h>

static int decay(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  (void)t, (void)user;
  NV_Ith_S(out, 0) = -NV_Ith_S(y, 0);
  return 0;
}

/* On y' = -y the error of a short step is the estimate times gain h^(p-s), p the order: by methods whose
 * first eigenvalue is real and by those where it is one of a pair. */
static void gain_makes_errors_of_estimates(void)
{
  static const struct {
    const char *method;
    double h;
  } row[] = {{"gauss:s=2", 0.02}, {"gauss:s=3", 0.1}, {"gauss:s=4", 0.4},
             {"radau:s=2", 0.02}, {"radau:s=3", 0.1}, {"radau:s=4", 0.4}};
  static const sunrealtype start[] = {1};
  const steif_problem p = {.name = "decay", .n = 1, .t1 = 10, .y0 = start, .f = decay};
  steif_context *ctx = steif_context_new(NULL);
  for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
    steif_options o = steif_defaults();
    o.rtol = 1e-2, o.h0 = row[i].h, o.newton = 1e-13;
    steif_solver *s = steif_solver_new(ctx, &p, row[i].method, &o);
    CU_ASSERT_FATAL(s && !steif_solve_step(s));
    const stf_step *step = &s->step;
    stf_transform split;
    stf_estimate e;
    CHECK(!stf_transform_build(s->pool, ctx, step->table, &split));
    stf_estimate_open(&e, step->table, &split, o.rtol);
    const double error = fabs(NV_Ith_S(step->y, 0) - exp(-step->h));
    const double told =
      fabs(NV_Ith_S(step->error, 0)) * e.gain * pow(step->h, step->table->order - e.s);
    CHECK(step->h == row[i].h && step->table->order > e.s);
    if (!(fabs(told / error - 1) < 0.2))
      printf("\n  %s: error %.4g, by the estimate %.4g", row[i].method, error, told);
    CHECK(fabs(told / error - 1) < 0.2);
    steif_solver_free(&s);
  }
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_gain[] = {
  {"the gain makes errors of estimates", gain_makes_errors_of_estimates}, CU_TEST_INFO_NULL};
