/* layer.c: the initial layer of a method on N x' + x = f, step by step.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "layer.h"

static void fill(steif_report *r, const struct layer *l)
{
  steif_report_whole(r, "index", (long)l->k);
  steif_report_real(r, "h", l->h);
  steif_report_whole(r, "layer_steps", l->result.layer_steps);
  for (size_t i = 0; i <= l->steps; i++) {
    steif_report_row(r, "rows");
    steif_report_whole(r, "rows.i", (long)i);
    steif_report_real(r, "rows.t", l->t[i]);
    steif_report_list(r, "rows.x", l->k, l->x + i * l->k);
    steif_report_list(r, "rows.exact", l->k, l->exact + i * l->k);
    steif_report_real(r, "rows.error", l->error[i]);
  }
}

static int tell(struct call *call, const struct layer *l)
{
  const char *other = word_of(call, "--vs", NULL);
  double error;
  steif_report *r = steif_report_new(call->ctx);
  fill(r, l);
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

static int run(struct call *call)
{
  struct layer l = {.k = (size_t)whole_of(call, "--index", 0),
                    .steps = (size_t)whole_of(call, "--steps", 8),
                    .h = real_of(call, "--h", 0)};
  if (!l.k || !given(call, "--h"))
    return refuse(call, "--index K and --h H are needed: the index of the block and the step");
  if (given(call, "--rtol") && !given(call, "--vs"))
    return refuse(call, "--rtol is the tolerance of --vs ida; add that or leave it out");
  if (l.steps > 10000000 / l.k)
    return refuse(call, "--index %zu with --steps %zu is too much; take fewer", l.k, l.steps);
  snprintf(l.problem, sizeof l.problem, "jordan:k=%zu,case=%s", l.k,
           word_of(call, "--case", "N-inc"));
  const int failed =
    layer_measure(call->ctx, &l, call->word[0], word_of(call, "--start", NULL));
  const int code = failed ? fail(call) : tell(call, &l);
  layer_free(&l);
  return code;
}

static const struct option options[] = {
  {"--index", COUNT, "K", "index of N x' + x = f, the size of the Jordan block"},
  {"--h", POSITIVE, "H", "step"},
  {"--case", WORD, "C", "H-inc, N-inc, N-cons, sin-inc or sin-cons (default N-inc)"},
  {"--start", CHOICE, "constant|ramp|cq|exact", "starting procedure of multistep methods"},
  {"--steps", COUNT, "M", "how many steps (default 8)"},
  {"--vs", CHOICE, "ida|cvode|arkode", "run that on the same system"},
  {"--rtol", POSITIVE, "R", "its relative tolerance (default 1e-6)"},
  {NULL, FLAG, NULL, NULL},
};

const struct verb verb_layer = {
  "layer",
  "Follow the initial layer on N x' + x = f step by step",
  "METHOD --index K --h H [--case C] [--start S] [--steps M] [--vs ida]",
  1,
  1,
  options,
  NULL,
  run};
