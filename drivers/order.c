/* order.c: the observed order of a method.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "curves.h"

static void fill(steif_report *r, const char *problem, const steif_method_info *m, size_t count,
                 const steif_order_row *row)
{
  steif_report_text(r, "problem", problem);
  if (m->order) steif_report_whole(r, "claimed", m->order);
  for (size_t i = 0; i < count; i++) {
    steif_report_row(r, "rows");
    steif_report_real(r, "rows.h", row[i].h);
    steif_report_real(r, "rows.error", row[i].error);
    steif_report_real(r, "rows.order", row[i].order);
  }
}

static int tell(struct call *call, const char *problem, const steif_method_info *m,
                size_t count, const steif_order_row *row)
{
  error_curves errors = {.title = call->word[0], .y_label = "error"};
  errors_open(&errors, call->word[0]);
  for (size_t i = 0; i < count; i++) errors_add(&errors, row[i].h, row[i].error);
  steif_report *r = steif_report_new(call->ctx);
  steif_report_text(r, "method", call->word[0]);
  fill(r, problem, m, count, row);
  const int code = r ? present(call, r) : fail(call);
  steif_report_free(&r);
  return code ? code : errors_plot(call, &errors, call->plot);
}

static int run(struct call *call)
{
  const char *name = word_of(call, "--problem", "harmonic"), *method = call->word[0];
  const size_t count = (size_t)whole_of(call, "--halvings", 4) + 1;
  steif_order_row row[HALVINGS];
  steif_method_info m;
  steif_problem p;
  if (count > HALVINGS)
    return refuse(call, "--halvings is %zu and must be below %d", count - 1, HALVINGS);
  if (steif_method_find(call->ctx, method, &m) != STEIF_OK) return fail(call);
  if (steif_problem_find(call->ctx, name, &p) != STEIF_OK) return fail(call);
  /* High orders reach rounding soon: they begin with longer steps. */
  const double h = real_of(call, "--h", m.order > 5 ? 0.5 : m.order > 2 ? 0.25 : 0.0625);
  const steif_options o = options_of(call);
  progress(call, "%s on %s", method, name);
  const int code = steif_order_measure(call->ctx, &p, method, &o, h, count, row) == STEIF_OK
                     ? tell(call, name, &m, count, row)
                     : fail(call);
  steif_problem_clear(call->ctx, &p);
  return code;
}

static const struct option options[] = {
  {"--problem", WORD, "P", "with an exact solution or a reference (default harmonic)"},
  {"--h", POSITIVE, "H", "first step"},
  {"--halvings", NATURAL, "M", "how often it is halved (default 4)"},
  RUN_OPTIONS,
  {NULL, FLAG, NULL, NULL},
};

const struct verb verb_order = {"order",
                                "Measure the order of a method by halving its step",
                                "METHOD [--problem P] [--h H --halvings M]",
                                1,
                                1,
                                options,
                                NULL,
                                run};
