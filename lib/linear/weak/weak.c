/* weak.c: does a method converge weakly on a descriptor system? Runs with steps h, h/2, ... are read
 * as functions, paired with the test function and compared with the exact distribution.
 * S. L. Campbell, Distributional convergence of BDF approximations (1988).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "measure.h"
#include <math.h>
#include <steif/method.h>
#include <stdio.h>
#include <string.h>

#define USABLE 0.1    /* of an error, the most that rounding may be */
#define UNSEEN 1e-10  /* of the size of g, derivatives that are none */
#define UNENDED 1e-12 /* of it, at the end of its interval */

/* ---- rows --------------------------------------------------------------------------------- */

/* Over several components 2-norms. */
static int fill_row(stf_measure *w, size_t i, const stf_judged *j,
                    const steif_weak_result *result, steif_weak_row *row)
{
  const steif_weak_query *q = w->query;
  const sunrealtype h = ldexp(w->h, -(int)i);
  const bool all = q->component == STEIF_ALL;
  sunrealtype value = 0, error = 0, level = 0;
  STEIF_TRY(stf_measure_run(w, i));
  for (int m = w->first; m < w->first + w->count; m++) {
    const sunrealtype v = w->value[m];
    if (all && q->values) q->values[i * (size_t)w->subject.n + (size_t)m] = v;
    level = hypot(level,
                  w->level[m] + 4 * STF_EPS * (fabs(w->exact[m]) + fabs(v)) + result->accuracy);
    value = all ? hypot(value, v) : v;
    error = all ? hypot(error, v - w->exact[m]) : v - w->exact[m];
  }
  row[i] = (steif_weak_row){h, value, error, NAN, level, 0};
  row[i].usable =
    level <= USABLE * fabs(error) && error != 0 && isfinite(error) && !(h > j->longest);
  if (i > 0 && !isfinite(j->inside)) row[i].order = log2(fabs(row[i - 1].error / row[i].error));
  return stf_measure_tell(w, i);
}

/* ---- what the rows may be judged by ------------------------------------------------------- */

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

/* What is known before the rows are made. */
static int look_before(const stf_measure *w, steif_weak_row *row,
                       const steif_weak_result *result, stf_judged *j)
{
  const steif_weak_query *q = w->query;
  const sunrealtype t1 = (sunrealtype)w->subject.weight.t1;
  *j = (stf_judged){.row = row,
                    .rows = q->rows,
                    .size = fabs(result->exact),
                    .accuracy = result->accuracy,
                    .blind = -1,
                    .inside = NAN,
                    .decidable = w->longer && !q->exact};
  const size_t inside = stf_break_inside(q->break_count, q->breaks, t1, w->h);
  if (inside < q->break_count && !w->mesh.anew) {
    j->inside = q->breaks[inside], j->able = w->mesh.able;
    j->fitting = stf_break_step(q->break_count, q->breaks, t1, w->h);
  }
  return stf_measure_longest(w, &j->longest, &j->fastest);
}

static int conclude(const stf_measure *w, stf_judged *j, steif_weak_result *result)
{
  const stf_subject *s = &w->subject;
  STEIF_TRY(look_at_end(w, result->note, sizeof result->note));
  STEIF_TRY(find_blind(w, 0, s->block.k ? s->block.c : s->impulse.c, &j->blind));
  for (size_t b = 0; b < s->jumps; b++)
    STEIF_TRY(find_blind(w, s->jump[b].t, s->jump[b].at.c, &j->blind));
  stf_weak_judge(j, result);
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
  stf_mesh_say(&w->mesh, result->mesh, sizeof result->mesh);
  STEIF_TRY(stf_subject_pair(&w->subject, w->exact, &result->accuracy, result->source,
                             sizeof result->source));
  for (int m = 0; m < w->subject.n && !isfinite(result->accuracy); m++) w->exact[m] = NAN;
  result->exact = 0;
  for (int m = w->first; m < w->first + w->count; m++)
    result->exact = all ? hypot(result->exact, w->exact[m]) : w->exact[m];
  for (int m = 0; all && q->exacts && m < w->subject.n; m++) q->exacts[m] = w->exact[m];
  return STEIF_OK;
}

