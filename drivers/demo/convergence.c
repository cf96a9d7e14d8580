/* convergence.c: weak convergence, where there is any, on N x' + x = f, index 2 to 4.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "demo.h"
#include "weak.h"

static const struct {
  const char *label, *method, *start;
} methods[] = {
  {"be", "be", NULL},
  {"bdf:p=2, ramp", "bdf:p=2", "ramp"},
  {"bdf:p=2, cq", "bdf:p=2", "cq"},
  {"radau:s=3, stages", "radau:s=3", NULL},
};
enum { METHODS = sizeof methods / sizeof *methods, ROWS = 5 };

static void row(demo *d, const char *label, const struct weak *w)
{
  const steif_weak_row *last = &w->row[w->query.rows - 1];
  steif_report *r = d->report;
  steif_report_row(r, "weak");
  steif_report_text(r, "weak.method", label);
  steif_report_whole(r, "weak.index", w->k);
  steif_report_text(r, "weak.convention", convention_name(w->query.convention));
  steif_report_real(r, "weak.value", last->value);
  steif_report_real(r, "weak.exact", w->result.exact);
  steif_report_real(r, "weak.error", last->error);
  steif_report_real(r, "weak.order", last->order);
  steif_report_text(r, "weak.verdict", w->result.verdict);
}

static int one(demo *d, size_t i, long k, error_curves *errors)
{
  struct weak w = {
    .k = k,
    .kind = "N-inc",
    .query = {
      .method = methods[i].method, .start = methods[i].start, .h = 1.0 / 16, .rows = ROWS}};
  progress(d->call, "weak error of %s, index %ld", methods[i].label, k);
  if (weak_measure(d->call->ctx, &w) != STEIF_OK) return fail(d->call);
  row(d, methods[i].label, &w);
  if (k != 3) return EXIT_OK;
  errors_open(errors, methods[i].label);
  for (size_t j = 0; j < ROWS; j++) errors_add(errors, w.row[j].h, w.row[j].error);
  return EXIT_OK;
}

int demo_weak(demo *d)
{
  error_curves errors = {.title = "Weak error at index 3 from inconsistent values",
                         .y_label = "|<x_h, g> - <x, g>|"};
  int code = EXIT_OK;
  for (long k = 2; k <= 4; k++)
    for (size_t i = 0; i < METHODS && code == EXIT_OK; i++) code = one(d, i, k, &errors);
  return code ? code : errors_plot(d->call, &errors, demo_picture(d, "weak.svg"));
}
