/* break_mesh.c: constant steps with every break of f on their mesh, or constant steps from break to break:
 * there a run begins anew from the x that it has reached. For one-step methods this is nothing but a change of
 * the step; convolution quadrature begins anew with the source E x(tau-) / h and Gregory's weights of f
 * from the right, and its comb ends before the break with the same weights, so that both sides are
 * integrated to its order.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "measure.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* A break is a whole number of steps within WHOLE of one; a first choice keeps within these factors of
 * the step wanted and divides the interval, too. */
#define WHOLE 1e-9
#define SHORTER 0.6
#define LONGER 1.7
#define SHORTEST (1.0 / 32) /* of the step wanted */
/* Steps, in units of the time: shorter ones lose the sides of their ends (STF_STEP_END). */
#define RESOLVED 1e-8
enum {
  TOLD = 3,
  WEIGHTED = 2 * STF_GREGORY
}; /* segments in a sentence; steps with end weights */

static bool whole(sunrealtype t, sunrealtype h)
{
  const sunrealtype n = t / h;
  return fabs(n - round(n)) <= WHOLE * fmax(1, n) && round(n) >= 1;
}

size_t stf_break_inside(size_t count, const sunrealtype *breaks, sunrealtype t1, sunrealtype h)
{
  for (size_t b = 0; b < count && breaks[b] < t1; b++)
    if (!whole(breaks[b], h)) return b;
  return count;
}

/* Does h = first break / m serve? */
static bool serves(size_t count, const sunrealtype *breaks, sunrealtype t1, bool divides,
                   sunrealtype h)
{
  return stf_break_inside(count, breaks, t1, h) == count && (!divides || whole(t1, h));
}

sunrealtype stf_break_step(size_t count, const sunrealtype *breaks, sunrealtype t1,
                           sunrealtype h)
{
  if (!count || breaks[0] >= t1) return h;
  for (int divides = 1; divides >= 0; divides--) {
    const sunrealtype m = fmax(1, round(breaks[0] / h));
    for (sunrealtype away = 0; breaks[0] / (m + away) >= SHORTEST * h; away++) {
      const sunrealtype shorter = breaks[0] / (m + away),
                        longer = m > away ? breaks[0] / (m - away) : INFINITY;
      if (divides && shorter < SHORTER * h && longer > LONGER * h) break;
      if (serves(count, breaks, t1, divides, shorter)) return shorter;
      if (longer <= LONGER * h && serves(count, breaks, t1, divides, longer)) return longer;
    }
  }
  return NAN;
}

/* ---- segments ------------------------------------------------------------------------------------ */

/* The order of backward differentiation, 1 for Runge-Kutta methods; 0: there is no second run. */
static int order_of(const stf_measure *w, int *order)
{
  steif_spec spec;
  int stages;
  *order = 0;
  STEIF_TRY(stf_recurrence_of(w->ctx, w->query->method, &stages));
  if (!stages) return STEIF_OK;
  STEIF_TRY(steif_spec_parse(w->ctx, w->query->method, &spec));
  *order = 1;
  return strcmp(spec.name, "bdf") ? STEIF_OK : stf_spec_int(w->ctx, &spec, "p", 1, 6, 2, order);
}

/* Does the run begin anew at breaks, `inside` of which lie in the interval? */
static int begins_anew(stf_measure *w, size_t inside, int order)
{
  const steif_weak_query *q = w->query;
  const sunrealtype t1 = (sunrealtype)w->subject.weight.t1;
  const bool can = w->cq ? order > 0 : order == 1,
             meshed = stf_break_inside(q->break_count, q->breaks, t1, w->h) == q->break_count;
  w->mesh.able = can;
  if (!inside) return STEIF_OK;
  STEIF_CHECK(can || !q->restart, w->ctx, STEIF_UNSUPPORTED,
              "runs restart at breaks of f with one-step methods and with convolution "
              "quadrature (.start = \"cq\"), not with '%s'",
              q->method);
  w->mesh.anew = can && (q->restart || (w->cq ? q->h == 0 || meshed : q->h == 0 && !meshed));
  return STEIF_OK;
}

