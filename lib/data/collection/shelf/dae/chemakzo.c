/* chemakzo.c: the chemical Akzo Nobel problem: carbon dioxide bubbles through a mixture of two
 * species; five kinetic equations and one equilibrium, M y' = f(y), M = diag(1,1,1,1,1,0),
 * index 1.
 *
 *   y1' = -2 r1 + r2 - r3 - r4,  y2' = -r1/2 - r4 - r5/2 + F,  y3' = r1 - r2 + r3,
 *   y4' = -r2 + r3 - 2 r4,  y5' = r2 - r3 + r5,  0 = Ks y1 y4 - y6,
 *   r1 = k1 y1^4 sqrt(y2), r2 = k2 y3 y4, r3 = k2/K y1 y5, r4 = k3 y1 y4^2, r5 = k4 y6^2 sqrt(y2),
 *   F = klA (pCO2/H - y2)
 *
 * with the parameters k1, k2, k3, k4, K, klA, Ks, pCO2, H, of which the start depends on Ks by y6.
 *
 * W. J. H. Stortelder, Parameter estimation in dynamic systems, CWI (1998); IVP Test Set.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "published.h"
#include <math.h>
#include <steif/parameters.h>
#include <string.h>

enum { UNKNOWNS = 6, PARAMETERS = 9 };
static const char *const names[] = {"k1", "k2", "k3", "k4", "K", "klA", "Ks", "pCO2", "H"};
static const sunrealtype values[] = {18.7, 0.58, 0.09, 0.42, 34.4, 3.3, 115.83, 0.9, 737};

struct mixture {
  sunrealtype p[PARAMETERS], y0[UNKNOWNS];
  steif_parameters parameters;
};

/* Names for the values. */
struct rates {
  sunrealtype k1, k2, k3, k4, K, klA, Ks, pCO2, H;
};

static struct rates rates_of(const void *user)
{
  const sunrealtype *p = user ? ((const struct mixture *)user)->p : values;
  return (struct rates){p[0], p[1], p[2], p[3], p[4], p[5], p[6], p[7], p[8]};
}

static int f(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const sunrealtype *u = NV_DATA_S(y);
  sunrealtype *d = NV_DATA_S(ydot);
  const struct rates k = rates_of(user);
  (void)t;
  if (!(u[1] >= 0)) return 1;
  const sunrealtype root = sqrt(u[1]), square = u[0] * u[0];
  const sunrealtype r1 = k.k1 * square * square * root, r2 = k.k2 * u[2] * u[3],
                    r3 = k.k2 / k.K * u[0] * u[4], r4 = k.k3 * u[0] * u[3] * u[3],
                    r5 = k.k4 * u[5] * u[5] * root, in = k.klA * (k.pCO2 / k.H - u[1]);
  d[0] = -2 * r1 + r2 - r3 - r4;
  d[1] = -0.5 * r1 - r4 - 0.5 * r5 + in;
  d[2] = r1 - r2 + r3;
  d[3] = -r2 + r3 - 2 * r4;
  d[4] = r2 - r3 + r5;
  d[5] = k.Ks * u[0] * u[3] - u[5];
  return 0;
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector tmp1,
               N_Vector tmp2, N_Vector tmp3)
{
  const sunrealtype *u = NV_DATA_S(y);
  const struct rates k = rates_of(user);
  (void)t, (void)fy, (void)tmp1, (void)tmp2, (void)tmp3;
  if (!(u[1] > 0)) return 1;
  const sunrealtype root = sqrt(u[1]), cube = u[0] * u[0] * u[0];
  const sunrealtype r11 = 4 * k.k1 * cube * root, r12 = k.k1 * cube * u[0] / (2 * root),
                    r23 = k.k2 * u[3], r24 = k.k2 * u[2], r31 = k.k2 / k.K * u[4],
                    r35 = k.k2 / k.K * u[0], r41 = k.k3 * u[3] * u[3],
                    r44 = 2 * k.k3 * u[0] * u[3], r52 = k.k4 * u[5] * u[5] / (2 * root),
                    r56 = 2 * k.k4 * u[5] * root;
  const sunrealtype columns[6][6] = {
    {-2 * r11 - r31 - r41, -0.5 * r11 - r41, r11 + r31, r31 - 2 * r41, -r31, k.Ks * u[3]},
    {-2 * r12, -0.5 * (r12 + r52) - k.klA, r12, 0, r52, 0},
    {r23, 0, -r23, -r23, r23, 0},
    {r24 - r44, -r44, -r24, -r24 - 2 * r44, r24, k.Ks * u[0]},
    {-r35, 0, r35, r35, -r35, 0},
    {0, -0.5 * r56, 0, 0, r56, -1},
  };
  for (sunindextype j = 0; j < 6; j++)
    for (sunindextype i = 0; i < 6; i++) SM_ELEMENT_D(J, i, j) = columns[j][i];
  return 0;
}

