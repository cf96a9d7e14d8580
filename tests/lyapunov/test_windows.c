/* test_windows.c: what means over an interval and over windows of it say.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "integral_separation.h"
#include "suite.h"
#include "variation.h"
#include <nvector/nvector_serial.h>
#include <sunmatrix/sunmatrix_dense.h>

/* y' = A(t) y, trace A = 5 t^4 - 3: from 0 to 2 its mean is 2^4 - 3. */
static int f(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  (void)user;
  NV_Ith_S(out, 0) = (5 * t * t * t * t - 1) * NV_Ith_S(y, 0);
  NV_Ith_S(out, 1) = -2 * NV_Ith_S(y, 1);
  return 0;
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
               N_Vector b, N_Vector c)
{
  (void)y, (void)fy, (void)user, (void)a, (void)b, (void)c;
  SM_ELEMENT_D(J, 0, 0) = 5 * t * t * t * t - 1;
  SM_ELEMENT_D(J, 1, 1) = -2;
  return 0;
}

static void mean_traces_are_integrals(void)
{
  static const sunrealtype y0[] = {1, 1};
  const steif_problem p = {.name = "quartic", .n = 2, .t1 = 2, .y0 = y0, .f = f, .jac = jac};
  steif_context *ctx = steif_context_new(NULL);
  stf_mean_trace trace;
  CU_ASSERT_FATAL(!stf_mean_trace_find(ctx, &p, 0, 2, true, NULL, &trace));
  CHECK(trace.known);
  CLOSE(trace.value, 13, 1e-9);
  steif_context_free(&ctx);
}

/* Two sums that grow apart at the rate 1 everywhere, or at 0.05 in the first half and at 2 in the second: both
 * apart at every time, but in the second case by as much as windows scatter. */
static void windows_that_scatter_decide_nothing(void)
{
  enum { STEPS = 2048 };
  steif_context *ctx = steif_context_new(NULL);
  for (int uneven = 0; uneven < 2; uneven++) {
    stf_pool *pool = stf_pool_new(ctx);
    stf_gaps gaps;
    steif_separation pair;
    sunrealtype now[2] = {0};
    CU_ASSERT_FATAL(pool && !stf_gaps_open(pool, STEPS, 2, &gaps));
    for (long n = 1; n <= STEPS; n++) {
      now[0] += 0.01 * (!uneven ? 1 : n <= STEPS / 2 ? 0.05 : 2);
      stf_gaps_record(&gaps, n, now);
    }
    stf_gaps_judge(&gaps, 0.01, &pair);
    CHECK(pair.low > 0 && pair.separated == !uneven);
    stf_pool_free(&pool);
  }
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_windows[] = {
  {"mean traces are integrals", mean_traces_are_integrals},
  {"windows that scatter decide nothing", windows_that_scatter_decide_nothing},
  CU_TEST_INFO_NULL};
