/* lyapunov.c: exponents and spectral intervals by discrete QR of the computed recurrence.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "lyapunov_thresholds.h"
#include "integral_separation.h"
#include "variation.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PARTS = 16, TOLD = 1000 };

typedef struct spectrum {
  stf_variation v;
  stf_constant constant;
  stf_gaps separation;           /* sum NULL: not asked for */
  long steps, transient, window; /* averaged; before; of an interval */
  long made;                     /* averaged until the run was stopped */
  sunrealtype *w, *R;
  sunrealtype *sum, *rest; /* of ln R_ii, compensated */
  sunrealtype *ring;       /* the last window + 1 sums */
  sunrealtype *low, *high;
  sunrealtype *part, *spread,
    *begun; /* means over parts, their squares, sums where one began */
  int parts;
  long part_begun;
  sunrealtype trace, mu;
  sunrealtype climb, rise;     /* ln |w| above its least so far; the most of that */
  sunrealtype *y, first, last; /* y before a step, |h y'| of the first and the last step */
} spectrum;

/* The constant steps that fit, and how many of them come before the averages. */
static int plan(steif_context *ctx, const steif_problem *p, const steif_lyapunov_options *o,
                spectrum *s)
{
  STEIF_TRY(stf_constant_steps(ctx, o->h, p->t0, o->t1 != 0 ? o->t1 : p->t1, &s->constant));
  const sunrealtype h = s->constant.h, span = s->constant.end - p->t0;
  STEIF_CHECK(o->transient >= 0 && o->transient < span, ctx, STEIF_BAD_INPUT,
              "the transient of %g must be shorter than the run of %g", o->transient, span);
  s->transient = (long)ceil(o->transient / h * (1 - STF_STEP_ROUNDING));
  s->steps = s->constant.whole - s->transient;
  STEIF_CHECK(s->steps >= 1, ctx, STEIF_BAD_INPUT,
              "no step of h = %g is left after the transient of %g", h, o->transient);
  const sunrealtype averaged = (sunrealtype)s->steps * h;
  STEIF_CHECK(
    o->window >= 0 && o->window <= averaged * (1 + STF_STEP_ROUNDING), ctx, STEIF_BAD_INPUT,
    "a window of %g is longer than the %g that are averaged: shorten it or end the run "
    "later",
    o->window, averaged);
  s->window = o->window > 0 ? lround(o->window / h) : s->steps / 10;
  if (s->window < 1) s->window = 1;
  return STEIF_OK;
}

static int room(stf_pool *pool, spectrum *s)
{
  const size_t d = (size_t)s->v.d, m = (size_t)s->v.m;
  s->w = stf_pool_array(pool, d * m, sizeof *s->w);
  s->R = stf_pool_array(pool, m * m, sizeof *s->w);
  s->sum = stf_pool_array(pool, 2 * m, sizeof *s->w);
  s->ring = stf_pool_array(pool, ((size_t)s->window + 1) * m, sizeof *s->w);
  s->low = stf_pool_array(pool, 2 * m, sizeof *s->w);
  s->part = stf_pool_array(pool, 3 * m, sizeof *s->w);
  s->y = stf_pool_array(pool, d, sizeof *s->y);
  if (!s->w || !s->R || !s->sum || !s->ring || !s->low || !s->part || !s->y)
    return STEIF_NO_MEMORY;
  s->spread = s->part + m;
  s->begun = s->part + 2 * m;
  s->rest = s->sum + m;
  s->high = s->low + m;
  for (size_t i = 0; i < m; i++) {
    s->low[i] = INFINITY;
    s->high[i] = -INFINITY;
  }
  s->mu = -INFINITY;
  return STEIF_OK;
}

/* X becomes orthonormal in the principal coordinate; R_ii are left on R's diagonal. */
static int straighten(spectrum *s)
{
  stf_variation *v = &s->v;
  if (v->g->k > 1) stf_variation_principal(v, s->w); /* else ell = 1 */
  STEIF_CHECK(
    stf_triangle(v->d, v->m, v->g->k > 1 ? s->w : v->X, s->w, s->R, &v->algebra), v->ctx,
    STEIF_NOT_FINITE,
    "a direction of the variational equation of '%s' vanished or overflowed in the step "
    "of %s to t = %.12g: take a smaller h, or fewer exponents",
    v->problem->name, v->method, v->t);
  stf_renormalise(v->g->k * v->d, v->m, s->R, v->X, &v->algebra);
  return STEIF_OK;
}

static int turn(spectrum *s)
{
  STEIF_TRY(stf_variation_step(&s->v));
  return straighten(s);
}

