/* impulse.c: jump and impulses of E x' + F x = f from any x(0-), and the run that follows.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "impulse.h"
#include <string.h>

static int run(struct call *call)
{
  steif_problem p = {0};
  if (impulse_is_nonlinear(call, &p)) return impulse_nonlinear(call, &p);
  if (!p.name && !strcmp(call->word[0], "-")) return fail(call);
  int code = EXIT_OK;
  if (given(call, "--restitution") || given(call, "--stages"))
    code =
      bad_usage(call, "--restitution and --stages are for nonlinear problems: leave them out");
  else if (given(call, "--rtol") && !given(call, "--method") && !given(call, "--vs"))
    code = bad_usage(call, "--rtol is the tolerance of a run; add --method and --t1, or --vs");
  else
    return strcmp(call->word[0], "all") ? impulse_on_system(call, &p)
                                        : impulse_collection(call);
  steif_problem_clear(call->ctx, &p);
  return code;
}

static const struct option options[] = {
  START_OPTIONS,
  {"--method", WORD, "METHOD", "integrate from x(0+); jumps at the declared breaks of f", NULL},
  {"--t1", REAL, "T", "end of the run", NULL},
  {"--layers", FLAG, NULL, "from x(0-) itself, steps in layers: be, bdf:p=, radau:s=", NULL},
  {"--h", POSITIVE, "H", "constant step size of --method (default: adaptive)", NULL},
  {"--h0", POSITIVE, "H", "first step of an adaptive step size (default: automatic)", NULL},
  {"--rtol", POSITIVE, "R", "relative tolerance of --method or --vs (default: 1e-6)", NULL},
  {"--atol", POSITIVE, "A", "absolute tolerance (default: rtol times max |x|, up to 1)", NULL},
  {"--restitution", REAL, "E", "restitution in an impact of a nonlinear problem", "0"},
  {"--stages", FLAG, NULL, "nonlinear jump that is not unique: positions, then velocities",
   NULL},
  {"--projectors", FLAG, NULL, "show the spectral projectors, too (n > 400: of x(0-))", NULL},
  SLOPES_OPTION,
  {"--vs", CHOICE, "ida|cvode|arkode",
   "run it, too, from x(0-) to --t1 (all: each); ida in every setting, best first", NULL},
  ANALYSIS_OPTIONS,
  PARALLEL_OPTION("circles shared by ranks: mpirun -np N steif ... --parallel, N = points / 8"),
  OPTIONS_END,
};

static const struct rule rules[] = {START_RULES,
                                    {"--h", EXCLUDES, "--rtol"},
                                    {"--h", EXCLUDES, "--atol"},
                                    {"--atol", NEEDS, "--method|--vs"},
                                    {"--h", EXCLUDES, "--h0"},
                                    {"--h", EXCLUDES, "--layers"},
                                    {"--projectors", EXCLUDES, "--method"},
                                    {"--slopes", EXCLUDES, "--method"},
                                    {"--method", NEEDS, "--t1"},
                                    {"--t1", NEEDS, "--method|--vs"},
                                    {"--h", NEEDS, "--method"},
                                    {"--h0", NEEDS, "--method"},
                                    {"--layers", NEEDS, "--method"},
                                    {"--plot", NEEDS, "--method"},
                                    RULES_END};

const struct verb verb_impulse = {
  .name = "impulse",
  .about =
    "Find x(0+) and the impulses of E x' + F x = f or of a nonlinear problem from any x(0-)",
  .usage = "E.mtx F.mtx --x0 X.mtx | PROBLEM | all [--forcing FILE] [--method METHOD --t1 T "
           "--csv FILE]",
  .least = 1,
  .most = 2,
  .picture = true,
  .option = options,
  .rule = rules,
  .matrices = true,
  .run = run,
};
