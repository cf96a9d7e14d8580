/* supervise_run.c: what `steif supervise` measures: error control alone, then the supervised run.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "answers.h"
#include "integration.h"

static void run_once(struct call *call, const steif_problem *p,
                     enum steif_supervision_rule rule, double *y, struct supervise_run *j)
{
  const bool alone = rule == STEIF_SUPERVISE_NONE;
  const steif_options o = options_of(call);
  interruption_poll();
  const steif_supervision how = {.rule = rule,
                                 .rate = real_of(call, "--rate"),
                                 .window = real_of(call, "--window"),
                                 .swing = real_of(call, "--swing"),
                                 .tell = supervise_keep,
                                 .user = j};
  progress(call, "%s on %s%s", call->word[1], call->word[0],
           alone ? ", error control alone" : ", supervised");
  j->t[0] = p->t0;
  j->code = steif_supervise(call->ctx, p, call->word[1], &o, &how, y, &j->facts);
}

/* Windows that were finished before a signal came. */
static int stopped(struct call *call, struct supervise_answer *a, size_t windows)
{
  const int output = windows > 0 ? supervise_present(a) : EXIT_OK;
  return output ? output : fail(call);
}

int supervise_both(struct call *call, const steif_problem *p, struct supervise_answer *a)
{
  static const enum steif_supervision_rule rule[] = {STEIF_SUPERVISE_WINDOWS,
                                                     STEIF_SUPERVISE_SUM};
  a->kept.rows = a;
  supervise_begin(a);
  run_once(call, p, STEIF_SUPERVISE_NONE, a->y, &a->alone); /* it may well overflow */
  if (a->alone.code == STEIF_STOPPED) return stopped(call, a, a->alone.count);
  run_once(call, p, rule[choice_of(call, "--watch")], a->y, &a->kept);
  if (a->kept.code == STEIF_OK) return supervise_present(a);
  return a->kept.code == STEIF_STOPPED ? stopped(call, a, a->kept.count) : fail(call);
}
