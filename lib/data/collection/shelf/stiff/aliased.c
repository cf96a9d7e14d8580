/* aliased.c: x' = (L + D cos(2 pi t / period)) x, x(0) = 1: it decays at the rate L < 0, and a method
 * whose stages stand where the cosine is 1 sees x' = (L + D) x.
 *
 * x = e^{L t + D period/(2 pi) sin(2 pi t / period)}.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "collection.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <sunmatrix/sunmatrix_dense.h>

typedef struct setting {
  sunrealtype D, L, period;
} setting;

static const sunrealtype start[] = {1};

/* Phases are taken of the fraction of a period: they stay exact after many. */
static sunrealtype phase(const setting *s, sunrealtype t)
{
  const sunrealtype turns = t / s->period;
  return 6.2831853071795864769 * (turns - nearbyint(turns));
}

static sunrealtype rate(const setting *s, sunrealtype t)
{
  return s->L + s->D * cos(phase(s, t));
}

static int f(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  N_VGetArrayPointer(ydot)[0] = rate(user, t) * N_VGetArrayPointer(y)[0];
  return 0;
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
               N_Vector b, N_Vector c)
{
  (void)y, (void)fy, (void)a, (void)b, (void)c;
  SM_ELEMENT_D(J, 0, 0) = rate(user, t);
  return 0;
}

static int exact(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  const setting *s = user;
  const sunrealtype wave = s->D * s->period / 6.2831853071795864769;
  N_VGetArrayPointer(y)[0] = exp(s->L * t + wave * sin(phase(s, t)));
  return yp ? f(t, y, yp, user) : 0;
}

static int build(steif_context *ctx, const steif_spec *spec, steif_problem *self)
{
  setting s;
  STEIF_TRY(stf_spec_only(ctx, spec, (const char *const[]){"D", "L", "period", NULL}));
  STEIF_TRY(stf_spec_real(ctx, spec, "D", -1e6, 1e6, 2, &s.D));
  STEIF_TRY(stf_spec_real(ctx, spec, "L", -1e6, 1e6, -1, &s.L));
  STEIF_TRY(stf_spec_real(ctx, spec, "period", 1e-12, 1e6, 0.1, &s.period));
  if (!stf_collection_allocate(ctx, self, sizeof s, 0)) return STEIF_NO_MEMORY;
  *(setting *)self->user = s;
  self->period = s.period;
  return STEIF_OK;
}

const steif_problem steif_problem_aliased = {
  .about = "x' = lambda(t) x that decays, and grows with steps of one period, "
           "D=2,L=-1,period=0.1: A. Steyer and E. Van "
           "Vleck, arXiv 1709.02059, theorem 3.4",
  .n = 1,
  .t1 = 5,
  .y0 = start,
  .f = f,
  .jac = jac,
  .exact = exact,
  .build = build,
  .destroy = stf_collection_release,
};
