/* transamp.c: an amplifier of two transistors, node voltages U_1 .. U_8, M U' = f(t, U) with a
 * constant M of rank 5, index 1.
 *
 *   C1 (U2' - U1') = (U1 - Ue)/R0                C1 (U1' - U2') = (2 U2 - Ub)/R + (1 - alpha) g1
 *   -C2 U3' = U3/R - g1                          C3 (U5' - U4') = (U4 - Ub)/R + alpha g1
 *   C3 (U4' - U5') = (2 U5 - Ub)/R + (1 - alpha) g2
 *   -C4 U6' = U6/R - g2                          C5 (U8' - U7') = (U7 - Ub)/R + alpha g2
 *   C5 (U7' - U8') = U8/R
 *   g1 = beta (e^((U2 - U3)/Uf) - 1),  g2 = beta (e^((U5 - U6)/Uf) - 1),  Ue = 0.1 sin(200 pi t)
 *
 * P. Rentrop, M. Roche, G. Steinebach, Numer. Math. 55 (1989)
 * 545-563; E. Hairer, C. Lubich, M. Roche, Lecture Notes in Mathematics 1409 (1989).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "published.h"
#include <math.h>

static const sunrealtype UB = 6, UF = 0.026, ALPHA = 0.99, BETA = 1e-6, R0 = 1000, R = 9000;

/* Emitter currents BETA (e^(U/UF) - 1) of both transistors, or where `slope` their derivatives;
 * 1 on overflow. */
static int emitters(const sunrealtype *u, int slope, sunrealtype g[2])
{
  for (int i = 0; i < 2; i++) {
    const sunrealtype z = (u[1 + 3 * i] - u[2 + 3 * i]) / UF;
    if (!(z < 300)) return 1;
    g[i] = slope ? BETA / UF * exp(z) : BETA * (exp(z) - 1);
  }
  return 0;
}

static int f(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const sunrealtype *u = NV_DATA_S(y), in = 0.1 * sin(200 * 3.14159265358979323846 * t);
  sunrealtype *d = NV_DATA_S(ydot), g[2];
  (void)user;
  if (emitters(u, 0, g)) return 1;
  d[0] = (u[0] - in) / R0;
  d[1] = (2 * u[1] - UB) / R + (1 - ALPHA) * g[0];
  d[2] = u[2] / R - g[0];
  d[3] = (u[3] - UB) / R + ALPHA * g[0];
  d[4] = (2 * u[4] - UB) / R + (1 - ALPHA) * g[1];
  d[5] = u[5] / R - g[1];
  d[6] = (u[6] - UB) / R + ALPHA * g[1];
  d[7] = u[7] / R;
  return 0;
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector tmp1,
               N_Vector tmp2, N_Vector tmp3)
{
  static const sunrealtype resistors[] = {1, 2, 1, 1, 2, 1, 1, 1};
  sunrealtype g[2];
  (void)t, (void)fy, (void)user, (void)tmp1, (void)tmp2, (void)tmp3;
  if (emitters(NV_DATA_S(y), 1, g)) return 1;
  for (sunindextype i = 0; i < 8; i++) SM_ELEMENT_D(J, i, i) = resistors[i] / (i > 0 ? R : R0);
  for (sunindextype i = 0; i < 2; i++) {
    const sunindextype base = 1 + 3 * i;
    sunrealtype *c = SM_COLUMN_D(J, base) + base, *e = SM_COLUMN_D(J, base + 1) + base;
    c[0] += (1 - ALPHA) * g[i];
    e[0] = -(1 - ALPHA) * g[i];
    c[1] = -g[i];
    e[1] += g[i];
    c[2] = ALPHA * g[i];
    e[2] = -ALPHA * g[i];
  }
  return 0;
}

/* Capacitors 1, 3, 5 uF join nodes 1-2, 4-5, 7-8; 2 and 4 uF join nodes 3 and 6
 * to the ground. */
static int mass(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  for (sunindextype i = 0; i < 8; i += 3) {
    const sunrealtype farad = 1e-6 * ((sunrealtype)(2 * i) / 3 + 1);
    SM_ELEMENT_D(E, i, i) = SM_ELEMENT_D(E, i + 1, i + 1) = -farad;
    SM_ELEMENT_D(E, i, i + 1) = SM_ELEMENT_D(E, i + 1, i) = farad;
  }
  SM_ELEMENT_D(E, 2, 2) = -2e-6;
  SM_ELEMENT_D(E, 5, 5) = -4e-6;
  return 0;
}

/* Slopes from M U' = f and the derivatives of the three hidden constraints f1 + f2 = 0,
 * f4 + f5 = 0, f7 + f8 = 0. The values that circulate with the test set (51.338775,
 * -24.9757667, -10.00564453) satisfy neither to more than four digits. */
static const sunrealtype y0[] = {0, 3, 3, 6, 3, 3, 6, 0};
static const sunrealtype yp0[] = {
  51.3392765171807206,  51.3392765171807206,  -166.666666666666667, -24.9703285154063289,
  -24.9703285154063289, -83.3333333333333333, -10.0002764024563387, -10.0002764024563387};
static const int index[] = {1, 1, 1, 1, 1, 1, 1, 1};
static const sunrealtype end[] = {
  -0.0055621450122627092, 3.0065224719030419, 2.8499587886081281, 2.9264225362062408,
  2.7046178650105541,     2.7618377783931449, 4.7709276316167717, 1.236995868091548};
static const steif_reference reference = {
  .t = 0.2, .value = end, .digits = 12, .source = IVP_TEST_SET "transamp"};

const steif_problem steif_problem_transamp = {
  .name = "transamp",
  .about = "Amplifier of two transistors, singular constant mass matrix, index 1. P. Rentrop, "
           "M. Roche, G. Steinebach (1989); IVP Test Set II-4.",
  .n = 8,
  .t1 = 0.2,
  .y0 = y0,
  .yp0 = yp0,
  .f = f,
  .jac = jac,
  .E = mass,
  .index = index,
  .dae_index = 1,
  .reference = &reference,
};
