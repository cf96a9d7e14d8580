/* weak.c: does a method converge weakly on N x' + x = f, or on a system?
 * SPDX-License-Identifier: BSD-3-Clause */
#include "weak.h"

static void fill(steif_report *r, const struct call *call, const void *result)
{
  const struct weak *w = result;
  (void)call;
  steif_report_text(r, "method", w->query.method);
  steif_report_whole(r, "index", w->k);
  steif_report_text(r, "case", w->kind);
  steif_report_text(r, "convention", convention_name(w->query.convention));
  steif_report_real(r, "exact", w->result.exact);
  for (size_t i = 0; i < w->query.rows; i++) {
    weak_row_begin(r, w->row + i);
    steif_report_real(r, "rows.value", w->row[i].value);
    weak_row_end(r, w->row + i);
  }
  steif_report_text(r, "verdict", w->result.verdict);
}

static int on_block(struct call *call)
{
  struct weak w = weak_asked(call);
  if (!w.k)
    return bad_usage(call,
                     "--index K is needed, the index of N x' + x = f, or a system to run on");
  progress(call, "%s on index %ld", w.query.method, w.k);
  if (weak_measure(call->ctx, &w) != STEIF_OK) return fail(call);
  const int code = present_result(call, fill, &w);
  return code ? code : weak_end(call, &w);
}

static int run(struct call *call)
{
  const bool block = given(call, "--index") || given(call, "--case");
  if (call->words == 1) return on_block(call);
  return block
           ? bad_usage(call, "--index and --case name a Jordan block; leave them out with a "
                             "system")
           : weak_system(call);
}

static const struct option options[] = {
  {"--index", COUNT, "K", "index of the Jordan block N in N x' + x = f, instead of a system",
   NULL},
  {"--case", WORD, "C", "its start and forcing: H-inc, N-inc, N-cons, sin-inc or sin-cons",
   "N-inc"},
  {"--component", COUNT, "I",
   "one component, counted from 1 (default: 1 of a block, all of a system)", NULL},
  {"--convention", CHOICE, "P|R|C|stage",
   "how the values x_n are read as a function (steif/weak.h)", NULL},
  {"--start", CHOICE, "constant|ramp|cq|exact", "starting procedure of multistep methods",
   NULL},
  {"--h", POSITIVE, "H", "first step size (default: 1/64 of the interval, breaks on the mesh)",
   NULL},
  {"--halvings", NATURAL, "M", "how often it is halved (default: 4; 0 with --h)", NULL},
  {"--breaks", REALS, "a,b,c",
   "times at which f or a derivative of it jumps (default: those of "
   "step, ramp, abs, min and max of what is linear in t)",
   NULL},
  {"--state-space", FLAG, NULL, "the second file is A of E x' = A x + f, so F = -A", NULL},
  START_OPTIONS,
  OPTIONS_END,
};
static const struct rule rules[] = {{"--halvings", AT_MOST, "39"}, START_RULES, RULES_END};

const struct verb verb_weak = {
  .name = "weak",
  .about =
    "Measure weak convergence: <x_h, g> of a run against <x, g> of the exact distribution",
  .usage = "METHOD --index K | E.mtx F.mtx --x0 X.mtx | PROBLEM [--convention V] [--start S] "
           "[--h H]",
  .least = 1,
  .most = 3,
  .picture = true,
  .option = options,
  .rule = rules,
  .run = run,
};
