/* weak_ball.c: weak convergence in H^-m, the worst case over all test functions.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "output.h"
#include "weak.h"
#include <math.h>

struct answer {
  const struct weak *weak;
  steif_report *report;
  steif_weak_ball result;
  steif_ball_row row[HALVINGS];
};

static void arrays(steif_report *r, const struct answer *a, size_t rows)
{
  double h[HALVINGS], norm[HALVINGS];
  for (size_t i = 0; i < rows; i++) h[i] = a->row[i].h, norm[i] = a->row[i].norm;
  steif_report_list(r, "h", rows, h);
  steif_report_list(r, "norm", rows, norm);
}

static void head(const struct answer *a)
{
  steif_report *r = a->report;
  const struct call *call = a->weak->call;
  const steif_weak_query *q = &a->weak->query;
  steif_report_text(r, "method", q->method);
  steif_report_text(r, "system", a->weak->k ? a->weak->problem : call->word[1]);
  steif_report_whole(r, "index", a->result.index);
  steif_report_text(r, "convention", convention_name(q->convention));
  steif_report_whole(r, "m", a->result.m);
  if (q->cells) steif_report_whole(r, "cells", q->cells);
}

/* The callback of the measure. */
static int told(size_t i, void *user)
{
  const struct answer *a = user;
  steif_report *r = a->report;
  const steif_ball_row *row = a->row + i;
  if (i == 0) head(a);
  steif_report_row(r, "rows");
  steif_report_real(r, "rows.h", row->h);
  steif_report_real(r, "rows.norm", row->norm);
  if (a->weak->query.cells) steif_report_real(r, "rows.bsplines", row->splines);
  steif_report_real(r, "rows.rounding", row->rounding);
  steif_report_real(r, "rows.order", row->usable ? row->order : NAN);
  rows_come(a->weak->call, r);
  return 0;
}

static void tail(const struct answer *a)
{
  steif_report *r = a->report;
  if (wants_arrays(a->weak->call)) arrays(r, a, a->weak->query.rows);
  for (int i = 0; i < a->result.count; i++) {
    const steif_ball_space *s = a->result.space + i;
    steif_report_row(r, "spaces");
    steif_report_whole(r, "spaces.m", s->m);
    steif_report_real(r, "spaces.norm", s->norm);
    steif_report_real(r, "spaces.order", s->order);
    steif_report_whole(r, "spaces.converges", s->converges);
  }
  if (*a->result.mesh) steif_report_text(r, "mesh", a->result.mesh);
  steif_report_text(r, "verdict", a->result.verdict);
}

int weak_ball(struct call *call, struct weak *w, int m)
{
  struct answer a = {.weak = w, .report = steif_report_new(call->ctx)};
  int code = a.report ? weak_prepare(call->ctx, w) : STEIF_NO_MEMORY;
  w->query.tell = told, w->query.told = &a;
  if (!code) code = steif_weak_measure_ball(call->ctx, &w->query, m, a.row, &a.result);
  speak(a.result.verdict, sizeof a.result.verdict);
  if (!code) tail(&a);
  code = code ? descriptor_fail(call) : present(call, a.report);
  steif_report_free(&a.report);
  if (code || !weak_is_open(a.result.converges, a.result.verdict)) return code;
  say(call, "%s [STEIF_NOT_CERTIFIED]", a.result.verdict);
  return EXIT_UNCERTIFIED;
}
