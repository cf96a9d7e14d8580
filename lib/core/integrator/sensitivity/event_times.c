/* event_times.c: derivatives of the times of events by parameters.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "random.h"
#include "saltation.h"
#include <math.h>

enum { NODES = 8, PROBES = 6 };
static const sunrealtype grazing = 1e-6; /* of |g_y f- + g_t| in |g_y| |f-| */

/* The slope of dense output, from values at nine times about t: exact up to degree 8. Dense output that evaluates f would
 * do so beyond t, where it may be another: f before t is the slope. */
static int slope_at(steif_solver *s, sunrealtype t, N_Vector out)
{
  if (!s->engine && !s->step.method->dense) {
    const sunrealtype before = nextafter(t, -INFINITY);
    const int code = stf_system_rhs(&s->step.system, before, s->saltation->y, out);
    return code > 0 ? steif_status(s->ctx) : code;
  }
  sunrealtype node[NODES + 1], weight[NODES + 1];
  const sunrealtype h = s->step.h;
  for (int j = 0; j <= NODES; j++) {
    const sunrealtype to = t + (j % 2 ? 1 : -1) * ((j + 1) / 2) * h / 8;
    node[j] = (to - t) / h;
  }
  stf_differentiate(NODES, node, weight);
  N_VConst(0, out);
  for (int j = 0; j <= NODES; j++) {
    STEIF_TRY(stf_dense(s, t + node[j] * h, s->saltation->point));
    stf_axpy(&s->step.system.space, weight[j] / h, s->saltation->point, out);
  }
  return STEIF_OK;
}

/* y, its slope and S on the near side of t, which lies in the last step. */
int stf_saltation_look(steif_solver *s, sunrealtype t)
{
  stf_saltation *w = s->saltation;
  const stf_carry *T = s->step.carry;
  w->t = t;
  STEIF_TRY(stf_dense(s, t, w->y));
  STEIF_TRY(slope_at(s, t, w->slope));
  for (int k = 0; k < stf_columns(s); k++)
    if (t != s->step.t)
      STEIF_TRY(stf_column_dense(s, k, t, w->S[k]));
    else
      stf_copy(&s->step.system.space, T->S[k], w->S[k]);
  return STEIF_OK;
}

int stf_saltation_values(steif_solver *s, sunrealtype t, N_Vector y, N_Vector out)
{
  return s->problem->event(t, y, stf_array(out), s->problem->user);
}

int stf_undifferentiable(steif_solver *s, int i, int code)
{
  if (code < 0 && code != STEIF_RETRY) return code;
  char name[64];
  stf_event_name(s->problem, i, sizeof name, name);
  return STEIF_FAIL(
    s->ctx, STEIF_UNSUPPORTED,
    "event function %s of problem '%s' has no derivative at t = %.12g, where it "
    "fires (differences of it disagree): sensitivities need a smooth one",
    name, s->problem->name, s->saltation->t);
}

/* |g_y| |f-| of function i, components in their own sizes, by random directions. */
static int rate_expected(steif_solver *s, int i, sunrealtype *expected)
{
  stf_saltation *w = s->saltation;
  const sunrealtype *y = stf_array(w->y), *f = stf_array(w->slope);
  const stf_line line = {.dy = w->direction, .k = -1};
  sunrealtype *v = stf_array(w->direction), sum = 0, rate = 0;
  stf_random random = {1};
  for (int probe = 0; probe < PROBES; probe++) {
    for (sunindextype j = 0; j < s->problem->n; j++)
      v[j] = (stf_random_in(&random, -1, 1) < 0 ? -1 : 1) * (fabs(y[j]) + s->step.system.scale);
    STEIF_TRY(stf_along(s, stf_saltation_values, &line, w->g[0], w->g + 1));
    const sunrealtype along = stf_array(w->g[0])[i];
    sum += along * along / PROBES;
  }
  for (sunindextype j = 0; j < s->problem->n; j++) {
    const sunrealtype part = f[j] / (fabs(y[j]) + s->step.system.scale);
    rate += part * part;
  }
  *expected = sqrt(sum * rate);
  return STEIF_OK;
}

/* tau_p of function i into tau. */
static int times_of(steif_solver *s, int i, sunrealtype *tau)
{
  stf_saltation *w = s->saltation;
  const stf_carry *T = s->step.carry;
  sunrealtype expected;
  const stf_line ahead = {.dt = 1, .dy = w->slope, .k = -1};
  int code = stf_along(s, stf_saltation_values, &ahead, w->g[0], w->g + 1);
  if (code) return stf_undifferentiable(s, i, code);
  const sunrealtype rate = stf_array(w->g[0])[i];
  code = rate_expected(s, i, &expected);
  if (code) return stf_undifferentiable(s, i, code);
  if (!(fabs(rate) >= grazing * expected) || rate == 0) {
    char name[64];
    stf_event_name(s->problem, i, sizeof name, name);
    return STEIF_FAIL(
      s->ctx, STEIF_UNSUPPORTED,
      "event %s of problem '%s' grazes at t = %.12g: its function changes by %.3g a "
      "unit of time, below 1e-6 of %.3g: derivatives of its time grow without bound there",
      name, s->problem->name, w->t, rate, expected);
  }
  for (int k = 0; k < stf_columns(s); k++) {
    const stf_line line = {.dy = w->S[k], .k = T->parameter[k]};
    code = stf_along(s, stf_saltation_values, &line, w->g[0], w->g + 1);
    if (code) return stf_undifferentiable(s, i, code);
    tau[k] = -stf_array(w->g[0])[i] / rate;
  }
  return STEIF_OK;
}

/* Two functions that fire at once do so for all p, or what is behind them has no derivative. */
static int agree(steif_solver *s, int i)
{
  const stf_carry *T = s->step.carry;
  const stf_saltation *w = s->saltation;
  char name[64];
  STEIF_TRY(times_of(s, i, w->other));
  stf_event_name(s->problem, i, sizeof name, name);
  for (int k = 0; k < stf_columns(s); k++) {
    const sunrealtype both = fabs(w->tau[k]) + fabs(w->other[k]);
    STEIF_CHECK(
      fabs(w->tau[k] - w->other[k]) <= 1e-6 * both + 1e-9 / T->scale[k], s->ctx,
      STEIF_UNSUPPORTED,
      "two events of problem '%s' at once at t = %.12g, %s and one whose time has another "
      "derivative by parameter %d: what comes after them has none",
      s->problem->name, w->t, name, T->parameter[k] + 1);
  }
  return STEIF_OK;
}

int stf_saltation_times(steif_solver *s, sunrealtype t)
{
  stf_saltation *w = s->saltation;
  bool found = false;
  STEIF_TRY(stf_saltation_look(s, t));
  for (int i = 0; i < s->problem->events; i++) {
    if (!s->events->fired[i]) continue;
    STEIF_TRY(found ? agree(s, i) : times_of(s, i, w->tau));
    found = true;
  }
  w->known = true;
  return STEIF_OK;
}
