/* weak_block.c: weak convergence on one Jordan block.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "weak.h"

static void head(steif_report *r, const struct weak *w)
{
  steif_report_text(r, "method", w->query.method);
  steif_report_whole(r, "index", w->k);
  steif_report_text(r, "case", w->kind);
  steif_report_text(r, "convention", convention_name(w->query.convention));
  steif_report_real(r, "exact", w->result.exact);
}

static void row(steif_report *r, const struct weak *w, size_t i)
{
  weak_row_begin(r, w->row + i);
  steif_report_real(r, "rows.value", w->row[i].value);
  weak_row_end(r, w->row + i);
}

static const struct weak_form form = {head, row, weak_verdict};

int weak_block(struct call *call)
{
  struct weak w = weak_asked(call);
  if (!w.k)
    return bad_usage(call,
                     "--index K is needed, the index of N x' + x = f, or a system to run on");
  progress(call, "%s on index %ld", w.query.method, w.k);
  return weak_answer(call, &w, &form);
}
