/* event_values.c: event functions g of relations and timers.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "reactions.h"
#include <math.h>
#include <string.h>

/* Places of passes that stand elsewhere are never an event. */
static void values(const stf_model *m, const double *memory, double t, const double *y,
                   double *g)
{
  stf_feed feed = m->feed;
  feed.t = t;
  feed.y = y;
  feed.memory = memory;
  for (int32_t i = 0; i < m->switches + m->timers; i++)
    g[i] = i < m->switches && !m->switch_used[i];
  stf_quantity_run(m, &m->events, &feed, g);
}

void stf_event_values(const stf_model *m, double t, const double *y, double *g)
{
  values(m, m->memory, t, y, g);
}

/* After an event g is as small as rounding and may stay so, where a relation stops what it watches: it is
 * moved to its new side by a few units of rounding of the largest |g| since the last event, so that it
 * does not fire again by noise. Once g is far on that side the shift is taken back, or each event that brings
 * g back to the same side, such as a ball's next bounce, would lie deeper than the one before. */
int stf_event_callback(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  static const double far = 1e3;
  const stf_model *m = user;
  stf_event_values(m, t, N_VGetArrayPointer(y), g);
  for (int32_t i = 0; i < m->switches; i++) {
    m->event_range[i] = fmax(m->event_range[i], fabs(g[i]));
    const bool away =
      g[i] * m->event_shift[i] > 0 && fabs(g[i]) > far * fabs(m->event_shift[i]);
    if (away && m->switch_open[i] < STF_AT_ZERO) m->event_shift[i] = 0;
    g[i] += m->event_shift[i];
  }
  return 0;
}

/* What the rounding of y makes of g, at y(1 +- 2 eps), into g; 0 where g jumps there. */
static void rounding_of(const stf_model *m, double t, const double *y, const double *at,
                        double *g)
{
  static const double jump = 1e-6; /* of the range */
  double *beside = m->memory_literal + m->memories;
  for (int32_t i = 0; i < m->n; i++) beside[i] = y[i] * (1 + (i % 2 ? 2 : -2) * STF_EPS);
  stf_event_values(m, t, beside, g);
  for (int32_t i = 0; i < m->switches; i++) {
    const double off = fabs(g[i] - at[i]);
    g[i] = off <= jump * m->event_range[i] ? off : 0;
  }
}

/* Of what has fired, of what may stay at 0, and where a truth that follows others has left the side of its shift. */
static bool moves(const stf_model *m, int32_t i, const int *fired)
{
  const double shift = m->event_shift[i];
  const bool truth = m->memory[m->discretes + i] != 0;
  return fired[i] || m->switch_open[i] == STF_AT_ZERO || (shift != 0 && (shift < 0) != truth);
}

void stf_event_move(const stf_model *m, double t, const double *y, const int *fired)
{
  static const double units = 64 * STF_EPS, times = 8;
  double *noise = m->event_values[0];
  rounding_of(m, t, y, m->event_values[1], noise);
  for (int32_t i = 0; i < m->switches; i++) {
    if (!moves(m, i, fired)) continue;
    const double g = fabs(m->event_values[1][i]),
                 least = fmax(fmax(units * m->event_range[i], times * noise[i]), 1e-300),
                 shift = least + 2 * g;
    m->event_shift[i] = g > 1e3 * least ? 0 : m->memory[m->discretes + i] != 0 ? -shift : shift;
    m->event_range[i] = 0;
  }
}

void stf_event_sides(const stf_model *m, double t, const double *y, int ahead, double *g)
{
  static const double units = 64 * STF_EPS;
  const double h = 1024 * STF_EPS * (fabs(t) + stf_span(m));
  values(m, m->memory, t + ahead * h, y, g);
  for (int32_t i = 0; i < m->switches; i++)
    if (m->switch_used[i] != STF_OF_TIME || !(fabs(g[i]) > units * m->event_range[i])) g[i] = 0;
}

/* g of a relation may hang on the truth of others, as in abs(x) < 1: until none changes. */
void stf_literal_switches(const stf_model *m, double t, const double *y, double *memory)
{
  double *g = m->event_values[1], *truth = memory + m->discretes;
  bool changed = true;
  for (int32_t round = 0; changed && round <= m->switches; round++) {
    changed = false;
    values(m, memory, t, y, g);
    for (int32_t i = 0; i < m->switches; i++) {
      changed = changed || truth[i] != (g[i] < 0);
      truth[i] = g[i] < 0;
    }
  }
}
