/* special_series.c: Taylor coefficients of functions u(a) with u' = q(a) a', q elementary: inverse
 * functions, erf, the angle, and tables.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "series.h"
#include <math.h>

/* u' = a' q from u_0: k u_k = sum_{j=1..k} j a_j q_{k-j}. */
static void integrate(int n, const stf_series *a, const stf_series *q, double u0, stf_series *u)
{
  u->c[0] = u0;
  for (int k = 1; k <= n; k++) {
    double sum = 0;
    for (int j = 1; j <= k; j++) sum += j * a->c[j] * q->c[k - j];
    u->c[k] = sum / k;
  }
}

/* w = one + sign a^2 */
static void square(int n, const stf_series *a, double one, double sign, stf_series *w)
{
  stf_series_times(n, a, a, w);
  for (int k = 0; k <= n; k++) w->c[k] *= sign;
  w->c[0] += one;
}

const char *stf_special_series(int kind, int n, const stf_series *a, stf_series *u,
                               stf_series *w)
{
  const double x = a->c[0];
  stf_series *q = w + 1;
  const char *wrong = NULL;
  const double value = stf_operate(kind, x, 0, 0);
  if (!isfinite(value)) return "a function outside its domain";
  switch (kind) {
  case STF_OP_ASIN:
  case STF_OP_ACOS: square(n, a, 1, -1, w); break;
  case STF_OP_ASINH: square(n, a, 1, 1, w); break;
  case STF_OP_ACOSH: square(n, a, -1, 1, w); break;
  case STF_OP_ATANH: square(n, a, 1, -1, w); break;
  case STF_OP_ERF: square(n, a, 0, -1, w); break;
  default: return "a function without a series";
  }
  if (kind == STF_OP_ERF)
    stf_series_exp(n, w, q);
  else
    wrong = stf_series_power(n, w, kind == STF_OP_ATANH ? -1 : -0.5, q);
  const double factor = kind == STF_OP_ACOS ? -1 : kind == STF_OP_ERF ? 2 / sqrt(acos(-1)) : 1;
  for (int k = 0; !wrong && k <= n; k++) q->c[k] *= factor;
  if (!wrong) integrate(n, a, q, value, u);
  return wrong;
}

/* (a' b - a b')/(a^2 + b^2) is the derivative of the angle of (b, a). */
const char *stf_angle_series(int n, const stf_series *a, const stf_series *b, stf_series *u,
                             stf_series *w)
{
  stf_series *square_sum = w, *turn = w + 1, *rate = w + 2;
  stf_series_times(n, a, a, square_sum);
  stf_series_times(n, b, b, turn);
  for (int k = 0; k <= n; k++) square_sum->c[k] += turn->c[k];
  for (int k = 0; k <= n; k++) {
    turn->c[k] = 0;
    for (int j = 0; j < k; j++)
      turn->c[k - 1] += (k - j) * (a->c[k - j] * b->c[j] - b->c[k - j] * a->c[j]);
  }
  u->c[0] = atan2(a->c[0], b->c[0]);
  if (n && stf_series_over(n - 1, turn, square_sum, rate)) return "the angle of zero";
  for (int k = 1; k <= n; k++) u->c[k] = rate->c[k - 1] / k;
  return NULL;
}

/* In the interval of the table that a enters. */
const char *stf_lookup_series(const stf_lookup *l, int n, const stf_series *a, int sign,
                              stf_series *u, stf_series *w)
{
  const double x = a->c[0];
  size_t i = 0;
  stf_series_constant(n, stf_lookup_value(l, x), u);
  if (!isfinite(u->c[0])) return "a table outside its range";
  const double from = l->x[0], to = l->x[l->count - 1];
  if (x < from || x > to || (x == from && sign < 0) || (x == to && sign > 0)) return NULL;
  while (i + 2 < l->count && (l->x[i + 1] < x || (l->x[i + 1] == x && sign > 0))) i++;
  if (l->kind == STF_STEPS_TABLE) {
    u->c[0] = l->y[i];
    return NULL;
  }
  if (l->kind == STF_LINES_TABLE) {
    for (int k = 0; k <= n; k++)
      u->c[k] = l->slope[i] * (a->c[k] - (k ? 0 : l->x[i])) + (k ? 0 : l->y[i]);
    return NULL;
  }
  const double h = l->x[i + 1] - l->x[i], rise = l->y[i + 1] - l->y[i];
  const double left = l->kind ? h * l->slope[i] - rise : 0,
               right = l->kind ? rise - h * l->slope[i + 1] : 0;
  stf_series *s = w, *rest = w + 1, *mix = w + 2, *product = w + 3;
  for (int k = 0; k <= n; k++) {
    s->c[k] = (a->c[k] - (k ? 0 : l->x[i])) / h;
    rest->c[k] = (k ? 0 : 1) - s->c[k];
    mix->c[k] = left * rest->c[k] + right * s->c[k];
  }
  stf_series_times(n, s, rest, product);
  stf_series_times(n, product, mix, u);
  for (int k = 0; k <= n; k++) u->c[k] += rise * s->c[k] + (k ? 0 : l->y[i]);
  return NULL;
}
