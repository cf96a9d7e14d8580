/* swing.c: a mass on a rigid rod, let go 2 radians from the vertical below; index 1:
 *
 *   x' = u,  y' = v,  u' = -lambda x,  v' = -lambda y - 1,  0 = u^2 + v^2 - lambda (x^2 + y^2) - y.
 *
 * The length x^2 + y^2 = 1 and its derivative x u + y v = 0 are not among the equations: they hold at
 * the start, and a method drifts off them.
 *
 * It passes the vertical, x = 0, at K, 3K, 5K, ... and turns, x v = y u, at 2K, 4K, ..., K the
 * complete elliptic integral of modulus sin 1 (Abramowitz and Stegun 1964, 17.3).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "collection.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <sunmatrix/sunmatrix_dense.h>

enum { X, Y, U, V, LAMBDA, N };
#define ANGLE 2.
#define K 2.08743823172962368359160291148 /* arithmetic-geometric mean in 30-digit arithmetic */

static int f(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  const sunrealtype *z = N_VGetArrayPointer(y);
  sunrealtype *out = N_VGetArrayPointer(r);
  (void)t, (void)user;
  out[X] = z[U];
  out[Y] = z[V];
  out[U] = -z[LAMBDA] * z[X];
  out[V] = -z[LAMBDA] * z[Y] - 1;
  out[LAMBDA] = z[U] * z[U] + z[V] * z[V] - z[LAMBDA] * (z[X] * z[X] + z[Y] * z[Y]) - z[Y];
  return 0;
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
               N_Vector b, N_Vector c)
{
  const sunrealtype *z = N_VGetArrayPointer(y);
  (void)t, (void)fy, (void)user, (void)a, (void)b, (void)c;
  SM_ELEMENT_D(J, X, U) = SM_ELEMENT_D(J, Y, V) = 1;
  SM_ELEMENT_D(J, U, X) = SM_ELEMENT_D(J, V, Y) = -z[LAMBDA];
  SM_ELEMENT_D(J, U, LAMBDA) = -z[X];
  SM_ELEMENT_D(J, V, LAMBDA) = -z[Y];
  SM_ELEMENT_D(J, LAMBDA, X) = -2 * z[LAMBDA] * z[X];
  SM_ELEMENT_D(J, LAMBDA, Y) = -2 * z[LAMBDA] * z[Y] - 1;
  SM_ELEMENT_D(J, LAMBDA, U) = 2 * z[U];
  SM_ELEMENT_D(J, LAMBDA, V) = 2 * z[V];
  SM_ELEMENT_D(J, LAMBDA, LAMBDA) = -(z[X] * z[X] + z[Y] * z[Y]);
  return 0;
}

static int mass(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  for (int i = X; i <= V; i++) SM_ELEMENT_D(E, i, i) = 1;
  return 0;
}

/* lambda = u^2 + v^2 - y from the second derivative of the length. */
static int exact(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  sunrealtype *z = N_VGetArrayPointer(y), phi, rate;
  stf_collection_pendulum(1, ANGLE, 0, t, &phi, &rate);
  const sunrealtype s = sin(phi), c = cos(phi);
  z[X] = s;
  z[Y] = -c;
  z[U] = rate * c;
  z[V] = rate * s;
  z[LAMBDA] = rate * rate + c;
  if (!yp) return 0;
  sunrealtype *d = N_VGetArrayPointer(yp);
  const int code = f(t, y, yp, user);
  d[LAMBDA] = -3 * z[V];
  return code;
}

static int marks(sunrealtype t, N_Vector y, sunrealtype *value, void *user)
{
  const sunrealtype *z = N_VGetArrayPointer(y);
  (void)t, (void)user;
  value[0] = z[X];
  value[1] = z[X] * z[V] - z[Y] * z[U]; /* angular velocity */
  return 0;
}

/* Energy, and what the index 1 form no longer says. */
static int kept(sunrealtype t, N_Vector y, sunrealtype *value, void *user)
{
  const sunrealtype *z = N_VGetArrayPointer(y);
  (void)t, (void)user;
  value[0] = (z[U] * z[U] + z[V] * z[V]) / 2 + z[Y];
  value[1] = z[X] * z[X] + z[Y] * z[Y];
  value[2] = z[X] * z[U] + z[Y] * z[V];
  return 0;
}

/* sin 2, -cos 2; lambda = cos 2 at rest, y' = (0, 0, -lambda x, -lambda y - 1, 0). */
static const sunrealtype start[] = {.909297426825681695, .416146836547142387, 0, 0,
                                    -.416146836547142387};
static const sunrealtype slope[] = {0, 0, .378401247653963788, -.826821810431805953, 0};
static const sunrealtype times[] = {K, 2 * K, 3 * K, 4 * K, 5 * K};
static const steif_event list[] = {{.name = "vertical"}, {.name = "turn"}};

const steif_problem steif_problem_swing = {
  .about =
    "pendulum of 2 radians in Cartesian coordinates, index 1: events that change nothing, "
    "at multiples of an elliptic integral; M. Abramowitz and I. A. Stegun, Handbook of "
    "Mathematical Functions, 1964, 17.3",
  .n = N,
  .t1 = 11,
  .y0 = start,
  .yp0 = slope,
  .f = f,
  .jac = jac,
  .E = mass,
  .dae_index = 1,
  .autonomous = 1,
  .exact = exact,
  .invariants = 3,
  .invariant = kept,
  .events = 2,
  .event = marks,
  .event_list = list,
  .event_times = times,
  .event_time_count = sizeof times / sizeof *times,
};
