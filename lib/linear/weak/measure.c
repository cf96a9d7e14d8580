/* measure.c: a run in double, paired, and beside it runs that tell its rounding: the same in long double,
 * once with the data of the run and once with f, t and what else is known to double only changed by
 * random parts of eps. Where a method has no such run, runs on multiples of the data differ by rounding
 * alone.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "measure.h"
#include "longer.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <string.h>

/* Of differences between runs on multiples of the data, which see nothing of coefficients that are
 * rounded once and for all. */
enum { DISTRUST = 16 };
enum { LAYERS = 2, STEPS = 64, MOST_STEPS = 1 << 26, LOOKS = 500 };

/* The step of the first row. */
static sunrealtype first_step(const steif_weak_query *q)
{
  const sunrealtype t1 = q->g ? q->g->t1 : 1, h = t1 / STEPS;
  if (q->h != 0) return q->h;
  const sunrealtype fitting = stf_break_step(q->break_count, q->breaks, t1, h);
  return isfinite(fitting) ? fitting : h;
}

static int check_steps(steif_context *ctx, const steif_weak_query *q, sunrealtype t1)
{
  const sunrealtype h = first_step(q);
  STEIF_CHECK(t1 > 0 && isfinite(t1), ctx, STEIF_BAD_INPUT,
              "the test function ends at t1 = %g, which must be positive", t1);
  STEIF_CHECK(h > 0 && h <= t1, ctx, STEIF_BAD_INPUT,
              "the step h = %g must lie in (0, %g], the support of the test function", h, t1);
  STEIF_CHECK(ldexp(ceil(t1 / h), (int)fmin((double)q->rows, 64) - 1) <= MOST_STEPS, ctx,
              STEIF_BAD_INPUT,
              "%zu rows from h = %g would take more than %d steps: ask for fewer rows", q->rows,
              h, (int)MOST_STEPS);
  return STEIF_OK;
}

int stf_measure_check(steif_context *ctx, const steif_weak_query *q)
{
  STEIF_CHECK(q->method, ctx, STEIF_BAD_INPUT, "no method was named: give one such as \"be\"");
  STEIF_CHECK(q->convention >= STEIF_P && q->convention <= STEIF_STAGE, ctx, STEIF_BAD_INPUT,
              "convention %d is none of P, R, C and stage", (int)q->convention);
  STEIF_CHECK(q->rows >= 1, ctx, STEIF_BAD_INPUT,
              "no rows were asked for: three or more decide");
  STEIF_CHECK(!q->break_count || q->linear, ctx, STEIF_BAD_INPUT,
              "breaks belong to the forcing of a system of one's own");
  for (size_t b = 0; b < q->break_count; b++)
    STEIF_CHECK(q->breaks[b] > (b ? q->breaks[b - 1] : 0), ctx, STEIF_BAD_INPUT,
                "breaks must be positive and ascend: %g comes after %g", q->breaks[b],
                b ? q->breaks[b - 1] : 0);
  return check_steps(ctx, q, q->g ? q->g->t1 : 1);
}

int stf_measure_components(stf_measure *w)
{
  const steif_weak_query *q = w->query;
  const int n = w->subject.n;
  STEIF_CHECK(q->component == STEIF_ALL || (q->component >= 0 && q->component < n), w->ctx,
              STEIF_BAD_INPUT, "component %d is not one of the %d of '%s'", q->component + 1, n,
              w->subject.problem.name);
  w->first = q->component == STEIF_ALL ? 0 : q->component;
  w->count = q->component == STEIF_ALL ? n : 1;
  return STEIF_OK;
}

/* The largest rate at which f changes, 1/time: (|f^(j)| / |f|)^(1/j) over places of [0, t1]. */
static int rate_of_forcing(const stf_measure *w, sunrealtype *rate)
{
  const stf_subject *s = &w->subject;
  const steif_forcing f = s->block.k ? s->block.forcing : s->linear.f;
  void *user = s->block.k ? s->block.user : s->linear.user;
  sunrealtype most = 0;
  *rate = 0;
  for (int j = 0; f && j <= s->index; j++) {
    sunrealtype largest = 0;
    for (int i = 0; i < LOOKS; i++) {
      const sunrealtype t = (sunrealtype)w->subject.weight.t1 * (i + 0.5) / LOOKS;
      if (f(t, j, w->room, user)) return STEIF_OK; /* no more derivatives */
      largest = fmax(largest, N_VMaxNorm(w->room));
    }
    if (j == 0) most = largest;
    if (j > 0 && most > 0) *rate = fmax(*rate, pow(largest / most, 1.0 / j));
  }
  return STEIF_OK;
}

