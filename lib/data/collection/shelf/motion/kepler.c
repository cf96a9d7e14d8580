/* kepler.c: the two-body problem q'' = -q/|q|^3 from the pericentre, eccentricity e.
 *
 * With the eccentric anomaly E, E - e sin E = t (period 2 pi):
 *   q = (cos E - e, sqrt(1-e^2) sin E),  p = (-sin E, sqrt(1-e^2) cos E) / (1 - e cos E).
 * Conserved: energy |p|^2/2 - 1/|q| = -1/2, angular momentum q_1 p_2 - q_2 p_1 = sqrt(1-e^2).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "collection.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <sunmatrix/sunmatrix_dense.h>

#define TWO_PI 6.28318530717958647692

typedef struct orbit {
  sunrealtype e, start[4];
} orbit;

static int kick(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const sunrealtype *x = N_VGetArrayPointer(y), r2 = x[0] * x[0] + x[1] * x[1];
  const sunrealtype pull = 1 / (r2 * sqrt(r2));
  sunrealtype *dx = N_VGetArrayPointer(ydot);
  (void)t, (void)user;
  dx[2] = -pull * x[0];
  dx[3] = -pull * x[1];
  return 0;
}

static int f(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const sunrealtype *x = N_VGetArrayPointer(y);
  sunrealtype *dx = N_VGetArrayPointer(ydot);
  dx[0] = x[2];
  dx[1] = x[3];
  return kick(t, y, ydot, user);
}

/* d(-q/r^3)/dq = (3 q q^T - r^2 I) / r^5. */
static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
               N_Vector b, N_Vector c)
{
  const sunrealtype *x = N_VGetArrayPointer(y), r2 = x[0] * x[0] + x[1] * x[1];
  const sunrealtype r5 = r2 * r2 * sqrt(r2);
  (void)t, (void)fy, (void)user, (void)a, (void)b, (void)c;
  for (int i = 0; i < 2; i++) {
    SM_ELEMENT_D(J, i, i + 2) = 1;
    for (int j = 0; j < 2; j++)
      SM_ELEMENT_D(J, i + 2, j) = (3 * x[i] * x[j] - (i == j ? r2 : 0)) / r5;
  }
  return 0;
}

/* E - e sin E = M on [0, pi]: convex there, so Newton's iteration descends from pi. */
static sunrealtype anomaly(sunrealtype e, sunrealtype M)
{
  sunrealtype E = 0.5 * TWO_PI;
  for (int i = 0; i < 60; i++) {
    const sunrealtype step = (E - e * sin(E) - M) / (1 - e * cos(E));
    E -= step;
    if (step <= STF_EPS * E) break;
  }
  return E;
}

static int exact(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  const orbit *o = user;
  const sunrealtype M = remainder(t, TWO_PI), E = copysign(anomaly(o->e, fabs(M)), M);
  const sunrealtype minor = sqrt((1 - o->e) * (1 + o->e)), rate = 1 / (1 - o->e * cos(E));
  sunrealtype *x = N_VGetArrayPointer(y);
  x[0] = cos(E) - o->e;
  x[1] = minor * sin(E);
  x[2] = -rate * sin(E);
  x[3] = rate * minor * cos(E);
  return yp ? f(t, y, yp, user) : 0;
}

static int conserved(sunrealtype t, N_Vector y, sunrealtype *value, void *user)
{
  const sunrealtype *x = N_VGetArrayPointer(y);
  (void)t, (void)user;
  value[0] = 0.5 * (x[2] * x[2] + x[3] * x[3]) - 1 / hypot(x[0], x[1]);
  value[1] = x[0] * x[3] - x[1] * x[2];
  return 0;
}

static int build(steif_context *ctx, const steif_spec *spec, steif_problem *self)
{
  sunrealtype e;
  STEIF_TRY(stf_spec_only(ctx, spec, (const char *const[]){"e", NULL}));
  STEIF_TRY(stf_spec_real(ctx, spec, "e", 0, 0.99, 0.6, &e));
  orbit *o = stf_collection_allocate(ctx, self, sizeof *o, 0);
  if (!o) return STEIF_NO_MEMORY;
  *o = (orbit){e, {1 - e, 0, 0, sqrt((1 + e) / (1 - e))}};
  self->y0 = o->start;
  return STEIF_OK;
}

const steif_problem steif_problem_kepler = {
  .about = "planar two-body problem with eccentricity e=0.6, one period; Hairer, Lubich and "
           "Wanner, Geometric Numerical Integration, Springer 2006, ch. I.2",
  .n = 4,
  .t1 = TWO_PI,
  .f = f,
  .jac = jac,
  .autonomous = 1,
  .exact = exact,
  .invariants = 2,
  .invariant = conserved,
  .positions = 2,
  .kick = kick,
  .unit_mass = 1,
  .build = build,
  .destroy = stf_collection_release,
};
