/* bounce.c: a ball falls from height H and bounces with restitution e,
 *
 *   y' = v, v' = -g;   at y = 0 falling: v becomes -e v.
 *
 * With T = sqrt(2 H/g) it hits the ground for the k-th time at
 *   t_k = T + 2 T (e + e^2 + ... + e^(k-1)),   k = 1, 2, ...,
 * after which v = g T e^k; all bounces are over at T (1 + e)/(1 - e). Parameters H = 1, g = 9.81, e = 0.8.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "collection.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <steif/parameters.h>
#include <sunmatrix/sunmatrix_dense.h>

enum { KNOWN = 64 };
enum { HEIGHT, GRAVITY, RESTITUTION, PARAMETERS };

typedef struct ball {
  sunrealtype p[PARAMETERS], start[2];
  sunrealtype times[KNOWN]; /* with the parameters that it was built with */
  steif_parameters parameters;
} ball;

static const char *const names[] = {"H", "g", "e"};

static int f(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const ball *b = user;
  (void)t;
  N_VGetArrayPointer(ydot)[0] = N_VGetArrayPointer(y)[1];
  N_VGetArrayPointer(ydot)[1] = -b->p[GRAVITY];
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
  x[1] *= -((const ball *)user)->p[RESTITUTION];
  return STEIF_RESTART;
}

static void times(const ball *b, sunrealtype *to)
{
  sunrealtype flight = sqrt(2 * b->p[HEIGHT] / b->p[GRAVITY]), t = flight;
  for (int k = 0; k < KNOWN; k++, t += 2 * flight) {
    to[k] = t;
    flight *= b->p[RESTITUTION];
  }
}

static int exact(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  const ball *b = user;
  const sunrealtype g = b->p[GRAVITY], H = b->p[HEIGHT];
  sunrealtype *x = N_VGetArrayPointer(y), at[KNOWN];
  int k = 0;
  times(b, at);
  while (k < KNOWN && t >= at[k]) k++;
  if (k == KNOWN) return 1;
  const sunrealtype up = sqrt(2 * g * H) * pow(b->p[RESTITUTION], k), s = k ? t - at[k - 1] : t;
  x[0] = (k ? up * s : H) - g * s * s / 2;
  x[1] = (k ? up : 0) - g * s;
  return yp ? f(t, y, yp, user) : 0;
}

/* -df/dp. */
static int slope(sunrealtype t, N_Vector y, N_Vector yp, int k, N_Vector out, void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  N_VGetArrayPointer(out)[0] = 0;
  N_VGetArrayPointer(out)[1] = k == GRAVITY;
  return 0;
}

static int begin_slope(int k, N_Vector S0, void *user)
{
  (void)user;
  N_VGetArrayPointer(S0)[0] = k == HEIGHT;
  N_VGetArrayPointer(S0)[1] = 0;
  return 0;
}

static int follow(void *user)
{
  ball *b = user;
  b->start[0] = b->p[HEIGHT];
  return 0;
}

static int build(steif_context *ctx, const steif_spec *spec, steif_problem *self)
{
  static const char *const keys[] = {"e", NULL};
  sunrealtype e;
  STEIF_TRY(stf_spec_only(ctx, spec, keys));
  STEIF_TRY(stf_spec_real(ctx, spec, "e", 0.01, 1, 0.8, &e));
  ball *b = stf_collection_allocate(ctx, self, sizeof *b, 0);
  if (!b) return STEIF_NO_MEMORY;
  b->p[HEIGHT] = b->start[0] = 1, b->p[GRAVITY] = 9.81, b->p[RESTITUTION] = e;
  b->parameters = (steif_parameters){.count = PARAMETERS,
                                     .value = b->p,
                                     .name = names,
                                     .dFdp = slope,
                                     .start = begin_slope,
                                     .moved = follow};
  times(b, b->times);
  self->parameters = &b->parameters;
  self->y0 = b->start;
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
