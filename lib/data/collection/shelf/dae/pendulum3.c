/* pendulum3.c: the planar pendulum in Cartesian coordinates as an implicit DAE F(t, y, y') = 0.
 *
 *   x' = u - mu x,  y' = v - mu y,  u' = -lambda x,  v' = -lambda y - g,  and
 *   index=3    x^2 + y^2 = 1                       (mu = 0)
 *   index=2    x u + y v = 0                       (mu = 0)
 *   index=1    u^2 + v^2 - lambda (x^2 + y^2) - g y = 0   (mu = 0)
 *   index=ggl  the first two together, index 2     (Gear, Gupta and Leimkuhler)
 *
 * All have the solution of phi'' = -g sin phi, x = sin phi, y = -cos phi.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "collection.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

#define GRAVITY 9.81
#define PHI0 (1.57079632679489661923 - 0.6) /* 0.6 below the horizontal */
#define RATE0 0.7

enum { X, Y, U, V, LAMBDA, MU };
enum { GGL = 4 };

typedef struct model {
  int form; /* 1, 2, 3 or GGL */
} model;

/* (x, y, u, v, lambda, mu) and slopes at PHI0, RATE0:
 * lambda = u^2 + v^2 - g y, lambda' = -3 g v. */
static const sunrealtype start[] = {.8253356149096783,  -.56464247339503536, .39524973137652475,
                                    .57773493043677481, 6.0291426640052969,  0};
static const sunrealtype slope[] = {.39524973137652475, .57773493043677481,  -4.976066167974989,
                                    -6.405689973744516, -17.002739002754283, 0};
static const int index3[] = {1, 1, 2, 2, 3}, index2[] = {1, 1, 1, 1, 2, 2};

static int F(sunrealtype t, N_Vector yy, N_Vector yyp, N_Vector rr, void *user)
{
  const int form = ((const model *)user)->form;
  const sunrealtype *z = N_VGetArrayPointer(yy), *zp = N_VGetArrayPointer(yyp);
  const sunrealtype mu = form == GGL ? z[MU] : 0;
  const sunrealtype position = z[X] * z[X] + z[Y] * z[Y], radial = z[X] * z[U] + z[Y] * z[V];
  sunrealtype *r = N_VGetArrayPointer(rr);
  (void)t;
  r[0] = zp[X] - z[U] + mu * z[X];
  r[1] = zp[Y] - z[V] + mu * z[Y];
  r[2] = zp[U] + z[LAMBDA] * z[X];
  r[3] = zp[V] + z[LAMBDA] * z[Y] + GRAVITY;
  if (form == 1)
    r[4] = z[U] * z[U] + z[V] * z[V] - z[LAMBDA] * position - GRAVITY * z[Y];
  else
    r[4] = form == 2 ? radial : position - 1;
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

static void acceleration_row(SUNMatrix J, int row, const sunrealtype *z)
{
  SM_ELEMENT_D(J, row, X) = -2 * z[LAMBDA] * z[X];
  SM_ELEMENT_D(J, row, Y) = -2 * z[LAMBDA] * z[Y] - GRAVITY;
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
  if (form == 1) acceleration_row(J, 4, z);
  if (form == 3 || form == GGL) position_row(J, 4, z);
  if (form == 2 || form == GGL) velocity_row(J, form == GGL ? 5 : 4, z);
  return 0;
}

static void state(const model *m, sunrealtype t, sunrealtype *z, sunrealtype *zp)
{
  sunrealtype phi, rate;
  stf_collection_pendulum(GRAVITY, PHI0, RATE0, t, &phi, &rate);
  const sunrealtype x = sin(phi), y = -cos(phi), lambda = rate * rate - GRAVITY * y;
  const sunrealtype value[] = {x, y, -y * rate, x * rate, lambda, 0};
  const sunrealtype change[] = {
    value[U], value[V], -lambda * x, -lambda * y - GRAVITY, -3 * GRAVITY * value[V], 0};
  const size_t n = m->form == GGL ? 6 : 5;
  memcpy(z, value, n * sizeof *z);
  if (zp) memcpy(zp, change, n * sizeof *zp);
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
  (void)t, (void)user;
  value[0] = 0.5 * (z[U] * z[U] + z[V] * z[V]) + GRAVITY * z[Y];
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
  .y0 = start,
  .yp0 = slope,
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
