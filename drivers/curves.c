/* curves.c: errors against steps, work against precision.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "curves.h"

void errors_open(error_curves *e, const char *label)
{
  if (e->count == ERRORS) return;
  e->curve[e->count].label = label;
  e->curve[e->count++].count = 0;
}

void errors_add(error_curves *e, double h, double error)
{
  const size_t k = e->count - 1, i = e->curve[k].count;
  if (i == HALVINGS) return;
  e->curve[k].h[i] = h, e->curve[k].error[i] = error < 0 ? -error : error;
  e->curve[k].count++;
}

int errors_plot(const struct call *call, const error_curves *e, const char *path)
{
  steif_curve curve[ERRORS];
  for (size_t k = 0; k < e->count; k++)
    curve[k] =
      (steif_curve){e->curve[k].label, e->curve[k].count, e->curve[k].h, e->curve[k].error, 1};
  const steif_plot plot = {e->title, "h", e->y_label, 1, 1, 0, e->count, curve};
  return save_plot(call, &plot, path);
}

void work_open(work_curves *w, const char *method)
{
  if (w->count == WORDS) return;
  w->label[w->count] = method;
  w->first[w->count++] = w->points;
}

void work_add(work_curves *w, const outcome *o)
{
  if (!o->known || w->points == WORK_POINTS) return;
  w->digits[w->points] = o->mescd;
  w->seconds[w->points++] = o->stats.cpu_s;
}

int work_plot(const struct call *call, const work_curves *w, const char *problem,
              const char *path)
{
  steif_curve curve[WORDS];
  char title[128];
  for (size_t k = 0; k < w->count; k++) {
    const size_t first = w->first[k], end = k + 1 < w->count ? w->first[k + 1] : w->points;
    curve[k] =
      (steif_curve){w->label[k], end - first, w->digits + first, w->seconds + first, 1};
  }
  snprintf(title, sizeof title, "Work against precision: %s", problem);
  const steif_plot plot = {title, "digits (mescd)", "processor seconds", 0, 1, 0, w->count,
                           curve};
  return save_plot(call, &plot, path);
}
