/* plei.c: the Pleiades, seven stars of masses 1 .. 7 in a plane under gravitation; not stiff,
 * with close encounters. Unknowns x, y, x', y'.
 *
 *   x_i'' = sum_j j (x_j - x_i)/r_ij^3,  y_i'' = sum_j j (y_j - y_i)/r_ij^3
 *
 * E. Hairer, S. P. Norsett, G. Wanner, Solving Ordinary Differential Equations I, section II.10.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "published.h"
#include <math.h>

enum { N = 7 };

static int kick(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const sunrealtype *x = NV_DATA_S(y), *z = x + N;
  sunrealtype *ax = NV_DATA_S(ydot) + 2 * N, *az = ax + N;
  (void)t, (void)user;
  for (int i = 0; i < 2 * N; i++) ax[i] = 0;
  for (int i = 0; i < N; i++)
    for (int j = 0; j < i; j++) {
      const sunrealtype dx = x[j] - x[i], dz = z[j] - z[i], r2 = dx * dx + dz * dz;
      if (!(r2 > 0)) return 1;
      const sunrealtype w = 1 / (r2 * sqrt(r2));
      ax[i] += (j + 1) * w * dx;
      az[i] += (j + 1) * w * dz;
      ax[j] -= (i + 1) * w * dx;
      az[j] -= (i + 1) * w * dz;
    }
  return 0;
}

static int f(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  for (int i = 0; i < 2 * N; i++) NV_DATA_S(ydot)[i] = NV_DATA_S(y)[2 * N + i];
  return kick(t, y, ydot, user);
}

/* Add m times the tidal tensor T = d(acceleration of star i)/d(position of star j). */
static void tide(SUNMatrix J, int i, int j, sunrealtype m, const sunrealtype T[3])
{
  SM_ELEMENT_D(J, 2 * N + i, j) += m * T[0];
  SM_ELEMENT_D(J, 2 * N + i, N + j) += m * T[1];
  SM_ELEMENT_D(J, 3 * N + i, j) += m * T[1];
  SM_ELEMENT_D(J, 3 * N + i, N + j) += m * T[2];
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector tmp1,
               N_Vector tmp2, N_Vector tmp3)
{
  const sunrealtype *x = NV_DATA_S(y), *z = x + N;
  (void)t, (void)fy, (void)user, (void)tmp1, (void)tmp2, (void)tmp3;
  for (int i = 0; i < 2 * N; i++) SM_ELEMENT_D(J, i, 2 * N + i) = 1;
  for (int i = 0; i < N; i++)
    for (int j = 0; j < i; j++) {
      const sunrealtype dx = x[j] - x[i], dz = z[j] - z[i], r2 = dx * dx + dz * dz;
      if (!(r2 > 0)) return 1;
      const sunrealtype w = 1 / (r2 * sqrt(r2)), s = 3 * w / r2;
      const sunrealtype T[3] = {w - s * dx * dx, -s * dx * dz, w - s * dz * dz};
      tide(J, i, j, j + 1, T);
      tide(J, i, i, -(j + 1), T);
      tide(J, j, i, i + 1, T);
      tide(J, j, j, -(i + 1), T);
    }
  return 0;
}

/* Energy, both momenta and angular momentum. */
static int invariant(sunrealtype t, N_Vector y, sunrealtype *value, void *user)
{
  const sunrealtype *x = NV_DATA_S(y), *z = x + N, *u = z + N, *v = u + N;
  (void)t, (void)user;
  value[0] = value[1] = value[2] = value[3] = 0;
  for (int i = 0; i < N; i++) {
    value[0] += (i + 1) * (u[i] * u[i] + v[i] * v[i]) / 2;
    value[1] += (i + 1) * u[i];
    value[2] += (i + 1) * v[i];
    value[3] += (i + 1) * (x[i] * v[i] - z[i] * u[i]);
    for (int j = 0; j < i; j++) value[0] -= (i + 1) * (j + 1) / hypot(x[i] - x[j], z[i] - z[j]);
  }
  return 0;
}

static const sunrealtype y0[] = {3, 3,  -1, -3,    2, -2,   2,    /* x */
                                 3, -3, 2,  0,     0, -4,   4,    /* y */
                                 0, 0,  0,  0,     0, 1.75, -1.5, /* x' */
                                 0, 0,  0,  -1.25, 1, 0,    0};   /* y' */
static const sunrealtype end[] = {
  0.37061391439705021, 3.2372840920572332,   -3.222559032418324,   0.65970914557753102,
  0.34255817071565842, 1.5621721014006309,   -0.70030929222124949, -3.9434375855173922,
  -3.2713809739725499, 5.2250818434565431,   -2.5906124349774702,  1.1982136933922749,
  -0.2429682344935824, 1.0914492404289799,   3.4170038063143129,   1.3545845016255009,
  -2.5900655978107752, 2.0250537347142421,   -1.155815100160448,   -0.80729881702230211,
  0.59523963542087099, -3.7412449612340102,  0.37734596857506297,  0.93868588695510735,
  0.36679222272005713, -0.34740463538084898, 2.3449154481809371,   -1.947020434263292};
static const steif_reference reference = {
  .t = 3, .value = end, .digits = 10, .source = IVP_TEST_SET "plei"};

const steif_problem steif_problem_plei = {
  .name = "plei",
  .about = "Pleiades, seven stars in a plane, not stiff. E. Hairer, S. P. Norsett, G. Wanner, "
           "Solving Ordinary Differential Equations I, II.10; IVP Test Set II-13.",
  .n = 4 * N,
  .t1 = 3,
  .y0 = y0,
  .f = f,
  .jac = jac,
  .autonomous = 1,
  .reference = &reference,
  .invariants = 4,
  .invariant = invariant,
  .positions = 2 * N,
  .kick = kick,
  .unit_mass = 1,
};
