/* pendulum.c: the mathematical pendulum q' = p, p' = -sin q, H = p^2/2 - cos q, from (1, 0).
 * SPDX-License-Identifier: BSD-3-Clause */
#include "collection.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <sunmatrix/sunmatrix_dense.h>

static const sunrealtype start[] = {1, 0};

static const sunrealtype end[] = {-0.998949814623850652, -0.0420333775342122937};
static const steif_reference reference = {
  .t = 10,
  .value = end,
  .digits = 17,
  .source = "Taylor series of order 36 in 50-digit arithmetic, steps 0.1 and 0.08 agree"};

static int f(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const sunrealtype *x = N_VGetArrayPointer(y);
  sunrealtype *dx = N_VGetArrayPointer(ydot);
  (void)t, (void)user;
  dx[0] = x[1];
  dx[1] = -sin(x[0]);
  return 0;
}

static int kick(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const sunrealtype *x = N_VGetArrayPointer(y);
  (void)t, (void)user;
  N_VGetArrayPointer(ydot)[1] = -sin(x[0]);
  return 0;
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
               N_Vector b, N_Vector c)
{
  (void)t, (void)fy, (void)user, (void)a, (void)b, (void)c;
  SM_ELEMENT_D(J, 0, 1) = 1;
  SM_ELEMENT_D(J, 1, 0) = -cos(N_VGetArrayPointer(y)[0]);
  return 0;
}

static int exact(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  sunrealtype *x = N_VGetArrayPointer(y);
  stf_collection_pendulum(1, start[0], start[1], t, &x[0], &x[1]);
  return yp ? f(t, y, yp, user) : 0;
}

static int energy(sunrealtype t, N_Vector y, sunrealtype *value, void *user)
{
  const sunrealtype *x = N_VGetArrayPointer(y);
  (void)t, (void)user;
  *value = 0.5 * x[1] * x[1] - cos(x[0]);
  return 0;
}

const steif_problem steif_problem_pendulum = {
  .about = "mathematical pendulum H = p^2/2 - cos q from (1, 0); Hairer, Lubich and Wanner, "
           "Geometric Numerical Integration, Springer 2006, ch. I.1",
  .n = 2,
  .t1 = 10,
  .y0 = start,
  .f = f,
  .jac = jac,
  .autonomous = 1,
  .exact = exact,
  .reference = &reference,
  .invariants = 1,
  .invariant = energy,
  .positions = 1,
  .kick = kick,
  .unit_mass = 1,
};
