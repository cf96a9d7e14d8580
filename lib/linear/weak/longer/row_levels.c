/* row_levels.c: a run in double, paired, and beside it runs that tell its rounding: the same in long double,
 * once with the data of the run, once with f, t and what else is known to double only changed by random
 * parts of eps, and once each from unknowns in other orders, where coordinates are the run's own. Where a
 * method has no such run, runs on multiples of the data differ by rounding alone.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "measure.h"
#include <math.h>
#include <string.h>

/* Of differences between runs on multiples of the data, which see nothing of coefficients that are
 * rounded once and for all; of those between coordinates, each a sample of the rounding of both; events
 * of the first three runs are kept. */
enum { DISTRUST = 16, TURNED = 4, EVENTS = 3 };

stf_frame stf_measure_frame(stf_measure *w)
{
  stf_subject *s = &w->subject;
  stf_apart *apart =
    w->as_given ? NULL : stf_subject_apart(s, w->query->method, w->query->start);
  return apart ? (stf_frame){&apart->linear, apart->z0, apart, NULL}
               : (stf_frame){&s->linear, s->problem.y0, NULL, NULL};
}

stf_frame stf_measure_turn(const stf_measure *w, int i)
{
  const stf_turned *t = w->turned + i;
  return (stf_frame){&t->apart.linear, t->apart.z0, &t->apart, t};
}

long double stf_frame_component(const stf_frame *frame, int m, const long double *z)
{
  long double sum = 0;
  if (!frame->apart) return z[m];
  const size_t n = (size_t)frame->apart->n,
               at = (size_t)(frame->turned ? stf_turned_place(frame->turned, m) : m);
  for (size_t j = 0; j < n; j++) sum += frame->apart->maps.back[j * n + at] * z[j];
  return sum;
}

static stf_pairing pairing_of(stf_measure *w, int which)
{
  const size_t n = (size_t)w->subject.n;
  stf_pairing p = {.g = &w->subject.weight,
                   .convention = w->query->convention,
                   .solved = w->cq,
                   .unit = stf_measure_step(w),
                   .n = w->subject.n,
                   .sum = w->sum + (size_t)which * n};
  memset(p.sum, 0, n * sizeof *p.sum);
  if (w->events) p.events = w->events + which, p.events->count = 0;
  return p;
}

/* Segment i of the run: its steps, and Gregory's weights where another one follows. */
static stf_segment go_on(const stf_measure *w, size_t i, stf_pairing *p)
{
  const stf_segment part = stf_measure_segment(w, i);
  p->from = part.from, p->h = part.h, p->steps = part.steps;
  p->ends = i + 1 < w->mesh.count ? w->mesh.ends : 0;
  return part;
}

static int in_double(stf_measure *w, const steif_problem *problem, stf_apart *apart, int which)
{
  const steif_weak_query *q = w->query;
  stf_pairing p = pairing_of(w, which);
  for (size_t i = 0; i < w->mesh.count; i++) {
    const stf_segment part = go_on(w, i, &p);
    steif_problem from = *problem;
    stf_trace trace = {
      .steps = part.steps, .apart = apart, .pairing = &p, .state = w->away, .continued = i > 0};
    from.t0 = (sunrealtype)part.from;
    if (w->subject.sides.count) trace.sides = &w->subject.sides;
    STEIF_TRY(stf_trace_run(w->ctx, &from, q->method, q->start, (sunrealtype)part.h, &trace));
  }
  return STEIF_OK;
}

void stf_longer_segment(stf_longer *run, const stf_segment *part, size_t i)
{
  run->from = part->from, run->h = part->h, run->steps = part->steps;
  run->continued = i > 0;
}

stf_longer stf_measure_longer(const stf_measure *w, const stf_frame *frame, bool shaken)
{
  const stf_subject *s = &w->subject;
  return (stf_longer){.ctx = w->ctx,
                      .linear = frame->linear,
                      .sides = s->sides.count ? (stf_sides *)&s->sides : NULL,
                      .closed = s->problem.exact ? &s->problem : NULL,
                      .method = w->query->method,
                      .start = w->query->start,
                      .x0 = frame->x0,
                      .n = s->n,
                      .shaken = shaken};
}

