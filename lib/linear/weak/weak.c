/* weak.c: does a method converge weakly on a descriptor system? Runs with steps h, h/2, ... are read
 * as functions, paired with the test function and compared with the exact distribution.
 * S. L. Campbell, Distributional convergence of BDF approximations (1988).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "measure.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

#define USABLE 0.1    /* of an error, the most that rounding may be */
#define UNSEEN 1e-10  /* of the size of g, derivatives that are none */
#define UNENDED 1e-12 /* of it, at the end of its interval */
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

static int check(steif_context *ctx, const steif_weak_query *q)
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

/* ---- rows --------------------------------------------------------------------------------- */

/* Over several components 2-norms. */
static int fill_row(stf_measure *w, size_t i, const steif_weak_result *result,
                    steif_weak_row *row)
{
  const steif_weak_query *q = w->query;
  const sunrealtype h = ldexp(w->h, -(int)i), t1 = (sunrealtype)w->subject.weight.t1;
  const bool all = q->component == STEIF_ALL;
  sunrealtype value = 0, error = 0, level = 0;
  STEIF_TRY(stf_measure_run(w, h, (size_t)ceil(t1 / h * (1 - 1e-9))));
  for (int m = w->first; m < w->first + w->count; m++) {
    const sunrealtype v = w->value[m];
    if (all && q->values) q->values[i * (size_t)w->subject.n + (size_t)m] = v;
    level = hypot(level,
                  w->level[m] + 4 * STF_EPS * (fabs(w->exact[m]) + fabs(v)) + result->accuracy);
    value = all ? hypot(value, v) : v;
    error = all ? hypot(error, v - w->exact[m]) : v - w->exact[m];
  }
  row[i] = (steif_weak_row){h, value, error, NAN, level, 0};
  row[i].usable = level <= USABLE * fabs(error) && isfinite(error);
  if (i > 0) row[i].order = log2(fabs(row[i - 1].error / row[i].error));
  return STEIF_OK;
}

/* ---- what the rows may be judged by ------------------------------------------------------- */

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

static int find_longest(const stf_measure *w, stf_judged *j)
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
  j->longest = INFINITY;
  for (int i = 0; i < 4; i++)
    if (1 / known[i].rate < j->longest) {
      j->longest = 1 / known[i].rate;
      j->fastest = known[i].what;
    }
  return STEIF_OK;
}

/* Has some component an impulse of order q there? */
static bool has_impulse(const stf_measure *w, const sunrealtype *c, int q)
{
  const size_t n = (size_t)w->subject.n;
  for (int m = w->first; m < w->first + w->count; m++)
    if (c[(size_t)q * n + (size_t)m] != 0) return true;
  return false;
}

/* At t = 0 or a break: the lowest order q of impulses that are there while g^(q) is 0, q = k - 1, by
 * which errors are measured, among them. */
static int find_blind(const stf_measure *w, sunrealtype t, const sunrealtype *c, int *blind)
{
  const int k = w->subject.index;
  long double g[STF_DERIVATIVES], most, rate, scale = 1;
  STEIF_TRY(stf_weight_scale(&w->subject.weight, &most, &rate));
  if (k < 2) return STEIF_OK;
  STEIF_TRY(stf_weight_at(&w->subject.weight, t, k - 1, g));
  for (int q = 0; q < k; q++, scale *= rate) {
    if (fabsl(g[q]) > (long double)UNSEEN * most * scale) continue;
    if ((q < k - 1 && !has_impulse(w, c, q)) || *blind >= 0) continue;
    *blind = q;
  }
  return STEIF_OK;
}

/* Does g end with its first k - 1 derivatives at 0? */
static int look_at_end(const stf_measure *w, char *note, size_t room)
{
  const int k = w->subject.index > 1 ? w->subject.index : 1;
  const stf_weight *g = &w->subject.weight;
  long double d[STF_DERIVATIVES], most, rate, scale = 1;
  STEIF_TRY(stf_weight_scale(g, &most, &rate));
  STEIF_CHECK(k < STF_DERIVATIVES, w->ctx, STEIF_UNSUPPORTED,
              "index %d takes too many derivatives of the test function", k);
  STEIF_TRY(stf_weight_end(g, k - 1, d));
  for (int q = 0; q < k && !*note; q++, scale *= rate)
    if (fabsl(d[q]) > UNENDED * most * scale)
      snprintf(note, room,
               "g%s%.0d(t1) = %.3Lg at t1 = %.3Lg is not 0: values belong to g cut off there",
               q ? "^" : "", q, d[q], g->t1);
  return STEIF_OK;
}

