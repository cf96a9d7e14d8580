/* settle.c: the state behind an event of a linear system, by the jump of its distribution.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "base.h"
#include <steif/impulse.h>
#include <string.h>

int steif_settle_jump(steif_context *ctx, const steif_problem *problem, sunrealtype t,
                      N_Vector y, N_Vector yp)
{
  (void)yp;
  sunrealtype *x = N_VGetArrayPointer(y);
  STEIF_CHECK(x, ctx, STEIF_UNSUPPORTED, "a jump at t = %.12g needs vectors with a host array",
              t);
  steif_linear linear;
  steif_impulse jump = {0};
  STEIF_TRY(steif_linear_of(ctx, problem, &linear));
  const int code =
    steif_impulse_find(ctx, linear.E, linear.F, x, t, linear.f, linear.user, NULL, NULL, &jump);
  if (!code) memcpy(x, jump.x_plus, (size_t)problem->n * sizeof *x);
  steif_impulse_clear(ctx, &jump);
  SUNMatDestroy(linear.E);
  SUNMatDestroy(linear.F);
  return code;
}
