/* taylor_curve.c: F and its derivatives along a curve. Order 0 is F itself; the others are
 * fitted through nodes whose distance is chosen, for each order, to balance what the
 * interpolant misses against rounding: (tail + eps scale) / delta^order is made small.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "total_derivatives.h"
#include <math.h>
#include <string.h>

enum { NODES = 13, NEARER = 6 };

int stf_total_derivatives_open(stf_pool *pool, stf_point *point, int order,
                               stf_total_derivatives *l)
{
  const size_t n = point->n;
  *l = (stf_total_derivatives){.point = point, .order = order};
  stf_chebyshev_open(&l->rule, NODES, order);
  l->values = stf_pool_array(pool, 2 * NODES * n, sizeof *l->values);
  l->still = l->values ? l->values + NODES * n : NULL;
  l->rows = stf_pool_array(pool, (size_t)(order + 1) * n, sizeof *l->rows);
  l->tail = stf_pool_array(pool, n, sizeof *l->tail);
  return l->values && l->rows && l->tail ? STEIF_OK : STEIF_NO_MEMORY;
}

/* The largest error of an equation of this order, relative to its terms; negative: none
 * has it. */
static sunrealtype error(const stf_total_derivatives *l, const sunrealtype *scale,
                         const int *order, int p, sunrealtype delta)
{
  sunrealtype worst = -1;
  for (size_t i = 0; i < l->point->n; i++) {
    if (order && order[i] != p) continue;
    const sunrealtype size = scale[i] > 0 ? scale[i] : 1;
    worst = fmax(worst, l->tail[i] / size);
  }
  if (worst < 0) return -1;
  return stf_chebyshev_growth(&l->rule, p) * (worst + STF_EPS) / pow(delta, p);
}

/* Do the nodes follow how the equations of this order vary? Where they do not, the fit has a small slope that says
 * nothing: what oscillates often between two nodes differs by as much as over all of them. */
static bool resolved(const stf_total_derivatives *l, const sunrealtype *scale, const int *order,
                     int p)
{
  static const sunrealtype followed = 1e-2;
  const size_t n = l->point->n;
  for (size_t i = 0; i < n; i++) {
    if (order && order[i] != p) continue;
    sunrealtype low = l->values[i], high = low;
    for (size_t k = 1; k < NODES; k++) {
      low = fmin(low, l->values[k * n + i]);
      high = fmax(high, l->values[k * n + i]);
    }
    if (l->tail[i] > followed * (high - low) + 64 * STF_EPS * scale[i]) return false;
  }
  return true;
}

/* Have equations of this order the same values where t stays? */
static bool without_t(const stf_total_derivatives *l, const int *order, int p)
{
  const size_t n = l->point->n;
  for (size_t k = 0; k < NODES * n; k++)
    if ((!order || order[k % n] == p) && l->values[k] != l->still[k]) return false;
  return true;
}

/* The best nodes of an order so far. */
typedef struct choice {
  sunrealtype error;
  bool resolved;
  stf_window window;
} choice;

/* Nearer nodes have rounding only: what interpolants miss was small, and errors have grown since. */
static bool past_best(const stf_total_derivatives *l, const choice *best,
                      const sunrealtype *now)
{
  static const sunrealtype small = 1e-9, grown = 1e3;
  for (int p = 1; p <= l->order; p++)
    if (now[p] >= 0 &&
        !(best[p].resolved && best[p].error * pow(best[p].window.delta, p) < small &&
          now[p] > grown * best[p].error))
      return false;
  return true;
}

/* E and B do not show how fast F changes with t alone: thousands of periods may fit into the interval. */
static sunrealtype fastest_change(const stf_total_derivatives *l)
{
  static const sunrealtype periods = 1e4;
  const sunrealtype length = l->point->problem.t1 - l->point->t;
  return length > 0 ? fmax(l->fastest, periods / length) : l->fastest;
}