int stf_measure_longest(const stf_measure *w, sunrealtype *longest, const char **fastest)
{
  const stf_subject *s = &w->subject;
  long double most, rate;
  sunrealtype of_f;
  STEIF_TRY(stf_weight_scale(&w->subject.weight, &most, &rate));
  STEIF_TRY(rate_of_forcing(w, &of_f));
  const struct {
    sunrealtype rate;
    const char *what;
  } known[] = {{(sunrealtype)rate, "the test function"},
               {LAYERS * (s->index + 1) / (sunrealtype)s->weight.t1,
                "the interval of the test function, which holds the layer"},
               {of_f, "the forcing"},
               {s->structure.finite > 0 ? s->structure.radius : 0,
                "the fastest finite eigenvalue of the system"}};
  *longest = INFINITY;
  for (int i = 0; i < 4; i++)
    if (1 / known[i].rate < *longest) {
      *longest = 1 / known[i].rate;
      *fastest = known[i].what;
    }
  return STEIF_OK;
}

int stf_measure_open(steif_context *ctx, const steif_weak_query *query, stf_measure *w)
{
  *w = (stf_measure){.ctx = ctx, .query = query};
  w->cq = stf_trace_is_cq(ctx, query->method, query->start);
  w->h = first_step(query);
  stf_subject *s = &w->subject;
  STEIF_TRY(stf_subject_open(ctx, query->problem, query->linear, query->x0, s));
  s->weight = stf_weight_of(ctx, query->g);
  s->sides.count = query->break_count, s->sides.breaks = query->breaks;
  const size_t n = (size_t)s->n;
  if (s->linear.E) STEIF_TRY(stf_longer_serves(ctx, query->method, s->n, &w->longer));
  w->exact = stf_allocate(ctx, 3 * n, sizeof *w->exact);
  w->sum = stf_allocate(ctx, 4 * n, sizeof *w->sum);
  if (!w->exact || !w->sum) return STEIF_NO_MEMORY;
  w->value = w->exact + n, w->level = w->value + n;
  w->room = N_VNew_Serial(s->n, steif_sundials(ctx));
  STEIF_CHECK(w->room, ctx, STEIF_NO_MEMORY, "no memory for a vector");
  return STEIF_OK;
}

void stf_measure_close(stf_measure *w)
{
  if (w->room) N_VDestroy(w->room);
  stf_release(w->ctx, w->exact);
  stf_release(w->ctx, w->sum);
  stf_subject_close(&w->subject);
}

/* x_m of z. */
static long double component(const stf_measure *w, const stf_apart *apart, int m,
                             const long double *z)
{
  const size_t n = (size_t)w->subject.n;
  long double sum = 0;
  if (!apart) return z[m];
  for (size_t j = 0; j < n; j++) sum += apart->maps.back[j * n + (size_t)m] * z[j];
  return sum;
}

static stf_pairing pairing_of(stf_measure *w, long double h, size_t steps, int which)
{
  const size_t n = (size_t)w->subject.n;
  stf_pairing p = {.g = &w->subject.weight,
                   .convention = w->query->convention,
                   .solved = w->cq,
                   .steps = steps,
                   .h = h,
                   .n = w->subject.n,
                   .sum = w->sum + (size_t)which * n};
  memset(p.sum, 0, n * sizeof *p.sum);
  if (w->events) p.events = w->events + which, p.events->count = 0;
  return p;
}

static int in_double(stf_measure *w, const steif_problem *problem, stf_apart *apart,
                     sunrealtype h, size_t steps, int which)
{
  const steif_weak_query *q = w->query;
  stf_pairing p = pairing_of(w, h, steps, which);
  stf_trace trace = {.steps = steps, .apart = apart, .pairing = &p};
  if (w->subject.sides.count) trace.sides = &w->subject.sides;
  return stf_trace_run(w->ctx, problem, q->method, q->start, h, &trace);
}

