/* compare.c: several methods on one problem, work against precision.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "comparison.h"
#include "problem.h"
#include <string.h>

static int run(struct call *call)
{
  static comparison c;
  steif_method_info m;
  size_t longest = strlen("method");
  for (int k = 1; k < call->words; k++)
    if (steif_method_find(call->ctx, call->word[k], &m) != STEIF_OK) return fail(call);
  const int found = find_problem(call, call->word[0], &c.problem);
  if (found) return found;
  c.given = c.problem;
  c.report = steif_report_new(call->ctx);
  steif_report_text(c.report, "problem", call->word[0]);
  for (int k = 1; k < call->words; k++)
    if (strlen(call->word[k]) > longest) longest = strlen(call->word[k]);
  steif_report_reserve(c.report, "method", longest);
  int code = c.report ? compare_start(call, &c) : fail(call);
  if (!code) own_reference(call, &c);
  for (int k = 1; !code && k < call->words; k++) compare_method(call, &c, call->word[k]);
  if (!code) code = present(call, c.report);
  compare_end(call, &c);
  if (interrupted()) {
    say(call, "interrupted: runs that were left are not made [STEIF_STOPPED]");
    return exit_of(STEIF_STOPPED);
  }
  if (!code) code = work_plot(call, &c.work, call->word[0], call->plot);
  if (code || c.good) return code;
  say(call, "no run came to the end: see the column message for the cause of each");
  return EXIT_FAILED;
}

static const struct option options[] = {
  {"--rtols", REALS, "a,b,c", "relative tolerances", "1e-4,1e-6,1e-8"},
  {"--hs", REALS, "a,b,c",
   "constant step sizes, for methods without an error estimate or for all", NULL},
  {"--h", REALS, "H", "the same with one step size", NULL},
  {"--atol", POSITIVE, "A", "absolute tolerance (default: rtol times the problem's scale)",
   NULL},
  RUN_OPTIONS,
  RANKS_OPTIONS,
  OPTIONS_END,
};
static const struct rule rules[] = {
  {"--h", EXCLUDES, "--hs"}, {"--linear", NEEDS, "--parallel"}, RULES_END};

const struct verb verb_compare = {
  .name = "compare",
  .about =
    "Compare methods on one problem; cvode, ida and arkode are among them. On a DAE ida "
    "runs in every setting and shows the best; ida:suppress=0 is its default alone. Where no "
    "end values are known, two tighter runs make some. cpu_s of runs below 20 ms is the least "
    "of five",
  .usage = "PROBLEM METHOD... [--rtols a,b,c] [--hs a,b,c]",
  .least = 2,
  .most = WORDS,
  .picture = true,
  .option = options,
  .rule = rules,
  .run = run,
};
