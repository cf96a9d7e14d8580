/* passed.c: dense output of a step that evaluates f anew, where an event at its end has changed f since: the
 * polynomial through the solution, and its derivatives by parameters, at Chebyshev points, which are looked at before the
 * event is handled.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "saltation.h"
#include <math.h>

enum { POINTS = 10 }; /* degree 9: methods with such dense output are of order 8 at most */

static bool evaluates(const steif_solver *s) { return !s->engine && !s->step.method->dense; }

int stf_event_pass_open(steif_solver *s)
{
  if (!evaluates(s) && !s->chosen) return STEIF_OK;
  s->events->passed = stf_pool_vectors(s->pool, POINTS * (1 + stf_columns(s)), s->shown);
  return s->events->passed ? STEIF_OK : STEIF_NO_MEMORY;
}

static sunrealtype node(int k)
{
  const sunrealtype pi = 3.14159265358979323846;
  return (1 - cos(pi * k / (POINTS - 1))) / 2;
}

int stf_event_pass(steif_solver *s, sunrealtype t)
{
  stf_detector *w = s->events;
  w->passing = false;
  if (!w->passed || !evaluates(s)) return STEIF_OK;
  w->from = s->step.t - s->step.h, w->to = t;
  for (int j = 0; j < POINTS; j++) {
    const sunrealtype at = w->from + node(j) * (t - w->from);
    STEIF_TRY(stf_dense(s, at, w->passed[j]));
    for (int k = 0; k < stf_columns(s); k++)
      STEIF_TRY(stf_column_dense(s, k, at, w->passed[(k + 1) * POINTS + j]));
  }
  return STEIF_OK;
}

bool stf_event_passed(const steif_solver *s) { return s->events && s->events->passing; }

/* Barycentric weights of these points are 1, -1, 1, ..., half of it at both ends (J.-P. Berrut, L. N. Trefethen, SIAM
 * Review 46, 2004). */
int stf_event_recall(const steif_solver *s, int column, sunrealtype t, N_Vector y)
{
  const stf_detector *w = s->events;
  N_Vector *const passed = w->passed + (column + 1) * POINTS;
  const sunrealtype x = (t - w->from) / (w->to - w->from);
  sunrealtype c[POINTS], sum = 0;
  for (int k = 0; k < POINTS; k++) {
    const sunrealtype away = x - node(k);
    if (away == 0) {
      N_VScale(1, passed[k], y);
      return STEIF_OK;
    }
    c[k] = (k % 2 ? -1 : 1) * (k == 0 || k == POINTS - 1 ? 0.5 : 1) / away;
    sum += c[k];
  }
  for (int k = 0; k < POINTS; k++) c[k] /= sum;
  stf_combine(&s->step.system.space, POINTS, c, passed, y);
  return STEIF_OK;
}
