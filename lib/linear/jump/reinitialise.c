/* reinitialise.c: the state behind an event.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "base.h"
#include "problem.h"
#include <steif/jump.h>
#include <string.h>

static int settle(steif_context *ctx, const steif_problem *problem, sunrealtype t,
                  sunrealtype rtol, bool stages, N_Vector y, N_Vector yp)
{
  STEIF_CHECK(problem && y && yp, ctx, STEIF_BAD_INPUT,
              "a problem, y and y' are needed, got NULL");
  sunrealtype *to = N_VGetArrayPointer(y), *slope = N_VGetArrayPointer(yp);
  STEIF_CHECK(to && slope, ctx, STEIF_UNSUPPORTED,
              "a jump at t = %.12g needs vectors with a host array", t);
  steif_jump jump;
  const steif_point at = {.y = to, .yp = slope, .t = t};
  const steif_jump_request request = {.rtol = rtol, .stages = stages};
  STEIF_TRY(steif_jump_find(ctx, problem, &at, &request, &jump));
  int code = STEIF_OK;
  if (!jump.unique && !stages)
    code = STEIF_FAIL(ctx, STEIF_NOT_CERTIFIED, "after t = %.12g of problem '%s': %s", t,
                      problem->name, jump.message);
  const size_t bytes = (size_t)problem->n * sizeof *to;
  if (!code) memcpy(to, jump.y, bytes), memcpy(slope, jump.yp, bytes);
  steif_jump_clear(&jump);
  return code;
}

int steif_reinitialise(steif_context *ctx, const steif_problem *problem, sunrealtype t,
                       sunrealtype rtol, N_Vector y, N_Vector yp)
{
  STF_NAMED(problem);
  return settle(ctx, problem, t, rtol, false, y, yp);
}

int steif_reinitialise_stages(steif_context *ctx, const steif_problem *problem, sunrealtype t,
                              sunrealtype rtol, N_Vector y, N_Vector yp)
{
  STF_NAMED(problem);
  return settle(ctx, problem, t, rtol, true, y, yp);
}
