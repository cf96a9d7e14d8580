/* layer.c: the initial layer of a run on a descriptor system, step by step, and its length.
 *
 * Outside the layer the error is what the method makes of the smooth solution. That level is
 * measured, not guessed: a twin run starts on the smooth solution LEAD steps earlier, so that at t0
 * it has forgotten its own start (backward differentiation of order p forgets in p (k-1) steps),
 * and the layer is where the error exceeds twice the twin's. The twin has the slow part of x(0+)
 * where it starts. Without forcing that of a Jordan block is zero. Where f is not known before t0
 * the twin starts at t0 and is looked at LEAD steps later.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "subject.h"
#include <math.h>
#include <string.h>

/* Errors below VISIBLE max |x_i| are rounding. */
#define VISIBLE 1e-9
enum { LEAD = 6 }; /* steps of the lead per unit of index: the largest p */

typedef struct layer {
  steif_context *ctx;
  const char *method, *start;
  stf_subject subject;
  sunrealtype h;
  size_t steps;
} layer;

static sunrealtype largest(const sunrealtype *x, size_t count)
{
  sunrealtype most = 0;
  for (size_t i = 0; i < count; i++) most = fmax(most, fabs(x[i]));
  return most;
}

/* error_i = max_m |x_im - x_s,m(t_i)| for rows 0 .. steps. */
static void compare(const layer *l, size_t steps, const sunrealtype *x,
                    const sunrealtype *exact, sunrealtype *error)
{
  const size_t n = (size_t)l->subject.n;
  for (size_t i = 0; i <= steps; i++) {
    error[i] = 0;
    for (size_t m = 0; m < n; m++)
      error[i] = fmax(error[i], fabs(x[i * n + m] - exact[i * n + m]));
  }
}

/* A multistep method that starts on the closed solution has no other twin than itself. */
static bool bound(const layer *l)
{
  const bool word = l->start ? !strcmp(l->start, "exact") : !!strstr(l->method, "start=exact");
  return word && !l->subject.block.k;
}

/* The start of the twin, and its time. */
static int twin_start(layer *l, size_t lead, sunrealtype *t, sunrealtype *x0)
{
  *t = -l->h * (sunrealtype)lead;
  const bool hushed = stf_silence(l->ctx, true);
  const int code = bound(l) ? STEIF_RETRY : stf_subject_before(&l->subject, *t, x0);
  stf_silence(l->ctx, hushed);
  if (code == STEIF_NO_MEMORY) STEIF_FAIL(l->ctx, code, "no memory for a twin of the run");
  if (!code || code == STEIF_NO_MEMORY) return code;
  *t = 0;
  return stf_subject_smooth(&l->subject, 1, t, x0);
}

/* The largest error after the lead; work: 2 n + 2 values a step and n for the start. */
static int twin_error(layer *l, size_t lead, sunrealtype *work, sunrealtype *level)
{
  stf_subject *s = &l->subject;
  const size_t n = (size_t)s->n, steps = lead + l->steps, rows = steps + 1;
  sunrealtype *t = work, *error = t + rows, *x = error + rows, *exact = x + rows * n,
              *x0 = exact + rows * n;
  steif_problem twin = s->problem;
  STEIF_TRY(twin_start(l, lead, &twin.t0, x0));
  twin.y0 = x0, twin.yp0 = NULL;
  stf_trace trace = {.count = (int)n, .steps = steps, .t = t, .x = x};
  trace.apart = stf_subject_apart(s, l->method, l->start);
  STEIF_TRY(stf_trace_run(l->ctx, &twin, l->method, l->start, l->h, &trace));
  memcpy(exact, x0, n * sizeof *exact);
  STEIF_TRY(s->block.k ? stf_subject_smooth(s, rows, t, exact)
                       : stf_subject_follow(s, rows, t, exact));
  compare(l, steps, x, exact, error);
  *level = largest(error + lead, l->steps + 1);
  return STEIF_OK;
}