static int in_long_double(stf_measure *w, const stf_frame *frame, bool shaken, int which)
{
  stf_pairing p = pairing_of(w, which);
  stf_longer run = stf_measure_longer(w, frame, shaken);
  run.pairing = &p, run.state = w->sum + 4 * w->subject.n;
  if (which == 1) {
    p.square = w->sum + 3 * w->subject.n;
    memset(p.square, 0, (size_t)w->subject.n * sizeof *p.square);
  }
  if (frame->turned) p.events = NULL;
  for (size_t i = 0; i < w->mesh.count; i++) {
    const stf_segment part = go_on(w, i, &p);
    stf_longer_segment(&run, &part, i);
    STEIF_TRY(stf_longer_run(&run));
  }
  return STEIF_OK;
}

/* ---- multiples of the data --------------------------------------------------------------------- */

typedef struct multiple {
  const steif_linear *linear;
  sunrealtype factor;
} multiple;

static int multiplied(sunrealtype t, int derivative, N_Vector g, void *user)
{
  const multiple *m = user;
  const int code = m->linear->f(t, derivative, g, m->linear->user);
  if (!code) N_VScale(m->factor, g, g);
  return code;
}

/* The run on factor times x(0-) and f, divided by it, added to the levels where it differs more. */
static int again(stf_measure *w, const stf_frame *frame, sunrealtype factor)
{
  stf_subject *s = &w->subject;
  stf_apart *apart = frame->apart ? &s->apart : NULL;
  multiple m = {&s->linear, factor};
  const steif_linear scaled = {s->linear.E, s->linear.F, s->linear.f ? multiplied : NULL, &m};
  const steif_linear *kept = apart ? apart->from : NULL;
  steif_problem problem;
  sunrealtype *x0 = stf_allocate(w->ctx, (size_t)s->n, sizeof *x0);
  if (!x0) return STEIF_NO_MEMORY;
  for (int i = 0; i < s->n; i++) x0[i] = factor * s->problem.y0[i];
  if (apart) apart->from = &scaled;
  int code = steif_linear_problem(w->ctx, &scaled, x0, 0, 1, &problem);
  if (!code) code = in_double(w, &problem, apart, 1);
  if (apart) apart->from = kept;
  stf_release(w->ctx, x0);
  for (int i = 0; !code && i < s->n; i++) {
    const sunrealtype v = (sunrealtype)(stf_frame_component(frame, i, w->sum + s->n) / factor);
    w->level[i] = fmax(w->level[i], DISTRUST * fabs(v - w->value[i]));
  }
  return code;
}

static int level_by_multiples(stf_measure *w, const stf_frame *frame)
{
  static const sunrealtype factor[] = {1.0 / 3, 0.7, 1.3};
  memset(w->level, 0, (size_t)w->subject.n * sizeof *w->level);
  for (int i = 0; w->subject.linear.E && i < 3; i++) STEIF_TRY(again(w, frame, factor[i]));
  return STEIF_OK;
}

/* ---- other runs --------------------------------------------------------------------------------- */

/* What the sums in `row` of frame `other` differ by from those in row 1, added to the levels with a
 * factor where it is the largest so far. */
static void differ(stf_measure *w, const stf_frame *frame, const stf_frame *other, int row,
                   int base, int factor)
{
  const size_t n = (size_t)w->subject.n;
  for (int m = 0; m < w->subject.n; m++) {
    const long double v = stf_frame_component(frame, m, w->sum + (size_t)base * n),
                      u = stf_frame_component(other, m, w->sum + (size_t)row * n);
    const sunrealtype apart = (sunrealtype)(factor * fabsl(u - v));
    w->away[m] = isfinite(apart) ? fmax(w->away[m], apart) : INFINITY;
  }
}

/* `run` of every turn into row 2. */
static int turns(stf_measure *w, const stf_frame *frame, int base)
{
  for (int i = 0; i < STF_TURNS && frame->apart && w->turned[i].apart.linear.E; i++) {
    const stf_frame turn = stf_measure_turn(w, i);
    STEIF_TRY(w->query->exact ? stf_exact_sums(w, &turn, false, 2)
                              : in_long_double(w, &turn, false, 2));
    differ(w, frame, &turn, 2, base, TURNED);
  }
  return STEIF_OK;
}

