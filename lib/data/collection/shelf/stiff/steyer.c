/* steyer.c: x' = A(t) x that decays, while methods of large steps make it grow.
 *
 *   A = Q B Q^T + Q' Q^T,  B = [[a cos t + b1, beta], [0, a cos t + b2]],
 *   Q the rotation by omega t. The Lyapunov exponents are b1 and b2. X(t, 0) = Q(t) Y(t) with
 *   y11 = e^{a sin t + b1 t}, y22 = e^{a sin t + b2 t}, y21 = 0,
 *   y12 = beta e^{a sin t} (e^{b1 t} - e^{b2 t}) / (b1 - b2).
 * The solution is the first or the second column of X(t, 0).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "collection.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <sunmatrix/sunmatrix_dense.h>

typedef struct setting {
  sunrealtype a, b1, b2, beta, omega;
  int column;
} setting;

static const sunrealtype unit[] = {1, 0, 1};

static void coefficient(const setting *s, sunrealtype t, sunrealtype A[2][2])
{
  const sunrealtype c = cos(s->omega * t), n = sin(s->omega * t), wave = s->a * cos(t);
  const sunrealtype g1 = wave + s->b1, g2 = wave + s->b2;
  A[0][0] = g1 * c * c - s->beta * c * n + g2 * n * n;
  A[0][1] = (g1 - g2) * c * n + s->beta * c * c - s->omega;
  A[1][0] = (g1 - g2) * c * n - s->beta * n * n + s->omega;
  A[1][1] = g1 * n * n + s->beta * c * n + g2 * c * c;
}

static int f(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const sunrealtype *x = N_VGetArrayPointer(y);
  sunrealtype *dx = N_VGetArrayPointer(ydot), A[2][2];
  coefficient(user, t, A);
  for (int i = 0; i < 2; i++) dx[i] = A[i][0] * x[0] + A[i][1] * x[1];
  return 0;
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector u,
               N_Vector v, N_Vector w)
{
  sunrealtype A[2][2];
  (void)y, (void)fy, (void)u, (void)v, (void)w;
  coefficient(user, t, A);
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++) SM_ELEMENT_D(J, i, j) = A[i][j];
  return 0;
}

/* (e^{b1 t} - e^{b2 t}) / (b1 - b2), t e^{b1 t} when they are equal. */
static sunrealtype shear(const setting *s, sunrealtype t)
{
  const sunrealtype gap = s->b1 - s->b2;
  return exp(s->b2 * t) * (gap != 0 ? expm1(gap * t) / gap : t);
}

static int exact(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  const setting *s = user;
  const sunrealtype E = exp(s->a * sin(t)), c = cos(s->omega * t), n = sin(s->omega * t);
  const sunrealtype u = s->column == 1 ? E * exp(s->b1 * t) : E * s->beta * shear(s, t);
  const sunrealtype v = s->column == 1 ? 0 : E * exp(s->b2 * t);
  sunrealtype *x = N_VGetArrayPointer(y);
  x[0] = c * u - n * v;
  x[1] = n * u + c * v;
  return yp ? f(t, y, yp, user) : 0;
}

static int build(steif_context *ctx, const steif_spec *spec, steif_problem *self)
{
  static const char *const keys[] = {"a", "b1", "b2", "beta", "omega", "column", NULL};
  setting s;
  STEIF_TRY(stf_spec_only(ctx, spec, keys));
  STEIF_TRY(stf_spec_real(ctx, spec, "a", -100, 100, 1.2, &s.a));
  STEIF_TRY(stf_spec_real(ctx, spec, "b1", -1e6, 100, -0.14, &s.b1));
  STEIF_TRY(stf_spec_real(ctx, spec, "b2", -1e6, 100, -0.15, &s.b2));
  STEIF_TRY(stf_spec_real(ctx, spec, "beta", -1e6, 1e6, 10, &s.beta));
  STEIF_TRY(stf_spec_real(ctx, spec, "omega", -1e6, 1e6, 1, &s.omega));
  STEIF_TRY(stf_spec_int(ctx, spec, "column", 1, 2, 1, &s.column));
  if (!stf_collection_allocate(ctx, self, sizeof s, 0)) return STEIF_NO_MEMORY;
  *(setting *)self->user = s;
  self->period = 2 * s.omega == nearbyint(2 * s.omega) ? 6.2831853071795864769 : 0;
  self->y0 = unit + (s.column == 1 ? 0 : 1);
  return STEIF_OK;
}

const steif_problem steif_problem_steyer = {
  .about = "x' = A(t) x that decays with exponents b1, b2, "
           "a=1.2,b1=-0.14,b2=-0.15,beta=10,omega=1: A. Steyer and "
           "E. Van Vleck, arXiv 1709.02059, equation (3)",
  .n = 2,
  .t1 = 40,
  .y0 = unit,
  .f = f,
  .jac = jac,
  .exact = exact,
  .build = build,
  .destroy = stf_collection_release,
};