static int smooth_level(layer *l, sunrealtype *level)
{
  const stf_subject *s = &l->subject;
  const size_t n = (size_t)s->n, k = (size_t)(s->index > 0 ? s->index : 1), lead = LEAD * k,
               rows = lead + l->steps + 1;
  *level = 0;
  if (s->block.k && !s->block.forcing) return STEIF_OK;
  sunrealtype *work = stf_allocate(l->ctx, rows * (2 * n + 2) + n, sizeof *work);
  if (!work) return STEIF_NO_MEMORY;
  const int code = twin_error(l, lead, work, level);
  stf_release(l->ctx, work);
  return code;
}

static int follow(layer *l, sunrealtype *t, sunrealtype *x, sunrealtype *exact,
                  sunrealtype *error, steif_layer_result *result)
{
  const size_t n = (size_t)l->subject.n;
  stf_trace trace = {.count = (int)n, .steps = l->steps, .t = t, .x = x};
  trace.apart = stf_subject_apart(&l->subject, l->method, l->start);
  STEIF_TRY(stf_trace_run(l->ctx, &l->subject.problem, l->method, l->start, l->h, &trace));
  STEIF_TRY(stf_subject_smooth(&l->subject, l->steps + 1, t, exact));
  compare(l, l->steps, x, exact, error);
  sunrealtype level;
  STEIF_TRY(smooth_level(l, &level));
  result->threshold = fmax(VISIBLE * largest(x, n * (l->steps + 1)), 2 * level);
  result->layer_steps = 0, result->index = l->subject.index;
  for (size_t i = 1; i <= l->steps; i++)
    if (!(error[i] <= result->threshold)) result->layer_steps = (int)i;
  return STEIF_OK;
}

static int check(const layer *l)
{
  STEIF_CHECK(l->method, l->ctx, STEIF_BAD_INPUT,
              "no method was named: give one such as \"be\"");
  STEIF_CHECK(l->h > 0 && isfinite(l->h), l->ctx, STEIF_BAD_INPUT,
              "the step h = %g must be positive", l->h);
  STEIF_CHECK(l->steps >= 1 && l->steps <= 1u << 24, l->ctx, STEIF_BAD_INPUT,
              "%zu steps were asked for: give 1 to %u", l->steps, 1u << 24);
  return STEIF_OK;
}

int steif_layer_measure(steif_context *ctx, const char *method, const char *problem,
                        const char *start, sunrealtype h, size_t steps, sunrealtype *t,
                        sunrealtype *x, sunrealtype *exact, sunrealtype *error,
                        steif_layer_result *result)
{
  STEIF_CHECK(result, ctx, STEIF_BAD_INPUT, "no place for the result: it is NULL");
  *result = (steif_layer_result){0};
  layer l = {.ctx = ctx, .method = method, .start = start, .h = h, .steps = steps};
  STEIF_TRY(check(&l));
  STEIF_TRY(stf_subject_open(ctx, problem, NULL, NULL, &l.subject));
  const int code = follow(&l, t, x, exact, error, result);
  stf_subject_close(&l.subject);
  return code;
}

int steif_layer_linear(steif_context *ctx, const char *method, const steif_linear *linear,
                       const sunrealtype *x0, const char *start, sunrealtype h, size_t steps,
                       sunrealtype *t, sunrealtype *x, sunrealtype *exact, sunrealtype *error,
                       steif_layer_result *result)
{
  STEIF_CHECK(result, ctx, STEIF_BAD_INPUT, "no place for the result: it is NULL");
  *result = (steif_layer_result){0};
  layer l = {.ctx = ctx, .method = method, .start = start, .h = h, .steps = steps};
  STEIF_TRY(check(&l));
  STEIF_CHECK(linear, ctx, STEIF_BAD_INPUT, "no system was given: E and F are needed");
  STEIF_TRY(stf_subject_open(ctx, NULL, linear, x0, &l.subject));
  const int code = follow(&l, t, x, exact, error, result);
  stf_subject_close(&l.subject);
  return code;
}
