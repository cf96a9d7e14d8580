/* layer.c: the initial layer of a run on an index-k block, step by step, and its length.
 *
 * Outside the layer the error is what the method makes of the smooth solution. That level is
 * measured, not guessed: a twin run starts on the smooth solution LEAD steps earlier, so that at t0
 * it has forgotten its own start (backward differentiation of order p forgets in p (k-1) steps),
 * and the layer is where the error exceeds twice the twin's. Without forcing the twin is zero.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "descriptor.h"
#include <math.h>

/* Errors below VISIBLE max |x_i| are rounding. */
#define VISIBLE 1e-9
enum { LEAD = 6 }; /* steps of the lead per unit of index: the largest p */

typedef struct layer {
  steif_context *ctx;
  const char *method, *start;
  steif_problem problem;
  stf_block block;
  sunrealtype h;
  size_t steps;
} layer;

static sunrealtype largest(const sunrealtype *x, size_t count)
{
  sunrealtype most = 0;
  for (size_t i = 0; i < count; i++) most = fmax(most, fabs(x[i]));
  return most;
}

/* error_i = max_m |x_im - x_s,m(t_i)| for rows 0 .. steps; exact gets the smooth part. */
static int compare(layer *l, size_t steps, const sunrealtype *t, const sunrealtype *x,
                   sunrealtype *exact, sunrealtype *error)
{
  const size_t k = (size_t)l->block.k;
  for (size_t i = 0; i <= steps; i++) {
    STEIF_TRY(stf_block_series(&l->block, t[i], 0, false, exact + i * k));
    error[i] = 0;
    for (size_t m = 0; m < k; m++)
      error[i] = fmax(error[i], fabs(x[i * k + m] - exact[i * k + m]));
  }
  return STEIF_OK;
}

/* The largest error after the lead; work: 2 k + 2 values a step and k for the start. */
static int twin_error(layer *l, size_t lead, sunrealtype *work, sunrealtype *level)
{
  const size_t k = (size_t)l->block.k, steps = lead + l->steps, rows = steps + 1;
  sunrealtype *t = work, *error = t + rows, *x = error + rows, *exact = x + rows * k,
              *x0 = exact + rows * k;
  steif_problem twin = l->problem;
  twin.t0 -= l->h * (sunrealtype)lead;
  STEIF_TRY(stf_block_series(&l->block, twin.t0, 0, false, x0));
  twin.y0 = x0;
  twin.yp0 = NULL;
  stf_trace trace = {.count = (int)k, .steps = steps, .t = t, .x = x};
  STEIF_TRY(stf_trace_run(l->ctx, &twin, l->method, l->start, l->h, &trace));
  STEIF_TRY(compare(l, steps, t, x, exact, error));
  *level = largest(error + lead, l->steps + 1);
  return STEIF_OK;
}

static int smooth_level(layer *l, sunrealtype *level)
{
  const size_t k = (size_t)l->block.k, lead = LEAD * k, rows = lead + l->steps + 1;
  *level = 0;
  if (!l->block.forcing) return STEIF_OK;
  sunrealtype *work = stf_allocate(l->ctx, rows * (2 * k + 2) + k, sizeof *work);
  if (!work) return STEIF_NO_MEMORY;
  const int code = twin_error(l, lead, work, level);
  stf_release(l->ctx, work);
  return code;
}

static int follow(layer *l, sunrealtype *t, sunrealtype *x, sunrealtype *exact,
                  sunrealtype *error, steif_layer_result *result)
{
  const size_t k = (size_t)l->block.k;
  stf_trace trace = {.count = (int)k, .steps = l->steps, .t = t, .x = x};
  STEIF_TRY(stf_trace_run(l->ctx, &l->problem, l->method, l->start, l->h, &trace));
  STEIF_TRY(compare(l, l->steps, t, x, exact, error));
  sunrealtype level;
  STEIF_TRY(smooth_level(l, &level));
  result->threshold = fmax(VISIBLE * largest(x, k * (l->steps + 1)), 2 * level);
  result->layer_steps = 0;
  for (size_t i = 1; i <= l->steps; i++)
    if (!(error[i] <= result->threshold)) result->layer_steps = (int)i;
  return STEIF_OK;
}

int steif_layer_measure(steif_context *ctx, const char *method, const char *problem,
                        const char *start, sunrealtype h, size_t steps, sunrealtype *t,
                        sunrealtype *x, sunrealtype *exact, sunrealtype *error,
                        steif_layer_result *result)
{
  *result = (steif_layer_result){0};
  STEIF_CHECK(method, ctx, STEIF_BAD_INPUT, "no method was named: give one such as \"be\"");
  STEIF_CHECK(h > 0 && isfinite(h), ctx, STEIF_BAD_INPUT, "the step h = %g must be positive",
              h);
  STEIF_CHECK(steps >= 1 && steps <= 1u << 24, ctx, STEIF_BAD_INPUT,
              "%zu steps were asked for: give 1 to %u", steps, 1u << 24);
  layer l = {.ctx = ctx, .method = method, .start = start, .h = h, .steps = steps};
  STEIF_TRY(stf_jordan_open(ctx, problem, &l.problem, &l.block));
  const int code = follow(&l, t, x, exact, error, result);
  stf_block_close(&l.block);
  steif_problem_clear(ctx, &l.problem);
  return code;
}
