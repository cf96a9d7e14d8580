/* lorenz.c: Lorenz' convection model x' = s(y-x), y' = rx - y - xz, z' = xy - bz.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "collection.h"
#include <nvector/nvector_serial.h>
#include <sunmatrix/sunmatrix_dense.h>

static const sunrealtype s = 10, r = 28, b = 8.0 / 3;
static const sunrealtype start[] = {1, 1, 20};

static const sunrealtype end[] = {3.1613434128991870456, 5.4726937586681696091,
                                  12.353291612901809959};
static const steif_reference reference = {
  .t = 10,
  .value = end,
  .digits = 17,
  .source = "Taylor series of order 40 in 60-digit arithmetic, steps 0.02 and 0.0125 agree"};

static int f(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const sunrealtype *x = N_VGetArrayPointer(y);
  sunrealtype *dx = N_VGetArrayPointer(ydot);
  (void)t, (void)user;
  dx[0] = s * (x[1] - x[0]);
  dx[1] = r * x[0] - x[1] - x[0] * x[2];
  dx[2] = x[0] * x[1] - b * x[2];
  return 0;
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector tmp1,
               N_Vector tmp2, N_Vector tmp3)
{
  const sunrealtype *x = N_VGetArrayPointer(y);
  const sunrealtype row[3][3] = {{-s, s, 0}, {r - x[2], -1, -x[0]}, {x[1], x[0], -b}};
  (void)t, (void)fy, (void)user, (void)tmp1, (void)tmp2, (void)tmp3;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) SM_ELEMENT_D(J, i, j) = row[i][j];
  return 0;
}

const steif_problem steif_problem_lorenz = {
  .about =
    "Lorenz' convection model with s = 10, r = 28, b = 8/3 on its attractor: E. N. Lorenz, "
    "J. Atmos. Sci. 20 (1963) 130-141",
  .n = 3,
  .t1 = 10,
  .y0 = start,
  .f = f,
  .jac = jac,
  .autonomous = 1,
  .reference = &reference,
};
