/* lyapunov.c: Lyapunov exponents of a method's solution, and whether its step is short enough.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "answers.h"
#include "problem.h"
#include <stdlib.h>

static int measure(struct call *call, const steif_problem *p, struct lyapunov_answer *a)
{
  const steif_lyapunov_options o = {.h = real_of(call, "--h"),
                                    .t1 = real_of(call, "--t1"),
                                    .transient = real_of(call, "--transient"),
                                    .window = real_of(call, "--window"),
                                    .count = (int)a->count,
                                    .error = a->error};
  const char *method = call->word[1];
  progress(call, "%s on %s", method, call->word[0]);
  if (steif_lyapunov(call->ctx, p, method, &o, a->exponent, a->interval, &a->facts) ||
      steif_lyapunov_verify(call->ctx, p, method, &o, real_of(call, "--accuracy"),
                            real_of(call, "--period"), a->exponent, &a->facts, a->check,
                            &a->checks))
    return fail(call);
  /* One solution of a linear problem can be followed as long as it neither overflows nor is 0. */
  a->measured = a->facts.linear && !steif_growth_measure(call->ctx, p, method, &o, &a->growth);
  steif_forget(call->ctx);
  return lyapunov_present(call, a);
}

static int find(struct call *call, const steif_problem *p)
{
  const long count = whole_or(call, "--count", (long)p->n);
  struct lyapunov_answer a = {
    .count = (size_t)count, .t0 = p->t0, .t1 = real_or(call, "--t1", p->t1)};
  if (count > (long)p->n)
    return bad_usage(call, "--count is %ld and '%s' has %ld exponents", count, call->word[0],
                     (long)p->n);
  a.exponent = malloc(4 * a.count * sizeof *a.exponent);
  a.check = malloc((a.count + 2) * sizeof *a.check);
  int code = EXIT_FAILED;
  if (a.exponent && a.check) {
    a.interval = a.exponent + a.count;
    a.error = a.exponent + 3 * a.count;
    code = measure(call, p, &a);
  } else {
    code = no_memory(call, "the exponents", "ask for fewer with --count");
  }
  free(a.check);
  free(a.exponent);
  return code;
}

static int run(struct call *call) { return with_problem(call, find); }

static const struct option options[] = {
  {"--h", POSITIVE, "H", "constant step size", NULL},
  {"--t1", POSITIVE, "T", "end of the run (default: the problem's)", NULL},
  {"--transient", POSITIVE, "T", "time before the averages begin", NULL},
  {"--window", POSITIVE, "W", "length of the windows (default: a tenth of what is averaged)",
   NULL},
  {"--period", POSITIVE, "P", "period of A(t) in x' = A(t) x: compare with Floquet's exponents",
   NULL},
  {"--accuracy", POSITIVE, "R",
   "accuracy of the sum against the mean trace, in largest exponents", "0.01"},
  {"--count", COUNT, "K", "number of exponents, the largest first (default: all)", NULL},
  OPTIONS_END,
};
static const struct rule rules[] = {{"--h", REQUIRED, NULL}, RULES_END};

const struct verb verb_lyapunov = {
  .name = "lyapunov",
  .about = "Find Lyapunov exponents and whether the step is short enough",
  .usage = "PROBLEM METHOD --h H --t1 T [--transient T --window W --count K --period P]",
  .least = 2,
  .most = 2,
  .option = options,
  .rule = rules,
  .run = run,
};
