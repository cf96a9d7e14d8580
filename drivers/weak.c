/* weak.c: does a method converge weakly on N x' + x = f?
 * SPDX-License-Identifier: BSD-3-Clause */
#include "weak.h"

static void fill(steif_report *r, const struct weak *w)
{
  steif_report_text(r, "method", w->query.method);
  steif_report_whole(r, "index", w->k);
  steif_report_text(r, "case", w->kind);
  steif_report_text(r, "convention", convention_name(w->query.convention));
  steif_report_real(r, "exact", w->result.exact);
  for (size_t i = 0; i < w->query.rows; i++) {
    steif_report_row(r, "rows");
    steif_report_real(r, "rows.h", w->row[i].h);
    steif_report_real(r, "rows.value", w->row[i].value);
    steif_report_real(r, "rows.error", w->row[i].error);
    steif_report_real(r, "rows.order", w->row[i].order);
  }
  steif_report_text(r, "verdict", w->result.verdict);
}

static int tell(struct call *call, const struct weak *w)
{
  error_curves errors = {.title = call->word[0], .y_label = "weak error"};
  errors_open(&errors, call->word[0]);
  for (size_t i = 0; i < w->query.rows; i++) errors_add(&errors, w->row[i].h, w->row[i].error);
  steif_report *r = steif_report_new(call->ctx);
  fill(r, w);
  const int code = r ? present(call, r) : fail(call);
  steif_report_free(&r);
  return code ? code : errors_plot(call, &errors, call->plot);
}

static int run(struct call *call)
{
  struct weak w = {.k = whole_of(call, "--index", 0),
                   .kind = word_of(call, "--case", "N-inc"),
                   .convention = word_of(call, "--convention", NULL),
                   .query = {.method = call->word[0],
                             .start = word_of(call, "--start", NULL),
                             .h = real_of(call, "--h", 1.0 / 64)}};
  w.query.rows = (size_t)whole_of(call, "--halvings", given(call, "--h") ? 0 : 4) + 1;
  if (w.k < 1) return refuse(call, "--index K is needed: the index of N x' + x = f");
  if (w.query.rows > HALVINGS)
    return refuse(call, "--halvings is %zu and must be below %d", w.query.rows - 1, HALVINGS);
  progress(call, "%s on index %ld", w.query.method, w.k);
  return weak_measure(call->ctx, &w) == STEIF_OK ? tell(call, &w) : fail(call);
}

static const struct option options[] = {
  {"--index", COUNT, "K", "index of N x' + x = f"},
  {"--case", WORD, "C", "H-inc, N-inc, N-cons, sin-inc or sin-cons (default N-inc)"},
  {"--convention", CHOICE, "P|R|C|stage", "how the sequence is read as a function"},
  {"--start", CHOICE, "constant|ramp|cq|exact", "starting procedure of multistep methods"},
  {"--h", POSITIVE, "H", "first step, 1/H a whole number (default 1/64)"},
  {"--halvings", NATURAL, "M", "how often it is halved (default 4; 0 with --h)"},
  {NULL, FLAG, NULL, NULL},
};

const struct verb verb_weak = {
  "weak",
  "Pair a run on N x' + x = f with the test function, against the exact distribution",
  "METHOD --index K [--case C] [--convention V] [--start S] [--h H --halvings M]",
  1,
  1,
  options,
  NULL,
  run};