/* Steps near w->h from break to break, at least `least` in each segment. */
static int divide(stf_measure *w, size_t inside, size_t least)
{
  const sunrealtype *breaks = w->query->breaks;
  sunrealtype longest = 0;
  for (size_t i = 0; i <= inside; i++) {
    stf_segment *s = w->mesh.segment + i;
    s->from = i ? (long double)breaks[i - 1] : 0;
    s->to = i < inside ? (long double)breaks[i] : w->subject.weight.t1;
    s->steps = (size_t)ceill((s->to - s->from) / (long double)w->h * (1 - (long double)WHOLE));
    if (s->steps < least) s->steps = least;
    s->h = (s->to - s->from) / (long double)s->steps;
    longest = fmax(longest, (sunrealtype)s->h);
    STEIF_CHECK(ldexpl(s->h, 1 - (int)w->query->rows) > (long double)RESOLVED * s->to, w->ctx,
                STEIF_BAD_INPUT,
                "there is no room for steps between t = %.12Lg and %.12Lg: declare one break "
                "instead of breaks so near",
                s->from, s->to);
  }
  w->h = longest;
  return STEIF_OK;
}

int stf_mesh_open(stf_measure *w)
{
  const steif_weak_query *q = w->query;
  const long double t1 = w->subject.weight.t1;
  size_t inside = 0;
  int order;
  while (inside < q->break_count && (long double)q->breaks[inside] < t1) inside++;
  STEIF_TRY(order_of(w, &order));
  STEIF_TRY(begins_anew(w, inside, order));
  w->mesh.count = w->mesh.anew ? inside + 1 : 1;
  w->mesh.segment = stf_allocate(w->ctx, w->mesh.count, sizeof *w->mesh.segment);
  if (!w->mesh.segment) return STEIF_NO_MEMORY;
  const size_t steps = (size_t)ceil((sunrealtype)t1 / w->h * (1 - WHOLE));
  *w->mesh.segment = (stf_segment){0, (long double)w->h * (long double)steps, w->h, steps};
  if (!w->mesh.anew) return STEIF_OK;
  const int k = w->subject.index, layer = k > 1 ? order * (k - 1) + order + 1 : 2;
  w->mesh.ends = w->cq ? order : 0;
  return divide(w, inside, (size_t)(w->cq && layer < WEIGHTED ? WEIGHTED : layer));
}

stf_segment stf_measure_segment(const stf_measure *w, size_t i)
{
  stf_segment s = w->mesh.segment[i];
  s.h = ldexpl(s.h, -w->halvings);
  if (w->mesh.anew)
    s.steps <<= w->halvings;
  else {
    s.steps = stf_measure_steps(w);
    s.to = s.h * (long double)s.steps;
  }
  return s;
}

sunrealtype stf_measure_step(const stf_measure *w) { return ldexp(w->h, -w->halvings); }

size_t stf_measure_steps(const stf_measure *w)
{
  return (size_t)ceil((sunrealtype)w->subject.weight.t1 / stf_measure_step(w) * (1 - WHOLE));
}

void stf_mesh_say(const stf_mesh *mesh, char *text, size_t room)
{
  size_t used = 0;
  *text = 0;
  if (!mesh->anew) return;
  used = (size_t)snprintf(text, room, "restarts at each break:");
  for (size_t i = 0; i < mesh->count && i < TOLD && used < room; i++)
    used += (size_t)snprintf(text + used, room - used, "%s %zu steps of %.3Lg to t = %.6Lg",
                             i ? "," : "", mesh->segment[i].steps, mesh->segment[i].h,
                             mesh->segment[i].to);
  if (mesh->count > TOLD && used < room) snprintf(text + used, room - used, ", ...");
}
