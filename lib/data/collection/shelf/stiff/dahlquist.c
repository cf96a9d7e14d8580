/* dahlquist.c: the test equation y' = lambda y, y(0) = 1, as a real system for Re y and Im y.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "collection.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <sunmatrix/sunmatrix_dense.h>

typedef struct lambda {
  sunrealtype re, im;
} lambda;

static const sunrealtype start[] = {1, 0};

static int f(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const lambda *l = user;
  const sunrealtype *x = N_VGetArrayPointer(y);
  sunrealtype *dx = N_VGetArrayPointer(ydot);
  (void)t;
  dx[0] = l->re * x[0] - l->im * x[1];
  dx[1] = l->im * x[0] + l->re * x[1];
  return 0;
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
               N_Vector b, N_Vector c)
{
  const lambda *l = user;
  (void)t, (void)y, (void)fy, (void)a, (void)b, (void)c;
  SM_ELEMENT_D(J, 0, 0) = SM_ELEMENT_D(J, 1, 1) = l->re;
  SM_ELEMENT_D(J, 1, 0) = l->im;
  SM_ELEMENT_D(J, 0, 1) = -l->im;
  return 0;
}

static int exact(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  const lambda *l = user;
  sunrealtype *x = N_VGetArrayPointer(y);
  x[0] = exp(l->re * t) * cos(l->im * t);
  x[1] = exp(l->re * t) * sin(l->im * t);
  return yp ? f(t, y, yp, user) : 0;
}

static int build(steif_context *ctx, const steif_spec *spec, steif_problem *self)
{
  lambda l;
  STEIF_TRY(stf_spec_only(ctx, spec, (const char *const[]){"re", "im", NULL}));
  STEIF_TRY(stf_spec_real(ctx, spec, "re", -1e15, 700, -1, &l.re));
  STEIF_TRY(stf_spec_real(ctx, spec, "im", -1e15, 1e15, 1, &l.im));
  if (!stf_collection_allocate(ctx, self, sizeof l, 0)) return STEIF_NO_MEMORY;
  *(lambda *)self->user = l;
  return STEIF_OK;
}

const steif_problem steif_problem_dahlquist = {
  .about =
    "the linear test equation y' = lambda y in real form, lambda = re + i im (re=-1, im=1); "
    "G. Dahlquist, BIT 3 (1963) 27-43",
  .n = 2,
  .t1 = 1,
  .y0 = start,
  .f = f,
  .jac = jac,
  .autonomous = 1,
  .linear = 1,
  .exact = exact,
  .build = build,
  .destroy = stf_collection_release,
};
