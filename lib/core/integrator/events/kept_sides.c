/* kept_sides.c: what is zero for functions that have fired: behind an event of a DAE algebraic unknowns, and others by hidden
 * constraints, are put in their place; in the step they were off by its error. A function that goes back through zero by
 * that has not changed: it is on its new side until it is clearly on the old one, or on the new.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "integrator.h"
#include <math.h>

static bool any_fired_with_noise(const stf_detector *w)
{
  for (int i = 0; i < w->count; i++)
    if (w->fired[i] && w->noise[i] > 0) return true;
  return false;
}

/* What has fired is off by this much at once, and by as much again and again in the steps that follow: of 48 runs of a
 * valve, eight methods at six tolerances, two switch too often with 2, none with 4. */
static const sunrealtype reserve = 4;

int stf_event_find_noise(steif_solver *s, sunrealtype t)
{
  stf_detector *w = s->events;
  if (!any_fired_with_noise(w)) return STEIF_OK;
  const bool before = stf_silence(s->ctx, true);
  N_VScale(1, w->after, w->place);
  const int code = stf_mode_exactly(s, t, w->place);
  stf_silence(s->ctx, before);
  if (code == STEIF_NO_MEMORY) return code;
  if (code) return steif_forget(s->ctx), STEIF_OK;
  N_VLinearSum(1, w->place, -1, w->after, w->y);
  if (!(N_VMaxNorm(w->y) > 0)) return STEIF_OK;
  STEIF_TRY(stf_event_ask(s, t, w->after, w->low));
  STEIF_TRY(stf_event_ask(s, t, w->place, w->mid));
  for (int i = 0; i < w->count; i++) {
    const sunrealtype off = reserve * fabs(w->mid[i] - w->low[i]);
    if (!w->fired[i] || !(w->noise[i] > 0) || !(off > w->noise[i])) continue;
    w->noise[i] = off;
    w->coarse[i] = 1;
  }
  return STEIF_OK;
}

bool stf_event_kept(const stf_detector *w, int i, sunrealtype g)
{
  return w->coarse[i] && fabs(g) <= w->noise[i];
}
