/* orders.c: errors of several methods by halved steps.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "experiment.h"
#include <math.h>
#include <steif/collection.h>
#include <steif/region.h>

static int line(stf_trial *t, const steif_problem *p, const stf_order_line *l)
{
  const stf_orders *d = t->data;
  steif_order_row row[STF_HALVINGS];
  steif_options o = steif_defaults();
  o.t1 = d->t1;
  o.newton = 1e-6;
  STEIF_TRY(steif_order_measure(t->ctx, p, l->method, &o, d->h, d->rows, row));
  STEIF_TRY(stf_curve(t, l->method, 1));
  for (size_t i = 0; i < d->rows; i++) {
    const sunrealtype known = l->error[i];
    STEIF_TRY(stf_find(t, l->method, row[i].h, "error", row[i].error, known > 0 ? known : NAN,
                       d->digits * known + d->floor));
    STEIF_TRY(stf_curve_point(t, row[i].h, row[i].error));
  }
  return STEIF_OK;
}

int stf_order_table(stf_trial *t)
{
  const stf_orders *d = t->data;
  steif_problem p;
  int code = steif_problem_find(t->ctx, d->problem, &p);
  for (size_t i = 0; code == STEIF_OK && i < d->lines; i++) code = line(t, &p, d->line + i);
  steif_problem_clear(t->ctx, &p);
  return code;
}
