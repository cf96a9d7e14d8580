/* step_record.c: what a step leaves for the way back.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "backwards.h"
#include <math.h>
#include <string.h>

static int trace(const steif_solver *s, stf_trace *out)
{
  const steif_method *method = s->step.method;
  STEIF_CHECK(
    !s->engine && method && method->trace, s->ctx, STEIF_UNSUPPORTED,
    "gradients by '%s' are not served: take collocation (radau:s=3), dirk:hw43 or bdf",
    s->spec);
  return method->trace(&s->step, out);
}

int stf_record_open(stf_backwards *B)
{
  stf_trace now = {0};
  STEIF_TRY(trace(B->home, &now));
  const size_t n = (size_t)B->n;
  B->kind = now.kind, B->table = B->home->step.table;
  B->points = now.kind == STF_TRACE_BDF ? 2 : B->table->s;
  B->adaptive = B->home->step.adaptive;
  B->own = B->width = STF_HEAD + 2 * n * (size_t)B->points + (B->adaptive ? n : 0);
  return STEIF_OK;
}

static sunrealtype *put(sunrealtype *at, N_Vector v)
{
  const size_t n = (size_t)NV_LENGTH_S(v);
  memcpy(at, STF_ARRAY(v), n * sizeof *at);
  return at + n;
}

/* Stages X, slopes of the polynomial through them. */
static int stages_of(stf_backwards *B, steif_solver *s, N_Vector before, sunrealtype *to)
{
  const stf_step *step = &s->step;
  const sunrealtype *c, *b, *M = B->adjoint.transform.B;
  int count;
  N_Vector *X;
  STEIF_TRY(step->method->stages(step, &count, &c, &b, &X));
  for (int j = 0; j < count; j++) stf_sum(&B->space, 1, X[j], -1, before, B->r[j]);
  for (int j = 0; j < count; j++) {
    if (count > 1)
      stf_combine(&B->space, count, M + j * count, B->r, B->work);
    else
      stf_scale(&B->space, 1 / B->table->A[0], B->r[0], B->work);
    stf_scale(&B->space, 1 / step->h, B->work, B->work);
    to = put(put(to, X[j]), B->work);
  }
  return STEIF_OK;
}

static void slope(stf_backwards *B, int order, const sunrealtype *alpha, sunrealtype h,
                  N_Vector *past)
{
  sunrealtype a[STF_PAST];
  for (int j = 0; j <= order; j++) a[j] = alpha[j] / h;
  stf_combine(&B->space, order + 1, a, past, B->work);
}

static void bdf_of(stf_backwards *B, const stf_trace *now, const stf_step *step,
                   sunrealtype *to)
{
  N_Vector first[] = {now->between, now->past[1]}, second[] = {now->past[0], now->between};
  const size_t pair = 2 * (size_t)B->n;
  if (!now->between) {
    slope(B, now->order, now->alpha, step->h, now->past);
    put(put(to + pair, now->past[0]), B->work);
    return;
  }
  slope(B, 1, now->alpha, step->h / 2, first);
  to = put(put(to, now->between), B->work);
  slope(B, 1, now->alpha, step->h / 2, second);
  put(put(to, now->past[0]), B->work);
}

/* Where the step began: one that ends at a break ends just before it, and so do its stages. */
static sunrealtype beginning(const steif_solver *s)
{
  const steif_problem *p = s->problem;
  const stf_step *step = &s->step;
  sunrealtype from = step->t - step->h;
  if (step->adaptive && s->next_break < p->break_count && step->t == p->breaks[s->next_break])
    while (from + step->h >= step->t) from -= STF_EPS * fabs(step->t);
  return from;
}

int stf_record_step(stf_backwards *B, steif_solver *s, N_Vector before, sunrealtype *record)
{
  const stf_step *step = &s->step;
  stf_trace now = {0};
  STEIF_TRY(trace(s, &now));
  stf_head head = {
    .t = beginning(s), .h = step->h, .order = now.order, .halved = now.between != NULL};
  for (int j = 0; now.alpha && j <= now.order; j++) head.alpha[j] = now.alpha[j];
  memcpy(record, &head, sizeof head);
  sunrealtype *to = record + STF_HEAD;
  if (now.kind == STF_TRACE_COLLOCATION) STEIF_TRY(stages_of(B, s, before, to));
  if (now.kind == STF_TRACE_BDF) bdf_of(B, &now, step, to);
  for (int j = 0; now.kind == STF_TRACE_CHAIN && j < B->points; j++)
    to = put(put(to, now.Y[j]), now.Yp[j]);
  if (B->adaptive) put(record + B->own - (size_t)B->n, step->error);
  return STEIF_OK;
}

void stf_record_read(stf_backwards *B, const sunrealtype *record)
{
  const size_t n = (size_t)B->n;
  record += STF_HEAD;
  for (int j = 0; j < B->points; j++) {
    memcpy(STF_ARRAY(B->Y[j]), record, n * sizeof *record);
    memcpy(STF_ARRAY(B->Yp[j]), record + n, n * sizeof *record);
    record += 2 * n;
  }
  if (B->adaptive) memcpy(STF_ARRAY(B->error), record, n * sizeof *record);
}
