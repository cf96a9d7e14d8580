/* curves.h: the pictures that several verbs draw.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CURVES_H
#define CURVES_H

#include "integration.h"

/* Errors of several methods against the step, log-log, or over time; |error| is drawn. */
enum { ERRORS = 8, HALVINGS = 40, ERROR_POINTS = 512 };
typedef struct error_curves {
  const char *title, *y_label;
  bool over_time;
  size_t count;
  struct {
    const char *label;
    size_t count;
    double x[ERROR_POINTS], error[ERROR_POINTS];
  } curve[ERRORS];
} error_curves;
/* A curve with one more label; points are added to the last one. */
void errors_open(error_curves *e, const char *label);
void errors_add(error_curves *e, double x, double error);
int errors_plot(const struct call *call, const error_curves *e, const char *path);

/* Work against precision: one curve of (mescd, cpu_s) per method. */
enum { WORK_POINTS = WORDS * REALS_MOST };
typedef struct work_curves {
  size_t count, points;
  const char *label[WORDS];
  char note[64], measured[96]; /* for title and axis: which build of SUNDIALS this is; "" */
  size_t first[WORDS];
  double digits[WORK_POINTS], seconds[WORK_POINTS];
} work_curves;
void work_open(work_curves *w, const char *method);
void work_add(work_curves *w, const outcome *o);
int work_plot(const struct call *call, const work_curves *w, const char *problem,
              const char *path);

#endif
