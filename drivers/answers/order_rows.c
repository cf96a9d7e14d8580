/* order_rows.c: errors of a method with steps h, h/2, ..., and orders where rounding does not make them, row by row.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "answers.h"
#include "members.h"
#include <math.h>

/* Above rounding, as far as that is known. */
static bool usable(const steif_order_row *row) { return !(row->error < 10 * row->rounding); }

static void order_row(steif_report *r, const steif_order_row *row,
                      const steif_order_row *before)
{
  const bool seen = before && usable(row) && usable(before);
  steif_report_row(r, "rows");
  steif_report_real(r, "rows.h", row->h);
  steif_report_real(r, "rows.error", row->error);
  report_maybe(r, "rows.", "rounding", row->rounding >= 0, row->rounding);
  steif_report_real(r, "rows.order", seen ? log2(before->error / row->error) : NAN);
}

static void head(const struct call *call, const steif_problem *p, const struct order_answer *a)
{
  const double h = a->row[0].h, t1 = real_or(call, "--t1", p->t1);
  const struct steps_made made = {p->t0, h, a->row[0].end, h, t1, 0};
  steif_report *r = a->report;
  steif_report_text(r, "method", call->word[0]);
  steif_report_text(r, "problem", word_of(call, "--problem"));
  if (a->method.order) steif_report_whole(r, "claimed", a->method.order);
  steif_report_truth(r, "compensated", a->row[0].compensated);
  report_steps(r, &made);
  steif_report_text(r, "start", word_of(call, "--start"));
}

int order_measure(struct call *call, const steif_problem *p, struct order_answer *a)
{
  steif_options o = options_of(call);
  double h = real_of(call, "--h");
  int code = STEIF_OK;
  for (size_t i = 0; !code && i < a->count; i++, h /= 2) {
    steif_order_row *row = a->row + i;
    progress(call, "%s on %s, h / %g", call->word[0], p->name, ldexp(1, (int)i));
    code = steif_order_measure(call->ctx, p, call->word[0], &o, h, 1, row);
    if (!code) code = steif_order_rounding(call->ctx, p, call->word[0], &o, 1, row);
    if (!(row->error >= 0)) continue;
    if (i == 0) head(call, p, a);
    h = row->h, o.t1 = row->end;
    order_row(a->report, row, i ? row - 1 : NULL);
    a->made++;
    rows_come(call, a->report);
  }
  return code;
}
