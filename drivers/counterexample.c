/* counterexample.c: an equation that decays while a method grows on it.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "answers.h"
#include <stdlib.h>

static int follow(struct call *call, const steif_problem *p, struct counterexample_answer *a)
{
  return steif_counterexample_run(call->ctx, p, call->word[0], a->h, a->count, a->t, a->x,
                                  a->exact, &a->count)
           ? fail(call)
           : counterexample_present(call, a);
}

static int run(struct call *call)
{
  struct counterexample_answer a = {.h = real_of(call, "--h"),
                                    .rate = real_of(call, "--rate"),
                                    .count = whole_of(call, "--steps")};
  steif_problem p;
  if (steif_counterexample_new(call->ctx, call->word[0], a.h, a.rate, &p, &a.facts))
    return fail(call);
  a.t = calloc(3 * (size_t)a.count, sizeof *a.t);
  a.x = a.t ? a.t + a.count : NULL;
  a.exact = a.t ? a.x + a.count : NULL;
  const int code =
    a.t ? follow(call, &p, &a) : no_memory(call, "the steps", "take fewer --steps");
  free(a.t);
  steif_counterexample_clear(call->ctx, &p);
  return code;
}

static const struct option options[] = {
  {"--h", POSITIVE, "H", "step size", "0.1"},
  {"--rate", POSITIVE, "K", "rate at which the equation decays and the stages see growth", "1"},
  {"--steps", COUNT, "N", "number of steps", "200"},
  OPTIONS_END,
};
static const struct rule rules[] = {{"--steps", AT_MOST, "100000"}, RULES_END};

const struct verb verb_counterexample = {
  .name = "counterexample",
  .about = "Find an equation that decays while a method grows on it",
  .usage = "METHOD [--h H --rate K --steps N]",
  .least = 1,
  .most = 1,
  .picture = true,
  .option = options,
  .rule = rules,
  .run = run,
};