static int conclude(const stf_measure *w, steif_weak_row *row, steif_weak_result *result)
{
  const stf_subject *s = &w->subject;
  stf_judged j = {.row = row,
                  .rows = w->query->rows,
                  .size = fabs(result->exact),
                  .blind = -1,
                  .inside = NAN};
  const steif_weak_query *q = w->query;
  const sunrealtype t1 = (sunrealtype)s->weight.t1;
  const size_t inside = stf_break_inside(q->break_count, q->breaks, t1, w->h);
  if (inside < q->break_count) {
    j.inside = q->breaks[inside];
    j.fitting = stf_break_step(q->break_count, q->breaks, t1, w->h);
  }
  STEIF_TRY(find_longest(w, &j));
  STEIF_TRY(look_at_end(w, result->note, sizeof result->note));
  STEIF_TRY(find_blind(w, 0, s->block.k ? s->block.c : s->impulse.c, &j.blind));
  for (size_t b = 0; b < s->jumps; b++)
    STEIF_TRY(find_blind(w, s->jump[b].t, s->jump[b].at.c, &j.blind));
  for (size_t i = 0; i < j.rows; i++)
    if (row[i].h > j.longest) row[i].usable = 0;
  stf_weak_judge(&j, result);
  return STEIF_OK;
}

/* ---- the measure -------------------------------------------------------------------------- */

/* E_1 belongs to backward Euler started from x(0-), and is known for Jordan blocks. */
static int first_order(stf_measure *w, sunrealtype *value)
{
  const steif_weak_query *q = w->query;
  steif_spec spec;
  *value = NAN;
  STEIF_TRY(steif_spec_parse(w->ctx, q->method, &spec));
  const char *p = stf_spec_word(&spec, "p");
  const bool euler =
    !strcmp(spec.name, "be") || (!strcmp(spec.name, "bdf") && p && !strcmp(p, "1"));
  if (!w->subject.block.k || q->component == STEIF_ALL || !euler || w->cq ||
      (q->convention != STEIF_P && q->convention != STEIF_R))
    return STEIF_OK;
  return stf_block_first(&w->subject.block, q->component, q->convention, value);
}

static int find_exact(stf_measure *w, steif_weak_result *result)
{
  const steif_weak_query *q = w->query;
  const bool all = q->component == STEIF_ALL;
  result->index = w->subject.index;
  STEIF_TRY(stf_subject_pair(&w->subject, w->exact, &result->accuracy, result->source,
                             sizeof result->source));
  result->exact = 0;
  for (int m = w->first; m < w->first + w->count; m++)
    result->exact = all ? hypot(result->exact, w->exact[m]) : w->exact[m];
  for (int m = 0; all && q->exacts && m < w->subject.n; m++) q->exacts[m] = w->exact[m];
  return STEIF_OK;
}

static int measure_rows(stf_measure *w, steif_weak_row *row, steif_weak_result *result)
{
  const steif_weak_query *q = w->query;
  const int n = w->subject.n;
  STEIF_CHECK(q->component == STEIF_ALL || (q->component >= 0 && q->component < n), w->ctx,
              STEIF_BAD_INPUT, "component %d is not one of the %d of '%s'", q->component + 1, n,
              w->subject.problem.name);
  w->first = q->component == STEIF_ALL ? 0 : q->component;
  w->count = q->component == STEIF_ALL ? n : 1;
  STEIF_TRY(find_exact(w, result));
  STEIF_TRY(first_order(w, &result->first));
  for (size_t i = 0; i < q->rows; i++) STEIF_TRY(fill_row(w, i, result, row));
  return conclude(w, row, result);
}

int steif_weak_measure(steif_context *ctx, const steif_weak_query *query, steif_weak_row *row,
                       steif_weak_result *result)
{
  *result = (steif_weak_result){.first = NAN, .exact = NAN, .converges = -1};
  STEIF_TRY(check(ctx, query));
  stf_measure w;
  int code = stf_measure_open(ctx, query, &w);
  w.h = first_step(query);
  if (!code) code = measure_rows(&w, row, result);
  stf_measure_close(&w);
  return code;
}
