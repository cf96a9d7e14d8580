/* pollu.c: the chemical part of an air pollution model, 25 reactions of 20 species.
 *
 *   y_i' = sum_r nu_ir v_r,  v_r = k_r y_a or k_r y_a y_b
 *
 * J. G. Verwer, SIAM J. Sci. Comput. 15 (1994) 1243-1250.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "published.h"

/* Rate constants; the first entry only makes numbers agree with those of the reactions. */
static const sunrealtype k[] = {0,      0.35,  26.6,   12300,  8.6e-4, 8.2e-4,  15000,
                                1.3e-4, 24000, 16500,  9000,   0.022,  12000,   1.88,
                                16300,  4.8e6, 3.5e-4, 0.0175, 1e8,    4.44e11, 1240,
                                2.1,    5.78,  0.0474, 1780,   3.12};

static void rates(const sunrealtype *y, sunrealtype *r)
{
  r[1] = k[1] * y[0];
  r[2] = k[2] * y[1] * y[3];
  r[3] = k[3] * y[4] * y[1];
  r[4] = k[4] * y[6];
  r[5] = k[5] * y[6];
  r[6] = k[6] * y[6] * y[5];
  r[7] = k[7] * y[8];
  r[8] = k[8] * y[8] * y[5];
  r[9] = k[9] * y[10] * y[1];
  r[10] = k[10] * y[10] * y[0];
  r[11] = k[11] * y[12];
  r[12] = k[12] * y[9] * y[1];
  r[13] = k[13] * y[13];
  r[14] = k[14] * y[0] * y[5];
  r[15] = k[15] * y[2];
  r[16] = k[16] * y[3];
  r[17] = k[17] * y[3];
  r[18] = k[18] * y[15];
  r[19] = k[19] * y[15];
  r[20] = k[20] * y[16] * y[5];
  r[21] = k[21] * y[18];
  r[22] = k[22] * y[18];
  r[23] = k[23] * y[0] * y[3];
  r[24] = k[24] * y[18] * y[0];
  r[25] = k[25] * y[19];
}

static int f(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  sunrealtype r[26], *d = NV_DATA_S(ydot);
  (void)t, (void)user;
  rates(NV_DATA_S(y), r);
  d[0] =
    r[2] + r[3] + r[9] + r[11] + r[12] + r[22] + r[25] - r[1] - r[10] - r[14] - r[23] - r[24];
  d[1] = r[1] + r[21] - r[2] - r[3] - r[9] - r[12];
  d[2] = r[1] + r[17] + r[19] + r[22] - r[15];
  d[3] = r[15] - r[2] - r[16] - r[17] - r[23];
  d[4] = 2 * r[4] + r[6] + r[7] + r[13] + r[20] - r[3];
  d[5] = r[3] + 2 * r[18] - r[6] - r[8] - r[14] - r[20];
  d[6] = r[13] - r[4] - r[5] - r[6];
  d[7] = r[4] + r[5] + r[6] + r[7];
  d[8] = -r[7] - r[8];
  d[9] = r[7] + r[9] - r[12];
  d[10] = r[8] + r[11] - r[9] - r[10];
  d[11] = r[9];
  d[12] = r[10] - r[11];
  d[13] = r[12] - r[13];
  d[14] = r[14];
  d[15] = r[16] - r[18] - r[19];
  d[16] = -r[20];
  d[17] = r[20];
  d[18] = r[23] + r[25] - r[21] - r[22] - r[24];
  d[19] = r[24] - r[25];
  return 0;
}

/* Columns of the Jacobian from the derivatives of the rates: a reaction that consumes y_j
 * enters column j with its stoichiometric column times dr/dy_j. */
static void nitrogen(SUNMatrix J, const sunrealtype *y)
{
  const sunrealtype p10 = k[10] * y[10], p14 = k[14] * y[5], p23 = k[23] * y[3],
                    p24 = k[24] * y[18], p2 = k[2] * y[3], p3 = k[3] * y[4], p9 = k[9] * y[10],
                    p12 = k[12] * y[9];
  sunrealtype *c = SM_COLUMN_D(J, 0);
  c[0] = -k[1] - p10 - p14 - p23 - p24;
  c[1] = c[2] = k[1];
  c[3] = -p23;
  c[5] = -p14;
  c[10] = -p10;
  c[12] = p10;
  c[14] = p14;
  c[18] = p23 - p24;
  c[19] = p24;

  c = SM_COLUMN_D(J, 1);
  c[0] = p2 + p3 + p9 + p12;
  c[1] = -c[0];
  c[3] = -p2;
  c[4] = -p3;
  c[5] = p3;
  c[9] = p9 - p12;
  c[10] = -p9;
  c[11] = p9;
  c[13] = p12;
}