static void take_better(const choice *new, choice *best)
{
  if (new->resolved < best->resolved) return;
  if (new->resolved > best->resolved || new->error < best->error) *best = *new;
}

/* One way to lay nodes: beyond breaks, or not. */
typedef struct search {
  const stf_curve *curve;
  const sunrealtype *scale;
  const int *order;
  bool beyond, found;
  choice best[STF_DEEPEST + 2];
} search;

static void compare(stf_total_derivatives *l, search *x, sunrealtype delta, sunrealtype *now)
{
  for (int p = 1; p <= l->order; p++) {
    now[p] = error(l, x->scale, x->order, p, delta);
    if (now[p] < 0 || (x->beyond && !without_t(l, x->order, p))) continue;
    const choice new = {
      now[p], resolved(l, x->scale, x->order, p), {delta, l->rule.at, x->beyond}};
    take_better(&new, &x->best[p]);
  }
}

/* All nodes once with times beyond breaks, and once at t. */
static int sample_beyond(stf_total_derivatives *l, const stf_curve *c, sunrealtype delta)
{
  stf_point *s = l->point;
  stf_curve still = *c;
  still.still = true;
  STEIF_TRY(stf_curve_residual(s, &still, &l->rule, delta, l->still, NULL, NULL));
  const sunrealtype from = s->from, to = s->to;
  s->from = -INFINITY, s->to = INFINITY;
  const int code = stf_curve_residual(s, c, &l->rule, delta, l->values, NULL, l->tail);
  s->from = from, s->to = to;
  return code;
}

static int look(stf_total_derivatives *l, search *x, sunrealtype longest, sunrealtype shortest)
{
  sunrealtype now[STF_DEEPEST + 2];
  stf_point *s = l->point;
  x->found = false;
  for (int p = 1; p <= l->order; p++) x->best[p] = (choice){.error = INFINITY};
  for (sunrealtype delta = longest; delta >= shortest; delta *= 0.6) {
    const sunrealtype at = x->beyond ? 0 : stf_curve_place(s, x->curve, delta);
    if (at != l->rule.at) stf_chebyshev_about(&l->rule, at);
    const int code =
      x->beyond ? sample_beyond(l, x->curve, delta)
                : stf_curve_residual(s, x->curve, &l->rule, delta, l->values, NULL, l->tail);
    if (code < 0) return code;
    if (code) continue;
    x->found = true;
    compare(l, x, delta, now);
    if (past_best(l, x->best, now)) break;
  }
  return STEIF_OK;
}

/* l->rows by Taylor coefficients; sigma is s/tau. */
static int series(stf_total_derivatives *l, const stf_curve *c)
{
  const stf_point *s = l->point;
  const size_t n = s->n, orders = (size_t)l->order + 1;
  sunrealtype *y = l->values, power = 1;
  for (size_t p = 0; p <= orders; p++, power *= c->tau)
    for (size_t j = p * n; j < (p + 1) * n; j++) y[j] = c->z[j] / power;
  STEIF_TRY(s->taylor(s->ctx, &s->problem, c->t, l->order, y, l->rows));
  power = 1;
  for (size_t p = 0; p < orders; p++, power *= c->tau)
    for (size_t j = p * n; j < (p + 1) * n; j++) l->rows[j] *= power;
  return STEIF_OK;
}

/* Are there Taylor coefficients here, of the F that the callback has? A condition may be kept as it was before. */
static int look_at_series(stf_total_derivatives *l, const stf_curve *c,
                          const sunrealtype *scale)
{
  static const sunrealtype rounding = 1e-10;
  stf_point *s = l->point;
  sunrealtype *y = s->scratch, *yp = y + s->n, *F = l->values;
  l->exact = false;
  if (!s->taylor || c->count < l->order + 2 || l->order + 2 > NODES) return STEIF_OK;
  int code = series(l, c);
  stf_curve_at(c, s->n, 0, y, yp);
  if (!code) code = stf_point_residual(s, c->t, y, yp, F);
  if (code) return code < 0 ? code : STEIF_OK;
  l->exact = true;
  for (size_t i = 0; i < s->n; i++)
    l->exact = l->exact && fabs(F[i] - l->rows[i]) <= rounding * fmax(scale[i], fabs(F[i]));
  return STEIF_OK;
}

