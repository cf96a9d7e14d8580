/* roessler.c: Roessler's band x' = -y - z, y' = x + a y, z' = b + z (x - c).
 * SPDX-License-Identifier: BSD-3-Clause */
#include "collection.h"
#include <nvector/nvector_serial.h>
#include <sunmatrix/sunmatrix_dense.h>

static const sunrealtype a = 0.2, b = 0.2, c = 5.7;
static const sunrealtype start[] = {1, 1, 0};

static const sunrealtype end[] = {-0.754746422344828042081, -3.867716823566577807556,
                                  0.0288062524510141417193};
static const steif_reference reference = {
  .t = 10,
  .value = end,
  .digits = 17,
  .source =
    "Taylor series of orders 34 and 30 in 45-digit arithmetic, steps 0.05 and 0.04 agree"};

static int f(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const sunrealtype *x = N_VGetArrayPointer(y);
  sunrealtype *dx = N_VGetArrayPointer(ydot);
  (void)t, (void)user;
  dx[0] = -x[1] - x[2];
  dx[1] = x[0] + a * x[1];
  dx[2] = b + x[2] * (x[0] - c);
  return 0;
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector tmp1,
               N_Vector tmp2, N_Vector tmp3)
{
  const sunrealtype *x = N_VGetArrayPointer(y);
  (void)t, (void)fy, (void)user, (void)tmp1, (void)tmp2, (void)tmp3;
  SM_ELEMENT_D(J, 1, 0) = 1;
  SM_ELEMENT_D(J, 2, 0) = x[2];
  SM_ELEMENT_D(J, 0, 1) = -1;
  SM_ELEMENT_D(J, 1, 1) = a;
  SM_ELEMENT_D(J, 0, 2) = -1;
  SM_ELEMENT_D(J, 2, 2) = x[0] - c;
  return 0;
}

const steif_problem steif_problem_roessler = {
  .about =
    "Roessler's band with a = b = 0.2, c = 5.7, chaotic: O. E. Roessler, Phys. Lett. A 57 "
    "(1976) 397-398",
  .n = 3,
  .t1 = 10,
  .y0 = start,
  .f = f,
  .jac = jac,
  .autonomous = 1,
  .reference = &reference,
};
