/* ringmod.c: a ring modulator that mixes a low- and a high-frequency signal through four
 * diodes; parasitic capacitances Cs make it an oscillatory stiff ODE.
 *
 *   C U1' = I1 - I3/2 + I4/2 + I7 - U1/R        C U2' = I2 - I5/2 + I6/2 + I8 - U2/R
 *   Cs U3' = I3 - q(D1) + q(D4)                 Cs U4' = -I4 + q(D2) - q(D3)
 *   Cs U5' = I5 + q(D1) - q(D3)                 Cs U6' = -I6 - q(D2) + q(D4)
 *   Cp U7' = -U7/Rp + q(D1) + q(D2) - q(D3) - q(D4)
 *   Lh I1' = -U1,  Lh I2' = -U2
 *   Ls2 I3' = U1/2 - U3 - Rg2 I3                Ls3 I4' = -U1/2 + U4 - Rg3 I4
 *   Ls2 I5' = U2/2 - U5 - Rg2 I5                Ls3 I6' = -U2/2 + U6 - Rg3 I6
 *   Ls1 I7' = -U1 + e1(t) - (Ri + Rg1) I7       Ls1 I8' = -U2 - (Rc + Rg1) I8
 *   q(D) = gamma (e^(delta D) - 1),  D1 = U3 - U5 - U7 - e2(t),  D2 = U6 - U4 - U7 - e2(t),
 *   D3 = U4 + U5 + U7 + e2(t),  D4 = U7 + e2(t) - U3 - U6
 *
 * E. H. Horneber, Analyse nichtlinearer RLCUE-Netzwerke, dissertation, Kaiserslautern (1976).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "published.h"
#include <math.h>

static const sunrealtype C = 1.6e-8, CS = 2e-12, CP = 1e-8, R = 25000, RP = 50, LH = 4.45,
                         LS1 = 0.002, LS2 = 5e-4, LS3 = 5e-4, RG1 = 36.3, RG2 = 17.3,
                         RG3 = 17.3, RI = 50, RC = 600, GAMMA = 40.67286402e-9,
                         DELTA = 17.7493332, PI = 3.14159265358979323846;

/* Diode currents gamma (e^(delta U) - 1), or where `slope` their derivatives; 1 on overflow. */
static int diodes(sunrealtype t, const sunrealtype *y, int slope, sunrealtype q[4])
{
  const sunrealtype in = y[6] + 2 * sin(20000 * PI * t);
  const sunrealtype u[4] = {y[2] - y[4] - in, y[5] - y[3] - in, y[3] + y[4] + in,
                            in - y[2] - y[5]};
  for (int i = 0; i < 4; i++) {
    const sunrealtype z = DELTA * u[i];
    if (!(z < 300)) return 1;
    q[i] = slope ? GAMMA * DELTA * exp(z) : GAMMA * (exp(z) - 1);
  }
  return 0;
}

static int f(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const sunrealtype *u = NV_DATA_S(y);
  sunrealtype q[4], *d = NV_DATA_S(ydot);
  (void)user;
  if (diodes(t, u, 0, q)) return 1;
  d[0] = (u[7] - 0.5 * u[9] + 0.5 * u[10] + u[13] - u[0] / R) / C;
  d[1] = (u[8] - 0.5 * u[11] + 0.5 * u[12] + u[14] - u[1] / R) / C;
  d[2] = (u[9] - q[0] + q[3]) / CS;
  d[3] = (-u[10] + q[1] - q[2]) / CS;
  d[4] = (u[11] + q[0] - q[2]) / CS;
  d[5] = (-u[12] - q[1] + q[3]) / CS;
  d[6] = (-u[6] / RP + q[0] + q[1] - q[2] - q[3]) / CP;
  d[7] = -u[0] / LH;
  d[8] = -u[1] / LH;
  d[9] = (0.5 * u[0] - u[2] - RG2 * u[9]) / LS2;
  d[10] = (-0.5 * u[0] + u[3] - RG3 * u[10]) / LS3;
  d[11] = (0.5 * u[1] - u[4] - RG2 * u[11]) / LS2;
  d[12] = (-0.5 * u[1] + u[5] - RG3 * u[12]) / LS3;
  d[13] = (-u[0] + 0.5 * sin(2000 * PI * t) - (RI + RG1) * u[13]) / LS1;
  d[14] = (-u[1] - (RC + RG1) * u[14]) / LS1;
  return 0;
}

