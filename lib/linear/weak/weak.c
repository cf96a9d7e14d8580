/* weak.c: does a method converge weakly on a descriptor system? Runs with steps h, h/2, ... are read
 * as functions, paired with the test function and compared with the exact distribution.
 * S. L. Campbell, Distributional convergence of BDF approximations (1988).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "subject.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Verdicts. An order within FLAT of zero means a limit other than the exact value; two orders
 * further than SETTLED apart mean nothing yet; below ROUNDING eps sum |x_i| w_i an error is
 * rounding (the values of a layer carry a few eps each). */
#define FLAT 0.3
#define SETTLED 0.5
#define ROUNDING 16
enum { MOST_STEPS = 1 << 26 };

typedef struct measure {
  steif_context *ctx;
  const steif_weak_query *query;
  stf_subject subject;
  sunrealtype *floor; /* rounding level of each row */
  sunrealtype *exact; /* of every component */
  int first, count;   /* components paired */
  bool cq;
} measure;

static int check(steif_context *ctx, const steif_weak_query *q)
{
  STEIF_CHECK(q->method, ctx, STEIF_BAD_INPUT, "no method was named: give one such as \"be\"");
  STEIF_CHECK(q->convention >= STEIF_P && q->convention <= STEIF_STAGE, ctx, STEIF_BAD_INPUT,
              "convention %d is none of P, R, C and stage", (int)q->convention);
  STEIF_CHECK(q->rows >= 1, ctx, STEIF_BAD_INPUT, "no rows were asked for: two or more decide");
  STEIF_CHECK(q->h > 0 && q->h <= 1, ctx, STEIF_BAD_INPUT,
              "the step h = %g must lie in (0, 1], the support of the test function", q->h);
  const sunrealtype n = 1 / q->h;
  STEIF_CHECK(fabs(n - round(n)) <= 1e-9 * n, ctx, STEIF_BAD_INPUT,
              "1/h = %.10g is not a whole number: the steps must fill [0, 1]; take h = %.10g",
              n, 1 / fmax(1, round(n)));
  STEIF_CHECK(ldexp(round(n), (int)fmin((double)q->rows, 64) - 1) <= MOST_STEPS, ctx,
              STEIF_BAD_INPUT,
              "%zu rows from h = %g would take more than %d steps: ask for fewer rows", q->rows,
              q->h, (int)MOST_STEPS);
  return STEIF_OK;
}

/* One row. A run that starts from x(0-) has not produced that value: the comb leaves it out, where
 * convolution quadrature solves at t = 0 already. */
static int run(measure *w, stf_trace *trace, sunrealtype *value, sunrealtype *size)
{
  const steif_weak_query *q = w->query;
  const sunrealtype h = 1 / (sunrealtype)trace->steps;
  STEIF_TRY(stf_trace_run(w->ctx, &w->subject.problem, q->method, q->start, h, trace));
  if (q->convention == STEIF_STAGE) {
    *value = (sunrealtype)trace->stage;
    *size = (sunrealtype)trace->stage_size;
    return STEIF_OK;
  }
  if (q->convention == STEIF_C && !w->cq) trace->x[0] = 0;
  *value = stf_pair_sized(q->convention, trace->steps, trace->t, trace->x, size);
  return STEIF_OK;
}

/* Component m of a run with so many steps. */
static int pair(measure *w, int m, size_t steps, sunrealtype *value, sunrealtype *size)
{
  stf_trace trace = {
    .first = m, .count = 1, .steps = steps, .stages = w->query->convention == STEIF_STAGE};
  int code = STEIF_NO_MEMORY;
  trace.apart = stf_subject_apart(&w->subject, w->query->method, w->query->start);
  trace.t = stf_allocate(w->ctx, steps + 1, sizeof *trace.t);
  trace.x = stf_allocate(w->ctx, steps + 1, sizeof *trace.x);
  if (trace.t && trace.x) code = run(w, &trace, value, size);
  stf_release(w->ctx, trace.t);
  stf_release(w->ctx, trace.x);
  return code;
}

/* Over several components 2-norms. */
static int fill_row(measure *w, size_t i, const steif_weak_result *result, steif_weak_row *row)
{
  const steif_weak_query *q = w->query;
  const size_t steps = (size_t)llround(1 / q->h) << i;
  const bool all = q->component == STEIF_ALL;
  sunrealtype value = 0, error = 0, level = 0;
  for (int m = w->first; m < w->first + w->count; m++) {
    sunrealtype v = 0, size = 0;
    STEIF_TRY(pair(w, m, steps, &v, &size));
    if (all && q->values) q->values[i * (size_t)w->subject.n + (size_t)m] = v;
    level = hypot(level, ROUNDING * STF_EPS * (size + fabs(w->exact[m])) + result->accuracy);
    value = all ? hypot(value, v) : v;
    error = all ? hypot(error, v - w->exact[m]) : v - w->exact[m];
  }
  row[i] = (steif_weak_row){1 / (sunrealtype)steps, value, error, NAN};
  if (i > 0) row[i].order = log2(fabs(row[i - 1].error / row[i].error));
  w->floor[i] = level;
  return STEIF_OK;
}