static int in_long_double(stf_measure *w, stf_apart *apart, sunrealtype h, size_t steps,
                          bool shaken, int which)
{
  stf_subject *s = &w->subject;
  stf_pairing p = pairing_of(w, h, steps, which);
  stf_longer run = {.ctx = w->ctx,
                    .linear = apart ? &apart->linear : &s->linear,
                    .sides = s->sides.count ? &s->sides : NULL,
                    .closed = s->problem.exact ? &s->problem : NULL,
                    .method = w->query->method,
                    .start = w->query->start,
                    .x0 = apart ? apart->z0 : s->problem.y0,
                    .n = s->n,
                    .h = h,
                    .steps = steps,
                    .shaken = shaken,
                    .pairing = &p};
  if (shaken) p.shaken = &run.random;
  return stf_longer_run(&run);
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
static int again(stf_measure *w, stf_apart *apart, sunrealtype h, size_t steps,
                 sunrealtype factor)
{
  stf_subject *s = &w->subject;
  multiple m = {&s->linear, factor};
  const steif_linear scaled = {s->linear.E, s->linear.F, s->linear.f ? multiplied : NULL, &m};
  const steif_linear *kept = apart ? apart->from : NULL;
  steif_problem problem;
  sunrealtype *x0 = stf_allocate(w->ctx, (size_t)s->n, sizeof *x0);
  if (!x0) return STEIF_NO_MEMORY;
  for (int i = 0; i < s->n; i++) x0[i] = factor * s->problem.y0[i];
  if (apart) apart->from = &scaled;
  int code = steif_linear_problem(w->ctx, &scaled, x0, 0, 1, &problem);
  if (!code) code = in_double(w, &problem, apart, h, steps, 1);
  if (apart) apart->from = kept;
  stf_release(w->ctx, x0);
  for (int i = 0; !code && i < s->n; i++) {
    const sunrealtype v = (sunrealtype)(component(w, apart, i, w->sum + s->n) / factor);
    w->level[i] = fmax(w->level[i], DISTRUST * fabs(v - w->value[i]));
  }
  return code;
}

/* ---- a row -------------------------------------------------------------------------------------- */

static int level_by_longer(stf_measure *w, stf_apart *apart, sunrealtype h, size_t steps)
{
  const size_t n = (size_t)w->subject.n;
  STEIF_TRY(in_long_double(w, apart, h, steps, false, 1));
  STEIF_TRY(in_long_double(w, apart, h, steps, true, 2));
  for (size_t m = 0; m < n; m++) {
    const long double v = component(w, apart, (int)m, w->sum + n),
                      shaken = component(w, apart, (int)m, w->sum + 2 * n);
    w->level[m] = (sunrealtype)(fabsl(w->value[m] - v) + 2 * fabsl(shaken - v));
    if (!isfinite(w->level[m])) w->level[m] = INFINITY;
  }
  return STEIF_OK;
}

static int level_by_multiples(stf_measure *w, stf_apart *apart, sunrealtype h, size_t steps)
{
  static const sunrealtype factor[] = {1.0 / 3, 0.7, 1.3};
  memset(w->level, 0, (size_t)w->subject.n * sizeof *w->level);
  for (int i = 0; w->subject.linear.E && i < 3; i++)
    STEIF_TRY(again(w, apart, h, steps, factor[i]));
  return STEIF_OK;
}

/* Events in components of the problem. */
static int leave(const stf_measure *w, const stf_apart *apart, const stf_events *events)
{
  const size_t n = (size_t)w->subject.n;
  long double *x = stf_allocate(w->ctx, n, sizeof *x);
  if (!x) return STEIF_NO_MEMORY;
  for (size_t i = 0; i < events->count; i++) {
    long double *z = events->value + i * n;
    for (size_t m = 0; m < n; m++) x[m] = component(w, apart, (int)m, z);
    memcpy(z, x, n * sizeof *x);
  }
  stf_release(w->ctx, x);
  return STEIF_OK;
}

/* Rounding is that of f, and of what else is known to double only. */
static int in_many_digits(stf_measure *w, stf_apart *apart, sunrealtype h, size_t steps)
{
  const stf_subject *s = &w->subject;
  const size_t n = (size_t)s->n;
  long double defect;
  STEIF_TRY(stf_exact_sums(w, apart, h, steps, &defect));
  const sunrealtype of_g =
    (sunrealtype)(defect * s->weight.t1) * stf_subject_rounding(s) / STF_EPS;
  for (size_t m = 0; m < n; m++) {
    const long double v = component(w, apart, (int)m, w->sum),
                      shaken = component(w, apart, (int)m, w->sum + n);
    w->value[m] = (sunrealtype)v;
    w->level[m] = (sunrealtype)(2 * fabsl(shaken - v)) + of_g;
    if (!isfinite(w->level[m])) w->level[m] = INFINITY;
  }
  return STEIF_OK;
}

int stf_measure_run(stf_measure *w, sunrealtype h, size_t steps)
{
  stf_subject *s = &w->subject;
  if (stf_is_cobb(w->query->method)) return stf_cobb_run(w, h);
  stf_apart *apart = stf_subject_apart(s, w->query->method, w->query->start);
  if (w->query->exact) return in_many_digits(w, apart, h, steps);
  STEIF_TRY(in_double(w, &s->problem, apart, h, steps, 0));
  for (int m = 0; m < s->n; m++) w->value[m] = (sunrealtype)component(w, apart, m, w->sum);
  STEIF_TRY(w->longer ? level_by_longer(w, apart, h, steps)
                      : level_by_multiples(w, apart, h, steps));
  for (int i = 0; w->events && apart && i < 3; i++) STEIF_TRY(leave(w, apart, w->events + i));
  return STEIF_OK;
}
