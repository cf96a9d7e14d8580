/* reactions.c: the memory of a run: at its start and at events.
 *
 * The direction of a crossing says what a relation is afterwards, since g
 * itself is rounding at its root. Where assignments have moved g, its sign says
 * it.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "reactions.h"
#include <math.h>
#include <string.h>

enum { ROUNDS = 100 };

static stf_reaction *reaction(const stf_reactions *r, size_t i)
{
  return STF_AT(r->list, stf_reaction, i);
}

static stf_feed feed_at(const stf_model *m, double t, const double *y)
{
  stf_feed feed = m->feed;
  feed.t = t;
  feed.y = y;
  return feed;
}

/* Truths of all conditions from the switches. */
static void ask(const stf_model *m, double t, const double *y)
{
  const stf_reactions *r = m->reactions;
  const stf_feed feed = feed_at(m, t, y);
  memset(r->truths, 0, r->list.count * sizeof *r->truths);
  stf_quantity_run(m, &r->conditions, &feed, r->truths);
}

/* ---- timers
 * ----------------------------------------------------------------------------------
 */

/* The next time is counted in whole numbers, so that it does not drift. */
static void set_timer(const stf_model *m, stf_reaction *r)
{
  const double never = 1e300;
  if (r->times)
    m->memory[r->memory] = r->done < r->time_count ? r->times[r->done] : never;
  else
    m->memory[r->memory] = (r->from + r->done * r->period) / r->unit;
}

int stf_reactions_follow(stf_model *m)
{
  stf_reactions *r = m->reactions;
  for (size_t i = 0; r && i < r->list.count; i++) {
    stf_reaction *e = reaction(r, i);
    if (e->count) stf_tape_prepare(&e->tape, &m->feed, e->space);
    if (e->trigger != STF_TIMER) continue;
    STEIF_TRY(stf_timer_read(m, e));
    set_timer(m, e);
  }
  if (r) stf_quantity_prepare(m, &r->conditions);
  return STEIF_OK;
}

/* Times at the start and before are over. */
static void start_timer(const stf_model *m, stf_reaction *r, double t)
{
  r->done = 0;
  if (!r->times && t * r->unit >= r->from)
    r->done = (int32_t)fmin(floor((t * r->unit - r->from) / r->period), 1e9);
  while (r->done > 0 && !r->times && (r->from + (r->done - 1) * r->period) / r->unit > t)
    r->done--;
  do {
    set_timer(m, r);
  } while (m->memory[r->memory] <= t && ++r->done);
}

/* ---- the start
 * -------------------------------------------------------------------------------
 */

/* The truth of relation i; true when it was another. */
static bool is(const stf_model *m, int32_t i, bool truth)
{
  double *now = m->memory + m->discretes + i;
  const bool changed = *now != truth;
  *now = truth;
  return changed;
}

/* Truths that have changed move g of other relations, as that of abs(x) moves abs(x) - 1. Where g has moved beyond
 * rounding since event_values[0], or to 0, where it may stay, its sign says the truth; until none changes. True when f
 * changes by it. */
static bool spread(const stf_model *m, double t, const double *y)
{
  static const double noise = 64e3 * STF_EPS;
  double *before = m->event_values[0], *after = m->event_values[1];
  bool changed = true, any = false;
  for (int32_t round = 0; changed && round <= m->switches; round++) {
    changed = false;
    stf_event_values(m, t, y, after);
    for (int32_t i = 0; i < m->switches; i++) {
      const double least =
        noise * fmax(m->event_range[i], fmax(fabs(before[i]), fabs(after[i])));
      if (!(fabs(after[i] - before[i]) > least) && (after[i] != 0 || before[i] == 0)) continue;
      if (fabs(after[i]) <= least) m->switch_open[i] = STF_AT_ZERO;
      if (!is(m, i, after[i] < 0)) continue;
      changed = true;
      any = any || i < m->reactions->equation_switches;
    }
    memcpy(before, after, (size_t)(m->switches + m->timers) * sizeof *before);
  }
  return any;
}

/* y' of explicit equations; of others at the start, where it is known, and at events, before assignments. */
static bool slopes(const stf_model *m, double t, const double *at, double *yp)
{
  const stf_feed feed = feed_at(m, t, at);
  if (m->form == STEIF_ODE)
    stf_quantity_run(m, &m->f, &feed, yp);
  else if (at == m->y0 && m->yp0)
    memcpy(yp, m->yp0, (size_t)m->n * sizeof *yp);
  else if (t == m->slope_at)
    memcpy(yp, m->event_slope, (size_t)m->n * sizeof *yp);
  else
    return false;
  return true;
}

int stf_reactions_slope(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  stf_model *m = user;
  (void)y;
  memcpy(m->event_slope, N_VGetArrayPointer(yp), (size_t)m->n * sizeof *m->event_slope);
  m->slope_at = t;
  return 0;
}

/* event_values[1] := g after a short step along y' = f; false: y' is not known. */
static bool see_ahead(const stf_model *m, double t, const double *at)
{
  const double h = 1e-8 * stf_span(m);
  double *y = m->memory_literal + m->memories;
  if (!slopes(m, t, at, y)) return false;
  for (int32_t i = 0; i < m->n; i++) y[i] = at[i] + h * y[i];
  stf_event_values(m, t + h, y, m->event_values[1]);
  return true;
}

