/* curves.c: pictures of errors against steps or time, and of work against precision.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "curves.h"
#include <math.h>

void errors_open(error_curves *e, const char *label)
{
  if (e->count == ERRORS) return;
  e->curve[e->count].label = label;
  e->curve[e->count].count = 0;
  e->count++;
}

void errors_add(error_curves *e, double x, double error)
{
  const size_t k = e->count - 1, i = e->curve[k].count;
  if (i == ERROR_POINTS) return;
  e->curve[k].x[i] = x;
  e->curve[k].error[i] = fabs(error);
  e->curve[k].count++;
}

int errors_plot(const struct call *call, const error_curves *e, const char *path)
{
  steif_curve curve[ERRORS];
  for (size_t k = 0; k < e->count; k++)
    curve[k] =
      (steif_curve){e->curve[k].label, e->curve[k].count, e->curve[k].x, e->curve[k].error, 1};
  const steif_plot plot = {.title = e->title,
                           .x_label = e->over_time ? "t" : "h",
                           .y_label = e->y_label,
                           .log_x = !e->over_time,
                           .log_y = 1,
                           .count = e->count,
                           .curve = curve};
  return save_plot(call, &plot, path);
}

void work_open(work_curves *w, const char *method)
{
  if (w->count == WORDS) return;
  w->label[w->count] = method;
  w->first[w->count] = w->points;
  w->count++;
}

void work_add(work_curves *w, const outcome *o)
{
  if (!o->known || w->points == WORK_POINTS) return;
  w->digits[w->points] = o->mescd;
  w->seconds[w->points] = o->stats.cpu_s;
  w->points++;
}

/* Methods without a point are left out. */
int work_plot(const struct call *call, const work_curves *w, const char *problem,
              const char *path)
{
  steif_curve curve[WORDS];
  char title[160], axis[160];
  size_t count = 0;
  for (size_t k = 0; k < w->count; k++) {
    const size_t first = w->first[k], end = k + 1 < w->count ? w->first[k + 1] : w->points;
    if (first == end) continue;
    curve[count++] =
      (steif_curve){w->label[k], end - first, w->digits + first, w->seconds + first, 1};
  }
  snprintf(title, sizeof title, "Work against precision: %s%s%s", problem, *w->note ? ", " : "",
           w->note);
  snprintf(axis, sizeof axis, "digits (mescd)%s%s", *w->measured ? "; " : "", w->measured);
  const steif_plot plot = {.title = title,
                           .x_label = axis,
                           .y_label = "processor seconds",
                           .log_y = 1,
                           .count = count,
                           .curve = curve};
  return save_plot(call, &plot, path);
}
