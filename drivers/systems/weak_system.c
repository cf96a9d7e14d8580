/* weak_system.c: weak convergence on a descriptor system, of one component or of all.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "output.h"
#include "weak.h"
#include <math.h>
#include <stdlib.h>

enum { SHOWN = 12 }; /* components whose values are shown */

static int ascending(const void *a, const void *b)
{
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* In order, equal ones once; how many. */
static size_t distinct(double *t, size_t count)
{
  size_t kept = 0;
  qsort(t, count, sizeof *t, ascending);
  for (size_t i = 0; i < count; i++)
    if (!kept || t[i] > t[kept - 1] * (1 + 1e-14)) t[kept++] = t[i];
  return kept;
}

static bool lists(const struct weak *w)
{
  return w->query.component == STEIF_ALL && w->n <= SHOWN;
}

static void head(steif_report *r, const struct weak *w)
{
  const steif_weak_query *q = &w->query;
  steif_report_text(r, "method", q->method);
  steif_report_text(r, "system", w->call->word[1]);
  steif_report_whole(r, "index", w->result.index);
  if (q->component >= 0) steif_report_whole(r, "component", q->component + 1);
  steif_report_text(r, "convention", convention_name(q->convention));
  if (lists(w))
    steif_report_list(r, "exact", w->n, q->exacts);
  else
    steif_report_real(r, "exact", w->result.exact);
}

static void row(steif_report *r, const struct weak *w, size_t i)
{
  weak_row_begin(r, w->row + i);
  if (lists(w))
    steif_report_list(r, "rows.value", w->n, w->query.values + i * w->n);
  else
    steif_report_real(r, "rows.value", w->row[i].value);
  weak_row_end(r, w->row + i);
}

static void tail(steif_report *r, const struct weak *w)
{
  const steif_weak_query *q = &w->query;
  if (wants_arrays(w->call) && q->component == STEIF_ALL)
    steif_report_matrix(r, "values", q->rows, w->n, q->values);
  weak_verdict(r, w);
  steif_report_text(r, "message", w->result.source);
}

static const struct weak_form form = {head, row, tail};

static int answer(struct call *call, struct weak *w)
{
  progress(call, "%s on %s", call->word[0], call->word[1]);
  return weak_answer(call, w, &form);
}

/* The first place where f turns between its breaks; NaN: none. */
static double turn(const struct descriptor *l, const struct weak *w, double t1)
{
  const steif_weak_query *q = &w->query;
  double from = 0, where;
  for (size_t i = 0; i <= q->break_count; i++) {
    const double to = i < q->break_count ? q->breaks[i] : t1, inset = 1e-9 * t1;
    if (!steif_function_smooth(l->function, from + inset, to - inset, &where)) return where;
    from = to;
  }
  return NAN;
}

/* Breaks of f: those that its expressions declare, and --breaks. */
static int find_breaks(struct call *call, const struct descriptor *l, struct weak *w)
{
  double t1, *at = w->breaks;
  const int code = weak_end_of_test(call, &t1);
  if (code) return code;
  const size_t count = reals_of(call, "--breaks", at);
  const size_t own = steif_function_breaks(l->function, 0, t1, REALS_MOST - count, at + count);
  if (count + own > REALS_MOST)
    return bad_usage(call, "f has %zu breaks up to t = %g; %d are the most", count + own, t1,
                     REALS_MOST);
  w->query.breaks = at, w->query.break_count = distinct(at, count + own);
  const double where = l->function ? turn(l, w, t1) : NAN;
  return isnan(where)
           ? EXIT_OK
           : bad_usage(call, "f is not smooth near t = %.6g: name its breaks with --breaks",
                       where);
}

static int ask(struct call *call, const struct descriptor *l)
{
  const size_t n = (size_t)l->n;
  struct weak w = weak_asked(call);
  w.n = n;
  if (l->t0 != 0) return bad_usage(call, "the test function begins at t = 0; leave --t0 out");
  if (!given(call, "--component")) w.query.component = STEIF_ALL;
  if (descriptor_as_published(call, l) && !given(call, "--breaks")) {
    w.query.problem = call->word[1];
  } else {
    w.query.linear = &l->system;
    w.query.x0 = l->x0;
    const int code = find_breaks(call, l, &w);
    if (code) return code;
  }
  w.query.exacts = malloc(n * (w.query.rows + 1) * sizeof *w.query.exacts);
  if (!w.query.exacts) return no_memory(call, "all components", "name one with --component");
  w.query.values = w.query.exacts + n;
  const int code = answer(call, &w);
  free(w.query.exacts);
  return code;
}

int weak_system(struct call *call)
{
  struct descriptor l;
  int code = descriptor_open(call, &l, 1, true);
  if (!code) code = descriptor_started(call, &l);
  if (!code) code = ask(call, &l);
  descriptor_close(call, &l);
  return code;
}