/* A step, and how far y moved in it. */
static int turn_and_move(spectrum *s, sunrealtype *moved)
{
  const stf_variation *v = &s->v;
  memcpy(s->y, N_VGetArrayPointer(stf_variation_state(v)), (size_t)v->d * sizeof *s->y);
  STEIF_TRY(turn(s));
  const sunrealtype *y = N_VGetArrayPointer(stf_variation_state(v));
  *moved = 0;
  for (int i = 0; i < v->d; i++) *moved = hypot(*moved, y[i] - s->y[i]);
  return STEIF_OK;
}

static sunrealtype trace(const stf_variation *v)
{
  sunrealtype sum = v->E ? NAN : 0;
  for (int i = 0; i < v->g->r && !v->E; i++) sum += v->weight[i] * stf_jacobian_trace(v->J[i]);
  return sum;
}

/* Neumaier's sum: millions of logarithms. */
static void add(sunrealtype *sum, sunrealtype *rest, sunrealtype x)
{
  const sunrealtype total = *sum + x;
  *rest += fabs(*sum) >= fabs(x) ? (*sum - total) + x : (x - total) + *sum;
  *sum = total;
}

/* Mean and sum of squared deviations over the parts so far (Welford). */
static void close_part(spectrum *s, long n, const sunrealtype *now)
{
  const sunrealtype span = (sunrealtype)(n - s->part_begun) * s->v.h;
  s->parts++;
  s->part_begun = n;
  for (int i = 0; i < s->v.m; i++) {
    const sunrealtype mean = (now[i] - s->begun[i]) / span, off = mean - s->part[i];
    s->part[i] += off / s->parts;
    s->spread[i] += off * (mean - s->part[i]);
    s->begun[i] = now[i];
  }
}

/* Step n = 1, 2, ... of the average. */
static void record(spectrum *s, long n)
{
  const int m = s->v.m;
  const sunrealtype h = s->v.h;
  const long slots = s->window + 1;
  sunrealtype *now = s->ring + (n % slots) * m, *then = s->ring + ((n + 1) % slots) * m;
  for (int i = 0; i < m; i++) {
    const sunrealtype gain = log(s->R[i * m + i]);
    add(&s->sum[i], &s->rest[i], gain);
    if (i == 0) s->climb = fmax(0, s->climb + gain);
    now[i] = s->sum[i] + s->rest[i];
    if (n < s->window) continue;
    const sunrealtype rate = (now[i] - then[i]) / ((sunrealtype)s->window * h);
    s->low[i] = fmin(s->low[i], rate);
    s->high[i] = fmax(s->high[i], rate);
  }
  if (s->steps >= 2 * PARTS && n * PARTS >= (s->parts + 1) * s->steps) close_part(s, n, now);
  if (s->separation.sum) stf_gaps_record(&s->separation, n, now);
  if (2 * n >= s->steps) s->mu = fmax(s->mu, now[0] / ((sunrealtype)n * h));
  s->rise = fmax(s->rise, s->climb);
  s->trace += (trace(&s->v) - s->trace) / (sunrealtype)n;
}

static int descending(const void *a, const void *b)
{
  const sunrealtype x = *(const sunrealtype *)a, y = *(const sunrealtype *)b;
  return (x < y) - (x > y);
}

/* Kaplan and Yorke (1979); `sorted` is scratch. */
static sunrealtype dimension(const spectrum *s, const sunrealtype *exponent,
                             sunrealtype *sorted)
{
  const int m = s->v.m;
  sunrealtype sum = 0;
  memcpy(sorted, exponent, (size_t)m * sizeof *sorted);
  qsort(sorted, (size_t)m, sizeof *sorted, descending);
  for (int j = 0; j < m; j++) {
    if (sum + sorted[j] < 0) return (sunrealtype)j + sum / -sorted[j];
    sum += sorted[j];
  }
  return m == s->v.finite ? (sunrealtype)m : NAN;
}

static void tell(const spectrum *s, const steif_lyapunov_options *o, sunrealtype *exponent,
                 sunrealtype *interval, steif_lyapunov_facts *facts)
{
  steif_lyapunov_facts out = {
    .count = s->v.m, .steps = s->steps, .linear = s->v.linear, .h = s->v.h};
  out.time = (sunrealtype)s->steps * s->v.h;
  out.end = s->constant.end;
  out.trace = s->trace;
  out.mu = isfinite(s->mu) ? s->mu : NAN;
  out.rise = s->rise;
  out.flow =
    s->v.problem->autonomous && !s->v.linear ? log(s->last / s->first) / out.time : NAN;
  for (int i = 0; i < s->v.m; i++) {
    exponent[i] = (s->sum[i] + s->rest[i]) / out.time;
    out.sum += exponent[i];
    if (interval) {
      const bool any = s->low[i] <= s->high[i]; /* a whole window has been seen */
      interval[2 * i] = any ? s->low[i] : NAN;
      interval[2 * i + 1] = any ? s->high[i] : NAN;
    }
    if (o->error)
      o->error[i] = s->parts == PARTS ? sqrt(s->spread[i] / (PARTS * (PARTS - 1))) : NAN;
  }
  if (s->separation.sum) stf_gaps_judge(&s->separation, s->v.h, o->separation);
  out.dimension = dimension(s, exponent, s->begun);
  if (facts) *facts = out;
}

