/* counterexample_answer.c: a counterexample, and what a method makes of it.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "answers.h"
#include "members.h"

/* lambda(t) as text. */
static void formula(const struct counterexample_answer *a, char *text, size_t room)
{
  const steif_counterexample *e = &a->facts;
  int used = snprintf(text, room, "%.10g - %.10g", a->rate, e->E);
  for (int i = 0; i < e->nodes; i++)
    used += snprintf(text + used, room - (size_t)used, " sin^2(pi (t/h - %.10g))", e->node[i]);
}

static void fill(steif_report *r, const struct call *call, const void *result)
{
  static const struct member members[] = {MEMBER(steif_counterexample, exponent, A_REAL),
                                          MEMBER(steif_counterexample, constant, A_REAL),
                                          MEMBER(steif_counterexample, cosine, A_REAL),
                                          MEMBERS_END};
  const struct counterexample_answer *a = result;
  char lambda[STEIF_STAGES * 40 + 80];
  formula(a, lambda, sizeof lambda);
  steif_report_text(r, "method", call->word[0]);
  steif_report_text(r, "lambda", lambda);
  steif_report_real(r, "h", a->h);
  steif_report_list(r, "nodes", (size_t)a->facts.nodes, a->facts.node);
  steif_report_real(r, "mean", -a->rate);
  report_members(r, "", members, &a->facts);
  const long stride = a->count > 10 ? a->count / 10 : 1;
  for (long i = stride - 1; i < a->count; i += stride) {
    steif_report_row(r, "rows");
    steif_report_real(r, "rows.t", a->t[i]);
    steif_report_real(r, "rows.method", a->x[i]);
    steif_report_real(r, "rows.exact", a->exact[i]);
  }
}

int counterexample_present(const struct call *call, const struct counterexample_answer *a)
{
  char title[160];
  const size_t count = (size_t)a->count;
  const int code = present_result(call, fill, a);
  snprintf(title, sizeof title, "x' = lambda(t) x, a counterexample to %s", call->word[0]);
  const steif_curve curve[] = {{call->word[0], count, a->t, a->x, 0},
                               {"exact", count, a->t, a->exact, 0}};
  const steif_plot plot = {
    .title = title, .x_label = "t", .y_label = "|x|", .log_y = 1, .count = 2, .curve = curve};
  return code ? code : save_plot(call, &plot, call->plot);
}
