/* settle.c: a consistent state behind an event.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "base.h"
#include <steif/diagnose.h>
#include <string.h>

int steif_settle(steif_context *ctx, const steif_problem *problem, sunrealtype t, N_Vector y,
                 N_Vector yp)
{
  sunrealtype *to = N_VGetArrayPointer(y), *slope = N_VGetArrayPointer(yp);
  STEIF_CHECK(to && slope, ctx, STEIF_UNSUPPORTED,
              "a consistent state at t = %.12g needs vectors with a host array", t);
  steif_start start = {0};
  const steif_inquiry at = {.y = to, .yp = slope, .t = t};
  const int code = steif_consistent(ctx, problem, &at, NULL, &start);
  const size_t bytes = (size_t)problem->n * sizeof *to;
  if (!code) memcpy(to, start.y, bytes), memcpy(slope, start.yp, bytes);
  steif_start_clear(&start);
  return code;
}
