/* solve.c: one integration.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "problem.h"
#include "saved_run.h"
#include "solution.h"

static int integrate_on(struct call *call, const steif_problem *p)
{
  trajectory tr;
  steif_options options = options_of(call);
  steif_solver *s = NULL;
  int code = trajectory_open(call, p, &options, &tr);
  if (!code && !(tr.report = steif_report_new(call->ctx))) code = fail(call);
  if (!code && call->continues) code = saved_run_load(call, p, &options, &tr, &s);
  if (!code) {
    const outcome o = integrate(call->ctx, p, call->word[1], &options, &s);
    saved_run_end(&tr, s, &o);
    code = solution_present(call, &o, s, &tr);
  }
  steif_solver_free(&s);
  steif_report_free(&tr.report);
  trajectory_free(&tr);
  return code;
}

static int run(struct call *call) { return with_problem(call, integrate_on); }

static const struct option options[] = {
  {"--rtol", POSITIVE, "R", "relative tolerance", "1e-6"},
  {"--atol", POSITIVE, "A", "absolute tolerance (default: rtol times the problem's scale)",
   NULL},
  {"--h", POSITIVE, "H", "constant step size instead of a tolerance", NULL},
  RUN_OPTIONS,
  {"--at", TIMES, "T,T,...", "the solution at these ascending times instead of steps", NULL},
  {"--points", COUNT, "N", "the same at N equal distances from the start to the end", NULL},
  {"--events", FLAG, NULL, "a table of the events of the problem", NULL},
  {"--npz", OUTPUT, "FILE", "t, y and events as arrays for numpy.load", NULL},
  CHECKPOINT_OPTIONS,
  OPTIONS_END,
};
static const struct rule rules[] = {{"--h", EXCLUDES, "--rtol"},
                                    {"--h", EXCLUDES, "--atol"},
                                    {"--at", EXCLUDES, "--points"},
                                    CHECKPOINT_RULE,
                                    RULES_END};

const struct verb verb_solve = {
  .name = "solve",
  .about = "Integrate one problem with one method",
  .usage = "PROBLEM METHOD [--rtol R --atol A | --h H] [--t1 T] [--events]",
  .least = 2,
  .most = 2,
  .picture = true,
  .option = options,
  .rule = rules,
  .run = run,
};