/* The linear network around the diodes. */
static void network(SUNMatrix J)
{
  for (sunindextype i = 0; i < 2; i++) {
    const sunindextype a = 9 + 2 * i, b = a + 1, c = 13 + i;
    SM_ELEMENT_D(J, i, i) = -1 / (R * C);
    SM_ELEMENT_D(J, i, 7 + i) = SM_ELEMENT_D(J, i, c) = 1 / C;
    SM_ELEMENT_D(J, i, a) = -0.5 / C;
    SM_ELEMENT_D(J, i, b) = 0.5 / C;
    SM_ELEMENT_D(J, 7 + i, i) = -1 / LH;
    SM_ELEMENT_D(J, a, i) = 0.5 / LS2;
    SM_ELEMENT_D(J, a, 2 + 2 * i) = -1 / LS2;
    SM_ELEMENT_D(J, a, a) = -RG2 / LS2;
    SM_ELEMENT_D(J, b, i) = -0.5 / LS3;
    SM_ELEMENT_D(J, b, 3 + 2 * i) = 1 / LS3;
    SM_ELEMENT_D(J, b, b) = -RG3 / LS3;
    SM_ELEMENT_D(J, c, i) = -1 / LS1;
    SM_ELEMENT_D(J, c, c) = -((i ? RC : RI) + RG1) / LS1;
    SM_ELEMENT_D(J, 2 + 2 * i, a) = 1 / CS;
    SM_ELEMENT_D(J, 3 + 2 * i, b) = -1 / CS;
  }
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector tmp1,
               N_Vector tmp2, N_Vector tmp3)
{
  /* dU_i/dy_j for j = 3 .. 7, and the sign with which diode i feeds nodes 3 .. 7. */
  static const signed char U[4][5] = {
    {1, 0, -1, 0, -1}, {0, -1, 0, 1, -1}, {0, 1, 1, 0, 1}, {-1, 0, 0, -1, 1}};
  static const signed char N[4][5] = {
    {-1, 0, 1, 0, 1}, {0, 1, 0, -1, 1}, {0, -1, -1, 0, -1}, {1, 0, 0, 1, -1}};
  sunrealtype q[4];
  (void)fy, (void)user, (void)tmp1, (void)tmp2, (void)tmp3;
  if (diodes(t, NV_DATA_S(y), 1, q)) return 1;
  network(J);
  for (sunindextype j = 0; j < 5; j++) {
    sunrealtype *c = SM_COLUMN_D(J, 2 + j) + 2;
    for (int r = 0; r < 5; r++) {
      sunrealtype sum = 0;
      for (int i = 0; i < 4; i++) sum += N[i][r] * U[i][j] * q[i];
      c[r] = sum / (r < 4 ? CS : CP);
    }
  }
  SM_ELEMENT_D(J, 6, 6) -= 1 / (RP * CP);
  return 0;
}

static const sunrealtype y0[15];
static const sunrealtype end[] = {
  -0.023390573584867451,   -0.0073674854855408254, 0.25829567092911693,
  -0.40644657212834501,    -0.40394556651497943,   0.26079667654229433,
  0.11067618612699751,     2.939904342435596e-07,  -2.8400299336423291e-08,
  0.00072671982672645533,  0.000792948719696084,   -0.00072552834956989649,
  -0.00079414019685265205, 7.0884954169761141e-05, 2.3900590752365701e-05};
static const steif_reference reference = {
  .t = 1e-3, .value = end, .digits = 9, .source = IVP_TEST_SET "ringmod"};

const steif_problem steif_problem_ringmod = {
  .name = "ringmod",
  .about = "Ring modulator, a circuit of four diodes with parasitic capacitances, oscillatory "
           "and stiff. E. H. Horneber (1976); IVP Test Set II-12.",
  .n = 15,
  .t1 = 1e-3,
  .y0 = y0,
  .f = f,
  .jac = jac,
  .reference = &reference,
};