/* In parts between breaks, and beyond them where these are in the way. */
static int choose(stf_total_derivatives *l, search *x)
{
  const sunrealtype tau = x->curve->tau, room = stf_curve_room(l->point, x->curve);
  const sunrealtype longest = 100 / (l->slowest * tau), widest = fmin(longest, room);
  const sunrealtype shortest = 1e-5 / (fastest_change(l) * tau);
  search other = *x;
  other.beyond = true;
  STEIF_TRY(look(l, x, widest, fmin(shortest, widest)));
  if (stf_curve_place(l->point, x->curve, widest) != 0 || widest < longest)
    STEIF_TRY(look(l, &other, longest, shortest));
  else
    other.found = false;
  for (int p = 1; p <= l->order; p++) {
    if (other.found) take_better(&other.best[p], &x->best[p]);
    l->window[p] = x->best[p].window;
    if (room < longest && !l->window[p].beyond && l->window[p].delta > 0.5 * room)
      l->narrow = true, l->noise = fmax(l->noise, x->best[p].error * l->rule.middle[p]);
  }
  return x->found || other.found ? STEIF_OK : STEIF_RETRY;
}

int stf_total_derivatives_choose(stf_total_derivatives *l, const stf_curve *c,
                                 const sunrealtype *scale, const int *order)
{
  search x = {.curve = c, .scale = scale, .order = order};
  l->narrow = false, l->noise = 0;
  if (l->order == 0) return STEIF_OK;
  STEIF_TRY(look_at_series(l, c, scale));
  return l->exact ? STEIF_OK : choose(l, &x);
}

bool stf_total_derivatives_fit(const stf_total_derivatives *l, const stf_curve *c)
{
  for (int p = 1; p <= l->order; p++) {
    const stf_window *w = &l->window[p];
    if (!(w->delta > 0)) continue;
    if (w->at != 0 || w->delta > stf_curve_room(l->point, c) ||
        stf_curve_place(l->point, c, w->delta) != 0)
      return false;
  }
  return true;
}

/* Nodes outside of the domain of F come nearer. */
static int approach(stf_total_derivatives *l, const stf_curve *c, int p)
{
  int code = STEIF_RETRY;
  stf_window *w = &l->window[p];
  stf_curve curve = *c;
  curve.still = w->beyond;
  if (w->at != l->rule.at) stf_chebyshev_about(&l->rule, w->at);
  for (int k = 0; k < NEARER && code > 0; k++) {
    code = stf_curve_residual(l->point, &curve, &l->rule, w->delta, l->values, l->rows, NULL);
    if (code > 0) w->delta /= 4;
  }
  return code;
}

int stf_total_derivatives_evaluate(stf_total_derivatives *l, const stf_curve *c,
                                   sunrealtype *out)
{
  const size_t n = l->point->n;
  sunrealtype *y = l->point->scratch, *yp = y + n;
  stf_curve_at(c, n, 0, y, yp);
  STEIF_TRY(stf_point_residual(l->point, c->t, y, yp, out));
  if (l->exact) {
    STEIF_TRY(series(l, c));
    memcpy(out + n, l->rows + n, (size_t)l->order * n * sizeof *out);
    return STEIF_OK;
  }
  for (int p = 1; p <= l->order; p++) {
    if (!(l->window[p].delta > 0)) continue; /* no equation has this order */
    STEIF_TRY(approach(l, c, p));
    memcpy(out + (size_t)p * n, l->rows + (size_t)p * n, n * sizeof *out);
  }
  return STEIF_OK;
}
