/* fit.c: parameters of a problem from measurements.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fitted.h"

static int run(struct call *call)
{
  steif_problem p;
  const int found = find_problem(call, call->word[0], &p);
  if (found) return found;
  struct fitted a = {.problem = &p, .method = call->word[1]};
  int code = fitted_ask(call, &a);
  if (!code) code = fitted_find(call, &a);
  steif_fit_free(call->ctx, &a.fit);
  steif_measurements_free(call->ctx, &a.data);
  steif_problem_clear(call->ctx, &p);
  return code;
}

static const struct option options[] = {
  {"--data", WORD, "FILE.csv",
   "measurements: a first line t and names of unknowns or outputs, perhaps with units, x {m}; "
   "empty cells are skipped; a model may name its own",
   NULL},
  {"--parameters", WORD, "P=START,...",
   "parameters, perhaps with start values, or all; a model may name its own", "all"},
  {"--log", FLAG, NULL, "fit log p (default where start values and bounds are positive)", NULL},
  {"--linear", FLAG, NULL, "fit p itself", NULL},
  {"--sd", REALS, "S,...",
   "standard deviations of the columns, or one for all: known, so intervals are normal; else "
   "they are estimated, and intervals are Student's",
   NULL},
  {"--bounds", WORD, "P=A:B,...", "bounds of parameters; A or B may be missing", NULL},
  {"--starts", COUNT, "N", "descents, from points between the bounds or within factors of 10",
   "1"},
  {"--evaluations", COUNT, "N", "most runs of a descent", "200"},
  {"--repeated", FLAG, NULL, "a time may occur in several rows", NULL},
  {"--rtol", POSITIVE, "R", "relative tolerance of the runs, and of the fit", "1e-8"},
  {"--atol", POSITIVE, "A", "absolute tolerance (default: R times the problem's scale)", NULL},
  RUN_OPTIONS,
  OPTIONS_END,
};

static const struct rule rules[] = {{"--log", EXCLUDES, "--linear"}, RULES_END};

const struct verb verb_fit = {
  .name = "fit",
  .about = "Find parameters from measurements",
  .usage = "PROBLEM [METHOD] [--data FILE.csv] [--parameters k1=0.02,k2 --sd S --starts N]",
  .least = 1,
  .most = 2,
  .method = "auto",
  .picture = true,
  .matrices = true,
  .option = options,
  .rule = rules,
  .run = run,
};
