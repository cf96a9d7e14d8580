/* bounce.c: a ball falls from height 1 and bounces with restitution e,
 *
 *   y' = v, v' = -g;   at y = 0 falling: v becomes -e v.
 *
 * With T = sqrt(2/g) it hits the ground for the k-th time at
 *   t_k = T + 2 T (e + e^2 + ... + e^(k-1)),   k = 1, 2, ...,
 * after which v = g T e^k; all bounces are over at T (1 + e)/(1 - e).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "collection.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <sunmatrix/sunmatrix_dense.h>

enum { KNOWN = 64 };
static const sunrealtype g = 9.81;

typedef struct ball {
  sunrealtype e, times[KNOWN];
} ball;

static int f(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  (void)t, (void)user;
  N_VGetArrayPointer(ydot)[0] = N_VGetArrayPointer(y)[1];
  N_VGetArrayPointer(ydot)[1] = -g;
  return 0;
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
               N_Vector b, N_Vector c)
{
  (void)t, (void)y, (void)fy, (void)user, (void)a, (void)b, (void)c;
  SM_ELEMENT_D(J, 0, 1) = 1;
  return 0;
}

static int ground(sunrealtype t, N_Vector y, sunrealtype *value, void *user)
{
  (void)t, (void)user;
  *value = N_VGetArrayPointer(y)[0];
  return 0;
}

static int hit(sunrealtype t, N_Vector y, const int *fired, void *user)
{
  (void)t, (void)fired;
  sunrealtype *x = N_VGetArrayPointer(y);
  x[0] = 0;
  x[1] *= -((const ball *)user)->e;
  return STEIF_RESTART;
}

static int exact(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  const ball *b = user;
  sunrealtype *x = N_VGetArrayPointer(y);
  int k = 0;
  while (k < KNOWN && t >= b->times[k]) k++;
  if (k == KNOWN) return 1;
  const sunrealtype up = sqrt(2 * g) * pow(b->e, k), s = k ? t - b->times[k - 1] : t;
  x[0] = (k ? up * s : 1) - g * s * s / 2;
  x[1] = (k ? up : 0) - g * s;
  return yp ? f(t, y, yp, user) : 0;
}

static int build(steif_context *ctx, const steif_spec *spec, steif_problem *self)
{
  static const char *const keys[] = {"e", NULL};
  sunrealtype e;
  STEIF_TRY(stf_spec_only(ctx, spec, keys));
  STEIF_TRY(stf_spec_real(ctx, spec, "e", 0.01, 1, 0.8, &e));
  ball *b = stf_collection_allocate(ctx, self, sizeof *b, 0);
  if (!b) return STEIF_NO_MEMORY;
  b->e = e;
  sunrealtype flight = sqrt(2 / g), t = flight;
  for (int k = 0; k < KNOWN; k++, t += 2 * flight) {
    b->times[k] = t;
    flight *= e;
  }
  self->event_times = b->times;
  self->event_time_count = KNOWN;
  return STEIF_OK;
}

static const sunrealtype start[] = {1, 0};
static const steif_event list[] = {{.name = "ground", .direction = -1}};

const steif_problem steif_problem_bounce = {
  .about =
    "a ball bounces with restitution e=0.8: events that change the state; impacts in closed "
    "form, B. Brogliato, Nonsmooth Mechanics, Springer 1999, ch. 1",
  .n = 2,
  .t1 = 3,
  .y0 = start,
  .f = f,
  .jac = jac,
  .autonomous = 1,
  .exact = exact,
  .events = 1,
  .event = ground,
  .event_list = list,
  .handle_event = hit,
  .build = build,
  .destroy = stf_collection_release,
};
