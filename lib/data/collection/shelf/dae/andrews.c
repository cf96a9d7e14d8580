/* andrews.c: Andrews' squeezing mechanism, seven rigid bodies that move in a plane without
 * friction under a motor and a spring. Angles q = (beta, Theta, gamma, Phi, delta, Omega,
 * epsilon), velocities v, accelerations w and six multipliers, index 3:
 *
 *   q' = v,  v' = w,  0 = M(q) w + G(q)^T lambda - F(q, v),  0 = g(q),  G = dg/dq
 *
 * W. Schiehlen (ed.), Multibody Systems Handbook, Springer (1990); Hairer and Wanner
 * (1996), VII.7; IVP Test Set.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "published.h"
#include <math.h>
#include <string.h>

enum { BETA, THETA, GAMMA, PHI, DELTA, OMEGA, EPSILON, ANGLES, JOINTS = 6 };
enum { V = ANGLES, W = 2 * ANGLES, L = 3 * ANGLES, SIZE = 3 * ANGLES + JOINTS };

static const sunrealtype M1 = 0.04325, M2 = 0.00365, M3 = 0.02373, M4 = 0.00706, M5 = 0.07050,
                         M6 = 0.00706, M7 = 0.05498;
static const sunrealtype I1 = 2.194e-6, I2 = 4.410e-7, I3 = 5.255e-6, I4 = 5.667e-7,
                         I5 = 1.169e-5, I6 = 5.667e-7, I7 = 1.912e-5;
#define XA (-0.06934)
#define YA (-0.00227)
#define XB (-0.03635)
#define YB 0.03273
static const sunrealtype XC = 0.014, YC = 0.072, SPRING = 4530, LENGTH = 0.07785, MOTOR = 0.033;
#define D 0.028
#define RR 0.007
#define SS 0.035
#define E_ 0.02
#define U 0.04
#define ZF 0.02
#define ZT 0.04
static const sunrealtype DA = 0.0115, EA = 0.01421, RA = 0.00092, SA = 0.01874, SB = 0.01043,
                         SC = 0.018, SD = 0.02, TA = 0.02308, TB = 0.00916, UA = 0.01228,
                         UB = 0.00449, FA = 0.01421;

/* g_l = sum amplitude cos(sum of angles - quarter pi/2) - place_l. */
typedef struct rod {
  int joint;
  sunrealtype amplitude;
  int quarter;       /* 0: cosine, 1: sine */
  int angle, second; /* second: another angle, or -1 */
} rod;
static const rod rods[] = {
  {0, RR, 0, BETA, -1},    {0, -D, 0, BETA, THETA},     {0, -SS, 1, GAMMA, -1},
  {1, RR, 1, BETA, -1},    {1, -D, 1, BETA, THETA},     {1, SS, 0, GAMMA, -1},
  {2, RR, 0, BETA, -1},    {2, -D, 0, BETA, THETA},     {2, -E_, 1, PHI, DELTA},
  {2, -ZT, 0, DELTA, -1},  {3, RR, 1, BETA, -1},        {3, -D, 1, BETA, THETA},
  {3, E_, 0, PHI, DELTA},  {3, -ZT, 1, DELTA, -1},      {4, RR, 0, BETA, -1},
  {4, -D, 0, BETA, THETA}, {4, -ZF, 0, OMEGA, EPSILON}, {4, -U, 1, EPSILON, -1},
  {5, RR, 1, BETA, -1},    {5, -D, 1, BETA, THETA},     {5, -ZF, 1, OMEGA, EPSILON},
  {5, U, 0, EPSILON, -1}};
enum { RODS = sizeof rods / sizeof *rods };
static const sunrealtype place[] = {XB, YB, XA, YA, XA, YA};

/* Derivative of order 0, 1 or 2 of rod r by its angle(s). */
static sunrealtype swing(const rod *r, const sunrealtype *q, int order)
{
  const sunrealtype x = q[r->angle] + (r->second >= 0 ? q[r->second] : 0);
  const sunrealtype wave[] = {cos(x), -sin(x), -cos(x), sin(x)};
  return r->amplitude * wave[(order + 3 * r->quarter) % 4];
}

static void joints(const sunrealtype *q, sunrealtype *g, sunrealtype G[JOINTS][ANGLES])
{
  memset(G, 0, JOINTS * sizeof *G);
  for (int l = 0; l < JOINTS; l++) g[l] = -place[l];
  for (const rod *r = rods; r < rods + RODS; r++) {
    const sunrealtype slope = swing(r, q, 1);
    g[r->joint] += swing(r, q, 0);
    G[r->joint][r->angle] += slope;
    if (r->second >= 0) G[r->joint][r->second] += slope;
  }
}

/* H += lambda^T d^2 g/dq^2. */
static void curvature(const sunrealtype *q, const sunrealtype *lambda,
                      sunrealtype H[ANGLES][ANGLES])
{
  for (const rod *r = rods; r < rods + RODS; r++) {
    const sunrealtype bend = lambda[r->joint] * swing(r, q, 2);
    H[r->angle][r->angle] += bend;
    if (r->second < 0) continue;
    H[r->second][r->second] += bend;
    H[r->angle][r->second] += bend;
    H[r->second][r->angle] += bend;
  }
}

