/* layer.c: the initial layer of a method on a descriptor system, step by step.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "layer.h"
#include <math.h>

static int on_system(struct call *call, struct layer *l)
{
  struct descriptor q;
  int code = descriptor_open(call, &q, 1, true);
  if (!code) code = descriptor_started(call, &q);
  if (!code && q.t0 != 0) code = bad_usage(call, "a layer begins at t = 0; leave --t0 out");
  double at;
  if (!code && steif_function_breaks(q.function, 0, l->h * (double)l->steps, 1, &at))
    code = bad_usage(call, "f breaks at t = %g: take --steps %.0f, which end before", at,
                     floor(at / l->h));
  snprintf(l->problem, sizeof l->problem, "%s", call->word[1]);
  l->k = (size_t)q.n;
  if (!descriptor_as_published(call, &q)) l->system = &q;
  if (!code) code = layer_follow(call, l);
  descriptor_close(call, &q);
  return code;
}

static int on_block(struct call *call, struct layer *l)
{
  if (!l->k)
    return bad_usage(call,
                     "--index K is needed, the index of N x' + x = f, or a system to run on");
  snprintf(l->problem, sizeof l->problem, "jordan:k=%zu,case=%s", l->k,
           word_of(call, "--case"));
  return layer_follow(call, l);
}

static int run(struct call *call)
{
  struct layer l = {.k = (size_t)whole_of(call, "--index"),
                    .steps = (size_t)whole_of(call, "--steps"),
                    .h = real_of(call, "--h")};
  const bool block = given(call, "--index") || given(call, "--case");
  if (call->words == 1) return on_block(call, &l);
  return block
           ? bad_usage(call, "--index and --case name a Jordan block; leave them out with a "
                             "system")
           : on_system(call, &l);
}

static const struct option options[] = {
  {"--index", COUNT, "K", "index of the Jordan block N in N x' + x = f, instead of a system",
   NULL},
  {"--h", POSITIVE, "H", "constant step size", NULL},
  {"--case", WORD, "C", "its start and forcing: H-inc, N-inc, N-cons, sin-inc or sin-cons",
   "N-inc"},
  {"--component", COUNT, "I", "show one component only, counted from 1", NULL},
  {"--start", CHOICE, "constant|ramp|cq|exact", "starting procedure of multistep methods",
   NULL},
  {"--steps", COUNT, "M", "how many steps", "8"},
  {"--vs", CHOICE, "ida|cvode|arkode",
   "run this one on the same system, ida in its best setting", NULL},
  {"--rtol", POSITIVE, "R", "relative tolerance of --vs", "1e-6"},
  {"--state-space", FLAG, NULL, "the second file is A of E x' = A x + f, so F = -A", NULL},
  START_OPTIONS,
  OPTIONS_END,
};
static const struct rule rules[] = {
  {"--h", REQUIRED, NULL}, {"--rtol", NEEDS, "--vs"}, START_RULES, RULES_END};

const struct verb verb_layer = {
  .name = "layer",
  .about = "Show the initial layer of a method on a descriptor system, step by step",
  .usage = "METHOD --index K | E.mtx F.mtx --x0 X.mtx | PROBLEM --h H [--start S] [--steps M] "
           "[--vs ida]",
  .least = 1,
  .most = 3,
  .picture = true,
  .matrices = true,
  .option = options,
  .rule = rules,
  .run = run,
};
