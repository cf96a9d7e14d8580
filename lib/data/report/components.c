/* components.c: the first components of a solution over time as a picture, those of like size in one panel.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "report.h"
#include <math.h>
#include <stdio.h>

enum { CURVES = 8, LABEL = 64 };
static const double uneven = 30; /* sizes that differ by more than this do not fit one axis */
static const double long_time =
  1e4; /* a stiff run that lasts longer has its layers on a log axis */

struct component {
  double size, *y; /* the largest finite |y|, and y in all rows */
  int panel;       /* -1: none so far */
  char label[LABEL];
};

static void take(struct component *c, size_t count, size_t n, size_t k, const double *rows)
{
  c->size = 0;
  c->panel = -1;
  for (size_t i = 0; i < count; i++) {
    c->y[i] = rows[i * n + k];
    if (isfinite(c->y[i])) c->size = fmax(c->size, fabs(c->y[i]));
  }
}

/* From the largest size down; what is 0 throughout goes with the first. Returns how many panels. */
static size_t distribute(size_t curves, struct component *c)
{
  size_t panels = 0;
  for (size_t left = curves; left; panels++) {
    double top = 0;
    for (size_t k = 0; k < curves; k++)
      if (c[k].panel < 0) top = fmax(top, c[k].size);
    for (size_t k = 0; k < curves; k++) {
      const bool fits = c[k].size * uneven >= top || (panels == 0 && c[k].size == 0);
      if (c[k].panel >= 0 || !fits) continue;
      c[k].panel = (int)panels;
      left--;
    }
  }
  return panels;
}

static steif_plot panel_of(int panel, size_t curves, const struct component *c, size_t count,
                           const double *t, steif_curve *curve)
{
  steif_plot plot = {.log_x = count > 0 && t[count - 1] >= long_time, .curve = curve};
  for (size_t k = 0; k < curves; k++)
    if (c[k].panel == panel)
      curve[plot.count++] = (steif_curve){c[k].label, count, t, c[k].y, 0};
  plot.y_label = plot.count == 1 ? curve->label : "";
  return plot;
}

int steif_plot_components(steif_context *ctx, const char *title, size_t count, size_t n,
                          const char *const *names, const double *t, const double *y,
                          const char *path)
{
  const size_t curves = n < CURVES ? n : CURVES;
  struct component c[CURVES];
  steif_curve curve[CURVES];
  steif_plot panel[CURVES];
  if (!ctx) return STEIF_BAD_INPUT;
  double *x = stf_allocate(ctx, count * curves + 1, sizeof *x);
  if (!x) return STEIF_NO_MEMORY;
  for (size_t k = 0; k < curves; k++) {
    c[k].y = x + k * count;
    take(c + k, count, n, k, y);
    if (names)
      snprintf(c[k].label, LABEL, "%s", names[k]);
    else
      snprintf(c[k].label, LABEL, "y%zu", k + 1);
  }
  const size_t panels = distribute(curves, c);
  for (size_t i = 0, used = 0; i < panels; used += panel[i++].count)
    panel[i] = panel_of((int)i, curves, c, count, t, curve + used);
  panel[0].title = title;
  panel[panels - 1].x_label = curves < n ? "t (the first components are shown)" : "t";
  const int code = steif_panels_save(ctx, panels, panel, path);
  stf_release(ctx, x);
  return code;
}