static void oxygen(SUNMatrix J, const sunrealtype *y)
{
  const sunrealtype q2 = k[2] * y[1], q3 = k[3] * y[1], q23 = k[23] * y[0];
  sunrealtype *c = SM_COLUMN_D(J, 2);
  c[2] = -k[15];
  c[3] = k[15];

  c = SM_COLUMN_D(J, 3);
  c[0] = q2 - q23;
  c[1] = -q2;
  c[2] = k[17];
  c[3] = -q2 - k[16] - k[17] - q23;
  c[15] = k[16];
  c[18] = q23;

  c = SM_COLUMN_D(J, 4);
  c[0] = c[5] = q3;
  c[1] = c[4] = -q3;

  c = SM_COLUMN_D(J, 15);
  c[2] = k[19];
  c[5] = 2 * k[18];
  c[15] = -k[18] - k[19];
}

static void radicals(SUNMatrix J, const sunrealtype *y)
{
  const sunrealtype p6 = k[6] * y[6], q6 = k[6] * y[5], p8 = k[8] * y[8], q8 = k[8] * y[5],
                    q14 = k[14] * y[0], p20 = k[20] * y[16], q20 = k[20] * y[5];
  sunrealtype *c = SM_COLUMN_D(J, 5);
  c[0] = -q14;
  c[4] = p6 + p20;
  c[5] = -p6 - p8 - q14 - p20;
  c[6] = -p6;
  c[7] = p6;
  c[8] = -p8;
  c[10] = p8;
  c[14] = q14;
  c[16] = -p20;
  c[17] = p20;

  c = SM_COLUMN_D(J, 6);
  c[4] = 2 * k[4] + q6;
  c[5] = -q6;
  c[6] = -k[4] - k[5] - q6;
  c[7] = k[4] + k[5] + q6;

  c = SM_COLUMN_D(J, 8);
  c[4] = c[7] = c[9] = k[7];
  c[5] = -q8;
  c[8] = -k[7] - q8;
  c[10] = q8;

  c = SM_COLUMN_D(J, 16);
  c[4] = c[17] = q20;
  c[5] = c[16] = -q20;
}

static void products(SUNMatrix J, const sunrealtype *y)
{
  const sunrealtype q9 = k[9] * y[1], q10 = k[10] * y[0], q12 = k[12] * y[1],
                    q24 = k[24] * y[0];
  sunrealtype *c = SM_COLUMN_D(J, 9);
  c[0] = c[13] = q12;
  c[1] = c[9] = -q12;

  c = SM_COLUMN_D(J, 10);
  c[0] = q9 - q10;
  c[1] = -q9;
  c[9] = c[11] = q9;
  c[10] = -q9 - q10;
  c[12] = q10;

  c = SM_COLUMN_D(J, 12);
  c[0] = c[10] = k[11];
  c[12] = -k[11];

  c = SM_COLUMN_D(J, 13);
  c[4] = c[6] = k[13];
  c[13] = -k[13];

  c = SM_COLUMN_D(J, 18);
  c[0] = k[22] - q24;
  c[1] = k[21];
  c[2] = k[22];
  c[18] = -k[21] - k[22] - q24;
  c[19] = q24;

  c = SM_COLUMN_D(J, 19);
  c[0] = c[18] = k[25];
  c[19] = -k[25];
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector tmp1,
               N_Vector tmp2, N_Vector tmp3)
{
  const sunrealtype *u = NV_DATA_S(y);
  (void)t, (void)fy, (void)user, (void)tmp1, (void)tmp2, (void)tmp3;
  nitrogen(J, u);
  oxygen(J, u);
  radicals(J, u);
  products(J, u);
  return 0;
}

static const sunrealtype y0[] = {0, 0.2, 0, 0.04, 0, 0, 0.1,   0.3, 0.01, 0,
                                 0, 0,   0, 0,    0, 0, 0.007, 0,   0,    0};
static const sunrealtype end[] = {
  0.056462554800227688,   0.13424841304223389,    4.1397343310994266e-09,
  0.0055231402074843589,  2.018977262302196e-07,  1.464541863493966e-07,
  0.077842491189979643,   0.3245075353396018,     0.0074940133838804057,
  1.6222931573015609e-08, 1.1358638332570749e-08, 0.002230505975721359,
  0.00020871628827986299, 1.396921016840158e-05,  0.0089648848568982947,
  4.352846369330103e-18,  0.0068992196962634053,  0.0001007803037365946,
  1.772146513969984e-06,  5.6829432923163919e-05};
static const steif_reference reference = {
  .t = 60, .value = end, .digits = 11, .source = IVP_TEST_SET "pollu"};

const steif_problem steif_problem_pollu = {
  .name = "pollu",
  .about = "Chemistry of air pollution, 25 reactions of 20 species. J. G. Verwer (1994); "
           "IVP Test Set II-2.",
  .n = 20,
  .t1 = 60,
  .y0 = y0,
  .f = f,
  .jac = jac,
  .autonomous = 1,
  .reference = &reference,
};