static int mass(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  for (sunindextype i = 0; i < 5; i++) SM_ELEMENT_D(E, i, i) = 1;
  return 0;
}

/* y6 = k.Ks y1 y4; slopes of the differential part are f, y6' = k.Ks (y1' y4 + y1 y4'). */
static const sunrealtype y0[] = {0.444, 0.00123, 0, 0.007, 0, 115.83 * 0.444 * 0.007};
static const sunrealtype yp0[] = {-0.05097681765216577,  -0.013729322308134246,
                                  0.025487429806082887,  -3.91608e-6,
                                  0.0019090002227229194, -0.04153391171915414};
/* -df/dp, as coefficients of r1 .. r5, F and the equilibrium. */
static int slope(sunrealtype t, N_Vector y, N_Vector yp, int i, N_Vector out, void *user)
{
  const sunrealtype *u = NV_DATA_S(y);
  const struct rates k = rates_of(user);
  sunrealtype *d = NV_DATA_S(out);
  (void)t, (void)yp;
  if (!(u[1] >= 0)) return 1;
  const sunrealtype root = sqrt(u[1]), square = u[0] * u[0], forth = u[2] * u[3],
                    back = u[0] * u[4];
  const sunrealtype r1 = i == 0 ? square * square * root : 0, r2 = i == 1 ? forth : 0;
  const sunrealtype r3 = i == 1 ? back / k.K : i == 4 ? -k.k2 * back / (k.K * k.K) : 0;
  const sunrealtype r4 = i == 2 ? u[0] * u[3] * u[3] : 0, r5 = i == 3 ? u[5] * u[5] * root : 0;
  const sunrealtype in = i == 5   ? k.pCO2 / k.H - u[1]
                         : i == 7 ? k.klA / k.H
                         : i == 8 ? -k.klA * k.pCO2 / (k.H * k.H)
                                  : 0;
  d[0] = 2 * r1 - r2 + r3 + r4;
  d[1] = 0.5 * r1 + r4 + 0.5 * r5 - in;
  d[2] = -r1 + r2 - r3;
  d[3] = r2 - r3 + 2 * r4;
  d[4] = -r2 + r3 - r5;
  d[5] = i == 6 ? -u[0] * u[3] : 0;
  return 0;
}

static int start_slope(int i, N_Vector S0, void *user)
{
  (void)user;
  N_VConst(0, S0);
  if (i == 6) NV_Ith_S(S0, 5) = y0[0] * y0[3];
  return 0;
}

static int follow(void *user)
{
  struct mixture *m = user;
  m->y0[5] = rates_of(m).Ks * m->y0[0] * m->y0[3];
  return 0;
}

static int build(steif_context *ctx, const steif_spec *spec, steif_problem *self)
{
  STEIF_TRY(stf_spec_only(ctx, spec, (const char *const[]){NULL}));
  struct mixture *m = stf_collection_allocate(ctx, self, sizeof *m, 0);
  if (!m) return STEIF_NO_MEMORY;
  memcpy(m->p, values, sizeof values);
  memcpy(m->y0, y0, sizeof y0);
  m->parameters = (steif_parameters){.count = PARAMETERS,
                                     .value = m->p,
                                     .name = names,
                                     .dFdp = slope,
                                     .start = start_slope,
                                     .moved = follow};
  self->parameters = &m->parameters;
  self->y0 = m->y0;
  return STEIF_OK;
}

static const int index[] = {1, 1, 1, 1, 1, 1};
static const sunrealtype end[] = {0.1150794920661702,   0.001203831471567715,
                                  0.1611562887407974,   0.00036561564212492828,
                                  0.017080108852644039, 0.0048735313103074546};
static const steif_reference reference = {
  .t = 180, .value = end, .digits = 13, .source = IVP_TEST_SET "chemakzo"};

const steif_problem steif_problem_chemakzo = {
  .name = "chemakzo",
  .about = "Chemical Akzo Nobel problem, five kinetic equations and one equilibrium, index 1. "
           "W. J. H. Stortelder (1998); IVP Test Set II-3.",
  .n = 6,
  .t1 = 180,
  .y0 = y0,
  .yp0 = yp0,
  .f = f,
  .jac = jac,
  .E = mass,
  .index = index,
  .dae_index = 1,
  .autonomous = 1,
  .reference = &reference,
  .build = build,
  .destroy = stf_collection_release,
};
