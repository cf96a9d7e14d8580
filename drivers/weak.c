/* weak.c: does a method converge weakly on N x' + x = f, or on a system?
 * SPDX-License-Identifier: BSD-3-Clause */
#include "weak.h"

static int run(struct call *call)
{
  const bool block = given(call, "--index") || given(call, "--case");
  if (call->words == 1) return weak_block(call);
  return block
           ? bad_usage(call, "--index and --case name a Jordan block; leave them out with a "
                             "system")
           : weak_system(call);
}

static const struct option options[] = {
  {"--index", COUNT, "K", "index of the Jordan block N in N x' + x = f, instead of a system",
   NULL},
  {"--case", WORD, "C", "its start and forcing: H-inc, N-inc, N-cons, sin-inc or sin-cons",
   "N-inc"},
  {"--component", COUNT, "I",
   "one component, counted from 1 (default: 1 of a block, all of a system)", NULL},
  {"--convention", CHOICE, "P|R|C|stage",
   "how the values x_n are read as a function (steif/weak.h)", NULL},
  {"--start", CHOICE, "constant|ramp|cq|exact", "starting procedure of multistep methods",
   NULL},
  {"--h", POSITIVE, "H", "first step size (default: 1/64 of the interval, breaks on the mesh)",
   NULL},
  {"--halvings", NATURAL, "M", "how often it is halved (default: 4; 0 with --h)", NULL},
  {"--breaks", REALS, "a,b,c",
   "times at which f or a derivative of it jumps (default: those of "
   "step, ramp, abs, min and max of what is linear in t)",
   NULL},
  {"--restart", FLAG, NULL,
   "restart at each break, with steps near H between breaks (default: where no constant step "
   "fits them all)",
   NULL},
  {"--g", WORD, "EXPR[;EXPR..]",
   "test functions: expressions in t, or power:n=, bump:c=,w=, "
   "expcos:a=,b=, hermite:n=,scale=",
   "power:n=8"},
  {"--ball", COUNT, "M",
   "the worst of all test functions instead: norms in H^-M, and orders in H^-m "
   "for all m (--g ball:m=M; bspline:m=M,cells=N: beside the worst of such splines)",
   NULL},
  {"--exact", FLAG, NULL, "runs in many-digit arithmetic: where rounding would decide", NULL},
  {"--t1", POSITIVE, "T", "they end at T (default: 1, or where they are 0)", NULL},
  {"--state-space", FLAG, NULL, "the second file is A of E x' = A x + f, so F = -A", NULL},
  START_OPTIONS,
  OPTIONS_END,
};
static const struct rule rules[] = {
  {"--halvings", AT_MOST, "39"}, {"--ball", EXCLUDES, "--g"}, START_RULES, RULES_END};

const struct verb verb_weak = {
  .name = "weak",
  .about = "Measure weak convergence: <x_h, g> of a run against <x, g> of the exact "
           "distribution; METHOD cobb: of "
           "(E + h F) x' + F x = f",
  .usage = "METHOD --index K | E.mtx F.mtx --x0 X.mtx | PROBLEM [--convention V] [--start S] "
           "[--h H]",
  .least = 1,
  .most = 3,
  .picture = true,
  .matrices = true,
  .option = options,
  .rule = rules,
  .run = run,
};
