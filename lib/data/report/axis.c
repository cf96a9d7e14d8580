/* axis.c: ranges, pixels and ticks of one axis: steps of 1, 2 or 5 times a power of ten, decades
 * on log axes.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "report.h"
#include <math.h>

/* Beyond this the differences of two values may overflow. */
static const double huge = 1e300;

bool stf_axis_value(const stf_axis *axis, double value, double *coordinate)
{
  if (!isfinite(value) || fabs(value) > huge || (axis->log && value <= 0)) return false;
  *coordinate = axis->log ? log10(value) : value;
  return true;
}

double stf_axis_pixel(const stf_axis *axis, double coordinate)
{
  return axis->p0 + (axis->p1 - axis->p0) * ((coordinate - axis->lo) / (axis->hi - axis->lo));
}

/* A range that is a point is opened; what is left gets a margin of 4 %. A log axis spans 0.65
 * decades at least, so that two of the ticks 1 .. 9 are in it. */
static void widen(stf_axis *axis)
{
  const double size = fmax(fabs(axis->lo), fabs(axis->hi));
  double margin = 0.04 * (axis->hi - axis->lo);
  if (margin <= 1e-9 * size) margin = axis->log ? 0.5 : 0.1 * size;
  if (margin <= 0) margin = 0.5;
  axis->lo -= margin;
  axis->hi += margin;
  const double lacking = axis->log ? 0.65 - (axis->hi - axis->lo) : 0;
  if (lacking > 0) {
    axis->lo -= lacking / 2;
    axis->hi += lacking / 2;
  }
}

void stf_axis_range(stf_axis *axis, const steif_plot *plot, bool vertical)
{
  stf_axis other = {.log = vertical ? plot->log_x : plot->log_y};
  bool any = false;
  for (size_t k = 0; k < plot->count; k++)
    for (size_t i = 0; i < plot->curve[k].count; i++) {
      const double x = plot->curve[k].x[i], y = plot->curve[k].y[i];
      double v, unused;
      if (!stf_axis_value(axis, vertical ? y : x, &v)) continue;
      if (!stf_axis_value(&other, vertical ? x : y, &unused)) continue;
      if (!any || v < axis->lo) axis->lo = v;
      if (!any || v > axis->hi) axis->hi = v;
      any = true;
    }
  if (any)
    widen(axis);
  else {
    axis->lo = 0;
    axis->hi = 1;
  }
}

void stf_axis_equal(stf_axis *x, stf_axis *y)
{
  const double ux = (x->hi - x->lo) / fabs(x->p1 - x->p0);
  const double uy = (y->hi - y->lo) / fabs(y->p1 - y->p0);
  stf_axis *narrow = ux < uy ? x : y;
  const double middle = 0.5 * (narrow->lo + narrow->hi);
  const double half = 0.5 * fmax(ux, uy) * fabs(narrow->p1 - narrow->p0);
  narrow->lo = middle - half;
  narrow->hi = middle + half;
}

static stf_tick *next(stf_axis *axis, double at, bool major)
{
  if (axis->ticks == STF_TICKS) return NULL;
  stf_tick *tick = &axis->tick[axis->ticks++];
  *tick = (stf_tick){.at = at, .major = major};
  return tick;
}

/* The smallest of 1, 2, 5, 10 times a power of ten that is at least `raw`. */
static double step_above(double raw)
{
  const double power = pow(10, floor(log10(raw)));
  const double lead = raw / power;
  return power * (lead <= 1 ? 1 : lead <= 2 ? 2 : lead <= 5 ? 5 : 10);
}

/* Labels carry the decimals that the step needs, in units of 10^scale for very large and very
 * small numbers. */
static void linear(stf_axis *axis, int about)
{
  const double step = step_above((axis->hi - axis->lo) / about);
  const double size = fmax(fabs(axis->lo), fabs(axis->hi));
  const int magnitude = (int)floor(log10(size));
  axis->scale = magnitude >= 5 || magnitude <= -4 ? magnitude : 0;
  int decimals = axis->scale - (int)floor(log10(step) + 1e-9);
  if (decimals < 0) decimals = 0;
  if (decimals > 12) decimals = 12;
  const double unit = pow(10, axis->scale);
  const double first = ceil(axis->lo / step - 1e-9), last = floor(axis->hi / step + 1e-9);
  for (double k = first; k <= last && axis->ticks < STF_TICKS; k++) {
    stf_tick *tick = next(axis, k * step, true);
    stf_report_number(tick->label, sizeof tick->label, 'f', decimals, k * step / unit + 0.0);
  }
}

static void name_power(stf_tick *tick, int lead, int power)
{
  tick->decade = true;
  tick->lead = lead;
  tick->power = power;
}

/* Few decades: 1, 2, 5 (or 1 .. 9) times a power of ten are named. */
static void within(stf_axis *axis)
{
  const double span = axis->hi - axis->lo;
  for (double d = floor(axis->lo); d <= axis->hi; d++)
    for (int m = 1; m <= 9; m++) {
      const double at = d + log10(m);
      if (at < axis->lo || at > axis->hi) continue;
      const bool named = span < 0.7 || m == 1 || m == 2 || m == 5;
      stf_tick *tick = next(axis, at, named);
      if (!tick || !named) continue;
      if (fabs(d) > 3)
        name_power(tick, m, (int)lround(d));
      else
        stf_report_number(tick->label, sizeof tick->label, 'g', 3, pow(10, at));
    }
}

/* Decades, every so many of them when there are too many; 2 .. 9 between them when few. */
static void decades(stf_axis *axis, int about)
{
  const double span = axis->hi - axis->lo;
  double every = 1;
  while (span / every > about) every = every < 2 ? 2 : every < 5 ? 5 : every * 2;
  const double first = ceil(axis->lo / every - 1e-9), last = floor(axis->hi / every + 1e-9);
  for (double k = first; k <= last; k++) {
    stf_tick *tick = next(axis, k * every, true);
    if (tick) name_power(tick, 1, (int)lround(k * every));
  }
  if (span > 6) return;
  for (double d = floor(axis->lo); d <= axis->hi; d++)
    for (int m = 2; m <= 9; m++) {
      const double at = d + log10(m);
      if (at >= axis->lo && at <= axis->hi) next(axis, at, false);
    }
}

void stf_axis_ticks(stf_axis *axis, int about)
{
  axis->ticks = axis->scale = 0;
  if (!axis->log)
    linear(axis, about);
  else if (floor(axis->hi) - ceil(axis->lo) < 1)
    within(axis);
  else
    decades(axis, about);
}
