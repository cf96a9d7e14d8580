/* fekete.c: elliptic Fekete points: 20 bodies on the unit sphere that repel each other
 * with the force d/|d|^2 and are damped come to rest where the product of their distances
 * is largest. Positions p, velocities q, multipliers lambda of the sphere and mu of its
 * tangent (stabilised, index 2):
 *
 *   p_i' = q_i + 2 mu_i p_i,  q_i' = -q_i/2 + 2 lambda_i p_i + sum_j (p_i - p_j)/|p_i - p_j|^2,
 *   0 = |p_i|^2 - 1,  0 = 2 p_i . q_i
 *
 * W. J. H. Stortelder, J. J. B. de Swart, J. D. Pinter, J. Comput. Appl. Math. 130 (2001);
 * IVP Test Set.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "published.h"
#include <math.h>

enum { BODIES = 20, Q = 3 * BODIES, LAMBDA = 6 * BODIES, MU = 7 * BODIES, SIZE = 8 * BODIES };
static const sunrealtype DAMPING = 0.5;

typedef struct sphere {
  sunrealtype y0[SIZE], yp0[SIZE];
  int index[SIZE];
} sphere;

/* d = p_i - p_j and |d|^2. */
static sunrealtype apart(const sunrealtype *p, int i, int j, sunrealtype *d)
{
  for (int k = 0; k < 3; k++) d[k] = p[3 * i + k] - p[3 * j + k];
  return d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
}

static sunrealtype dot(const sunrealtype *x, const sunrealtype *y)
{
  return x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
}

/* Sum of the forces on body i; 1 where two bodies meet. */
static int push(const sunrealtype *p, int i, sunrealtype *force)
{
  sunrealtype d[3];
  force[0] = force[1] = force[2] = 0;
  for (int j = 0; j < BODIES; j++) {
    if (j == i) continue;
    const sunrealtype square = apart(p, i, j, d);
    if (!(square > 0)) return 1;
    for (int k = 0; k < 3; k++) force[k] += d[k] / square;
  }
  return 0;
}

static int f(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const sunrealtype *u = NV_DATA_S(y);
  sunrealtype *r = NV_DATA_S(ydot), force[3];
  (void)t, (void)user;
  for (int i = 0; i < BODIES; i++) {
    const sunrealtype *p = u + 3 * i, *q = u + Q + 3 * i;
    if (push(u, i, force)) return 1;
    for (int k = 0; k < 3; k++) {
      r[3 * i + k] = q[k] + 2 * u[MU + i] * p[k];
      r[Q + 3 * i + k] = -DAMPING * q[k] + 2 * u[LAMBDA + i] * p[k] + force[k];
    }
    r[LAMBDA + i] = dot(p, p) - 1;
    r[MU + i] = 2 * dot(p, q);
  }
  return 0;
}

/* Derivative of the force between bodies i and j: I/|d|^2 - 2 d d^T/|d|^4. */
static int couple(SUNMatrix J, const sunrealtype *p, int i, int j)
{
  sunrealtype d[3];
  const sunrealtype square = apart(p, i, j, d);
  if (!(square > 0)) return 1;
  for (int k = 0; k < 3; k++)
    for (int l = 0; l < 3; l++) {
      const sunrealtype x = ((k == l) - 2 * d[k] * d[l] / square) / square;
      SM_ELEMENT_D(J, Q + 3 * i + k, 3 * i + l) += x;
      SM_ELEMENT_D(J, Q + 3 * i + k, 3 * j + l) = -x;
    }
  return 0;
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector tmp1,
               N_Vector tmp2, N_Vector tmp3)
{
  const sunrealtype *u = NV_DATA_S(y);
  (void)t, (void)fy, (void)user, (void)tmp1, (void)tmp2, (void)tmp3;
  for (int i = 0; i < BODIES; i++) {
    for (int k = 0; k < 3; k++) {
      const int p = 3 * i + k, q = Q + p;
      SM_ELEMENT_D(J, p, p) = 2 * u[MU + i];
      SM_ELEMENT_D(J, p, q) = 1;
      SM_ELEMENT_D(J, p, MU + i) = SM_ELEMENT_D(J, q, LAMBDA + i) = 2 * u[p];
      SM_ELEMENT_D(J, q, p) = 2 * u[LAMBDA + i];
      SM_ELEMENT_D(J, q, q) = -DAMPING;
      SM_ELEMENT_D(J, LAMBDA + i, p) = SM_ELEMENT_D(J, MU + i, q) = 2 * u[p];
      SM_ELEMENT_D(J, MU + i, p) = 2 * u[q];
    }
  }
  for (int i = 0; i < BODIES; i++)
    for (int j = 0; j < BODIES; j++)
      if (i != j && couple(J, u, i, j)) return 1;
  return 0;
}

