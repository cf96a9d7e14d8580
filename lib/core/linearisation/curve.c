/* taylor_fit.c: Taylor coefficients of F, E and F_y along a polynomial curve, from values at
 * Chebyshev nodes: interpolate in T_0 .. T_{m-1} and read off the powers of sigma. The
 * last coefficients of the T_k tell how far the interpolant is from F.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "curve.h"
#include <math.h>
#include <string.h>

/* E and F_y, equilibrated, may change by this much along a curve. */
static const sunrealtype variation = 0.3;

/* Errors of values, of size 1, in coefficient q. */
static sunrealtype weights(const stf_chebyshev *rule, int q)
{
  sunrealtype sum = 0;
  for (int i = 0; i < rule->m; i++) sum += fabs(rule->weight[q * rule->m + i]);
  return sum;
}

/* sum_k of the fit's coefficients times T_k(at + x), by powers of x. */
void stf_chebyshev_about(stf_chebyshev *rule, sunrealtype at)
{
  const sunrealtype pi = 3.14159265358979323846;
  const int m = rule->m;
  sunrealtype power[STF_CHEBYSHEV_NODES][STF_CHEBYSHEV_NODES] = {{1}, {at, 1}};
  rule->at = at;
  for (int k = 2; k < m; k++)
    for (int q = 0; q <= k; q++)
      power[k][q] =
        2 * at * power[k - 1][q] + (q ? 2 * power[k - 1][q - 1] : 0) - power[k - 2][q];
  memset(rule->weight, 0, sizeof rule->weight);
  for (int i = 0; i < m; i++) {
    const sunrealtype angle = (2 * i + 1) * pi / (2 * m);
    for (int k = 0; k < m; k++) {
      const sunrealtype share = (k ? 2.0 : 1.0) / m * cos(k * angle);
      for (int q = 0; q <= rule->order; q++) rule->weight[q * m + i] += share * power[k][q];
    }
  }
}

void stf_chebyshev_open(stf_chebyshev *rule, int m, int order)
{
  const sunrealtype pi = 3.14159265358979323846;
  *rule = (stf_chebyshev){.m = m, .order = order};
  for (int i = 0; i < m; i++) {
    const sunrealtype angle = (2 * i + 1) * pi / (2 * m);
    rule->node[i] = cos(angle);
    for (int k = m - 2; k < m; k++)
      rule->tail[(k - m + 2) * m + i] = (k ? 2.0 : 1.0) / m * cos(k * angle);
  }
  stf_chebyshev_about(rule, 0);
  for (int q = 0; q <= order; q++) rule->middle[q] = weights(rule, q);
}

sunrealtype stf_chebyshev_growth(const stf_chebyshev *rule, int q)
{
  return rule->at == 0 ? 1 : weights(rule, q) / rule->middle[q];
}

sunrealtype stf_curve_room(const stf_point *s, const stf_curve *c)
{
  return (s->to - s->from) / (2 * c->tau);
}

sunrealtype stf_curve_place(const stf_point *s, const stf_curve *c, sunrealtype delta)
{
  const sunrealtype low = (s->from - c->t) / c->tau, high = (s->to - c->t) / c->tau;
  const sunrealtype middle = low + delta > 0 ? low + delta : fmin(0, high - delta);
  return fmin(fmax(-middle / delta, -1), 1);
}

void stf_curve_at(const stf_curve *c, size_t n, sunrealtype sigma, sunrealtype *y,
                  sunrealtype *yp)
{
  for (size_t j = 0; j < n; j++) {
    sunrealtype value = 0, slope = 0;
    for (int k = c->count - 1; k >= 0; k--) {
      slope = slope * sigma + value;
      value = value * sigma + c->z[(size_t)k * n + j];
    }
    y[j] = value, yp[j] = slope / c->tau;
  }
}

/* out = factor * (weight_0 row_0 + weight_1 row_1 + ...) */
static void combine(size_t n, size_t m, const sunrealtype *weight, const sunrealtype *rows,
                    sunrealtype factor, sunrealtype *out)
{
  memset(out, 0, n * sizeof *out);
  for (size_t i = 0; i < m; i++)
    for (size_t j = 0; j < n; j++) out[j] += weight[i] * rows[i * n + j];
  for (size_t j = 0; j < n; j++) out[j] *= factor;
}

