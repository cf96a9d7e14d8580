/* prothero.c: y' = lambda (y - phi(t)) + phi'(t), phi = 10 - (10 + t) e^{-t}, solution phi.
 *
 * For lambda -> -infinity the order that a Runge-Kutta method keeps is that of its stages.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "collection.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <sunmatrix/sunmatrix_dense.h>

static const sunrealtype start[] = {0};

static sunrealtype phi(sunrealtype t) { return -10 * expm1(-t) - t * exp(-t); }
static sunrealtype slope(sunrealtype t) { return (9 + t) * exp(-t); }

static int f(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const sunrealtype *lambda = user;
  N_VGetArrayPointer(ydot)[0] = *lambda * (N_VGetArrayPointer(y)[0] - phi(t)) + slope(t);
  return 0;
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
               N_Vector b, N_Vector c)
{
  const sunrealtype *lambda = user;
  (void)t, (void)y, (void)fy, (void)a, (void)b, (void)c;
  SM_ELEMENT_D(J, 0, 0) = *lambda;
  return 0;
}

static int exact(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  (void)user;
  N_VGetArrayPointer(y)[0] = phi(t);
  if (yp) N_VGetArrayPointer(yp)[0] = slope(t);
  return 0;
}

static int build(steif_context *ctx, const steif_spec *spec, steif_problem *self)
{
  sunrealtype lambda;
  STEIF_TRY(stf_spec_only(ctx, spec, (const char *const[]){"lambda", NULL}));
  STEIF_TRY(stf_spec_real(ctx, spec, "lambda", -1e15, 100, -1e6, &lambda));
  if (!stf_collection_allocate(ctx, self, sizeof lambda, 0)) return STEIF_NO_MEMORY;
  *(sunrealtype *)self->user = lambda;
  return STEIF_OK;
}

const steif_problem steif_problem_prothero = {
  .about =
    "y' = lambda (y - phi) + phi', lambda=-1e6: A. Prothero and A. Robinson, Math. Comp. 28 "
    "(1974) 145-162",
  .n = 1,
  .t1 = 5,
  .y0 = start,
  .f = f,
  .jac = jac,
  .linear = 1,
  .exact = exact,
  .build = build,
  .destroy = stf_collection_release,
};
