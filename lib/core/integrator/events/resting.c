/* resting.c: in a mode of index 2 or 3 an event function may be one of its constraints, as x^2 + y^2 - L^2 is behind
 * `when x^2 + y^2 > L^2`: it rests at zero, and what it shows is the error of the solution, on either side. It keeps its
 * side until it is further from zero than tolerances of the unknowns make it.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "integrator.h"
#include <math.h>
#include <string.h>

enum { DRAWS = 3 };
static const sunrealtype most = 10; /* tolerances */

static bool touched(const steif_solver *s, int i)
{
  const stf_detector *w = s->events;
  for (int k = 0; k < STF_NODES; k++)
    if (stf_event_crosses(s, i, w->node[k * w->count + i])) return true;
  return false;
}

static sunrealtype furthest(const stf_detector *w, int i)
{
  sunrealtype largest = 0;
  for (int k = 0; k < STF_NODES; k++) largest = fmax(largest, fabs(w->node[k * w->count + i]));
  return largest;
}

/* w->y = y, each component moved by its tolerance up or down. */
static void disturb(const steif_solver *s, const sunrealtype *y, int draw)
{
  sunrealtype *to = stf_array(s->events->y);
  for (size_t j = 0; j < (size_t)s->problem->n; j++)
    to[j] = y[j] + ((j >> draw) % 2 ? -1 : 1) * stf_allowed(s, y, j);
}

/* w->next: by how much tolerances of y change the functions, which are g there. */
static int find_errors(steif_solver *s, sunrealtype t, const sunrealtype *y,
                       const sunrealtype *g)
{
  stf_detector *w = s->events;
  memset(w->next, 0, (size_t)w->count * sizeof *w->next);
  for (int draw = 0; draw < DRAWS; draw++) {
    disturb(s, y, draw);
    STEIF_TRY(stf_event_ask(s, t, w->y, w->mid));
    for (int i = 0; i < w->count; i++) w->next[i] = fmax(w->next[i], fabs(w->mid[i] - g[i]));
  }
  return STEIF_OK;
}

int stf_event_find_resting(steif_solver *s, sunrealtype t)
{
  stf_detector *w = s->events;
  bool any = false;
  memset(w->rests, 0, (size_t)w->count * sizeof *w->rests);
  if (s->engine || s->problem->dae_index < 2 || !s->step.system.space.serial) return STEIF_OK;
  for (int i = 0; i < w->count; i++) any = any || touched(s, i);
  if (!any) return STEIF_OK;
  STEIF_TRY(stf_dense(s, t, w->place));
  STEIF_TRY(find_errors(s, t, stf_array(w->place), w->node + (STF_NODES - 1) * w->count));
  for (int i = 0; i < w->count; i++) w->rests[i] = furthest(w, i) <= most * w->next[i];
  return STEIF_OK;
}

int stf_event_find_jumped(steif_solver *s, sunrealtype t, bool *any)
{
  stf_detector *w = s->events;
  *any = false;
  memset(w->rests, 0, (size_t)w->count * sizeof *w->rests);
  STEIF_TRY(stf_event_ask(s, t, w->after, w->high));
  STEIF_TRY(find_errors(s, t, stf_array(w->after), w->high));
  for (int i = 0; i < w->count; i++) {
    const sunrealtype g = w->high[i];
    const bool clear = fabs(g) > fmax(most * w->next[i], w->noise[i]);
    w->fired[i] = clear && stf_event_crosses(s, i, g) ? -w->sign[i] : 0;
    *any = *any || w->fired[i];
    if (clear) w->sign[i] = (g > 0) - (g < 0), w->noise[i] = 0;
  }
  return STEIF_OK;
}