int stf_curve_residual(stf_point *s, const stf_curve *c, const stf_chebyshev *rule,
                       sunrealtype delta, sunrealtype *values, sunrealtype *out,
                       sunrealtype *tail)
{
  const size_t n = s->n, m = (size_t)rule->m;
  sunrealtype *y = s->scratch, *yp = s->scratch + n, factor = 1;
  for (size_t i = 0; i < m; i++) {
    const sunrealtype sigma = delta * (rule->node[i] - rule->at);
    stf_curve_at(c, n, sigma, y, yp);
    const sunrealtype t = c->still ? c->t : c->t + sigma * c->tau;
    STEIF_TRY(stf_point_residual(s, t, y, yp, values + i * n));
  }
  for (size_t q = 0; out && q <= (size_t)rule->order; q++, factor /= delta)
    combine(n, m, rule->weight + q * m, values, factor, out + q * n);
  for (size_t j = 0; tail && j < n; j++) {
    sunrealtype last[2] = {0, 0};
    for (size_t i = 0; i < 2 * m; i++) last[i / m] += rule->tail[i] * values[i % m * n + j];
    tail[j] = fmax(fabs(last[0]), fabs(last[1]));
  }
  return STEIF_OK;
}

/* -- matrices ---------------------------------------------------------------------------- */

/* E and F_y at the nodes: m matrices E, then m matrices F_y. */
static int sample(stf_point *s, const stf_curve *c, const stf_chebyshev *rule,
                  sunrealtype delta, sunrealtype *nodes)
{
  const size_t n = s->n, square = n * n, m = (size_t)rule->m;
  sunrealtype *y = s->scratch + 4 * n, *yp = s->scratch + 5 * n;
  for (size_t i = 0; i < m; i++) {
    const sunrealtype sigma = delta * (rule->node[i] - rule->at);
    stf_curve_at(c, n, sigma, y, yp);
    STEIF_TRY(stf_point_matrices(s, c->t + sigma * c->tau, y, yp, nodes + i * square,
                                 nodes + (m + i) * square));
  }
  return STEIF_OK;
}

/* Largest change of an entry over the nodes, against the largest of its row. */
static sunrealtype change(const stf_point *s, const stf_chebyshev *rule, sunrealtype tau,
                          const sunrealtype *nodes)
{
  const size_t n = s->n, square = n * n, m = (size_t)rule->m;
  sunrealtype *top = s->scratch, *move = s->scratch + n, worst = 0;
  memset(top, 0, 2 * n * sizeof *top);
  for (size_t k = 0; k < square; k++) {
    sunrealtype low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY}, size = 0;
    for (size_t i = 0; i < 2 * m; i++) {
      const sunrealtype x = nodes[i * square + k] / (i < m ? tau : 1);
      low[i / m] = fmin(low[i / m], x), high[i / m] = fmax(high[i / m], x);
      size = fmax(size, fabs(x));
    }
    const sunrealtype moved = high[0] - low[0] + high[1] - low[1];
    top[k % n] = fmax(top[k % n], size * s->size[k / n]);
    move[k % n] = fmax(move[k % n], moved * s->size[k / n]);
  }
  for (size_t i = 0; i < n; i++)
    if (top[i] > 0) worst = fmax(worst, move[i] / top[i]);
  return worst;
}

/* In a part between breaks that is shorter than all radii E and F_y are those at its ends beyond them. */
static int choose_nodes(stf_point *s, const stf_curve *c, stf_chebyshev *rule,
                        sunrealtype *nodes, sunrealtype *delta)
{
  static const sunrealtype radius[] = {0.3, 0.1, 0.03, 0.01, 3e-3, 1e-3, 3e-4};
  enum { COUNT = sizeof radius / sizeof *radius };
  const sunrealtype room = stf_curve_room(s, c);
  int code = STEIF_RETRY;
  for (int k = 0; k < COUNT; k++) {
    *delta = radius[k];
    if (*delta > room && radius[COUNT - 1] <= room) continue;
    const sunrealtype at = *delta > room ? 0 : stf_curve_place(s, c, *delta);
    if (at != rule->at) stf_chebyshev_about(rule, at);
    code = sample(s, c, rule, *delta, nodes);
    if (code < 0 || (!code && change(s, rule, c->tau, nodes) < variation)) break;
  }
  return code;
}

int stf_curve_matrices(stf_point *s, const stf_curve *c, stf_chebyshev *rule,
                       sunrealtype *nodes, sunrealtype *E, sunrealtype *B, sunrealtype *delta)
{
  const size_t square = s->n * s->n, m = (size_t)rule->m;
  STEIF_TRY(choose_nodes(s, c, rule, nodes, delta));
  sunrealtype factor = 1;
  for (size_t q = 0; q <= (size_t)rule->order; q++, factor /= *delta)
    for (size_t k = 0; k < square; k++) {
      sunrealtype sum[2] = {0, 0};
      for (size_t i = 0; i < m; i++) {
        sum[0] += rule->weight[q * m + i] * nodes[i * square + k];
        sum[1] += rule->weight[q * m + i] * nodes[(m + i) * square + k];
      }
      E[q * square + k] = sum[0] * factor, B[q * square + k] = sum[1] * factor;
    }
  return STEIF_OK;
}
