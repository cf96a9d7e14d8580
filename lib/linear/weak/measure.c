/* measure.c: what is asked for, and whether it makes sense.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "measure.h"
#include "prime_field.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <string.h>

enum { LAYERS = 2, STEPS = 64, MOST_STEPS = 1 << 26, LIMBS = 8 };

#define ROUGH 1e-3 /* of a test function, the most that its derivatives may miss */

/* The step of the first row. */
static sunrealtype first_step(const steif_weak_query *q)
{
  const sunrealtype t1 = q->g ? q->g->t1 : 1, h = t1 / STEPS;
  if (q->h != 0) return q->h;
  const sunrealtype fitting = stf_break_step(q->break_count, q->breaks, t1, h);
  return isfinite(fitting) && !q->restart ? fitting : h;
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
              "%zu rows from h = %g would take more than %d steps: take h above %.2g, or fewer "
              "rows",
              q->rows, h, (int)MOST_STEPS, ldexp(t1, (int)q->rows - 1) / MOST_STEPS);
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

int stf_measure_longest(const stf_measure *w, sunrealtype *longest, const char **fastest)
{
  const stf_subject *s = &w->subject;
  long double most, rate;
  STEIF_TRY(stf_weight_scale(&w->subject.weight, &most, &rate));
  const struct {
    sunrealtype rate;
    const char *what;
  } known[] = {{(sunrealtype)rate, "the test function"},
               {LAYERS * (s->index + 1) / (sunrealtype)s->weight.t1,
                "the interval of the test function, which holds the layer"},
               {s->rate, "the forcing"},
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

/* Have E and F as they are given, to the last bit, the structure that was found? */
static int is_exact(const stf_subject *s, bool *yes)
{
  enum { MOST = STF_DERIVATIVES };
  stf_field field;
  sunindextype weyr[MOST], infinite = 0;
  int count;
  STEIF_TRY(stf_field_open(s->ctx, s->linear.E, s->linear.F, false, &field));
  STEIF_TRY(stf_field_chains(s->ctx, &field, MOST, weyr, &count));
  for (int i = 0; i < count; i++) infinite += weyr[i];
  *yes = count == s->index && infinite == s->n - s->structure.finite;
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
  w->exact = stf_allocate(ctx, 4 * n, sizeof *w->exact);
  w->sum = stf_allocate(ctx, 5 * n, sizeof *w->sum);
  if (!w->exact || !w->sum) return STEIF_NO_MEMORY;
  w->value = w->exact + n, w->level = w->value + n, w->away = w->level + n;
  if (query->exact && s->apart.linear.E) STEIF_TRY(is_exact(s, &w->as_given));
  for (int i = 0; i < STF_TURNS && s->apart.linear.E && !w->as_given; i++)
    STEIF_TRY(stf_turned_open(ctx, &s->linear, &s->structure, s->problem.y0, i, w->turned + i));
  if (query->g && w->longer) {
    STEIF_TRY(stf_spline_open(&s->weight, stf_smooth(s->index), LIMBS, true, &w->smooth));
    s->weight.smooth = &w->smooth;
    STEIF_CHECK(
      w->smooth.defect <= ROUGH, ctx, STEIF_BAD_INPUT,
      "the test function is not smooth enough up to t = %g: what its first %d "
      "derivatives say differs from it by %.1Le of its size; take one like (1-t/%g)^%d, "
      "or end it before (.g->t1)",
      query->g->t1, stf_smooth(s->index), w->smooth.defect, query->g->t1,
      stf_smooth(s->index) + 1);
  }
  w->room = N_VNew_Serial(s->n, steif_sundials(ctx));
  STEIF_CHECK(w->room, ctx, STEIF_NO_MEMORY, "no memory for a vector");
  STEIF_TRY(stf_mesh_open(w));
  return stf_forcing_rate(w);
}

int stf_measure_tell(const stf_measure *w, size_t i)
{
  const steif_weak_query *q = w->query;
  STEIF_CHECK(!q->tell || !q->tell(i, q->told), w->ctx, STEIF_STOPPED,
              "the callback .tell stopped the measure after %zu of %zu rows", i + 1, q->rows);
  return STEIF_OK;
}

void stf_measure_close(stf_measure *w)
{
  if (w->room) N_VDestroy(w->room);
  for (int i = 0; i < STF_TURNS; i++) stf_turned_close(w->turned + i);
  stf_spline_close(w->ctx, &w->smooth);
  stf_release(w->ctx, w->exact);
  stf_release(w->ctx, w->sum);
  stf_release(w->ctx, w->mesh.segment);
  stf_subject_close(&w->subject);
}
