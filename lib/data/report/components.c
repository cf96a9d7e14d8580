/* components.c: the first components of a solution over time as a picture.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "report.h"
#include <math.h>
#include <stdio.h>

enum { CURVES = 8 };
static const double uneven = 100; /* sizes that differ by more than this do not fit one axis */
static const double long_time =
  1e4; /* a stiff run that lasts longer has its layers on a log axis */

/* y_k of all rows; the largest finite |y_k|. */
static double component(size_t count, size_t n, const double *rows, size_t k, double *y)
{
  double most = 0;
  for (size_t i = 0; i < count; i++) {
    y[i] = rows[i * n + k];
    if (isfinite(y[i])) most = fmax(most, fabs(y[i]));
  }
  return most;
}

/* Are components of very different size to be drawn as parts of their largest values? */
static bool scaled(size_t curves, const double *most)
{
  double low = INFINITY, high = 0;
  for (size_t k = 0; k < curves; k++) {
    high = fmax(high, most[k]);
    if (most[k] > 0) low = fmin(low, most[k]);
  }
  return high > uneven * low;
}

static void divide(size_t count, double *y, double by)
{
  for (size_t i = 0; i < count; i++) y[i] /= by;
}

int steif_plot_components(steif_context *ctx, const char *title, size_t count, size_t n,
                          const double *t, const double *y, const char *path)
{
  const size_t curves = n < CURVES ? n : CURVES;
  double most[CURVES], *x = stf_allocate(ctx, count * curves + 1, sizeof *x);
  char label[CURVES][32];
  steif_curve curve[CURVES];
  if (!x) return STEIF_NO_MEMORY;
  for (size_t k = 0; k < curves; k++) most[k] = component(count, n, y, k, x + k * count);
  const bool parts = scaled(curves, most);
  for (size_t k = 0; k < curves; k++) {
    const bool part = parts && most[k] > 0;
    if (part) divide(count, x + k * count, most[k]);
    snprintf(label[k], sizeof label[k], part ? "y%zu / %.3g" : "y%zu", k + 1, most[k]);
    curve[k] = (steif_curve){label[k], count, t, x + k * count, 0};
  }
  const steif_plot plot = {.title = title,
                           .x_label = "t",
                           .y_label = curves < n ? "the first components of y" : "y",
                           .log_x = count > 0 && t[count - 1] >= long_time,
                           .count = curves,
                           .curve = curve};
  const int code = steif_plot_save(ctx, &plot, path);
  stf_release(ctx, x);
  return code;
}
