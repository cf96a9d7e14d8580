/* pendulum3.c: the planar pendulum in Cartesian coordinates as an implicit DAE F(t, y, y') = 0.
 *
 *   x' = u - mu x,  y' = v - mu y,  u' = -lambda x,  v' = -lambda y - g,  and
 *   index=3    x^2 + y^2 = L^2                     (mu = 0)
 *   index=2    x u + y v = 0                       (mu = 0)
 *   index=1    u^2 + v^2 - lambda (x^2 + y^2) - g y = 0   (mu = 0)
 *   index=ggl  the first two together, index 2     (Gear, Gupta and Leimkuhler)
 *
 * All have the solution of phi'' = -g/L sin phi, x = L sin phi, y = -L cos phi. Parameters L = 1, g = 9.81 and the
 * start, phi0 = pi/2 - 0.6, that is 0.6 below the horizontal, with omega0 = 0.7.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "collection.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <steif/parameters.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

enum { X, Y, U, V, LAMBDA, MU, UNKNOWNS };
enum { GGL = 4 };
enum { LENGTH, GRAVITY, ANGLE, RATE, PARAMETERS };

typedef struct model {
  int form; /* 1, 2, 3 or GGL */
  sunrealtype p[PARAMETERS], start[UNKNOWNS], slope[UNKNOWNS];
  steif_parameters parameters;
} model;

static const char *const parameter[] = {"L", "g", "phi0", "omega0"};
static const int index3[] = {1, 1, 2, 2, 3}, index2[] = {1, 1, 1, 1, 2, 2};

static int F(sunrealtype t, N_Vector yy, N_Vector yyp, N_Vector rr, void *user)
{
  const model *m = user;
  const int form = m->form;
  const sunrealtype g = m->p[GRAVITY], L = m->p[LENGTH];
  const sunrealtype *z = N_VGetArrayPointer(yy), *zp = N_VGetArrayPointer(yyp);
  const sunrealtype mu = form == GGL ? z[MU] : 0;
  const sunrealtype position = z[X] * z[X] + z[Y] * z[Y], radial = z[X] * z[U] + z[Y] * z[V];
  sunrealtype *r = N_VGetArrayPointer(rr);
  (void)t;
  r[0] = zp[X] - z[U] + mu * z[X];
  r[1] = zp[Y] - z[V] + mu * z[Y];
  r[2] = zp[U] + z[LAMBDA] * z[X];
  r[3] = zp[V] + z[LAMBDA] * z[Y] + g;
  if (form == 1)
    r[4] = z[U] * z[U] + z[V] * z[V] - z[LAMBDA] * position - g * z[Y];
  else
    r[4] = form == 2 ? radial : position - L * L;
  if (form == GGL) r[5] = radial;
  return 0;
}

static void position_row(SUNMatrix J, int row, const sunrealtype *z)
{
  SM_ELEMENT_D(J, row, X) = 2 * z[X];
  SM_ELEMENT_D(J, row, Y) = 2 * z[Y];
}

static void velocity_row(SUNMatrix J, int row, const sunrealtype *z)
{
  SM_ELEMENT_D(J, row, X) = z[U];
  SM_ELEMENT_D(J, row, Y) = z[V];
  SM_ELEMENT_D(J, row, U) = z[X];
  SM_ELEMENT_D(J, row, V) = z[Y];
}

static void acceleration_row(SUNMatrix J, int row, const sunrealtype *z, sunrealtype g)
{
  SM_ELEMENT_D(J, row, X) = -2 * z[LAMBDA] * z[X];
  SM_ELEMENT_D(J, row, Y) = -2 * z[LAMBDA] * z[Y] - g;
  SM_ELEMENT_D(J, row, U) = 2 * z[U];
  SM_ELEMENT_D(J, row, V) = 2 * z[V];
  SM_ELEMENT_D(J, row, LAMBDA) = -(z[X] * z[X] + z[Y] * z[Y]);
}

static int idajac(sunrealtype t, sunrealtype c, N_Vector yy, N_Vector yyp, N_Vector rr,
                  SUNMatrix J, void *user, N_Vector tmp1, N_Vector tmp2, N_Vector tmp3)
{
  const int form = ((const model *)user)->form;
  const sunrealtype *z = N_VGetArrayPointer(yy), mu = form == GGL ? z[MU] : 0;
  (void)t, (void)yyp, (void)rr, (void)tmp1, (void)tmp2, (void)tmp3;
  for (int i = X; i <= Y; i++) {
    SM_ELEMENT_D(J, i, i) = c + mu;
    SM_ELEMENT_D(J, i, i + U) = -1;
    SM_ELEMENT_D(J, i + U, i) = z[LAMBDA];
    SM_ELEMENT_D(J, i + U, i + U) = c;
    SM_ELEMENT_D(J, i + U, LAMBDA) = z[i];
    if (form == GGL) SM_ELEMENT_D(J, i, MU) = z[i];
  }
  if (form == 1) acceleration_row(J, 4, z, ((const model *)user)->p[GRAVITY]);
  if (form == 3 || form == GGL) position_row(J, 4, z);
  if (form == 2 || form == GGL) velocity_row(J, form == GGL ? 5 : 4, z);
  return 0;
}

