/* single_orders.c: what the rows of a measure do not show, since a run is linear in its start and in f: how
 * the method does on impulses of every order by themselves, and on the smooth part by itself. The error
 * of order q is c_q times what the method makes of the Jordan block of index q + 2 from the last unit
 * vector, the same for every pencil. Where c_q is small, rows of the whole do not show that it does not
 * become smaller; where parts cancel, that it does; where g is 0 at 0 in some derivative, nothing.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "parts.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <steif/method.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

/* Impulses below so much of the largest, or of x(0-), are rounding; those below so many times the rounding
 * of the pencil's analysis may be. */
#define NONE 1e-13
#define SURE 10
/* An observed order so far above that of the method is an accident of these rows. */
#define ABOVE 0.5
/* LONGEST, COARSEST, FINEST: steps of the first row, the fewest and the most of it. */
enum { SMOOTHER = 6, ROWS = 4, MORE_ROWS = 5, LONGEST = 64, COARSEST = 16, FINEST = 256 };
enum { MANY_STEPS = 64, MANY_VALUES = 48 }; /* of the first row, for many digits unasked */

static sunrealtype largest(const stf_measure *w, const sunrealtype *c, int q)
{
  sunrealtype most = 0;
  for (int m = w->first; m < w->first + w->count; m++)
    most = fmax(most, fabs(c[(size_t)q * (size_t)w->subject.n + (size_t)m]));
  return most;
}

/* The largest |c_q| / t1^(q + 1) of the components measured, at 0 and where the run begins anew. */
static sunrealtype size_of(const stf_measure *w, int q)
{
  const stf_subject *s = &w->subject;
  sunrealtype most = largest(w, s->block.k ? s->block.c : s->impulse.c, q);
  for (size_t b = 0; b < s->jumps && w->mesh.anew; b++)
    if (q < s->jump[b].at.count) most = fmax(most, largest(w, s->jump[b].at.c, q));
  return most / pow((sunrealtype)s->weight.t1, q + 1);
}

/* (1 - t / t1)^n, none of whose derivatives that matter is 0 at 0. */
typedef struct generic {
  sunrealtype t1;
  int n;
} generic;

static int generic_taylor(long double t, int order, long double *c, void *user)
{
  const generic *g = user;
  long double binomial = 1;
  for (int j = 0; j <= order; j++) {
    c[j] = j > g->n ? 0 : binomial * powl(1 - t / g->t1, g->n - j);
    binomial *= -(long double)(g->n - j) / (j + 1) / g->t1;
  }
  return 0;
}

/* A question about one part. */
typedef struct question {
  const steif_linear *linear;
  const sunrealtype *x0;
  int generic;   /* power of the test function; 0: that of the measure */
  size_t rows;   /* and */
  sunrealtype h; /* first step; 0: those of the measure */
  int component;
  bool exact, apart; /* in many digits; without breaks */
} question;

/* From a row that counts to one below rounding. */
static sunrealtype least_order(const steif_weak_row *row, size_t rows)
{
  sunrealtype least = -INFINITY;
  for (size_t i = 1; i < rows; i++)
    if (row[i - 1].usable)
      least =
        fmax(least, log2(fabs(row[i - 1].error) / (fabs(row[i].error) + row[i].rounding)));
  return least;
}

static void answer(const steif_weak_query *query, const steif_weak_row *row,
                   const steif_weak_result *result, part *p)
{
  /* Nothing but 0 in any digit; beside x(0-) = 1, of which 0 is left. */
  const sunrealtype zero = p->q == STF_JUMP ? NONE * (query->g ? query->g->t1 : 1) : 0;
  bool none = query->exact || p->q == STF_JUMP;
  for (size_t i = 0; i < query->rows; i++) none = none && fabs(row[i].error) <= zero;
  p->converges = none ? 1 : result->converges;
  p->order = p->least = result->order;
  if (p->converges != 1 || isfinite(p->order)) return;
  const bool exact = none || stf_weak_is_exact(result);
  p->order = exact ? INFINITY : NAN;
  p->least = exact ? INFINITY : least_order(row, query->rows);
}

static int ask(const stf_measure *w, const question *about, part *p)
{
  steif_weak_query query = *w->query;
  steif_weak_result result;
  query.problem = NULL, query.linear = about->linear, query.x0 = about->x0;
  query.tell = NULL, query.values = query.exacts = NULL, query.component = about->component;
  query.h = w->h, query.restart = w->mesh.anew;
  if (about->h > 0) query.h = about->h, query.rows = about->rows;
  if (about->exact) query.exact = 1;
  if (about->apart) query.break_count = 0, query.restart = 0;
  generic power = {(sunrealtype)w->subject.weight.t1, about->generic};
  const steif_weight g = {generic_taylor, &power, power.t1, 0};
  if (about->generic) query.g = &g;
  steif_weak_row *rows = stf_allocate(w->ctx, query.rows, sizeof *rows);
  if (!rows) return STEIF_NO_MEMORY;
  const int code = stf_weak_rows(w->ctx, &query, rows, &result);
  if (!code) answer(&query, rows, &result, p);
  stf_release(w->ctx, rows);
  return code;
}

/* Component 1 of a Jordan block from the last unit vector, in many digits and with short steps where that
 * is possible. */