/* The limit of the errors from the last three rows (Aitken) or two (first order). */
static sunrealtype limit(const steif_weak_row *row, size_t rows)
{
  const sunrealtype c = row[rows - 1].error, b = row[rows - 2].error;
  const sunrealtype a = rows > 2 ? row[rows - 3].error : 0, bend = (c - b) - (b - a);
  const bool regular = rows > 2 && fabs(c - b) < 0.9 * fabs(b - a);
  return regular ? c - (c - b) * (c - b) / bend : 2 * c - b;
}

/* Judge the leading `rows` rows, whose errors are above rounding. */
static void judge(const steif_weak_row *row, size_t rows, steif_weak_result *result)
{
  const sunrealtype last = row[rows - 1].order, before = rows > 2 ? row[rows - 2].order : last;
  char *text = result->verdict;
  const size_t room = sizeof result->verdict;
  result->converges = 0;
  if (fabs(last) <= FLAT && fabs(last - before) <= SETTLED)
    snprintf(text, room, "does not converge weakly: error tends to %.3g", limit(row, rows));
  else if (!(fabs(last - before) <= SETTLED)) {
    result->converges = -1;
    snprintf(text, room,
             "undecided: the observed orders %.2f and %.2f differ; ask for more rows", before,
             last);
  } else if (last < 0)
    snprintf(text, room, "does not converge weakly: error grows like h^%.1f", last);
  else {
    result->converges = 1;
    snprintf(text, room, "converges weakly, order %.2f", last);
  }
}

static void conclude(const sunrealtype *level, const steif_weak_row *row, size_t rows,
                     steif_weak_result *result)
{
  size_t above = 0;
  while (above < rows && fabs(row[above].error) > level[above]) above++;
  char *text = result->verdict;
  const size_t room = sizeof result->verdict;
  result->converges = -1;
  if (rows < 2)
    snprintf(text, room, "undecided: one row shows no order; ask for two or more");
  else if (above == 0) {
    result->converges = 1;
    snprintf(text, room, "exact for every h (to rounding)");
  } else if (above == 1) {
    result->converges = 1;
    snprintf(text, room, "converges weakly, below rounding from h = %.3g", row[1].h);
  } else
    judge(row, above, result);
}

/* E_1 belongs to backward Euler started from x(0-), and is known for Jordan blocks. */
static int first_order(measure *w, sunrealtype *value)
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

static int find_exact(measure *w, steif_weak_result *result)
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

static int measure_rows(measure *w, steif_weak_row *row, steif_weak_result *result)
{
  const steif_weak_query *q = w->query;
  const int n = w->subject.n;
  STEIF_CHECK(q->component == STEIF_ALL || (q->component >= 0 && q->component < n), w->ctx,
              STEIF_BAD_INPUT, "component %d is not one of the %d of '%s'", q->component + 1, n,
              w->subject.problem.name);
  w->first = q->component == STEIF_ALL ? 0 : q->component;
  w->count = q->component == STEIF_ALL ? n : 1;
  w->floor = stf_allocate(w->ctx, q->rows + (size_t)n, sizeof *w->floor);
  if (!w->floor) return STEIF_NO_MEMORY;
  w->exact = w->floor + q->rows;
  STEIF_TRY(find_exact(w, result));
  STEIF_TRY(first_order(w, &result->first));
  for (size_t i = 0; i < q->rows; i++) STEIF_TRY(fill_row(w, i, result, row));
  conclude(w->floor, row, q->rows, result);
  return STEIF_OK;
}

int steif_weak_measure(steif_context *ctx, const steif_weak_query *query, steif_weak_row *row,
                       steif_weak_result *result)
{
  *result = (steif_weak_result){.first = NAN, .exact = NAN, .converges = -1};
  STEIF_TRY(check(ctx, query));
  measure w = {.ctx = ctx, .query = query};
  w.cq = stf_trace_is_cq(ctx, query->method, query->start);
  STEIF_TRY(stf_subject_open(ctx, query->problem, query->linear, query->x0, &w.subject));
  const int code = measure_rows(&w, row, result);
  stf_release(ctx, w.floor);
  stf_subject_close(&w.subject);
  return code;
}
