/* solve.c: one integration.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "descriptor.h"
#include "saved_run.h"
#include "solution.h"
#include "solve_system.h"

static int integrate_on(struct call *call, const steif_problem *p)
{
  trajectory tr;
  steif_options options = options_of(call);
  options.recompute = 1;
  steif_solver *s = NULL;
  int code = trajectory_open(call, p, &options, &tr);
  if (!code && !(tr.report = steif_report_new(call->ctx))) code = fail(call);
  if (!code && call->continues) code = saved_run_load(call, p, &options, &tr, &s);
  if (!code) {
    const outcome o = integrate(call->ctx, p, solution_method(call), &options, &s);
    saved_run_end(&tr, s, &o);
    code = solution_present(call, &o, s, &tr);
  }
  steif_solver_free(&s);
  steif_report_free(&tr.report);
  trajectory_free(&tr);
  return code;
}

static int run(struct call *call)
{
  if (descriptor_is_file(call->word[0])) return solve_system(call, integrate_on);
  const char *const own[] = {"--x0", "--f", "--forcing", "--input"};
  for (int i = 0; i < 4; i++)
    if (given(call, own[i]))
      return bad_usage(call, "%s is for E.mtx A.mtx; a problem has its own", own[i]);
  if (call->words == 2) return with_problem(call, integrate_on);
  return bad_usage(call, "\"%s\" is one word too many: steif solve %s", call->word[2],
                   call->verb->usage);
}

static const struct option options[] = {
  {"--rtol", POSITIVE, "R", "relative tolerance", "1e-6"},
  {"--atol", POSITIVE, "A", "absolute tolerance (default: rtol times its scale)", NULL},
  {"--h", POSITIVE, "H", "constant step size instead of a tolerance", NULL},
  RUN_OPTIONS,
  ATTRIBUTE_OPTIONS,
  {"--at", TIMES, "T,T,...", "the solution at these ascending times instead of steps", NULL},
  {"--points", COUNT, "N", "the same at N equal distances from the start to the end", NULL},
  {"--events", FLAG, NULL, "a table of the events of the problem", NULL},
  {"--npz", OUTPUT, "FILE", "t, y and events as arrays for numpy.load", NULL},
  {"--h5", OUTPUT, "FILE", "the same as an HDF5 file, where libhdf5 is installed", NULL},
  {"--x0", WORD, "X.mtx", "of E x' = A x + f: x(0-), a column of as many rows as E", NULL},
  {"--f", WORD, "TEXT", "f as expressions in t separated by ';' (default: 0)", NULL},
  {"--forcing", WORD, "FILE", "f from a file: an expression per line, or samples (.csv)", NULL},
  {"--input", WORD, "B.mtx", "B of f = B u, u by --forcing or --f (.mat: its B)", NULL},
  CHECKPOINT_OPTIONS,
  RANKS_OPTIONS,
  OPTIONS_END,
};
static const struct rule rules[] = {{"--h", EXCLUDES, "--rtol"},
                                    {"--h", EXCLUDES, "--atol"},
                                    {"--at", EXCLUDES, "--points"},
                                    {"--forcing", EXCLUDES, "--f"},
                                    {"--input", NEEDS, "--forcing|--f"},
                                    {"--linear", NEEDS, "--parallel"},
                                    CHECKPOINT_RULE,
                                    RULES_END};

const struct verb verb_solve = {
  .name = "solve",
  .about = "Integrate one problem with one method",
  .usage = "PROBLEM [METHOD] [--rtol R | --h H] | E.mtx A.mtx METHOD --x0 X.mtx --t1 T",
  .least = 1,
  .most = 3,
  .method = "auto",
  .picture = true,
  .option = options,
  .rule = rules,
  .run = run,
};