static int measure_rows(stf_measure *w, steif_weak_row *row, steif_weak_result *result)
{
  const steif_weak_query *q = w->query;
  STEIF_TRY(stf_measure_components(w));
  STEIF_TRY(find_exact(w, result));
  STEIF_TRY(first_order(w, &result->first));
  stf_judged j;
  STEIF_TRY(look_before(w, row, result, &j));
  for (size_t i = 0; i < q->rows; i++) STEIF_TRY(fill_row(w, i, &j, result, row));
  return conclude(w, &j, result);
}

/* Rounding that is only estimated decides nothing. */
static void doubt(const stf_measure *w, steif_weak_result *result)
{
  const char *method = w->query->method;
  char seen[sizeof result->verdict];
  if (w->longer || w->query->exact || stf_is_cobb(method)) return;
  memcpy(seen, result->verdict, sizeof seen);
  result->converges = -1, result->order = NAN;
  snprintf(
    result->verdict, sizeof result->verdict,
    "undecided: no second run of '%.40s' with %d unknowns tells its rounding, only runs on "
    "multiples of the data; by these: %.90s",
    method, w->subject.n, seen);
}

/* Are they what the verdict is about? Not where no row resolves what is measured. */
static bool has_parts(const stf_measure *w)
{
  sunrealtype longest;
  const char *fastest;
  const steif_weak_query *q = w->query;
  const sunrealtype t1 = (sunrealtype)w->subject.weight.t1;
  const bool inside =
    stf_break_inside(q->break_count, q->breaks, t1, w->h) < q->break_count && !w->mesh.anew;
  if (!(w->longer || q->exact) || inside || q->rows < STF_LEAST_ROWS) return false;
  return !stf_measure_longest(w, &longest, &fastest) &&
         ldexp(w->h, -(int)(q->rows - 1)) <= longest;
}

static int measure(steif_context *ctx, const steif_weak_query *query, steif_weak_row *row,
                   bool parts, steif_weak_result *result)
{
  *result = (steif_weak_result){.first = NAN, .exact = NAN, .converges = -1, .order = NAN};
  STEIF_TRY(stf_measure_check(ctx, query));
  stf_measure w;
  int code = stf_measure_open(ctx, query, &w);
  if (!code) code = measure_rows(&w, row, result);
  if (!code && parts && has_parts(&w)) code = stf_measure_parts(&w, result);
  if (!code && result->converges >= 0) doubt(&w, result);
  stf_measure_close(&w);
  return code;
}

int stf_weak_rows(steif_context *ctx, const steif_weak_query *query, steif_weak_row *row,
                  steif_weak_result *result)
{
  return measure(ctx, query, row, false, result);
}

int steif_weak_measure(steif_context *ctx, const steif_weak_query *query, steif_weak_row *row,
                       steif_weak_result *result)
{
  STEIF_CHECK(query && row && result, ctx, STEIF_BAD_INPUT,
              "a query and places for rows and result are needed, got NULL");
  return measure(ctx, query, row, true, result);
}

/* ---- conventions ------------------------------------------------------------------------- */

int steif_convention_usual(steif_context *ctx, const char *method, const char *start,
                           enum steif_convention *convention)
{
  STEIF_CHECK(method && convention, ctx, STEIF_BAD_INPUT,
              "a method and a place for its convention are needed, got NULL");
  steif_method_info m = {.family = "cobb",
                         .stages = 1}; /* no method, but a limit beside them */
  if (strcmp(method, "cobb")) STEIF_TRY(steif_method_find(ctx, method, &m));
  const bool table = !strcmp(m.family, "irk") || !strcmp(m.family, "dirk");
  *convention =
    (m.stages > 1 && strcmp(m.family, "glm") != 0) || (table && strncmp(method, "radau:s=1", 9))
      ? STEIF_STAGE
      : STEIF_R;
  if (strstr(method, "start=cq") || (start && !strcmp(start, "cq"))) *convention = STEIF_C;
  return STEIF_OK;
}