/* Directions that are no solutions of a DAE of index above 1 are gone after `index` steps of the whole
 * history, impulses in them too: averages begin behind these. */
static int forget_start(spectrum *s)
{
  const stf_variation *v = &s->v;
  const long least = v->index > 1 ? (long)v->index * v->g->k : 0, more = least - s->transient;
  if (more <= 0) return STEIF_OK;
  s->transient += more, s->steps -= more;
  STEIF_CHECK(s->steps >= 1, v->ctx, STEIF_BAD_INPUT,
              "the first %ld steps of h = %g make directions of '%s', which has index %d, "
              "consistent, and none is left: end the run later",
              least, v->h, v->problem->name, v->index);
  if (s->window > s->steps) s->window = s->steps;
  return STEIF_OK;
}

/* The averages so far, at some TOLD of the steps. */
static int told(spectrum *s, const steif_lyapunov_options *o, long n)
{
  const long stride = s->steps > TOLD ? s->steps / TOLD : 1;
  if (!o->average || (n % stride && n < s->steps)) return STEIF_OK;
  const sunrealtype time = (sunrealtype)n * s->v.h;
  sunrealtype *mean = s->w; /* scratch between steps */
  for (int i = 0; i < s->v.m; i++) mean[i] = (s->sum[i] + s->rest[i]) / time;
  const int wish = o->average(s->v.t, s->v.m, mean, o->user);
  return wish == 0 ? STEIF_OK
                   : STEIF_FAIL(s->v.ctx, STEIF_CALLBACK,
                                "the callback .average stopped the run at t = %.12g", s->v.t);
}

/* What is known after n steps is the result. */
static int stopped(spectrum *s, long n)
{
  const stf_variation *v = &s->v;
  s->constant.end = v->t, s->last = NAN, s->made = n;
  return STEIF_FAIL(
    v->ctx, STEIF_STOPPED,
    "the run was stopped from outside at t = %.12g, after %ld of %ld steps averaged", v->t, n,
    s->steps);
}

static int run(stf_pool *pool, steif_context *ctx, const steif_problem *p, const char *method,
               const steif_lyapunov_options *o, spectrum *s)
{
  STEIF_TRY(plan(ctx, p, o, s));
  STEIF_TRY(stf_variation_open(pool, ctx, p, method, s->constant.h, s->constant.end, o->count,
                               o->linear, &s->v));
  STEIF_TRY(forget_start(s));
  STEIF_TRY(room(pool, s));
  if (o->separation) STEIF_TRY(stf_gaps_open(pool, s->steps, s->v.m, &s->separation));
  stf_variation_scatter(&s->v);
  STEIF_TRY(straighten(s));
  for (long n = 0; n < s->transient; n++) {
    STEIF_TRY(turn(s));
    if (o->stop && *o->stop) return stopped(s, 0);
  }
  for (long n = 1; n <= s->steps; n++) {
    sunrealtype *moved = n == 1 ? &s->first : n == s->steps ? &s->last : NULL;
    STEIF_TRY(moved ? turn_and_move(s, moved) : turn(s));
    record(s, n);
    STEIF_TRY(told(s, o, n));
    if (o->stop && *o->stop) return stopped(s, n);
  }
  return STEIF_OK;
}

int steif_lyapunov(steif_context *ctx, const steif_problem *problem, const char *method,
                   const steif_lyapunov_options *options, sunrealtype *exponent,
                   sunrealtype *interval, steif_lyapunov_facts *facts)
{
  STF_NAMED(problem);
  spectrum s = {0};
  if (facts) *facts = (steif_lyapunov_facts){0};
  STEIF_CHECK(problem && method && options && exponent, ctx, STEIF_BAD_INPUT,
              "a problem, a method, options and room for the exponents are needed");
  stf_pool *pool = stf_pool_new(ctx);
  if (!pool) return STEIF_NO_MEMORY;
  const int code = run(pool, ctx, problem, method, options, &s);
  if (code == STEIF_STOPPED) s.steps = s.made;
  if (code == STEIF_OK || (code == STEIF_STOPPED && s.made > 0))
    tell(&s, options, exponent, interval, facts);
  stf_pool_free(&pool);
  return code > 0 ? steif_status(ctx) : code;
}