/* Relations marked as `open` or more, whose g is 0 or as small as rounding: a short step along y' = f tells. With
 * `fired`, only what may be told in the midst of an event: what has fired may be over, and nothing fires twice. */
static bool look_ahead(stf_model *m, double t, const double *at, int open, const int *fired)
{
  const double *g = m->event_values[1], *y = m->memory_literal + m->memories;
  bool any = false, changed = true, told = false;
  for (int32_t i = 0; i < m->switches; i++) any = any || m->switch_open[i] >= open;
  if (!any || !see_ahead(m, t, at)) return false;
  for (int32_t round = 0; changed && round <= m->switches; round++) {
    changed = false;
    for (int32_t i = 0; i < m->switches; i++) {
      if (m->switch_open[i] < open || !isfinite(g[i]) || (fired && fired[i] && g[i] < 0))
        continue;
      changed = is(m, i, g[i] < 0) || changed;
    }
    told = told || changed;
    if (changed) stf_event_values(m, t + 1e-8 * stf_span(m), y, m->event_values[1]);
  }
  return told;
}

/* What is at 0, of event_values[0], leaves it by an event: it counts as on the side that is remembered. */
static void stay(stf_model *m, const int *fired)
{
  for (int32_t i = 0; i < m->switches; i++) {
    if (!m->switch_open[i] || m->event_values[0][i] != 0 || (fired && fired[i])) continue;
    m->event_shift[i] = m->memory[m->discretes + i] != 0 ? -1e-300 : 1e-300;
    m->switch_open[i] = STF_STAYS;
  }
}

static void undecided(stf_model *m, double t)
{
  const double *g = m->event_values[0];
  stf_event_values(m, t, m->y0, m->event_values[0]);
  for (int32_t i = 0; i < m->switches; i++) m->switch_open[i] = g[i] == 0;
  look_ahead(m, t, m->y0, STF_OPEN, NULL);
  spread(m, t, m->y0);
  stay(m, NULL);
}

int stf_reactions_begin(sunrealtype t, void *user)
{
  stf_model *m = user;
  stf_reactions *r = m->reactions;
  memcpy(m->memory, m->memory_start, (size_t)m->memories * sizeof *m->memory);
  m->slope_at = NAN;
  memset(m->event_shift, 0, (size_t)m->switches * sizeof *m->event_shift);
  memset(m->event_range, 0, (size_t)m->switches * sizeof *m->event_range);
  for (size_t i = 0; i < r->list.count; i++)
    if (reaction(r, i)->trigger == STF_TIMER) start_timer(m, reaction(r, i), t);
  stf_literal_switches(m, t, m->y0, m->memory);
  undecided(m, t);
  ask(m, t, m->y0);
  for (size_t i = 0; i < r->list.count; i++) {
    reaction(r, i)->truth = r->truths[i] != 0;
    reaction(r, i)->pending = 0;
  }
  return 0;
}

/* ---- an event
 * --------------------------------------------------------------------------------
 */

/* Which conditions have become true. */
static bool find_pending(const stf_model *m, double t, const double *y)
{
  const stf_reactions *r = m->reactions;
  bool any = false;
  ask(m, t, y);
  for (size_t i = 0; i < r->list.count; i++) {
    stf_reaction *e = reaction(r, i);
    const bool now = r->truths[i] != 0;
    if (e->trigger != STF_TIMER) {
      const bool fires = e->trigger == STF_CHANGES ? now != e->truth : now && !e->truth;
      e->pending = e->pending || fires;
      e->truth = now;
    }
    any = any || e->pending;
  }
  return any;
}

/* After assignments: relations whose g has moved are as their sign says. */
static void follow(const stf_model *m, double t, const double *y)
{
  double *before = m->event_values[0], *after = m->event_values[1];
  bool changed = true;
  for (int32_t round = 0; changed && round <= m->switches; round++) {
    changed = false;
    stf_event_values(m, t, y, after);
    for (int32_t i = 0; i < m->switches; i++)
      if (after[i] != before[i]) {
        changed = is(m, i, after[i] < 0) || changed;
        m->switch_open[i] = after[i] == 0;
      }
    memcpy(before, after, (size_t)(m->switches + m->timers) * sizeof *before);
  }
}

/* Does it change anything? */
static bool assign(const stf_model *m, const stf_reaction *e, double t, double *y)
{
  const stf_reactions *r = m->reactions;
  const stf_feed feed = feed_at(m, t, y);
  memset(r->values, 0, (size_t)e->count * sizeof *r->values);
  if (e->count) stf_tape_run(&e->tape, &feed, e->space, r->values);
  bool changes = false;
  for (int32_t k = 0; k < e->count; k++) {
    const stf_target *target = STF_AT(r->targets, stf_target, e->first + k);
    double *place = target->state >= 0 ? &y[target->state] : &m->memory[target->memory];
    changes = changes || *place != r->values[k];
    *place = r->values[k];
  }
  return changes;
}

