/* event.c: where event functions g_i(t, y(t)) change their sign within an accepted step.
 *
 * g is sampled at the Chebyshev points x_k = (1 - cos(k pi/4))/2 of the step. Between two of them a
 * change of sign is found from the samples; where both have the same sign, the polynomial of degree 4
 * through all five is looked at on 16 parts of the step and at its smallest values, and g itself is
 * asked where it has the other sign. A bracket is made smaller by the Illinois variant of the secant
 * rule for the function with the earliest root, with a bisection every fourth time, keeping the part
 * with the earliest change of any function (K. L. Hiebert, L. F. Shampine, Sandia report SAND80-0180,
 * 1980, for the idea), until it is as short as rounding allows.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "integrator.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static const sunrealtype point[STF_NODES] = {0, 0.14644660940672624, 0.5, 0.85355339059327376,
                                             1};

static int side(sunrealtype g) { return (g > 0) - (g < 0); }

static size_t bytes(const stf_detector *w) { return (size_t)w->count * sizeof *w->low; }

sunrealtype stf_event_tolerance(const steif_solver *s, sunrealtype t)
{
  const sunrealtype h = s->engine ? s->run.stats.h_last : s->step.h;
  return 4 * STF_EPS * (fabs(t) + h);
}

/* -- opening ----------------------------------------------------------------------------- */

int stf_event_open(steif_solver *s)
{
  const steif_problem *p = s->problem;
  if (p->events == 0 && !p->event) return STEIF_OK;
  STEIF_CHECK(p->events > 0 && p->event, s->ctx, STEIF_BAD_INPUT,
              "problem '%s' announces %d event functions: set .events and .event, or neither",
              p->name, p->events);
  const size_t m = (size_t)p->events;
  stf_detector *w = stf_pool_array(s->pool, 1, sizeof *w);
  if (!w) return STEIF_NO_MEMORY;
  w->count = p->events;
  w->last = -INFINITY;
  w->y = stf_pool_vector(s->pool, s->shown);
  w->after = stf_pool_vector(s->pool, s->shown);
  w->slope = stf_pool_vector(s->pool, s->shown);
  w->place = stf_pool_vector(s->pool, s->shown);
  w->low = stf_pool_array(s->pool, m * (5 + STF_NODES + STF_FINE + 1), sizeof *w->low);
  w->sign = stf_pool_array(s->pool, 7 * m, sizeof *w->sign);
  if (!w->y || !w->after || !w->slope || !w->place || !w->low || !w->sign)
    return STEIF_NO_MEMORY;
  w->high = w->low + m, w->mid = w->high + m, w->next = w->mid + m, w->noise = w->next + m;
  w->node = w->noise + m, w->fine = w->node + m * STF_NODES;
  w->fired = w->sign + m;
  w->leaves = w->sign + 2 * m;
  w->seen = w->sign + 3 * m;
  w->rests = w->sign + 4 * m;
  w->first = w->sign + 5 * m;
  w->coarse = w->sign + 6 * m;
  s->events = w;
  return stf_event_pass_open(s);
}

/* -- values ------------------------------------------------------------------------------- */

void stf_event_name(const steif_problem *p, int i, size_t room, char *name)
{
  const char *given = p->event_list ? p->event_list[i].name : NULL;
  if (given)
    snprintf(name, room, "'%s'", given);
  else
    snprintf(name, room, "g%d", i + 1);
}

int stf_event_ask(steif_solver *s, sunrealtype t, N_Vector y, sunrealtype *g)
{
  const steif_problem *p = s->problem;
  const long failures = stf_failures(s->ctx);
  const int returned = p->event(t, y, g, p->user);
  if (returned && stf_failures(s->ctx) > failures) return steif_status(s->ctx); /* told */
  STEIF_CHECK(returned == 0, s->ctx, STEIF_CALLBACK,
              "the event functions of problem '%s' returned %d at t = %.12g", p->name, returned,
              t);
  for (int i = 0; i < p->events; i++)
    if (isnan(g[i])) {
      stf_event_name(p, i, sizeof s->events->name, s->events->name);
      return STEIF_FAIL(s->ctx, STEIF_NOT_FINITE,
                        "event function %s of problem '%s' is NaN at t = %.12g: let it have a "
                        "number on both sides of the event",
                        s->events->name, p->name, t);
    }
  return STEIF_OK;
}