static int ask_block(const stf_measure *w, part *p)
{
  const int n = p->q + 2;
  int stages = 0;
  sunrealtype x0[STF_DERIVATIVES] = {0};
  SUNMatrix E = SUNDenseMatrix(n, n, steif_sundials(w->ctx)),
            F = SUNDenseMatrix(n, n, steif_sundials(w->ctx));
  int code = E && F
               ? STEIF_OK
               : STEIF_FAIL(w->ctx, STEIF_NO_MEMORY, "no memory for matrices of order %d", n);
  for (int i = 0; i < n && !code; i++) {
    SM_ELEMENT_D(F, i, i) = 1;
    if (i + 1 < n) SM_ELEMENT_D(E, i, i + 1) = 1;
  }
  const steif_linear block = {E, F, NULL, NULL};
  question about = {.linear = &block, .x0 = x0, .apart = true};
  x0[n - 1] = 1;
  if (!code) code = stf_recurrence_of(w->ctx, w->query->method, &stages);
  about.exact = stages > 0, about.generic = p->q + SMOOTHER;
  about.rows = ROWS, about.h = (sunrealtype)w->subject.weight.t1 / LONGEST;
  if (!code) code = ask(w, &about, p);
  if (E) SUNMatDestroy(E);
  if (F) SUNMatDestroy(F);
  return code;
}

/* ---- the smooth part --------------------------------------------------------------------------- */

static bool settled(const part *p) { return p->converges == 1 && !isnan(p->order); }

/* Of the method as such; infinite: not known. */
static sunrealtype order_of_method(const stf_measure *w)
{
  steif_method_info m;
  const bool silent = stf_silence(w->ctx, true);
  const int code = steif_method_find(w->ctx, w->query->method, &m);
  stf_silence(w->ctx, silent);
  return code || m.order <= 0 ? INFINITY : (sunrealtype)m.order;
}

/* What another test function, other steps, or all components tell where these rows do not: a component
 * converges where all do, with their order at least. */
static int ask_further(const stf_measure *w, question about, part *p)
{
  sunrealtype longest;
  const char *fastest;
  int stages = 0;
  const sunrealtype t1 = (sunrealtype)w->subject.weight.t1;
  STEIF_TRY(stf_recurrence_of(w->ctx, w->query->method, &stages));
  STEIF_TRY(stf_measure_longest(w, &longest, &fastest));
  if (longest * FINEST < t1) return STEIF_OK;
  about.generic = w->subject.index + SMOOTHER;
  about.rows = MORE_ROWS, about.h = t1 / COARSEST;
  while (about.h > longest) about.h /= 2;
  part other = *p;
  STEIF_TRY(ask(w, &about, &other));
  if (other.converges < 0 && stages > 0 && stages * w->subject.n <= MANY_VALUES &&
      t1 / about.h <= MANY_STEPS) {
    question exactly = about;
    exactly.exact = true, exactly.rows = ROWS;
    STEIF_TRY(ask(w, &exactly, &other));
  }
  if (other.converges < 0 && about.component != STEIF_ALL) {
    about.component = STEIF_ALL;
    STEIF_TRY(ask(w, &about, &other));
    if (other.converges == 0) other.converges = -1;
    other.order = NAN;
  }
  if (p->converges < 0 || other.converges == 0)
    *p = other;
  else if (isnan(p->order) || other.order < p->order - ABOVE)
    p->order = other.order, p->least = other.least;
  return STEIF_OK;
}

/* From x(0+); of starts on a closed solution nothing is known. */
static int ask_smooth(stf_measure *w, bool doubted, part *p)
{
  stf_subject *s = &w->subject;
  const sunrealtype at = 0;
  const char *start = w->query->start;
  const bool closed =
    start ? !strcmp(start, "exact") : strstr(w->query->method, "start=exact") != NULL;
  p->converges = -1, p->order = NAN;
  if (closed || !s->linear.E) return STEIF_OK;
  sunrealtype *x = stf_allocate(w->ctx, (size_t)s->n, sizeof *x);
  if (!x) return STEIF_NO_MEMORY;
  const question about = {.linear = w->query->linear ? w->query->linear : &s->linear,
                          .x0 = x,
                          .component = w->query->component};
  int code = stf_subject_smooth(s, 1, &at, x);
  if (!code) code = ask(w, &about, p);
  if (!code && !s->jumps && (doubted || !settled(p) || p->order > order_of_method(w) + ABOVE))
    code = ask_further(w, about, p);
  stf_release(w->ctx, x);
  return code;
}

/* ---- all of them ------------------------------------------------------------------------------- */

int stf_measure_parts(stf_measure *w, steif_weak_result *result)
{
  const stf_subject *s = &w->subject;
  const int count = s->index - 1;
  const bool slow = s->structure.finite > 0 || (s->block.k ? s->block.forcing : s->linear.f);
  const sunrealtype rounding = stf_subject_rounding(s);
  parts all = {
    .known = true, .least = INFINITY, .lowest = {.order = INFINITY}, .bad = {.converges = 1}};
  sunrealtype size = 0;
  if (count + 1 >= STF_DERIVATIVES) return STEIF_OK;
  for (int m = 0; m < s->n; m++) size = fmax(size, fabs(s->problem.y0[m]));
  for (int q = 0; q < count; q++) all.most = fmax(all.most, size_of(w, q));
  for (int q = STF_JUMP; q < count; q++) {
    part p = {.q = q, .size = q < 0 ? 0 : size_of(w, q)};
    if (q >= 0 && p.size <= NONE * fmax(size, all.most)) continue;
    p.doubtful = q >= 0 && p.size <= SURE * rounding;
    STEIF_TRY(ask_block(w, &p));
    stf_parts_note(&all, &p);
  }
  if (slow) {
    part p = {.q = STF_SMOOTH, .converges = -1};
    STEIF_TRY(ask_smooth(w, result->converges < 0, &p));
    stf_parts_note(&all, &p);
  }
  stf_parts_conclude(&all, s->jumps == 0 && !*result->note, result);
  return STEIF_OK;
}
