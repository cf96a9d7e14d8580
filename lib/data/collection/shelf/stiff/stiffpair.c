/* stiffpair.c: x' = diag(-1, -1000) x, x(0) = (1, 1): one slow and one fast decay.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "collection.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <sunmatrix/sunmatrix_dense.h>

#define SLOW -1.0
#define FAST -1000.0

static const sunrealtype start[] = {1, 1};

static int f(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const sunrealtype *x = N_VGetArrayPointer(y);
  sunrealtype *dx = N_VGetArrayPointer(ydot);
  (void)t, (void)user;
  dx[0] = SLOW * x[0];
  dx[1] = FAST * x[1];
  return 0;
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
               N_Vector b, N_Vector c)
{
  (void)t, (void)y, (void)fy, (void)user, (void)a, (void)b, (void)c;
  SM_ELEMENT_D(J, 0, 0) = SLOW;
  SM_ELEMENT_D(J, 1, 1) = FAST;
  return 0;
}

static int exact(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  sunrealtype *x = N_VGetArrayPointer(y);
  x[0] = exp(SLOW * t);
  x[1] = exp(FAST * t);
  return yp ? f(t, y, yp, user) : 0;
}

const steif_problem steif_problem_stiffpair = {
  .about = "two decoupled decays with rates 1 and 1000; on stiffness: E. Hairer and G. Wanner, "
           "Solving Ordinary Differential Equations II, Springer 1996, ch. IV",
  .n = 2,
  .t1 = 4,
  .y0 = start,
  .f = f,
  .jac = jac,
  .autonomous = 1,
  .linear = 1,
  .exact = exact,
};
