/* test_history.c: where past values may not be read, they are not: they are no numbers here.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "bdf_adaptive.h"
#include "integrator.h"
#include "suite.h"
#include <nvector/nvector_serial.h>
#include <steif/steif.h>

static int decay(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  (void)user;
  NV_Ith_S(out, 0) = -2 * t * NV_Ith_S(y, 0);
  return 0;
}

static const sunrealtype start[] = {1};

/* y = e^{-t^2}, some steps of BDF, by which it has left order 1. */
static steif_solver *begun(steif_context *ctx)
{
  static const steif_problem p = {.name = "decay", .n = 1, .t1 = 2, .y0 = start, .f = decay};
  steif_options o = steif_defaults();
  o.rtol = 1e-5;
  steif_solver *s = steif_solver_new(ctx, &p, "bdf", &o);
  CU_ASSERT_FATAL(s != NULL);
  while (steif_time(s) < 0.5) CU_ASSERT_FATAL(!steif_solve_step(s));
  const stf_bdf *e = s->step.state;
  CHECK(e->k >= 2 && e->points > 3);
  return s;
}

/* Solved to the end, and right. */
static void ends_right(steif_solver *s, sunrealtype rtol)
{
  CHECK(!steif_solve_to(s, 2));
  CHECK(fabs(NV_Ith_S(steif_solution(s), 0) - exp(-4)) < 10 * rtol);
}

static void lose(steif_solver *s, int from)
{
  const stf_bdf *e = s->step.state;
  for (int j = from; j <= STF_BDF_POINTS; j++) N_VConst(NAN, e->y[j]);
}

/* After a discontinuity nothing before it is known. */
static void restarts_read_no_past(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_solver *s = begun(ctx);
  lose(s, 1);
  s->step.restart = true;
  CHECK(!steif_solve_step(s));
  const stf_bdf *e = s->step.state;
  CHECK(e->last == 1 && e->points == 2);
  ends_right(s, 1e-5);
  steif_solver_free(&s);
  steif_context_free(&ctx);
}

/* Refused again and again, a step is made of the two last values alone. */
static void refusals_end_at_order_1(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_solver *s = begun(ctx);
  lose(s, 2);
  CHECK(!steif_solve_step(s));
  const stf_bdf *e = s->step.state;
  CHECK(e->last == 1);
  steif_solver_free(&s);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_history[] = {{"restarts read no past", restarts_read_no_past},
                                  {"refusals end at order 1", refusals_end_at_order_1},
                                  CU_TEST_INFO_NULL};
