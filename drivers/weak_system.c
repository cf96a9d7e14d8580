/* weak_system.c: weak convergence on a descriptor system, of one component or of all.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "weak.h"
#include <stdlib.h>

enum { SHOWN = 12 }; /* components whose values are shown */

static void fill(const struct call *call, steif_report *r, const struct weak *w, size_t n)
{
  const steif_weak_query *q = &w->query;
  const bool lists = q->component == STEIF_ALL && n <= SHOWN;
  steif_report_text(r, "method", q->method);
  steif_report_text(r, "system", call->word[1]);
  steif_report_whole(r, "index", w->result.index);
  if (q->component >= 0) steif_report_whole(r, "component", q->component);
  steif_report_text(r, "convention", convention_name(q->convention));
  if (lists)
    steif_report_list(r, "exact", n, q->exacts);
  else
    steif_report_real(r, "exact", w->result.exact);
  for (size_t i = 0; i < q->rows; i++) {
    steif_report_row(r, "rows");
    steif_report_real(r, "rows.h", w->row[i].h);
    if (lists)
      steif_report_list(r, "rows.value", n, q->values + i * n);
    else
      steif_report_real(r, "rows.value", w->row[i].value);
    steif_report_real(r, "rows.error", w->row[i].error);
    steif_report_real(r, "rows.order", w->row[i].order);
  }
  steif_report_text(r, "verdict", w->result.verdict);
  steif_report_text(r, "message", w->result.source);
}

static int answer(struct call *call, struct weak *w, size_t n)
{
  progress(call, "%s on %s", call->word[0], call->word[1]);
  if (weak_measure(call->ctx, w)) return linear_fail(call);
  steif_report *r = steif_report_new(call->ctx);
  if (r) fill(call, r, w, n);
  const int code = r ? present(call, r) : fail(call);
  steif_report_free(&r);
  return code ? code : weak_plot(call, w->query.rows, w->row);
}

static int ask(struct call *call, const struct linear *l)
{
  const size_t n = (size_t)l->n;
  struct weak w = weak_asked(call);
  if (l->t0 != 0) return refuse(call, "the test function begins at t = 0; leave --t0 out");
  if (!given(call, "--component")) w.query.component = STEIF_ALL;
  if (linear_as_published(call, l))
    w.query.problem = call->word[1];
  else
    w.query.linear = &l->system, w.query.x0 = l->x0;
  w.query.exacts = malloc(n * (w.query.rows + 1) * sizeof *w.query.exacts);
  if (!w.query.exacts) {
    say(call, "no memory for %zu components; name one by --component", n);
    return EXIT_FAILED;
  }
  w.query.values = w.query.exacts + n;
  const int code = answer(call, &w, n);
  free(w.query.exacts);
  return code;
}

int weak_system(struct call *call)
{
  struct linear l;
  int code = linear_open(call, &l, 1, true);
  if (!code) code = linear_started(call, &l);
  if (!code) code = ask(call, &l);
  linear_close(call, &l);
  return code;
}
