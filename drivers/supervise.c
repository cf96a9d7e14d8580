/* supervise.c: keep a decaying solution decaying, beside error control alone.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "answers.h"
#include "integration.h"
#include "problem.h"
#include <stdlib.h>

static int find(struct call *call, const steif_problem *p)
{
  const double window = real_of(call, "--window");
  const double windows = (real_or(call, "--t1", p->t1) - p->t0) / window;
  if (!(windows < 1e6))
    return bad_usage(call, "%g windows of %g: take a longer --window", windows, window);
  const size_t room = (size_t)(windows > 0 ? windows : 0) + 3;
  struct supervise_answer a = {.call = call,
                               .report = steif_report_new(call->ctx),
                               .n = (size_t)p->n,
                               .y = calloc((size_t)p->n, sizeof *a.y)};
  const bool alone = supervise_open(&a.alone, room), kept = supervise_open(&a.kept, room);
  const int code = a.report && a.y && alone && kept
                     ? supervise_both(call, p, &a)
                     : no_memory(call, "the windows", "take a longer --window");
  supervise_close(&a.alone);
  supervise_close(&a.kept);
  steif_report_free(&a.report);
  free(a.y);
  return code;
}

static int run(struct call *call) { return with_problem(call, find); }

static const struct option options[] = {
  {"--rate", POSITIVE, "G", "rate of decay that is certain: |w(t)| <= K exp(-G (t - s)) |w(s)|",
   NULL},
  {"--window", POSITIVE, "H", "length of the windows, two periods of the coefficients or more",
   NULL},
  {"--rtol", POSITIVE, "R", "relative tolerance", NULL},
  {"--atol", POSITIVE, "A", "absolute tolerance (not used where w is y)", NULL},
  {"--watch", CHOICE, "windows|sum",
   "repeat windows that grow, or cap the step size as growth adds up", "windows"},
  {"--swing", POSITIVE, "L", "ln K for --watch sum", "7"},
  RUN_OPTIONS,
  OPTIONS_END,
};
static const struct rule rules[] = {
  {"--rate", REQUIRED, NULL}, {"--window", REQUIRED, NULL}, RULES_END};

const struct verb verb_supervise = {
  .name = "supervise",
  .about = "Adapt the step size so that a decaying solution keeps decaying",
  .usage = "PROBLEM METHOD --rate G --window H [--rtol R --t1 T] [--watch windows|sum]",
  .least = 2,
  .most = 2,
  .picture = true,
  .option = options,
  .rule = rules,
  .run = run,
};
