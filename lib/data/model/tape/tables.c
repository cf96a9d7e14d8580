/* tables.c: functions given by nodes: linear, cubic and monotone, or steps.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "tape.h"
#include <math.h>

/* The interval of x: 0 .. count - 2. */
static size_t interval(const stf_lookup *l, double x)
{
  size_t low = 0, high = l->count - 1;
  while (high - low > 1) {
    const size_t middle = (low + high) / 2;
    if (l->x[middle] <= x)
      low = middle;
    else
      high = middle;
  }
  return low;
}

static bool outside(const stf_lookup *l, double x)
{
  return !(x >= l->x[0] && x <= l->x[l->count - 1]);
}

double stf_lookup_value(const stf_lookup *l, double x)
{
  if (!(x == x) || (l->error && outside(l, x))) return NAN;
  if (x <= l->x[0]) return l->y[0];
  if (x >= l->x[l->count - 1]) return l->y[l->count - 1];
  const size_t i = interval(l, x);
  const double h = l->x[i + 1] - l->x[i], s = (x - l->x[i]) / h, rise = l->y[i + 1] - l->y[i];
  if (l->kind == STF_STEPS_TABLE) return l->y[i];
  if (l->kind == STF_LINEAR_TABLE) return l->y[i] + s * rise;
  if (l->kind == STF_LINES_TABLE) return l->y[i] + l->slope[i] * (x - l->x[i]);
  const double a = h * l->slope[i] - rise, b = rise - h * l->slope[i + 1];
  return l->y[i] + s * rise + s * (1 - s) * (a * (1 - s) + b * s);
}

double stf_lookup_slope(const stf_lookup *l, double x)
{
  if (!(x == x) || (l->error && outside(l, x))) return NAN;
  if (x < l->x[0] || x >= l->x[l->count - 1] || l->kind == STF_STEPS_TABLE) return 0;
  const size_t i = interval(l, x);
  const double h = l->x[i + 1] - l->x[i], s = (x - l->x[i]) / h, rise = l->y[i + 1] - l->y[i];
  if (l->kind == STF_LINEAR_TABLE) return rise / h;
  if (l->kind == STF_LINES_TABLE) return l->slope[i];
  const double a = h * l->slope[i] - rise, b = rise - h * l->slope[i + 1];
  return (rise + (1 - 2 * s) * (a * (1 - s) + b * s) + s * (1 - s) * (b - a)) / h;
}
