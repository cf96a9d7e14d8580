/* layer.c: the initial layer of a method on N x' + x = f, step by step.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "layer.h"

static void fill(const struct call *call, steif_report *r, const struct layer *l)
{
  const bool one = given(call, "--component");
  const size_t n = one ? 1 : l->k, first = (size_t)whole_of(call, "--component", 0);
  steif_report_whole(r, "index", l->result.index);
  steif_report_real(r, "h", l->h);
  steif_report_whole(r, "layer_steps", l->result.layer_steps);
  for (size_t i = 0; i <= l->steps; i++) {
    steif_report_row(r, "rows");
    steif_report_whole(r, "rows.i", (long)i);
    steif_report_real(r, "rows.t", l->t[i]);
    steif_report_list(r, "rows.x", n, l->x + i * l->k + first);
    steif_report_list(r, "rows.exact", n, l->exact + i * l->k + first);
    steif_report_real(r, "rows.error", l->error[i]);
  }
}

static int tell(struct call *call, const struct layer *l)
{
  const char *other = word_of(call, "--vs", NULL);
  double error;
  steif_report *r = steif_report_new(call->ctx);
  fill(call, r, l);
  if (other) {
    const outcome o = layer_against(call->ctx, l, other, real_of(call, "--rtol", 1e-6), &error);
    steif_report_text(r, "ida.method", other);
    report_status(r, "ida.", &o);
    report_maybe(r, "ida.", "error", o.code == STEIF_OK, error);
  }
  const int code = r ? present(call, r) : fail(call);
  steif_report_free(&r);
  return code ? code : layer_plot(call, l, call->word[0]);
}

static int follow(struct call *call, struct layer *l)
{
  if (l->steps > 10000000 / l->k)
    return refuse(call, "%zu components with --steps %zu are too much; take fewer", l->k,
                  l->steps);
  if (whole_of(call, "--component", 0) >= (long)l->k)
    return refuse(call, "--component %s is not one of 0 .. %zu",
                  word_of(call, "--component", ""), l->k - 1);
  const int failed = layer_measure(call->ctx, l, call->word[0], word_of(call, "--start", NULL));
  const int code = failed ? linear_fail(call) : tell(call, l);
  layer_free(l);
  return code;
}

static int on_system(struct call *call, struct layer *l)
{
  struct linear q;
  int code = linear_open(call, &q, 1, true);
  if (!code) code = linear_started(call, &q);
  if (!code && q.t0 != 0) code = refuse(call, "a layer begins at t = 0; leave --t0 out");
  snprintf(l->problem, sizeof l->problem, "%s", call->word[1]);
  l->k = (size_t)q.n;
  if (!linear_as_published(call, &q)) l->system = &q;
  if (!code) code = follow(call, l);
  linear_close(call, &q);
  return code;
}

static int run(struct call *call)
{
  struct layer l = {.k = (size_t)whole_of(call, "--index", 0),
                    .steps = (size_t)whole_of(call, "--steps", 8),
                    .h = real_of(call, "--h", 0)};
  const bool system = call->words > 1;
  if (system && (given(call, "--index") || given(call, "--case")))
    return refuse(call, "--index and --case name a Jordan block; leave them out with a system");
  if ((!l.k && !system) || !given(call, "--h"))
    return refuse(call, "--index K and --h H are needed: the index of the block and the step");
  if (given(call, "--rtol") && !given(call, "--vs"))
    return refuse(call, "--rtol is the tolerance of --vs ida; add that or leave it out");
  snprintf(l.problem, sizeof l.problem, "jordan:k=%zu,case=%s", l.k,
           word_of(call, "--case", "N-inc"));
  return system ? on_system(call, &l) : follow(call, &l);
}

static const struct option options[] = {
  {"--index", COUNT, "K", "index of N x' + x = f, the Jordan block, instead of a system"},
  {"--h", POSITIVE, "H", "step"},
  {"--case", WORD, "C", "H-inc, N-inc, N-cons, sin-inc or sin-cons (default N-inc)"},
  {"--component", NATURAL, "I", "show that one only, from 0"},
  {"--start", CHOICE, "constant|ramp|cq|exact", "starting procedure of multistep methods"},
  {"--steps", COUNT, "M", "how many steps (default 8)"},
  {"--vs", CHOICE, "ida|cvode|arkode", "run that on the same system"},
  {"--rtol", POSITIVE, "R", "its relative tolerance (default 1e-6)"},
  {"--state-space", FLAG, NULL, "the second file is A of E x' = A x + f, so F = -A"},
  START_ROWS,
  {NULL, FLAG, NULL, NULL},
};

static const char *const clash[][2] = {{"--forcing", "--f"}, {NULL, NULL}};

const struct verb verb_layer = {"layer",
                                "Follow the initial layer of a run step by step",
                                "METHOD --index K | E.mtx F.mtx --x0 X.mtx | PROBLEM --h H "
                                "[--start S] [--steps M] [--vs ida]",
                                1,
                                3,
                                options,
                                clash,
                                run};
