/* event_values.c: event functions g of relations and timers.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "reactions.h"
#include <string.h>

/* Places of passes that stand elsewhere are never an event. */
void stf_event_values(const stf_model *m, double t, const double *y, double *g)
{
  stf_feed feed = m->feed;
  feed.t = t;
  feed.y = y;
  for (int32_t i = 0; i < m->switches + m->timers; i++)
    g[i] = i < m->switches && !m->switch_used[i];
  stf_quantity_run(m, &m->events, &feed, g);
}

int stf_event_callback(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  stf_event_values(user, t, N_VGetArrayPointer(y), g);
  return 0;
}

void stf_literal_switches(const stf_model *m, double t, const double *y, double *memory)
{
  double *g = m->event_values[1];
  stf_event_values(m, t, y, g);
  for (int32_t i = 0; i < m->switches; i++) memory[m->discretes + i] = g[i] < 0;
}
