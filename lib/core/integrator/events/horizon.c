/* horizon.c: event functions that change in t alone, faster than the solution shows: steps end at what is ahead.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "integrator.h"
#include <math.h>

enum { MOST = 100000 }; /* looks ahead */

static bool changed(stf_detector *w, const sunrealtype *g)
{
  for (int i = 0; i < w->count; i++) {
    const int side = (g[i] > 0) - (g[i] < 0);
    if (side * w->seen[i] < 0) return true;
    if (side != 0) w->seen[i] = side;
  }
  return false;
}

static int look(steif_solver *s, sunrealtype spacing)
{
  stf_detector *w = s->events;
  const sunrealtype from = s->end, width = s->t1 - from,
                    part = spacing > width / MOST ? spacing : width / MOST;
  N_Vector y = stf_last(s);
  for (int i = 0; i < w->count; i++) w->seen[i] = w->sign[i];
  for (long k = 1; from + (sunrealtype)k * part < s->t1; k++) {
    w->horizon = from + (sunrealtype)k * part;
    STEIF_TRY(stf_event_ask(s, w->horizon, y, w->mid));
    if (changed(w, w->mid)) return STEIF_OK;
  }
  w->horizon = s->t1;
  return STEIF_OK;
}

int stf_event_horizon(steif_solver *s, sunrealtype *stop)
{
  const sunrealtype spacing = s->problem->event_spacing;
  *stop = s->t1;
  if (!s->events || !(spacing > 0)) return STEIF_OK;
  const sunrealtype rest = s->events->horizon - s->end; /* too short for a step: it is over */
  if (rest <= 64 * STF_EPS * fabs(s->end)) STEIF_TRY(look(s, spacing));
  *stop = s->events->horizon;
  return STEIF_OK;
}
