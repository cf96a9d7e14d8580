/* henonheiles.c: a star in the plane of a galaxy, H = (p_1^2 + p_2^2 + q_1^2 + q_2^2)/2 +
 * q_1^2 q_2 - q_2^3/3, bounded below the energy 1/6; at 1/8 most orbits are chaotic.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "collection.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <sunmatrix/sunmatrix_dense.h>

/* Energy 1/8 with q_1 = 0, q_2 = 0.1 and p_2 = 0.03. */
#define P1 0.48965974580995186 /* sqrt(1/4 - 0.03^2 - 0.1^2 + 2/3 0.1^3) */
static const sunrealtype start[] = {0, 0.1, P1, 0.03};

static int kick(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const sunrealtype *q = N_VGetArrayPointer(y);
  sunrealtype *force = N_VGetArrayPointer(ydot) + 2;
  (void)t, (void)user;
  force[0] = -q[0] - 2 * q[0] * q[1];
  force[1] = -q[1] - q[0] * q[0] + q[1] * q[1];
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

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
               N_Vector b, N_Vector c)
{
  const sunrealtype *q = N_VGetArrayPointer(y);
  (void)t, (void)fy, (void)user, (void)a, (void)b, (void)c;
  SM_ELEMENT_D(J, 0, 2) = SM_ELEMENT_D(J, 1, 3) = 1;
  SM_ELEMENT_D(J, 2, 0) = -1 - 2 * q[1];
  SM_ELEMENT_D(J, 2, 1) = SM_ELEMENT_D(J, 3, 0) = -2 * q[0];
  SM_ELEMENT_D(J, 3, 1) = -1 + 2 * q[1];
  return 0;
}

static int energy(sunrealtype t, N_Vector y, sunrealtype *value, void *user)
{
  const sunrealtype *x = N_VGetArrayPointer(y);
  (void)t, (void)user;
  *value = 0.5 * (x[0] * x[0] + x[1] * x[1] + x[2] * x[2] + x[3] * x[3]) + x[0] * x[0] * x[1] -
           x[1] * x[1] * x[1] / 3;
  return 0;
}

const steif_problem steif_problem_henonheiles = {
  .about = "a star in a galaxy at energy 1/8, chaotic; M. Henon and C. Heiles, Astronom. J. 69 "
           "(1964)",
  .n = 4,
  .t1 = 100,
  .y0 = start,
  .f = f,
  .jac = jac,
  .autonomous = 1,
  .invariants = 1,
  .invariant = energy,
  .positions = 2,
  .kick = kick,
  .unit_mass = 1,
};
