/* hires.c: High Irradiance RESponses of photomorphogenesis, eight reactants; y7 + y8 is
 * constant.
 *
 *   y1' = -1.71 y1 + 0.43 y2 + 8.32 y3 + 0.0007
 *   y2' = 1.71 y1 - 8.75 y2
 *   y3' = -10.03 y3 + 0.43 y4 + 0.035 y5
 *   y4' = 8.32 y2 + 1.71 y3 - 1.12 y4
 *   y5' = -1.745 y5 + 0.43 y6 + 0.43 y7
 *   y6' = -280 y6 y8 + 0.69 y4 + 1.71 y5 - 0.43 y6 + 0.69 y7
 *   y7' = 280 y6 y8 - 1.81 y7
 *   y8' = -y7'
 *
 * E. Schaefer, J. Math. Biol. 2 (1975) 41-56.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "published.h"

static int f(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const sunrealtype *u = NV_DATA_S(y);
  const sunrealtype bind = 280 * u[5] * u[7];
  sunrealtype *d = NV_DATA_S(ydot);
  (void)t, (void)user;
  d[0] = -1.71 * u[0] + 0.43 * u[1] + 8.32 * u[2] + 0.0007;
  d[1] = 1.71 * u[0] - 8.75 * u[1];
  d[2] = -10.03 * u[2] + 0.43 * u[3] + 0.035 * u[4];
  d[3] = 8.32 * u[1] + 1.71 * u[2] - 1.12 * u[3];
  d[4] = -1.745 * u[4] + 0.43 * u[5] + 0.43 * u[6];
  d[5] = -bind + 0.69 * u[3] + 1.71 * u[4] - 0.43 * u[5] + 0.69 * u[6];
  d[6] = bind - 1.81 * u[6];
  d[7] = -d[6];
  return 0;
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector tmp1,
               N_Vector tmp2, N_Vector tmp3)
{
  const sunrealtype d6 = 280 * NV_Ith_S(y, 7), d8 = 280 * NV_Ith_S(y, 5);
  (void)t, (void)fy, (void)user, (void)tmp1, (void)tmp2, (void)tmp3;
  SM_ELEMENT_D(J, 0, 0) = -1.71;
  SM_ELEMENT_D(J, 1, 0) = 1.71;
  SM_ELEMENT_D(J, 0, 1) = 0.43;
  SM_ELEMENT_D(J, 1, 1) = -8.75;
  SM_ELEMENT_D(J, 3, 1) = 8.32;
  SM_ELEMENT_D(J, 0, 2) = 8.32;
  SM_ELEMENT_D(J, 2, 2) = -10.03;
  SM_ELEMENT_D(J, 3, 2) = 1.71;
  SM_ELEMENT_D(J, 2, 3) = 0.43;
  SM_ELEMENT_D(J, 3, 3) = -1.12;
  SM_ELEMENT_D(J, 5, 3) = 0.69;
  SM_ELEMENT_D(J, 2, 4) = 0.035;
  SM_ELEMENT_D(J, 4, 4) = -1.745;
  SM_ELEMENT_D(J, 5, 4) = 1.71;
  SM_ELEMENT_D(J, 4, 5) = 0.43;
  SM_ELEMENT_D(J, 5, 5) = -0.43 - d6;
  SM_ELEMENT_D(J, 6, 5) = d6;
  SM_ELEMENT_D(J, 7, 5) = -d6;
  SM_ELEMENT_D(J, 4, 6) = 0.43;
  SM_ELEMENT_D(J, 5, 6) = 0.69;
  SM_ELEMENT_D(J, 6, 6) = -1.81;
  SM_ELEMENT_D(J, 7, 6) = 1.81;
  SM_ELEMENT_D(J, 5, 7) = SM_ELEMENT_D(J, 7, 7) = -d8;
  SM_ELEMENT_D(J, 6, 7) = d8;
  return 0;
}

static const sunrealtype y0[] = {1, 0, 0, 0, 0, 0, 0, 0.0057};
static const sunrealtype end[] = {0.00073713125733256685, 0.00014424857263161851,
                                  5.8887297409675752e-05, 0.0011756513432831491,
                                  0.0023863561988313308,  0.0062389682527427964,
                                  0.0028499983951857689,  0.0028500016048142308};
static const steif_reference reference = {
  .t = 321.8122, .value = end, .digits = 12, .source = IVP_TEST_SET "hires"};

const steif_problem steif_problem_hires = {
  .name = "hires",
  .about = "High irradiance responses of photomorphogenesis, eight reactants. E. Schaefer "
           "(1975); IVP Test Set II-1; " HAIRER_WANNER " IV.10.",
  .n = 8,
  .t1 = 321.8122,
  .y0 = y0,
  .f = f,
  .jac = jac,
  .autonomous = 1,
  .reference = &reference,
  .rtol_scale = 1e-4,
};
