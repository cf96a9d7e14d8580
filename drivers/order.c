/* order.c: the observed order of a method.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "answers.h"
#include "curves.h"

struct answer {
  steif_method_info method;
  size_t count;           /* of rows asked for; a signal leaves the last ones without error */
  struct steps_made made; /* by the first row */
  steif_order_row row[HALVINGS];
};

static void fill(steif_report *r, const struct call *call, const void *result)
{
  const struct answer *a = result;
  steif_report_text(r, "method", call->word[0]);
  steif_report_text(r, "problem", word_of(call, "--problem"));
  if (a->method.order) steif_report_whole(r, "claimed", a->method.order);
  steif_report_truth(r, "compensated", a->row[0].compensated);
  report_steps(r, &a->made);
  steif_report_text(r, "start", word_of(call, "--start"));
  order_rows(r, a->count, a->row);
}

static int draw(const struct call *call, const struct answer *a)
{
  error_curves errors = {.title = call->word[0], .y_label = "error"};
  errors_open(&errors, call->word[0]);
  for (size_t i = 0; i < a->count; i++) errors_add(&errors, a->row[i].h, a->row[i].error);
  return errors_plot(call, &errors, call->plot);
}

static int present_rows(const struct call *call, const steif_problem *p, struct answer *a)
{
  const double h = a->row[0].h, t1 = real_or(call, "--t1", p->t1);
  a->made = (struct steps_made){p->t0, h, a->row[0].end, h, t1, 0};
  return present_result(call, fill, a);
}

static int run(struct call *call)
{
  struct answer a = {.count = (size_t)whole_of(call, "--halvings") + 1};
  const steif_options o = options_of(call);
  steif_problem p;
  if (steif_method_find(call->ctx, call->word[0], &a.method)) return fail(call);
  int code = find_problem(call, word_of(call, "--problem"), &p);
  if (code) return code;
  progress(call, "%s on %s", call->word[0], p.name);
  interruption_poll();
  code =
    steif_order_measure(call->ctx, &p, call->word[0], &o, real_of(call, "--h"), a.count, a.row);
  if (!code) code = steif_order_rounding(call->ctx, &p, call->word[0], &o, a.count, a.row);
  if (code == STEIF_STOPPED && a.row[0].error >= 0) present_rows(call, &p, &a);
  code = code ? fail(call) : present_rows(call, &p, &a);
  steif_problem_clear(call->ctx, &p);
  return code ? code : draw(call, &a);
}

static const struct option options[] = {
  {"--problem", WORD, "P", "problem with an exact solution or a reference", "harmonic"},
  {"--h", POSITIVE, "H", "first step size (default: 1/16; 1/4 and 1/2 for high orders)", NULL},
  {"--halvings", NATURAL, "M", "how often it is halved", "4"},
  RUN_OPTIONS,
  OPTIONS_END};
static const struct rule rules[] = {{"--halvings", AT_MOST, "39"}, RULES_END};

const struct verb verb_order = {
  .name = "order",
  .about = "Measure the order of a method by halving its step size",
  .usage = "METHOD [--problem P] [--h H --halvings M]",
  .least = 1,
  .most = 1,
  .picture = true,
  .option = options,
  .rule = rules,
  .run = run,
};