static int mass(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  for (int i = 0; i < LAMBDA; i++) SM_ELEMENT_D(E, i, i) = 1;
  return 0;
}

/* `count` bodies from number `first` on evenly on a circle of latitude. */
static void ring(sunrealtype *p, int first, int count, sunrealtype turn, sunrealtype latitude)
{
  const sunrealtype pi = 3.14159265358979323846;
  for (int i = 0; i < count; i++) {
    const sunrealtype angle = 2 * pi * (first == 16 ? i : i + 1) / count + pi * turn;
    p[3 * (first + i)] = cos(angle) * cos(pi * latitude);
    p[3 * (first + i) + 1] = sin(angle) * cos(pi * latitude);
    p[3 * (first + i) + 2] = sin(pi * latitude);
  }
}

/* At rest mu_i = 0 and, since p_i . (p_i - p_j)/|p_i - p_j|^2 = 1/2 on the sphere,
 * lambda_i = -(BODIES - 1)/4; only the velocities begin to change. */
static int build(steif_context *ctx, const steif_spec *spec, steif_problem *self)
{
  STEIF_TRY(stf_spec_only(ctx, spec, (const char *const[]){NULL}));
  sphere *s = stf_collection_allocate(ctx, self, sizeof *s, 0);
  if (!s) return STEIF_NO_MEMORY;
  ring(s->y0, 0, 3, 1.0 / 13, 3.0 / 8);
  ring(s->y0, 3, 7, 1.0 / 29, 1.0 / 8);
  ring(s->y0, 10, 6, 1.0 / 7, -2.0 / 15);
  ring(s->y0, 16, 4, 1.0 / 17, -3.0 / 10);
  for (int i = 0; i < BODIES; i++) {
    s->y0[LAMBDA + i] = -(BODIES - 1) / 4.0;
    push(s->y0, i, s->yp0 + Q + 3 * i);
    for (int k = 0; k < 3; k++)
      s->yp0[Q + 3 * i + k] += 2 * s->y0[LAMBDA + i] * s->y0[3 * i + k];
  }
  for (int i = 0; i < SIZE; i++) s->index[i] = i < LAMBDA ? 1 : 2;
  self->y0 = s->y0;
  self->yp0 = s->yp0;
  self->index = s->index;
  return STEIF_OK;
}

/* Positions of the first steady state, at t = 1000. */
static const sunrealtype end[] = {
  -0.40702633803332022, 0.34637587727918018,   0.84519424500304285,  0.077529347525215495,
  -0.26286627199722989, 0.96171228718291457,   0.71005778333435665,  0.121294805558612,
  0.69361770051722171,  0.23482677445576269,   0.74492779769233108,  0.62445092859563911,
  -0.43411147387828852, 0.87854304422628759,   0.199272044423766,    -0.95150596003125965,
  0.22035087627870051,  0.21466694982740081,   -0.63851916436098777, -0.43108332593906878,
  0.63754250277221214,  -0.14641750879143359,  -0.93808716352288624, 0.31393372987446899,
  0.56669740650699418,  -0.67392218850765417,  0.47400731354621561,  0.98432595384402932,
  -0.16969953578199959, -0.048005042906090901, 0.14641750879143309,  0.93808716352288746,
  -0.31393372987446561, -0.70927575499790141,  0.5264062637139616,   -0.46885429388549288,
  -0.86657318192844779, -0.48138780597560238,  -0.13159293529821781, -0.23478977787005381,
  -0.85943404080131303, -0.45414412879575788,  0.55309769400741182,  -0.76743702656151236,
  -0.3242273140037833,  0.77110509698969265,   0.63570418165770337,  0.035736855197770007,
  0.71039512093795909,  0.24035704312805189,   -0.66148867259105959, -0.0303820873873566,
  0.45019232936404607,  -0.89241458714420463,  -0.57729961581070932, -0.17667634149718131,
  -0.79718920209695443, 0.24144817669690391,   -0.34164568183731348, -0.90828465034462502};
static const steif_reference reference = {
  .t = 1000, .count = 3 * BODIES, .value = end, .digits = 11, .source = IVP_TEST_SET "fekete"};

const steif_problem steif_problem_fekete = {
  .about =
    "Elliptic Fekete points: 20 bodies on the sphere, stabilised index 2. Stortelder, de "
    "Swart and Pinter (2001); IVP Test Set II-13.",
  .n = SIZE,
  .t1 = 1000,
  .f = f,
  .jac = jac,
  .E = mass,
  .dae_index = 2,
  .autonomous = 1,
  .reference = &reference,
  .build = build,
  .destroy = stf_collection_release,
};
