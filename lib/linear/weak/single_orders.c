/* single_orders.c: what the rows of a measure do not show, since a run is linear in its start and in f: how
 * the method does on impulses of every order by themselves, and on the smooth part by itself. The error
 * of order q is c_q times what the method makes of the Jordan block of index q + 2 from the last unit
 * vector, the same for every pencil. Where c_q is small, rows of the whole do not show that it does not
 * become smaller; where parts cancel, that it does.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "measure.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

/* Impulses below so much of the largest, or of x(0-), are rounding. */
#define NONE 1e-13
/* Orders so far apart are different ones. */
#define APART 0.5
enum { SMOOTH = -1, SMOOTHER = 6, ROWS = 4, LONGEST = 64 }; /* steps of the first row */

/* One part: impulses of order q, or SMOOTH. */
typedef struct part {
  int q, converges;
  sunrealtype order, size; /* size: of the impulses */
} part;

typedef struct parts {
  int count;
  bool known;  /* all of them are decided */
  part lowest; /* of those that converge */
  part bad;    /* the last of those that do not; converges = 0: there is one */
} parts;

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

/* About component 1, in many digits and with short steps where that is possible. */
static int ask_exactly(const stf_measure *w, const steif_weight *g, steif_weak_query *query)
{
  int stages;
  query->component = 0, query->break_count = 0, query->restart = 0;
  STEIF_TRY(stf_recurrence_of(w->ctx, query->method, &stages));
  if (!stages) return STEIF_OK;
  query->exact = 1;
  query->rows = ROWS;
  query->h = g->t1 / LONGEST;
  query->g = g;
  return STEIF_OK;
}

/* The question of the measure about another system. */
static int ask(const stf_measure *w, const steif_linear *linear, const sunrealtype *x0,
               bool block, part *p)
{
  steif_weak_query query = *w->query;
  steif_weak_result result;
  query.problem = NULL, query.linear = linear, query.x0 = x0;
  query.values = query.exacts = NULL, query.h = w->h, query.restart = w->mesh.anew;
  generic power = {(sunrealtype)w->subject.weight.t1, p->q + SMOOTHER};
  const steif_weight g = {generic_taylor, &power, power.t1, 0};
  if (block) STEIF_TRY(ask_exactly(w, &g, &query));
  steif_weak_row *rows = stf_allocate(w->ctx, query.rows, sizeof *rows);
  if (!rows) return STEIF_NO_MEMORY;
  const int code = stf_weak_rows(w->ctx, &query, rows, &result);
  p->converges = code ? -1 : result.converges;
  p->order = result.order;
  stf_release(w->ctx, rows);
  return code;
}

static int ask_block(const stf_measure *w, part *p)
{
  const int n = p->q + 2;
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
  x0[n - 1] = 1;
  if (!code) code = ask(w, &block, x0, true, p);
  if (E) SUNMatDestroy(E);
  if (F) SUNMatDestroy(F);
  return code;
}

/* From x(0+); of starts on a closed solution nothing is known. */
static int ask_smooth(stf_measure *w, part *p)
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
  int code = stf_subject_smooth(s, 1, &at, x);
  if (!code) code = ask(w, w->query->linear ? w->query->linear : &s->linear, x, false, p);
  stf_release(w->ctx, x);
  return code;
}

static void note(parts *all, const part *p)
{
  const bool lower = !(p->order >= all->lowest.order);
  all->count++;
  if (p->converges < 0) all->known = false;
  if (p->converges == 0) all->bad = *p;
  if (p->converges == 1 && isfinite(p->order) && lower) all->lowest = *p;
}

/* The part in words; `most`: the largest impulses. */
static void name(const part *p, sunrealtype most, char *text, size_t room)
{
  if (p->q == SMOOTH)
    snprintf(text, room, "the smooth part");
  else
    snprintf(text, room, "impulses of order %d, %.1e of the largest", p->q, p->size / most);
}

static void conclude(const parts *all, sunrealtype most, steif_weak_result *r)
{
  char what[64];
  char *text = r->verdict;
  const size_t room = sizeof r->verdict;
  const bool bad = all->bad.converges == 0;
  const sunrealtype seen = r->order;
  if (r->converges == 1 && bad) {
    r->converges = -1, r->order = NAN;
    name(&all->bad, most, what, sizeof what);
    snprintf(text, room,
             "undecided: by themselves %s, do not converge; these rows do not show it", what);
  } else if (r->converges == 0 && !bad && all->known) {
    r->converges = -1, r->order = NAN;
    snprintf(text, room,
             "undecided: every part of the solution by itself converges, these rows do not "
             "show it; ask for more");
  } else if (r->converges == 1 && all->lowest.order < seen - APART) {
    r->order = all->lowest.order;
    name(&all->lowest, most, what, sizeof what);
    snprintf(text, room, "converges weakly, order %.2f, that of %s; %.2f with these steps",
             r->order, what, seen);
  }
}

int stf_measure_parts(stf_measure *w, steif_weak_result *result)
{
  const stf_subject *s = &w->subject;
  const int count = s->index - 1;
  const bool slow = s->structure.finite > 0 || (s->block.k ? s->block.forcing : s->linear.f);
  parts all = {.known = true, .lowest = {.order = INFINITY}, .bad = {.converges = 1}};
  sunrealtype most = 0, size = 0;
  int present = 0;
  for (int m = 0; m < s->n; m++) size = fmax(size, fabs(s->problem.y0[m]));
  for (int q = 0; q < count; q++) most = fmax(most, size_of(w, q));
  for (int q = 0; q < count; q++) present += size_of(w, q) > NONE * fmax(size, most);
  if (present == 0 || present + slow < 2 || count + 1 >= STF_DERIVATIVES) return STEIF_OK;
  for (int q = 0; q < count; q++) {
    part p = {.q = q, .size = size_of(w, q)};
    if (p.size <= NONE * fmax(size, most)) continue;
    STEIF_TRY(ask_block(w, &p));
    note(&all, &p);
  }
  if (slow) {
    part p = {.q = SMOOTH};
    STEIF_TRY(ask_smooth(w, &p));
    note(&all, &p);
  }
  conclude(&all, most, result);
  return STEIF_OK;
}
