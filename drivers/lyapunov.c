/* lyapunov.c: Lyapunov exponents of a method's solution, and whether its step is short enough.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "answers.h"
#include "integration.h"
#include <stdlib.h>

static int find(struct call *call, const steif_problem *p)
{
  if (!given(call, "--h") && !given(call, "--steps"))
    return bad_usage(call, "--h H is needed, or --period P --steps M");
  const long count = whole_or(call, "--count", (long)p->n);
  struct lyapunov_answer a = {
    .count = (size_t)count, .t0 = p->t0, .t1 = real_or(call, "--t1", p->t1)};
  if (count > (long)p->n)
    return bad_usage(call, "--count is %ld and '%s' has %ld exponents", count, call->word[0],
                     (long)p->n);
  a.exponent = malloc(4 * a.count * sizeof *a.exponent);
  a.check = malloc((a.count + 2) * sizeof *a.check);
  a.separation = calloc(a.count, sizeof *a.separation);
  int code = EXIT_FAILED;
  if (a.exponent && a.check && a.separation) {
    a.interval = a.exponent + a.count;
    a.error = a.exponent + 3 * a.count;
    code = lyapunov_measure(call, p, &a);
  } else {
    code = no_memory(call, "the exponents", "ask for fewer with --count");
  }
  series_close(&a);
  free(a.separation);
  free(a.check);
  free(a.exponent);
  return code;
}

static int run(struct call *call) { return with_problem(call, find); }

static const struct option options[] = {
  SET_OPTION,
  {"--h", POSITIVE, "H", "constant step size", NULL},
  {"--t1", POSITIVE, "T", "end of the run (default: the problem's)", NULL},
  {"--transient", POSITIVE, "T", "time before the averages begin", NULL},
  {"--window", POSITIVE, "W", "length of the windows (default: a tenth of what is averaged)",
   NULL},
  {"--period", POSITIVE, "P",
   "period of A(t) in x' = A(t) x, a whole number of steps: multipliers of the recurrence "
   "(the verdict looks for one itself)",
   NULL},
  {"--steps", COUNT, "M", "steps in the period P, instead of --h: h = P/M", NULL},
  {"--search", FLAG, NULL, "look for the longest steps that keep the decay in any case", NULL},
  {"--series", OUTPUT, "FILE",
   "t, |x| and the local error of every step of x' = A(t) x, else the averages so far, "
   "comma-separated",
   NULL},
  {"--accuracy", POSITIVE, "R",
   "accuracy of the sum against the mean trace, in largest exponents", "0.01"},
  {"--count", COUNT, "K", "number of exponents, the largest first (default: all)", NULL},
  OPTIONS_END,
};
static const struct rule rules[] = {
  {"--h", EXCLUDES, "--steps"}, {"--steps", NEEDS, "--period"}, RULES_END};

const struct verb verb_lyapunov = {
  .name = "lyapunov",
  .about = "Find Lyapunov exponents and whether the step is short enough",
  .usage =
    "PROBLEM METHOD --h H --t1 T [--transient T --window W --count K --period P --search]",
  .least = 2,
  .most = 2,
  .picture = true,
  .option = options,
  .rule = rules,
  .matrices = true,
  .run = run,
};