/* Couplings of inertia: of bodies 1-2, 4-5 and 6-7. */
static sunrealtype arm2(void) { return M2 * DA * RR; }
static sunrealtype arm4(void) { return M4 * ZT * (E_ - EA); }
static sunrealtype arm6(void) { return M6 * U * (ZF - FA); }

static void inertia(const sunrealtype *q, sunrealtype M[ANGLES][ANGLES])
{
  const sunrealtype co = arm2() * cos(q[THETA]), si4 = arm4() * sin(q[PHI]);
  const sunrealtype si6 = arm6() * sin(q[OMEGA]), e = M4 * (E_ - EA) * (E_ - EA),
                    z = M6 * (ZF - FA) * (ZF - FA);
  memset(M, 0, ANGLES * sizeof *M);
  M[0][0] = M1 * RA * RA + M2 * (RR * RR + DA * DA) - 2 * co + I1 + I2;
  M[0][1] = M[1][0] = M2 * DA * DA - co + I2;
  M[1][1] = M2 * DA * DA + I2;
  M[2][2] = M3 * (SA * SA + SB * SB) + I3;
  M[3][3] = e + I4;
  M[3][4] = M[4][3] = e + si4 + I4;
  M[4][4] = M4 * ZT * ZT + 2 * si4 + e + M5 * (TA * TA + TB * TB) + I4 + I5;
  M[5][5] = z + I6;
  M[5][6] = M[6][5] = z - si6 + I6;
  M[6][6] = z - 2 * si6 + M6 * U * U + M7 * (UA * UA + UB * UB) + I6 + I7;
}

/* Torque of the spring and its derivative by gamma; 1 when it has no length. */
static int spring(sunrealtype gamma, sunrealtype *torque, sunrealtype *slope)
{
  const sunrealtype co = cos(gamma), si = sin(gamma), x1 = SC * co - SD * si,
                    y1 = SD * co + SC * si;
  const sunrealtype a = SD * co + SC * si + XB - XC, b = SD * si - SC * co + YB - YC;
  const sunrealtype length = sqrt(a * a + b * b), s = a * x1 + b * y1;
  if (!(length > 0)) return 1;
  const sunrealtype s1 = x1 * x1 + y1 * y1 - a * (a + XC - XB) - b * (b + YC - YB);
  const sunrealtype pull = -SPRING * (1 - LENGTH / length);
  *torque = pull * s;
  *slope = pull * s1 - SPRING * LENGTH * s * s / (length * length * length);
  return 0;
}

static int forces(const sunrealtype *q, const sunrealtype *v, sunrealtype *F)
{
  const sunrealtype si = arm2() * sin(q[THETA]), co4 = arm4() * cos(q[PHI]),
                    co6 = arm6() * cos(q[OMEGA]);
  sunrealtype slope;
  F[0] = MOTOR - si * v[THETA] * (v[THETA] + 2 * v[BETA]);
  F[1] = si * v[BETA] * v[BETA];
  F[3] = co4 * v[DELTA] * v[DELTA];
  F[4] = -co4 * v[PHI] * (v[PHI] + 2 * v[DELTA]);
  F[5] = -co6 * v[EPSILON] * v[EPSILON];
  F[6] = co6 * v[OMEGA] * (v[OMEGA] + 2 * v[EPSILON]);
  return spring(q[GAMMA], &F[2], &slope);
}

static int f(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const sunrealtype *u = NV_DATA_S(y);
  sunrealtype *r = NV_DATA_S(ydot), M[ANGLES][ANGLES], G[JOINTS][ANGLES], F[ANGLES];
  (void)t, (void)user;
  if (forces(u, u + V, F)) return 1;
  inertia(u, M);
  joints(u, r + L, G);
  memcpy(r, u + V, 2 * ANGLES * sizeof *r);
  for (int i = 0; i < ANGLES; i++) {
    r[W + i] = -F[i];
    for (int j = 0; j < ANGLES; j++) r[W + i] += M[i][j] * u[W + j];
    for (int l = 0; l < JOINTS; l++) r[W + i] += G[l][i] * u[L + l];
  }
  return 0;
}

