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
  l->values = stf_pool_array(pool, NODES * n, sizeof *l->values);
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
  return worst < 0 ? -1 : (worst + STF_EPS) / pow(delta, p);
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

/* The best nodes of an order so far. */
typedef struct choice {
  sunrealtype error;
  bool resolved;
} choice;

/* Nearer nodes have rounding only: what interpolants miss was small, and errors have grown since. */
static bool past_best(const stf_total_derivatives *l, const choice *best,
                      const sunrealtype *now)
{
  static const sunrealtype small = 1e-9, grown = 1e3;
  for (int p = 1; p <= l->order; p++)
    if (now[p] >= 0 && !(best[p].resolved && best[p].error * pow(l->delta[p], p) < small &&
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

static void compare(stf_total_derivatives *l, const sunrealtype *scale, const int *order,
                    sunrealtype delta, choice *best, sunrealtype *now)
{
  for (int p = 1; p <= l->order; p++) {
    now[p] = error(l, scale, order, p, delta);
    if (now[p] < 0) continue;
    const choice new = {now[p], resolved(l, scale, order, p)};
    if (new.resolved < best[p].resolved) continue;
    if (new.resolved > best[p].resolved || new.error < best[p].error)
      best[p] = new, l->delta[p] = delta;
  }
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

int stf_total_derivatives_choose(stf_total_derivatives *l, const stf_curve *c,
                                 const sunrealtype *scale, const int *order)
{
  choice best[STF_DEEPEST + 2];
  sunrealtype now[STF_DEEPEST + 2];
  bool found = false;
  if (l->order == 0) return STEIF_OK;
  STEIF_TRY(look_at_series(l, c, scale));
  if (l->exact) return STEIF_OK;
  const sunrealtype longest = 100 / (l->slowest * c->tau);
  const sunrealtype shortest = 1e-5 / (fastest_change(l) * c->tau);
  for (int p = 1; p <= l->order; p++) l->delta[p] = 0, best[p] = (choice){INFINITY, false};
  for (sunrealtype delta = longest; delta >= shortest; delta *= 0.6) {
    const int code = stf_curve_residual(l->point, c, &l->rule, delta, l->values, NULL, l->tail);
    if (code < 0) return code;
    if (code) continue;
    found = true;
    compare(l, scale, order, delta, best, now);
    if (past_best(l, best, now)) break;
  }
  return found ? STEIF_OK : STEIF_RETRY;
}

/* Nodes outside of the domain of F come nearer. */
static int approach(stf_total_derivatives *l, const stf_curve *c, int p)
{
  int code = STEIF_RETRY;
  for (int k = 0; k < NEARER && code > 0; k++) {
    code = stf_curve_residual(l->point, c, &l->rule, l->delta[p], l->values, l->rows, NULL);
    if (code > 0) l->delta[p] /= 4;
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
    if (!(l->delta[p] > 0)) continue; /* no equation has this order */
    STEIF_TRY(approach(l, c, p));
    memcpy(out + (size_t)p * n, l->rows + (size_t)p * n, n * sizeof *out);
  }
  return STEIF_OK;
}
