/* weak.c: does a method converge weakly on N x' + x = f, or on a system?
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

static int block(struct call *call)
{
  struct weak w = weak_asked(call);
  progress(call, "%s on index %ld", w.query.method, w.k);
  if (weak_measure(call->ctx, &w) != STEIF_OK) return fail(call);
  steif_report *r = steif_report_new(call->ctx);
  fill(r, &w);
  const int code = r ? present(call, r) : fail(call);
  steif_report_free(&r);
  return code ? code : weak_plot(call, w.query.rows, w.row);
}

static int run(struct call *call)
{
  const bool system = call->words > 1;
  if (system && (given(call, "--index") || given(call, "--case")))
    return refuse(call, "--index and --case name a Jordan block; leave them out with a system");
  if (!system && !given(call, "--index"))
    return refuse(call,
                  "--index K is needed, the index of N x' + x = f, or a system to run on");
  const long halvings = whole_of(call, "--halvings", 0);
  if (halvings >= HALVINGS)
    return refuse(call, "--halvings is %ld and must be below %d", halvings, HALVINGS);
  return system ? weak_system(call) : block(call);
}

static const struct option options[] = {
  {"--index", COUNT, "K", "index of N x' + x = f, instead of a system"},
  {"--case", WORD, "C", "H-inc, N-inc, N-cons, sin-inc or sin-cons (default N-inc)"},
  {"--component", NATURAL, "I", "from 0 (default 0 of N x' + x = f, all of a system)"},
  {"--convention", CHOICE, "P|R|C|stage", "how the sequence is read as a function"},
  {"--start", CHOICE, "constant|ramp|cq|exact", "starting procedure of multistep methods"},
  {"--h", POSITIVE, "H", "first step, 1/H a whole number (default 1/64)"},
  {"--halvings", NATURAL, "M", "how often it is halved (default 4; 0 with --h)"},
  {"--state-space", FLAG, NULL, "the second file is A of E x' = A x + f, so F = -A"},
  START_ROWS,
  {NULL, FLAG, NULL, NULL},
};

static const char *const clash[][2] = {{"--forcing", "--f"}, {NULL, NULL}};

const struct verb verb_weak = {
  "weak",
  "Pair a run with the test function, against the exact distribution",
  "METHOD --index K | E.mtx F.mtx --x0 X.mtx | PROBLEM [--convention V] [--start S] [--h H]",
  1,
  3,
  options,
  clash,
  run};
