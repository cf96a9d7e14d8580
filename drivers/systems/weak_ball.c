/* weak_ball.c: weak convergence in H^-m, the worst case over all test functions.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "weak.h"
#include <math.h>

struct answer {
  const struct weak *weak;
  steif_weak_ball result;
  steif_ball_row row[HALVINGS];
};

static void fill(steif_report *r, const struct call *call, const void *result)
{
  const struct answer *a = result;
  const steif_weak_query *q = &a->weak->query;
  steif_report_text(r, "method", q->method);
  steif_report_text(r, "system", a->weak->k ? a->weak->problem : call->word[1]);
  steif_report_whole(r, "index", a->result.index);
  steif_report_text(r, "convention", convention_name(q->convention));
  steif_report_whole(r, "m", a->result.m);
  if (q->cells) steif_report_whole(r, "cells", q->cells);
  for (size_t i = 0; i < q->rows; i++) {
    const steif_ball_row *row = a->row + i;
    steif_report_row(r, "rows");
    steif_report_real(r, "rows.h", row->h);
    steif_report_real(r, "rows.norm", row->norm);
    if (q->cells) steif_report_real(r, "rows.bsplines", row->splines);
    steif_report_real(r, "rows.rounding", row->rounding);
    steif_report_real(r, "rows.order", row->usable ? row->order : NAN);
  }
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
  struct answer a = {.weak = w};
  int code = weak_prepare(call->ctx, w);
  if (!code) code = steif_weak_measure_ball(call->ctx, &w->query, m, a.row, &a.result);
  if (code) return descriptor_fail(call);
  code = present_result(call, fill, &a);
  if (code || !weak_is_open(a.result.converges, a.result.verdict)) return code;
  say(call, "%s [STEIF_NOT_CERTIFIED]", a.result.verdict);
  return EXIT_UNCERTIFIED;
}