int stf_event_value(steif_solver *s, sunrealtype t, sunrealtype *g)
{
  STEIF_TRY(stf_dense(s, t, s->events->y));
  return stf_event_ask(s, t, s->events->y, g);
}

bool stf_event_crosses(const steif_solver *s, int i, sunrealtype g)
{
  const stf_detector *w = s->events;
  const int asked = s->problem->event_list ? s->problem->event_list[i].direction : 0;
  const bool changes =
    w->sign[i] != 0 && side(g) != w->sign[i] && !w->rests[i] && !stf_event_kept(w, i, g);
  return changes && (asked == 0 || (asked > 0) == (w->sign[i] < 0));
}

static bool any_crosses(const steif_solver *s, const sunrealtype *g)
{
  for (int i = 0; i < s->events->count; i++)
    if (stf_event_crosses(s, i, g[i])) return true;
  return false;
}

/* Take the sides that g shows; near zero behind an event a side remains unknown. */
static void take_sides(stf_detector *w, const sunrealtype *g)
{
  for (int i = 0; i < w->count; i++)
    if (!w->rests[i] && (w->sign[i] != 0 || fabs(g[i]) > w->noise[i]) &&
        !stf_event_kept(w, i, g[i]))
      w->sign[i] = side(g[i]), w->noise[i] = 0, w->coarse[i] = 0;
}

/* -- bracket -------------------------------------------------------------------------------------- */

/* Smallest part of the bracket at which a secant meets zero; `weight` belongs to the far end. */
static sunrealtype secant(const steif_solver *s, sunrealtype weight)
{
  const stf_detector *w = s->events;
  sunrealtype least = 1;
  for (int i = 0; i < w->count; i++) {
    if (!stf_event_crosses(s, i, w->high[i])) continue;
    const sunrealtype a = fabs(w->low[i]), b = weight * fabs(w->high[i]);
    if (a < least * (a + b)) least = a / (a + b);
  }
  return least;
}

static void swap(sunrealtype **a, sunrealtype **b)
{
  sunrealtype *kept = *a;
  *a = *b, *b = kept;
}

/* Move w->t and *to together around the earliest change; g there in low and high. */
static int locate(steif_solver *s, sunrealtype *to)
{
  stf_detector *w = s->events;
  sunrealtype weight = 1;
  int moved = 0;
  for (int count = 1;; count++) {
    const sunrealtype width = *to - w->t, least = stf_event_tolerance(s, *to);
    if (width <= least) return STEIF_OK;
    const sunrealtype part = count % 4 ? secant(s, weight) : 0.5;
    const sunrealtype x = fmin(fmax(part * width, least / 2), width - least / 2);
    const sunrealtype t = w->t + x;
    if (t <= w->t || t >= *to) return STEIF_OK;
    STEIF_TRY(stf_event_value(s, t, w->mid));
    const int end = any_crosses(s, w->mid) ? 1 : -1;
    weight = end != moved ? 1 : end > 0 ? 2 * weight : weight / 2;
    moved = end;
    if (end > 0)
      *to = t, swap(&w->high, &w->mid);
    else
      w->t = t, swap(&w->low, &w->mid);
  }
}

/* A function that was put at zero by a reaction, that y' takes to one side and that is seen on the other at t has
 * been on both since w->t, and comes back through an event. Steps that do not show the first side are longer than
 * the way there and back, within their tolerance: bounces below it. */
static int find_side(steif_solver *s, int i, sunrealtype t)
{
  stf_detector *w = s->events;
  const sunrealtype least = stf_event_tolerance(s, t);
  for (sunrealtype x = (t - w->t) / 2; x > least && w->sign[i] == 0; x /= 2) {
    STEIF_TRY(stf_event_value(s, w->t + x, w->mid));
    if (side(w->mid[i]) == w->leaves[i]) w->sign[i] = w->leaves[i];
  }
  return w->sign[i] != 0 ? STEIF_OK : stf_event_below(s, i, w->t, t - w->t);
}

