/* deviation.c: how far a run comes from values that are known at given times.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "region.h"
#include <math.h>

/* Largest |y_i - known_i|; NaN stays. */
static void compare(const sunrealtype *y, const sunrealtype *known, sunindextype n,
                    sunrealtype *deviation)
{
  for (sunindextype i = 0; i < n; i++) {
    const sunrealtype off = fabs(y[i] - known[i]);
    if (off > *deviation || isnan(off)) *deviation = off;
  }
}

static int follow(steif_context *ctx, steif_solver *s, sunindextype n, size_t count,
                  const sunrealtype *t, const sunrealtype *known, sunrealtype *deviation)
{
  for (size_t k = 0; k < count; k++) {
    STEIF_TRY(steif_solve_to(s, t[k]));
    const sunrealtype *y = N_VGetArrayPointer(steif_solution(s));
    STEIF_CHECK(y, ctx, STEIF_UNSUPPORTED, "known values need vectors with a host array");
    compare(y, known + k * (size_t)n, n, deviation);
  }
  return STEIF_OK;
}

int steif_deviation(steif_context *ctx, const steif_problem *problem, const char *method,
                    const steif_options *options, size_t count, const sunrealtype *t,
                    const sunrealtype *known, sunrealtype *deviation)
{
  STF_NAMED(problem);
  STEIF_CHECK(problem && method && t && known && deviation, ctx, STEIF_BAD_INPUT,
              "a problem, a method, times, known values and room for a number are needed");
  *deviation = 0;
  steif_solver *s = steif_solver_new(ctx, problem, method, options);
  const int code =
    s ? follow(ctx, s, problem->n, count, t, known, deviation) : steif_status(ctx);
  steif_solver_free(&s);
  return code;
}
