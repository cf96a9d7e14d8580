/* order.c: the observed order of a method.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "answers.h"
#include "curves.h"

static int draw(const struct call *call, const struct order_answer *a)
{
  error_curves errors = {.title = call->word[0], .y_label = "error"};
  errors_open(&errors, call->word[0]);
  for (size_t i = 0; i < a->count; i++) errors_add(&errors, a->row[i].h, a->row[i].error);
  return errors_plot(call, &errors, call->plot);
}

static int run(struct call *call)
{
  static struct order_answer a;
  steif_problem p;
  a = (struct order_answer){.count = (size_t)whole_of(call, "--halvings") + 1};
  if (steif_method_find(call->ctx, call->word[0], &a.method)) return fail(call);
  int code = find_problem(call, word_of(call, "--problem"), &p);
  if (code) return code;
  a.report = steif_report_new(call->ctx);
  code = a.report ? order_measure(call, &p, &a) : STEIF_NO_MEMORY;
  const bool shown = !code || (code == STEIF_STOPPED && a.made);
  const int output = shown ? present(call, a.report) : EXIT_OK;
  code = code ? fail(call) : output;
  steif_report_free(&a.report);
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