/* What the spline is not of the test function, against smooth parts. */
static sunrealtype defect(const stf_measure *w)
{
  const stf_subject *s = &w->subject;
  return (sunrealtype)(w->smooth.defect * s->weight.t1) * stf_subject_rounding(s) / STF_EPS;
}

/* What the weights of row 1 leave open of x_m. */
static long double weight_noise(const stf_measure *w, const stf_frame *frame, int m)
{
  const size_t n = (size_t)w->subject.n;
  const long double *square = w->sum + 3 * n;
  long double sum = 0;
  if (!frame->apart) return stf_weight_noise(&w->subject.weight, square[m]);
  for (size_t j = 0; j < n; j++)
    sum += fabsl((long double)frame->apart->maps.back[j * n + (size_t)m]) *
           stf_weight_noise(&w->subject.weight, square[j]);
  return sum;
}

static int level_by_longer(stf_measure *w, const stf_frame *frame)
{
  const size_t n = (size_t)w->subject.n;
  memset(w->away, 0, n * sizeof *w->away);
  STEIF_TRY(in_long_double(w, frame, false, 1));
  STEIF_TRY(in_long_double(w, frame, true, 2));
  differ(w, frame, frame, 2, 1, 2);
  STEIF_TRY(turns(w, frame, 1));
  for (int m = 0; m < w->subject.n; m++) {
    const long double v = stf_frame_component(frame, m, w->sum + n);
    w->level[m] = (sunrealtype)(fabsl(w->value[m] - v) + weight_noise(w, frame, m)) +
                  w->away[m] + defect(w);
    if (!isfinite(w->level[m])) w->level[m] = INFINITY;
  }
  return STEIF_OK;
}

/* Rounding is that of f, and of what else is known to double only. */
static int in_many_digits(stf_measure *w, const stf_frame *frame)
{
  const stf_subject *s = &w->subject;
  memset(w->away, 0, (size_t)s->n * sizeof *w->away);
  STEIF_TRY(stf_exact_sums(w, frame, false, 0));
  STEIF_TRY(stf_exact_sums(w, frame, true, 1));
  differ(w, frame, frame, 1, 0, 2);
  STEIF_TRY(turns(w, frame, 0));
  for (int m = 0; m < s->n; m++) {
    w->value[m] = (sunrealtype)stf_frame_component(frame, m, w->sum);
    w->level[m] = w->away[m] + defect(w);
  }
  return STEIF_OK;
}

/* Events in components of the problem. */
static int leave(const stf_measure *w, const stf_frame *frame, const stf_events *events)
{
  const size_t n = (size_t)w->subject.n;
  long double *x = stf_allocate(w->ctx, n, sizeof *x);
  if (!x) return STEIF_NO_MEMORY;
  for (size_t i = 0; i < events->count; i++) {
    long double *z = events->value + i * n;
    for (size_t m = 0; m < n; m++) x[m] = stf_frame_component(frame, (int)m, z);
    memcpy(z, x, n * sizeof *x);
  }
  stf_release(w->ctx, x);
  return STEIF_OK;
}

int stf_measure_run(stf_measure *w, size_t row)
{
  stf_subject *s = &w->subject;
  w->halvings = (int)row;
  const sunrealtype h = stf_measure_step(w);
  if (stf_is_cobb(w->query->method)) return stf_cobb_run(w, h);
  const stf_frame frame = stf_measure_frame(w);
  if (frame.apart) stf_apart_enter(frame.apart, s->n, s->problem.y0, s->apart.z0);
  if (w->query->exact) return in_many_digits(w, &frame);
  if (w->query->convention == STEIF_P || w->query->convention == STEIF_R)
    STEIF_TRY(stf_weight_resolve(&s->weight, h));
  STEIF_TRY(in_double(w, &s->problem, frame.apart ? &s->apart : NULL, 0));
  for (int m = 0; m < s->n; m++)
    w->value[m] = (sunrealtype)stf_frame_component(&frame, m, w->sum);
  STEIF_TRY(w->longer ? level_by_longer(w, &frame) : level_by_multiples(w, &frame));
  for (int i = 0; w->events && frame.apart && i < EVENTS; i++)
    STEIF_TRY(leave(w, &frame, w->events + i));
  return STEIF_OK;
}