static int violated(const stf_model *m, const stf_reaction *e, double t)
{
  const stf_statement *s = stf_statement_at(m, e->statement);
  return STEIF_FAIL(m->ctx, STEIF_INFEASIBLE,
                    "line %u: the requirement is violated at t = %.12g", s->line, t);
}

/* All that is pending, in the order of the file. */
static int act(const stf_model *m, double t, double *y, bool *stops, bool *changes)
{
  const stf_reactions *r = m->reactions;
  for (size_t i = 0; i < r->list.count; i++) {
    stf_reaction *e = reaction(r, i);
    if (!e->pending) continue;
    e->pending = 0;
    if (e->trigger == STF_REQUIREMENT) return violated(m, e, t);
    *changes = assign(m, e, t, y) || *changes;
    *stops = *stops || e->stops;
    if (e->trigger == STF_TIMER) {
      e->done++;
      set_timer(m, e);
    }
    follow(m, t, y);
  }
  return STEIF_OK;
}

/* Truths of what has fired, before the event or after it. Time alone may touch 0 and go back: it is asked. */
static void turn(const stf_model *m, double t, const double *y, const int *fired, int ahead)
{
  double *g = m->event_values[1];
  stf_event_sides(m, t, y, ahead, g);
  for (int32_t i = 0; i < m->switches; i++)
    if (fired[i]) m->memory[m->discretes + i] = g[i] != 0 ? g[i] < 0 : fired[i] * ahead < 0;
}

/* What hangs on another relation may touch 0 where that one fires, as abs(x) does, and what is max(x, 0) without events
 * stays there: a step along y' = f tells. */
static void touch(stf_model *m, double t, const double *y, const int *fired)
{
  int together = 0;
  for (int32_t i = 0; i < m->switches; i++) together += fired[i] != 0;
  const bool seen = together > 0 && see_ahead(m, t, y);
  for (int32_t i = 0; i < m->switches; i++) {
    const bool hangs = together > 1 && m->switch_used[i] == STF_OF_OTHERS;
    if (fired[i] && hangs) m->switch_open[i] = STF_AT_ZERO;
    if (fired[i] && seen && m->event_values[1][i] == 0) m->switch_open[i] = STF_STAYS;
  }
  look_ahead(m, t, y, STF_AT_ZERO, NULL);
  spread(m, t, y);
  for (int32_t i = 0; i < m->switches; i++)
    if (fired[i] && m->switch_open[i] == STF_AT_ZERO) m->switch_open[i] = STF_OPEN;
}

/* A relation that has fired was the other way before, whatever was remembered of it. */
static bool flip(stf_model *m, double t, const double *y, const int *fired)
{
  const stf_reactions *r = m->reactions;
  bool changes = false;
  for (int32_t i = 0; i < m->switches; i++) {
    const bool stays = m->switch_open[i] >= STF_AT_ZERO && m->event_values[0][i] == 0;
    m->switch_open[i] = fired[i] ? STF_OPEN : stays ? STF_STAYS : 0;
  }
  turn(m, t, y, fired, -1);
  ask(m, t, y);
  for (size_t i = 0; i < r->list.count; i++) reaction(r, i)->truth = r->truths[i] != 0;
  turn(m, t, y, fired, 1);
  for (int32_t i = 0; i < m->switches; i++)
    changes = changes || (fired[i] && i < r->equation_switches);
  changes = spread(m, t, y) || changes;
  touch(m, t, y, fired);
  int timer = 0;
  for (size_t i = 0; i < r->list.count; i++)
    if (reaction(r, i)->trigger == STF_TIMER && fired[m->switches + timer++] > 0)
      reaction(r, i)->pending = 1;
  return changes;
}

int stf_reactions_handle(sunrealtype t, N_Vector v, const int *fired, void *user)
{
  stf_model *m = user;
  double *y = N_VGetArrayPointer(v);
  bool stops = false, acted = false;
  stf_event_values(m, t, y, m->event_values[0]);
  bool changes = flip(m, t, y, fired);
  for (int round = 0; find_pending(m, t, y); round++) {
    acted = true;
    m->slope_at = NAN;
    if (round == ROUNDS)
      return STEIF_FAIL(m->ctx, STEIF_STEP_LIMIT,
                        "events at t = %.12g cause each other without end (100 "
                        "rounds); give one of them a "
                        "condition that its own assignment ends",
                        t);
    STEIF_TRY(act(m, t, y, &stops, &changes));
    stf_event_values(m, t, y, m->event_values[0]);
    if (look_ahead(m, t, y, STF_OPEN, fired) && spread(m, t, y)) changes = true;
  }
  if (acted) {
    look_ahead(m, t, y, STF_OPEN, NULL);
    if (spread(m, t, y)) changes = true;
  }
  stf_event_values(m, t, y, m->event_values[1]);
  stf_event_move(m, t, y, fired);
  if (acted) {
    stf_event_values(m, t, y, m->event_values[0]);
    stay(m, fired);
  }
  return stops ? STEIF_FINISH : changes ? STEIF_RESTART : STEIF_CONTINUE;
}
