/* energy.c: what a method keeps of the invariants of a problem over a run.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "answers.h"
#include "integration.h"
#include "problem.h"
#include <stdlib.h>

static int find(struct call *call, struct energy_answer *a)
{
  steif_options o = options_of(call);
  o.observe = energy_follow, o.observer = a;
  steif_energy *e = &a->energy;
  e->drift = calloc(a->columns, sizeof *e->drift);
  e->row = calloc(e->rows * a->columns, sizeof *e->row);
  a->report = steif_report_new(call->ctx);
  int code = EXIT_FAILED;
  progress(call, "%s on %s to t = %g", call->word[1], a->problem->name, o.t1);
  if (!e->drift || !e->row || !a->report)
    code = no_memory(call, "the rows", "ask for fewer with --rows");
  else
    code =
      energy_shown(call, a, steif_energy_measure(call->ctx, a->problem, call->word[1], &o, e));
  steif_report_free(&a->report);
  free(e->row);
  free(e->drift);
  return code;
}

static int select_invariant(struct call *call, const steif_problem *p)
{
  const long which = whole_of(call, "--invariant");
  struct energy_answer a = {
    .problem = p,
    .call = call,
    .t1 = real_or(call, "--t1", p->t1),
    .which = (size_t)which,
    .columns = 1 + (size_t)p->invariants,
    .energy = {.period = real_of(call, "--period"), .rows = (size_t)whole_of(call, "--rows")}};
  return p->invariants > 0 && which > p->invariants
           ? bad_usage(call, "--invariant is %ld and '%s' has %d", which, call->word[0],
                       p->invariants)
           : find(call, &a);
}

static int run(struct call *call) { return with_problem(call, select_invariant); }

static const struct option options[] = {
  {"--h", POSITIVE, "H", "constant step size", NULL},
  {"--rtol", POSITIVE, "R", "relative tolerance of an adaptive step size", NULL},
  {"--atol", POSITIVE, "A", "absolute tolerance", NULL},
  {"--period", POSITIVE, "P",
   "period of the motion (default: between maxima of the first component)", NULL},
  {"--invariant", COUNT, "I", "which invariant, counted from 1", "1"},
  {"--rows", COUNT, "N", "rows of the table and points of the picture", "100"},
  RUN_OPTIONS,
  OPTIONS_END,
};
static const struct rule rules[] = {{"--h", EXCLUDES, "--rtol"},
                                    {"--h", EXCLUDES, "--atol"},
                                    {"--rows", AT_MOST, "1000000"},
                                    RULES_END};

const struct verb verb_energy = {
  .name = "energy",
  .about = "Measure whether an invariant drifts (grows) or oscillates, per period",
  .usage = "PROBLEM METHOD --h H --t1 T [--period P] [--invariant I]",
  .least = 2,
  .most = 2,
  .picture = true,
  .option = options,
  .rule = rules,
  .run = run,
};