/* d(M w - F)/dq beside what the joints contribute, and -dF/dv. */
static int dynamics(SUNMatrix J, const sunrealtype *q, sunrealtype H[ANGLES][ANGLES])
{
  const sunrealtype *v = q + V, *w = q + W;
  const sunrealtype si2 = arm2() * sin(q[THETA]), co2 = arm2() * cos(q[THETA]);
  const sunrealtype si4 = arm4() * sin(q[PHI]), co4 = arm4() * cos(q[PHI]);
  const sunrealtype si6 = arm6() * sin(q[OMEGA]), co6 = arm6() * cos(q[OMEGA]);
  sunrealtype torque, slope;
  if (spring(q[GAMMA], &torque, &slope)) return 1;
  H[0][THETA] += si2 * (2 * w[0] + w[1]) + co2 * v[THETA] * (v[THETA] + 2 * v[BETA]);
  H[1][THETA] += si2 * w[0] - co2 * v[BETA] * v[BETA];
  H[2][GAMMA] -= slope;
  H[3][PHI] += co4 * w[4] + si4 * v[DELTA] * v[DELTA];
  H[4][PHI] += co4 * (w[3] + 2 * w[4]) - si4 * v[PHI] * (v[PHI] + 2 * v[DELTA]);
  H[5][OMEGA] += -co6 * w[6] - si6 * v[EPSILON] * v[EPSILON];
  H[6][OMEGA] += -co6 * (w[5] + 2 * w[6]) + si6 * v[OMEGA] * (v[OMEGA] + 2 * v[EPSILON]);
  SM_ELEMENT_D(J, W, V + BETA) = 2 * si2 * v[THETA];
  SM_ELEMENT_D(J, W, V + THETA) = 2 * si2 * (v[THETA] + v[BETA]);
  SM_ELEMENT_D(J, W + 1, V + BETA) = -2 * si2 * v[BETA];
  SM_ELEMENT_D(J, W + 3, V + DELTA) = -2 * co4 * v[DELTA];
  SM_ELEMENT_D(J, W + 4, V + PHI) = 2 * co4 * (v[PHI] + v[DELTA]);
  SM_ELEMENT_D(J, W + 4, V + DELTA) = 2 * co4 * v[PHI];
  SM_ELEMENT_D(J, W + 5, V + EPSILON) = 2 * co6 * v[EPSILON];
  SM_ELEMENT_D(J, W + 6, V + OMEGA) = -2 * co6 * (v[OMEGA] + v[EPSILON]);
  SM_ELEMENT_D(J, W + 6, V + EPSILON) = -2 * co6 * v[OMEGA];
  return 0;
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector tmp1,
               N_Vector tmp2, N_Vector tmp3)
{
  const sunrealtype *u = NV_DATA_S(y);
  sunrealtype M[ANGLES][ANGLES], G[JOINTS][ANGLES], H[ANGLES][ANGLES] = {{0}}, g[JOINTS];
  (void)t, (void)fy, (void)user, (void)tmp1, (void)tmp2, (void)tmp3;
  if (dynamics(J, u, H)) return 1;
  inertia(u, M);
  joints(u, g, G);
  curvature(u, u + L, H);
  for (int i = 0; i < 2 * ANGLES; i++) SM_ELEMENT_D(J, i, V + i) = 1;
  for (int i = 0; i < ANGLES; i++) {
    for (int j = 0; j < ANGLES; j++) {
      SM_ELEMENT_D(J, W + i, j) = H[i][j];
      SM_ELEMENT_D(J, W + i, W + j) = M[i][j];
    }
    for (int l = 0; l < JOINTS; l++)
      SM_ELEMENT_D(J, W + i, L + l) = SM_ELEMENT_D(J, L + l, i) = G[l][i];
  }
  return 0;
}

static int mass(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  for (int i = 0; i < W; i++) SM_ELEMENT_D(E, i, i) = 1;
  return 0;
}

/* Start of the test set; slopes of w and lambda are not part of it. */
static const sunrealtype y0[SIZE] = {-0.0617138900142764358,
                                     0,
                                     0.455279819163070380,
                                     0.222668390165885885,
                                     0.487364979543842550,
                                     -0.222668390165885885,
                                     1.23054744454982119,
                                     0,
                                     0,
                                     0,
                                     0,
                                     0,
                                     0,
                                     0,
                                     14222.4439199541139,
                                     -10666.8329399655854,
                                     0,
                                     0,
                                     0,
                                     0,
                                     0,
                                     98.5668703962410896,
                                     -6.12268834425566265};
static const sunrealtype yp0[SIZE] = {[V] = 14222.4439199541139,
                                      [V + 1] = -10666.8329399655854};
static const int index[SIZE] = {1, 1, 1, 1, 1, 1, 1, 2, 2, 2, 2, 2, 2, 2,
                                3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3};
static const sunrealtype end[] = {
  15.81077119629904,   -15.75637105984298,  0.040822240130731012, -0.53473011632269485,
  0.52440996588053035, 0.53473011632269485, 1.048080741042263};
/* Ten digits: the published start is not quite consistent, and beta ends at 15.8107711951 from it as it is and at
 * 15.8107711965 from the repaired one, by radau:s=4 and radau:s=5 alike. */
static const steif_reference reference = {
  .t = 0.03, .count = ANGLES, .value = end, .digits = 10, .source = IVP_TEST_SET "andrews"};

const steif_problem steif_problem_andrews = {
  .name = "andrews",
  .about =
    "Andrews' squeezing mechanism, seven bodies, index 3. W. Schiehlen (1990); IVP Test Set "
    "II-8.",
  .n = SIZE,
  .t1 = 0.03,
  .y0 = y0,
  .yp0 = yp0,
  .f = f,
  .jac = jac,
  .E = mass,
  .index = index,
  .dae_index = 3,
  .autonomous = 1,
  .reference = &reference,
};
