/* orego.c: the Oregonator, a limit cycle of the Belousov-Zhabotinskii reaction.
 *
 *   y1' = s (y2 + y1 (1 - q y1 - y2)),  y2' = (y3 - (1 + y1) y2)/s,  y3' = w (y1 - y3),
 *   s = 77.27, w = 0.161, q = 8.375e-6
 *
 * R. J. Field, R. M. Noyes, J. Chem. Phys. 60 (1974) 1877-1884.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "published.h"

static const sunrealtype S = 77.27, W = 0.161, Q = 8.375e-6;

static int f(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const sunrealtype *u = NV_DATA_S(y);
  sunrealtype *d = NV_DATA_S(ydot);
  (void)t, (void)user;
  d[0] = S * (u[1] + u[0] * (1 - Q * u[0] - u[1]));
  d[1] = (u[2] - (1 + u[0]) * u[1]) / S;
  d[2] = W * (u[0] - u[2]);
  return 0;
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector tmp1,
               N_Vector tmp2, N_Vector tmp3)
{
  const sunrealtype *u = NV_DATA_S(y);
  (void)t, (void)fy, (void)user, (void)tmp1, (void)tmp2, (void)tmp3;
  SM_ELEMENT_D(J, 0, 0) = S * (1 - 2 * Q * u[0] - u[1]);
  SM_ELEMENT_D(J, 1, 0) = -u[1] / S;
  SM_ELEMENT_D(J, 2, 0) = W;
  SM_ELEMENT_D(J, 0, 1) = S * (1 - u[0]);
  SM_ELEMENT_D(J, 1, 1) = -(1 + u[0]) / S;
  SM_ELEMENT_D(J, 2, 1) = 0;
  SM_ELEMENT_D(J, 0, 2) = 0;
  SM_ELEMENT_D(J, 1, 2) = 1 / S;
  SM_ELEMENT_D(J, 2, 2) = -W;
  return 0;
}

static const sunrealtype y0[] = {1, 2, 3};
static const sunrealtype end[] = {1.0008148703185229, 1228.1785215499169, 132.0554942846706};
static const steif_reference reference = {
  .t = 360, .value = end, .digits = 12, .source = IVP_TEST_SET "orego"};

const steif_problem steif_problem_orego = {
  .name = "orego",
  .about = "Oregonator, limit cycle of the Belousov-Zhabotinskii reaction. R. J. Field, "
           "R. M. Noyes (1974); IVP Test Set II-8; " HAIRER_WANNER " IV.10.",
  .n = 3,
  .t1 = 360,
  .y0 = y0,
  .f = f,
  .jac = jac,
  .autonomous = 1,
  .reference = &reference,
  .rtol_scale = 1e-6,
};
