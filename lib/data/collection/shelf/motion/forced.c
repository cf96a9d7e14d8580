/* forced.c: the forced, damped oscillator q'' + c q' + k q = sin 2t from rest, k > c^2/4.
 *
 * With D = (k-4)^2 + 4c^2, a = (k-4)/D, b = -2c/D, r = c/2, w = sqrt(k - r^2):
 *   q = e^{-rt} (P cos wt + Q sin wt) + a sin 2t + b cos 2t,  P = -b,  Q = (rP - 2a)/w.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "collection.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <sunmatrix/sunmatrix_dense.h>

typedef struct oscillator {
  sunrealtype k, c; /* stiffness and damping */
  sunrealtype a, b, r, w, P, Q;
} oscillator;

static const sunrealtype start[] = {0, 0};

static int f(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const oscillator *o = user;
  const sunrealtype *x = N_VGetArrayPointer(y);
  sunrealtype *dx = N_VGetArrayPointer(ydot);
  dx[0] = x[1];
  dx[1] = sin(2 * t) - o->c * x[1] - o->k * x[0];
  return 0;
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
               N_Vector b, N_Vector c)
{
  const oscillator *o = user;
  (void)t, (void)y, (void)fy, (void)a, (void)b, (void)c;
  SM_ELEMENT_D(J, 0, 1) = 1;
  SM_ELEMENT_D(J, 1, 0) = -o->k;
  SM_ELEMENT_D(J, 1, 1) = -o->c;
  return 0;
}

static int exact(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  const oscillator *o = user;
  const sunrealtype e = exp(-o->r * t), C = cos(o->w * t), S = sin(o->w * t);
  sunrealtype *x = N_VGetArrayPointer(y);
  x[0] = e * (o->P * C + o->Q * S) + o->a * sin(2 * t) + o->b * cos(2 * t);
  x[1] = e * ((o->w * o->Q - o->r * o->P) * C - (o->r * o->Q + o->w * o->P) * S) +
         2 * o->a * cos(2 * t) - 2 * o->b * sin(2 * t);
  return yp ? f(t, y, yp, user) : 0;
}

static int build(steif_context *ctx, const steif_spec *spec, steif_problem *self)
{
  sunrealtype k, c;
  STEIF_TRY(stf_spec_only(ctx, spec, (const char *const[]){"k", "c", NULL}));
  STEIF_TRY(stf_spec_real(ctx, spec, "k", 1e-6, 1e12, 4, &k));
  STEIF_TRY(stf_spec_real(ctx, spec, "c", 0, 1e6, 0.5, &c));
  STEIF_CHECK(4 * k > c * c, ctx, STEIF_BAD_INPUT,
              "k = %g and c = %g do not oscillate: the closed solution needs k > c^2/4 = %g", k,
              c, c * c / 4);
  const sunrealtype D = (k - 4) * (k - 4) + 4 * c * c, r = c / 2, w = sqrt(k - r * r);
  STEIF_CHECK(D > 0, ctx, STEIF_BAD_INPUT,
              "k = 4 without damping is in resonance with sin 2t: choose c > 0 or another k");
  const sunrealtype a = (k - 4) / D, b = -2 * c / D;
  oscillator *o = stf_collection_allocate(ctx, self, sizeof *o, 0);
  if (!o) return STEIF_NO_MEMORY;
  *o = (oscillator){k, c, a, b, r, w, -b, (-r * b - 2 * a) / w};
  return STEIF_OK;
}

const steif_problem steif_problem_forced = {
  .about = "forced damped oscillator q'' + c q' + k q = sin 2t from rest, in closed form; "
           "parameters k=4, c=0.5",
  .n = 2,
  .t1 = 4,
  .y0 = start,
  .f = f,
  .jac = jac,
  .linear = 1,
  .exact = exact,
  .build = build,
  .destroy = stf_collection_release,
};
