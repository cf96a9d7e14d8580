/* sensitivity.c: derivatives of a solution by parameters.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "answers.h"
#include "gradient_answer.h"
#include "integration.h"

static int find(struct call *call, const steif_problem *p)
{
  struct sensitivity_answer a = {.problem = p, .options = options_of(call)};
  struct functional f = {.problem = *p};
  if (a.options.t1 == 0) a.options.t1 = p->t1;
  int code = sensitivity_choose(call, &a);
  if (!code && given(call, "--functional")) code = functional_open(call, p, &f);
  a.problem = &f.problem, a.options.test_quadratures = f.kinks;
  if (!code) code = sensitivity_measure(call, &a);
  sensitivity_close(&a);
  functional_close(call, &f);
  return code;
}

static int run(struct call *call)
{
  const bool back = given(call, "--adjoint") || given(call, "--end");
  if (given(call, "--adjoint") && !given(call, "--functional") && !given(call, "--end"))
    return bad_usage(call, "--adjoint needs --functional 'int y1' or --end y1");
  if (back && (given(call, "--parameters") || given(call, "--points")))
    return bad_usage(call,
                     "gradients are by all parameters, at the end: leave --parameters and "
                     "--points out");
  if (given(call, "--hessian") && !back)
    return bad_usage(call, "--hessian goes with --adjoint or --end");
  return with_problem(call, back ? gradient_answer : find);
}

static const struct option options[] = {
  {"--parameters", WORD, "P,...", "names of the parameters, or all", "all"},
  {"--adjoint", FLAG, NULL, "the gradient of --functional by all parameters, going back", NULL},
  {"--end", WORD, "E", "gradient of expressions at the end, 'y1; y2', added to --functional",
   NULL},
  {"--hessian", WORD, "P=V,...", "of a gradient: its derivative along this direction", NULL},
  {"--memory", COUNT, "BYTES", "for gradients (default: 1 GiB)", NULL},
  {"--points", COUNT, "N", "times shown, at equal distances to the end", "1"},
  {"--check", FLAG, NULL, "compare with differences of runs on the same mesh", NULL},
  {"--functional", WORD, "int G",
   "integral of an expression in t, unknowns and parameters; with --adjoint several: 'int y1; "
   "int y2'",
   NULL},
  {"--rtol", POSITIVE, "R", "relative tolerance of y and of its derivatives", "1e-6"},
  {"--atol", POSITIVE, "A", "absolute tolerance (default: R times the problem's scale)", NULL},
  {"--h", POSITIVE, "H", "constant step size instead", NULL},
  RUN_OPTIONS,
  OPTIONS_END,
};

const struct verb verb_sensitivity = {
  .name = "sensitivity",
  .about = "Find derivatives of a solution by parameters",
  .usage =
    "PROBLEM [METHOD] [--parameters k1,k2 --functional 'int G' --adjoint --end E --check]",
  .least = 1,
  .most = 2,
  .method = "auto",
  .matrices = true,
  .option = options,
  .run = run,
};
