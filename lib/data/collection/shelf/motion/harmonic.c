/* harmonic.c: the harmonic oscillator q' = p, p' = -q, H = (q^2 + p^2)/2.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "collection.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <sunmatrix/sunmatrix_dense.h>

static const sunrealtype start[] = {1, 0};

static int f(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const sunrealtype *x = N_VGetArrayPointer(y);
  sunrealtype *dx = N_VGetArrayPointer(ydot);
  (void)t, (void)user;
  dx[0] = x[1];
  dx[1] = -x[0];
  return 0;
}

static int kick(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const sunrealtype *x = N_VGetArrayPointer(y);
  (void)t, (void)user;
  N_VGetArrayPointer(ydot)[1] = -x[0];
  return 0;
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
               N_Vector b, N_Vector c)
{
  (void)t, (void)y, (void)fy, (void)user, (void)a, (void)b, (void)c;
  SM_ELEMENT_D(J, 0, 1) = 1;
  SM_ELEMENT_D(J, 1, 0) = -1;
  return 0;
}

static int exact(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  sunrealtype *x = N_VGetArrayPointer(y);
  x[0] = cos(t);
  x[1] = -sin(t);
  return yp ? f(t, y, yp, user) : 0;
}

static int energy(sunrealtype t, N_Vector y, sunrealtype *value, void *user)
{
  const sunrealtype *x = N_VGetArrayPointer(y);
  (void)t, (void)user;
  *value = 0.5 * (x[0] * x[0] + x[1] * x[1]);
  return 0;
}

const steif_problem steif_problem_harmonic = {
  .about = "harmonic oscillator from (q, p) = (1, 0); energy drift of methods on it: Hairer, "
           "Lubich and Wanner, Geometric Numerical Integration, Springer 2006, ch. I",
  .n = 2,
  .t1 = 1.5,
  .y0 = start,
  .f = f,
  .jac = jac,
  .autonomous = 1,
  .linear = 1,
  .exact = exact,
  .invariants = 1,
  .invariant = energy,
  .positions = 1,
  .kick = kick,
  .unit_mass = 1,
};
