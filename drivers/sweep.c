/* sweep.c: one problem with many values of its parameters, over threads.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "sweep.h"

static int run(struct call *call)
{
  const int checked = check_outputs(call);
  return checked ? checked : with_problem(call, sweep_run);
}

static const struct option options[] = {
  {"--p", REPEATED, "NAME=FROM:TO:COUNT[:log]",
   "values of a parameter, or NAME=V,V,...; several --p: all combinations, the last fastest",
   NULL},
  {"--random", COUNT, "N",
   "N members drawn at random instead, from NAME=FROM:TO[:log] or one of NAME=V,V,...", NULL},
  {"--seed", NATURAL, "S", "the numbers drawn depend on S and the member only", "1"},
  {"--threads", NATURAL, "T", "members at work at once, at most 64; 0: one for each core", "0"},
  {"--collect", CHOICE, "y|digits|stats",
   "of each member: the solution at the end, its digits, or what it has cost", "y"},
  {"--points", COUNT, "N", "rows of each member at N equal distances from its start to its end",
   NULL},
  {"--at", TIMES, "T,T,...", "the same at these ascending times", NULL},
  {"--strict", FLAG, NULL, "exit code 1 when any member fails, not only when all do", NULL},
  {"--resume", WORD, "FILE",
   "keep the rows of an earlier --csv FILE of this sweep, two of them checked, and run the "
   "others",
   NULL},
  {"--rtol", POSITIVE, "R", "relative tolerance", "1e-6"},
  {"--atol", POSITIVE, "A", "absolute tolerance (default: rtol times the problem's scale)",
   NULL},
  {"--h", POSITIVE, "H", "constant step size instead of a tolerance", NULL},
  PARALLEL_OPTION(
    "members shared by ranks: mpirun -np N steif sweep ... --parallel, a thread each"),
  SET_OPTION,
  INTERPRETED_OPTIONS,
  OPTIONS_END,
};
static const struct rule rules[] = {{"--p", REQUIRED, NULL},
                                    {"--seed", NEEDS, "--random"},
                                    {"--h", EXCLUDES, "--rtol"},
                                    {"--h", EXCLUDES, "--atol"},
                                    {"--threads", AT_MOST, "64"},
                                    {"--at", EXCLUDES, "--points"},
                                    {"--parallel", EXCLUDES, "--threads"},
                                    RULES_END};

const struct verb verb_sweep = {
  .name = "sweep",
  .about = "Integrate one problem with many values of its parameters",
  .usage = "PROBLEM [METHOD] --p NAME=FROM:TO:COUNT[:log] [--p ... --random N --threads T]",
  .least = 1,
  .most = 2,
  .method = "auto",
  .picture = true,
  .option = options,
  .rule = rules,
  .run = run,
};
