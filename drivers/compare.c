/* compare.c: several methods on one problem, work against precision.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "curves.h"

/* Step sizes for methods without an error estimate and when nothing else is given; else tolerances. */
static size_t settings(struct call *call, const char *method, double *value, bool *steps)
{
  steif_method_info m;
  const char *const hs = given(call, "--hs") ? "--hs" : "--h";
  const bool adaptive = steif_method_find(call->ctx, method, &m) == STEIF_OK && m.adaptive;
  *steps = given(call, hs) && (!adaptive || !given(call, "--rtols"));
  return reals_of(call, *steps ? hs : "--rtols", value);
}

static void one_method(struct call *call, const steif_problem *p, const char *method,
                       steif_report *r, work_curves *work)
{
  double value[REALS_MOST];
  bool steps;
  const size_t count = settings(call, method, value, &steps);
  const char *const what = steps ? "h" : "rtol";
  work_open(work, method);
  for (size_t i = 0; i < count && !interrupted(); i++) {
    steif_options o = options_of(call);
    o.h = steps ? value[i] : 0;
    if (!steps) o.rtol = value[i];
    progress(call, "%s, %s %.3g", method, what, value[i]);
    const outcome out = integrate(call->ctx, p, method, &o, NULL);
    if (out.why[0]) say(call, "%s, %s %.3g: %s", method, what, value[i], out.why);
    report_run(r, method, p, &o, &out);
    work_add(work, &out);
  }
}

static int run(struct call *call)
{
  static work_curves work;
  steif_problem p;
  steif_method_info m;
  for (int k = 1; k < call->words; k++)
    if (steif_method_find(call->ctx, call->word[k], &m) != STEIF_OK) return fail(call);
  if (steif_problem_find(call->ctx, call->word[0], &p) != STEIF_OK) return fail(call);
  steif_report *r = steif_report_new(call->ctx);
  steif_report_text(r, "problem", call->word[0]);
  for (int k = 1; r && k < call->words; k++) one_method(call, &p, call->word[k], r, &work);
  const int code = r ? present(call, r) : fail(call);
  steif_report_free(&r);
  steif_problem_clear(call->ctx, &p);
  if (!interrupted()) return code ? code : work_plot(call, &work, call->word[0], call->plot);
  say(call, "interrupted: runs that were left are not made [STEIF_STOPPED]");
  return EXIT_INTERRUPTED;
}

static const struct option options[] = {
  {"--rtols", REALS, "a,b,c", "relative tolerances", "1e-4,1e-6,1e-8"},
  {"--hs", REALS, "a,b,c",
   "constant step sizes, for methods without an error estimate or for all", NULL},
  {"--h", REALS, "H", "the same with one step size", NULL},
  {"--atol", POSITIVE, "A", "absolute tolerance (default: rtol times the problem's scale)",
   NULL},
  RUN_OPTIONS,
  OPTIONS_END,
};
static const struct rule rules[] = {{"--h", EXCLUDES, "--hs"}, RULES_END};

const struct verb verb_compare = {
  .name = "compare",
  .about = "Compare methods on one problem; cvode, ida and arkode are among them",
  .usage = "PROBLEM METHOD... [--rtols a,b,c] [--hs a,b,c]",
  .least = 2,
  .most = WORDS,
  .picture = true,
  .option = options,
  .rule = rules,
  .run = run,
};