int stf_event_below(steif_solver *s, int i, sunrealtype t, sunrealtype h)
{
  stf_detector *w = s->events;
  w->crowded = true;
  stf_event_name(s->problem, i, sizeof w->name, w->name);
  return STEIF_FAIL(s->ctx, STEIF_STEP_SIZE,
                    "events %s of problem '%s' crowd together at t = %.12g: after the last one "
                    "the function comes back "
                    "to zero within a step of %.3g, and its way lies below the tolerance: the "
                    "model bounces without "
                    "end, or its bounces are too low to be seen; give it a rule for that (rest "
                    "below a small speed), "
                    "lower the tolerance, or end the run there",
                    w->name, s->problem->name, t, h);
}

static int find_sides(steif_solver *s, sunrealtype t)
{
  stf_detector *w = s->events;
  for (int i = 0; i < w->count; i++) {
    if (w->sign[i] != 0 || w->leaves[i] == 0 || !(fabs(w->high[i]) > w->noise[i])) continue;
    const int asked = s->problem->event_list ? s->problem->event_list[i].direction : 0;
    const bool event = asked == 0 || asked == -w->leaves[i];
    if (event && side(w->high[i]) == -w->leaves[i]) STEIF_TRY(find_side(s, i, t));
  }
  return STEIF_OK;
}

/* Ends what is known of the step at an event? */
static bool over(const steif_solver *s)
{
  return s->events->cut || s->events->again || s->finished;
}

/* Go on to t, where g is in `high`; all changes on the way are events. */
static int walk(steif_solver *s, sunrealtype t)
{
  stf_detector *w = s->events;
  STEIF_TRY(find_sides(s, t));
  while (any_crosses(s, w->high)) {
    sunrealtype at = t;
    memcpy(w->next, w->high, bytes(w));
    STEIF_TRY(locate(s, &at));
    STEIF_TRY(stf_event_fire(s, at, t));
    w->t = at;
    if (over(s)) return STEIF_OK;
    swap(&w->low, &w->high);
    memcpy(w->high, w->next, bytes(w));
  }
  take_sides(w, w->high);
  w->t = t;
  swap(&w->low, &w->high);
  return STEIF_OK;
}

/* -- step ----------------------------------------------------------------------------------------- */

static int sample(steif_solver *s, sunrealtype from, sunrealtype to)
{
  stf_detector *w = s->events;
  const int m = w->count;
  memcpy(w->node, w->low, bytes(w));
  for (int k = 1; k < STF_NODES - 1; k++)
    STEIF_TRY(stf_event_value(s, from + point[k] * (to - from), w->node + k * m));
  sunrealtype *last = w->node + (STF_NODES - 1) * m;
  STEIF_TRY(to < s->end || stf_beyond(s)
              ? stf_event_value(s, to, last)
              : stf_event_ask(s, to, s->engine ? s->run.y : s->step.y, last));
  for (int j = 0; j <= STF_FINE; j++) {
    sunrealtype value[STF_NODES], *row = w->fine + j * m;
    stf_interpolate(STF_NODES - 1, point, (sunrealtype)j / STF_FINE, value);
    for (int i = 0; i < m; i++) {
      row[i] = 0;
      for (int k = 0; k < STF_NODES; k++) row[i] += value[k] * w->node[k * m + i];
    }
  }
  return STEIF_OK;
}

/* Where the polynomial of function i seems to have left its side, as a multiple of a part: at the end
 * of part j, or at the bottom of the parabola about it; 0: nowhere. */
static sunrealtype dip(const stf_detector *w, int i, int j)
{
  const int m = w->count;
  const sunrealtype *g = w->fine + j * m + i, sign = w->sign[i];
  const sunrealtype here = sign * g[0], left = sign * g[-m], right = sign * g[m];
  if (here < 0) return j;
  if (here > left || here > right) return 0;
  const sunrealtype slope = (right - left) / 2, bend = left - 2 * here + right;
  return bend > 0 && 2 * bend * here < slope * slope ? j - slope / bend : 0;
}

/* The first time after w->t and before `before` at which a function that has the same side there
 * may have changed; `before` when there is none. */
static sunrealtype hidden(const steif_solver *s, sunrealtype from, sunrealtype to,
                          sunrealtype before, const sunrealtype *g)
{
  const stf_detector *w = s->events;
  for (int i = 0; i < w->count; i++) {
    if (w->sign[i] == 0 || w->rests[i] || side(g[i]) != w->sign[i]) continue;
    for (int j = 1; j < STF_FINE; j++) {
      const sunrealtype at = dip(w, i, j);
      const sunrealtype t = from + at / STF_FINE * (to - from);
      if (at > 0 && t > w->t && t < before) before = t;
    }
  }
  return before;
}

