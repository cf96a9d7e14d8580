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

/* Nearer nodes have rounding only: what interpolants miss was small, and errors have grown since. */
static bool past_best(const stf_total_derivatives *l, const sunrealtype *best,
                      const sunrealtype *now)
{
  static const sunrealtype small = 1e-9, grown = 1e3;
  for (int p = 1; p <= l->order; p++)
    if (now[p] >= 0 && !(best[p] * pow(l->delta[p], p) < small && now[p] > grown * best[p]))
      return false;
  return true;
}

int stf_total_derivatives_choose(stf_total_derivatives *l, const stf_curve *c,
                                 const sunrealtype *scale, const int *order)
{
  sunrealtype best[STF_DEEPEST + 2], now[STF_DEEPEST + 2];
  bool found = false;
  if (l->order == 0) return STEIF_OK;
  const sunrealtype longest = 100 / (l->slowest * c->tau);
  const sunrealtype shortest = 1e-5 / (l->fastest * c->tau);
  for (int p = 1; p <= l->order; p++) l->delta[p] = 0, best[p] = INFINITY;
  for (sunrealtype delta = longest; delta >= shortest; delta *= 0.6) {
    const int code =
      stf_curve_residual(l->point, c, &l->rule, delta, l->values, l->rows, l->tail);
    if (code < 0) return code;
    for (int p = 1; p <= l->order && !code; p++) {
      now[p] = error(l, scale, order, p, delta);
      if (now[p] >= 0 && now[p] < best[p]) best[p] = now[p], l->delta[p] = delta;
      found = true;
    }
    if (!code && past_best(l, best, now)) break;
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
  for (int p = 1; p <= l->order; p++) {
    if (!(l->delta[p] > 0)) continue; /* no equation has this order */
    STEIF_TRY(approach(l, c, p));
    memcpy(out + (size_t)p * n, l->rows + (size_t)p * n, n * sizeof *out);
  }
  return STEIF_OK;
}