/* dF/dp of what F has of them: L^2 in the constraint, g. */
static int by_parameter(sunrealtype t, N_Vector y, N_Vector yp, int k, N_Vector out, void *user)
{
  const model *m = user;
  sunrealtype *r = N_VGetArrayPointer(out);
  (void)t, (void)yp;
  N_VConst(0, out);
  if (k == GRAVITY) r[3] = 1;
  if (k == GRAVITY && m->form == 1) r[4] = -N_VGetArrayPointer(y)[Y];
  if (k == LENGTH && (m->form == 3 || m->form == GGL)) r[4] = -2 * m->p[LENGTH];
  return 0;
}

/* (x, y, u, v, lambda, mu) and slopes at phi, phi': lambda' = -3 g v/L^2. */
static void at_angle(const sunrealtype *p, sunrealtype phi, sunrealtype rate, size_t n,
                     sunrealtype *z, sunrealtype *zp)
{
  const sunrealtype g = p[GRAVITY], L = p[LENGTH];
  const sunrealtype x = L * sin(phi), y = -L * cos(phi), lambda = rate * rate - g * y / (L * L);
  const sunrealtype value[] = {x, y, -y * rate, x * rate, lambda, 0};
  const sunrealtype change[] = {
    value[U], value[V], -lambda * x, -lambda * y - g, -3 * g * value[V] / (L * L), 0};
  memcpy(z, value, n * sizeof *z);
  if (zp) memcpy(zp, change, n * sizeof *zp);
}

static int start_slope(int k, N_Vector S0, void *user)
{
  const model *m = user;
  const sunrealtype g = m->p[GRAVITY], L = m->p[LENGTH], rate = m->p[RATE];
  const sunrealtype s = sin(m->p[ANGLE]), c = cos(m->p[ANGLE]);
  const sunrealtype by[PARAMETERS][UNKNOWNS] = {
    {s, -c, rate * c, rate * s, -g * c / (L * L), 0},
    {0, 0, 0, 0, c / L, 0},
    {L * c, L * s, -L * rate * s, L * rate * c, -g * s / L, 0},
    {0, 0, L * c, L * s, 2 * rate, 0}};
  memcpy(N_VGetArrayPointer(S0), by[k], (size_t)N_VGetLength(S0) * sizeof **by);
  return 0;
}

static int follow(void *user)
{
  model *m = user;
  at_angle(m->p, m->p[ANGLE], m->p[RATE], UNKNOWNS, m->start, m->slope);
  return 0;
}

static void state(const model *m, sunrealtype t, sunrealtype *z, sunrealtype *zp)
{
  sunrealtype phi, rate;
  const sunrealtype *p = m->p;
  stf_collection_pendulum(p[GRAVITY] / p[LENGTH], p[ANGLE], p[RATE], t, &phi, &rate);
  at_angle(p, phi, rate, m->form == GGL ? 6 : 5, z, zp);
}

static int exact(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  state(user, t, N_VGetArrayPointer(y), yp ? N_VGetArrayPointer(yp) : NULL);
  return 0;
}

/* Energy, and the constraints of position and velocity: free to drift in lower index forms. */
static int conserved(sunrealtype t, N_Vector y, sunrealtype *value, void *user)
{
  const sunrealtype *z = N_VGetArrayPointer(y);
  (void)t;
  value[0] = 0.5 * (z[U] * z[U] + z[V] * z[V]) + ((const model *)user)->p[GRAVITY] * z[Y];
  value[1] = z[X] * z[X] + z[Y] * z[Y];
  value[2] = z[X] * z[U] + z[Y] * z[V];
  return 0;
}

static int build(steif_context *ctx, const steif_spec *spec, steif_problem *self)
{
  static const char *const forms[] = {"1", "2", "3", "ggl"};
  STEIF_TRY(stf_spec_only(ctx, spec, (const char *const[]){"index", NULL}));
  const char *word = stf_spec_word(spec, "index");
  int form = word ? 1 : 3;
  while (word && form <= GGL && strcmp(word, forms[form - 1])) form++;
  STEIF_CHECK(form <= GGL, ctx, STEIF_BAD_INPUT,
              "index=%s of '%s' is not known: choose 1, 2, 3 or ggl", word, spec->name);
  model *m = stf_collection_allocate(ctx, self, sizeof *m, 0);
  if (!m) return STEIF_NO_MEMORY;
  m->form = form;
  m->p[LENGTH] = 1, m->p[GRAVITY] = 9.81, m->p[ANGLE] = 1.57079632679489661923 - 0.6,
  m->p[RATE] = 0.7;
  follow(m);
  m->parameters = (steif_parameters){.count = PARAMETERS,
                                     .value = m->p,
                                     .name = parameter,
                                     .dFdp = by_parameter,
                                     .start = start_slope,
                                     .moved = follow};
  self->parameters = &m->parameters;
  self->y0 = m->start, self->yp0 = m->slope;
  self->n = form == GGL ? 6 : 5;
  self->dae_index = form == GGL ? 2 : form;
  self->index = form == 3 ? index3 : form == 1 ? NULL : index2;
  return STEIF_OK;
}

static const char *const unknown[] = {"x", "y", "u", "v", "lambda", "mu"};
static const steif_names names = {.unknown = unknown};

const steif_problem steif_problem_pendulum3 = {
  .about = "planar pendulum in Cartesian coordinates, index=3 (or 2, 1, ggl); C. W. Gear, B. "
           "Leimkuhler and G. K. Gupta, J. Comput. Appl. Math. 12 (1985) 77-90",
  .t1 = 2,
  .F = F,
  .idajac = idajac,
  .autonomous = 1,
  .names = &names,
  .exact = exact,
  .invariants = 3,
  .invariant = conserved,
  .build = build,
  .destroy = stf_collection_release,
};