/* May function i, which is g at x of the part and p by the polynomial, do what that does not show? */
static bool strays(const stf_detector *w, int i, sunrealtype g, sunrealtype p)
{
  const sunrealtype part = 0.05, far = 4;
  sunrealtype low = INFINITY, high = -INFINITY, least = INFINITY;
  for (int k = 0; k < STF_NODES; k++) {
    const sunrealtype at = w->node[k * w->count + i];
    low = fmin(low, at), high = fmax(high, at), least = fmin(least, fabs(at));
  }
  const sunrealtype range = high - low, off = fabs(g - p);
  return off > part * range && least <= far * (range + off);
}

/* Asked at two more times: does the polynomial show all functions? Jumps and poles have no other cure than
 * short parts. */
static int check(steif_solver *s, sunrealtype from, sunrealtype to, bool *shown)
{
  static const sunrealtype x[] = {0.31, 0.72};
  stf_detector *w = s->events;
  *shown = true;
  for (int j = 0; j < 2 && *shown; j++) {
    sunrealtype value[STF_NODES];
    stf_interpolate(STF_NODES - 1, point, x[j], value);
    STEIF_TRY(stf_event_value(s, from + x[j] * (to - from), w->mid));
    for (int i = 0; i < w->count && *shown; i++) {
      sunrealtype p = 0;
      for (int k = 0; k < STF_NODES; k++) p += value[k] * w->node[k * w->count + i];
      *shown = !strays(w, i, w->mid[i], p);
    }
  }
  return STEIF_OK;
}

/* Events between two times of the step, whose halves are looked at where the whole is not shown. */
static int search(steif_solver *s, sunrealtype from, sunrealtype to, int halvings)
{
  stf_detector *w = s->events;
  const size_t m = (size_t)w->count;
  bool shown = true;
  STEIF_TRY(sample(s, from, to));
  STEIF_TRY(stf_event_find_resting(s, to));
  if (halvings > 0) STEIF_TRY(check(s, from, to, &shown));
  if (!shown) {
    const sunrealtype middle = from + (to - from) / 2;
    STEIF_TRY(search(s, from, middle, halvings - 1));
    return over(s) ? STEIF_OK : search(s, middle, to, halvings - 1);
  }
  for (int k = 1; k < STF_NODES; k++) {
    const sunrealtype *g = w->node + (size_t)k * m, end = from + point[k] * (to - from);
    for (sunrealtype t = from; t < end;) {
      t = hidden(s, from, to, end, g);
      if (t < end)
        STEIF_TRY(stf_event_value(s, t, w->high));
      else
        memcpy(w->high, g, m * sizeof *g);
      STEIF_TRY(walk(s, k == STF_NODES - 1 && t == end ? to : t));
      if (over(s)) return STEIF_OK;
    }
  }
  return STEIF_OK;
}

/* Handlers that put what they watch back again and again, at one time. */
static int check_rest(steif_solver *s, sunrealtype from, int *rounds)
{
  enum { MOST = 100 };
  stf_detector *w = s->events;
  *rounds = w->t - from > stf_event_tolerance(s, w->t) ? 0 : *rounds + 1;
  w->crowded = *rounds > MOST;
  STEIF_CHECK(!w->crowded, s->ctx, STEIF_STEP_SIZE,
              "events %s of problem '%s' follow each other without end at t = %.12g: their "
              "handler changes what the event functions read; let it leave them on their new "
              "side",
              w->name, s->problem->name, w->t);
  return STEIF_OK;
}

int stf_event_step(steif_solver *s, sunrealtype from)
{
  enum { HALVINGS = 6 };
  stf_detector *w = s->events;
  int rounds = 0;
  w->t = from;
  w->passing = false;
  do {
    const sunrealtype begun = w->t;
    w->again = false;
    STEIF_TRY(search(s, begun, s->end, HALVINGS));
    if (w->again) STEIF_TRY(check_rest(s, begun, &rounds));
  } while (w->again);
  return STEIF_OK;
}
