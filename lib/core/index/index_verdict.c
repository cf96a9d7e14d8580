/* index_verdict.c: one verdict from structure, growth and array at all points, and how sure it is.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "evidence.h"
#include "index_thresholds.h"
#include <math.h>
#include <string.h>

static void note(stf_summary *s, int which, int index)
{
  if (!s->found[which] || index < s->low[which]) s->low[which] = index;
  if (!s->found[which] || index > s->high[which]) s->high[which] = index;
  s->found[which]++;
}

stf_summary stf_summarise(const stf_evidence *e)
{
  stf_summary s = {.e = e, .stalls = e->arrays > 0, .singular = true, .gap = INFINITY};
  s.low[0] = s.high[0] = s.low[1] = s.high[1] = -1;
  for (int k = 0; k < e->points; k++) {
    const stf_resolvent_growth *g = &e->at[k].growth;
    const stf_derivative_array *a = &e->at[k].array;
    if (g->row && g->found) note(&s, 0, g->index);
    s.singular = s.singular && (!g->row || g->singular);
    if (k >= e->arrays) continue;
    s.gap = fmin(s.gap, a->gap);
    s.stalls = s.stalls && !a->closed && a->stalls;
    if (a->closed && a->gap >= STF_LEAST_GAP) note(&s, 1, a->index);
  }
  if (!e->arrays) s.gap = 0;
  return s;
}

/* -- lists ------------------------------------------------------------------------------- */

static void raise(int *to, int value)
{
  if (value > *to) *to = value;
}

/* Numbers and differentiations: from the growth, else from the array, else from the
 * structure. */
static void fill_lists(const stf_summary *s, steif_diagnosis *d)
{
  const stf_evidence *e = s->e;
  const size_t n = e->point->n;
  const bool array = s->found[1] > 0;
  for (size_t j = 0; j < n; j++) {
    d->number[j] = 1;
    d->derivatives[j] = 0;
    d->determined[j] = -1;
    d->c[j] = e->offsets.c[j];
    d->d[j] = e->offsets.d[j];
    if (!s->found[0] && !array && e->offsets.matched) {
      d->number[j] = e->offsets.component_index[j];
      d->derivatives[j] = e->offsets.c[j];
    }
    for (int k = 0; k < e->points; k++) {
      const stf_resolvent_growth *g = &e->at[k].growth;
      const stf_derivative_array *a = &e->at[k].array;
      if (g->row && g->found) {
        raise(&d->number[j], 1 + g->row[j]);
        raise(&d->derivatives[j], g->column[j]);
      }
      if (k >= e->arrays || !a->closed || a->gap < STF_LEAST_GAP) continue;
      raise(&d->determined[j], a->determined[j]);
      if (!s->found[0]) {
        raise(&d->number[j], a->determined[j]);
        raise(&d->derivatives[j], a->derivatives[j]);
      }
    }
  }
}

/* A certified structure bounds the numbers: growth up to rates that a small entry ends is none. */
static void bound_lists(const stf_summary *s, steif_diagnosis *d)
{
  const stf_offsets *S = &s->e->offsets;
  if (!stf_evidence_certified(s->e)) return;
  for (size_t j = 0; j < s->e->point->n; j++) {
    if (d->number[j] > S->component_index[j]) d->number[j] = S->component_index[j];
    if (d->derivatives[j] > S->c[j]) d->derivatives[j] = S->c[j];
  }
}

static void fill_freedom(const stf_summary *s, steif_diagnosis *d)
{
  const stf_evidence *e = s->e;
  d->freedom = -1;
  if (d->verdict != STEIF_REGULAR && d->verdict != STEIF_VARIES) return;
  if (stf_evidence_certified(e)) d->freedom = e->offsets.degrees_of_freedom;
  for (int k = e->arrays - 1; k >= 0; k--) {
    const stf_derivative_array *a = &e->at[k].array;
    if (!a->closed || a->gap < STF_LEAST_GAP || a->index != d->index) continue;
    d->freedom = a->freedom;
    memcpy(d->prescribe, a->prescribe, e->point->n * sizeof *d->prescribe);
  }
}

/* -- decisions --------------------------------------------------------------------------- */

static void set(steif_diagnosis *d, enum steif_verdict verdict,
                enum steif_confidence confidence, int index)
{
  d->verdict = verdict;
  d->confidence = confidence;
  d->index = index;
}

static bool array_everywhere(const stf_summary *s)
{
  return s->e->arrays > 0 && s->found[1] == s->e->arrays;
}

/* The structure is certified: the growth must agree with it, or the array decides. */
static void decide_certified(const stf_summary *s, steif_diagnosis *d)
{
  const int S = s->e->offsets.index;
  const bool grown = s->found[0] > 0 && s->low[0] == S && s->high[0] == S;
  const bool closed = array_everywhere(s);
  if (closed && s->low[1] == s->high[1] && s->low[1] <= S) {
    const bool sure = (grown && s->low[1] == S) || s->gap >= STF_CERTAIN_GAP;
    set(d, STEIF_REGULAR, sure ? STEIF_SURE : STEIF_PROBABLE, s->low[1]);
  } else if (grown)
    set(d, STEIF_REGULAR, s->found[1] && s->high[1] != S ? STEIF_PROBABLE : STEIF_SURE, S);
  else if (s->found[0] && s->low[0] == s->high[0] && s->high[0] <= S)
    set(d, STEIF_REGULAR, STEIF_PROBABLE, s->high[0]);
  else if (s->found[0])
    set(d, STEIF_VARIES, STEIF_PROBABLE, s->high[0] > S ? S : s->high[0]);
  else
    set(d, STEIF_REGULAR, STEIF_PROBABLE, S);
  if (!closed && stf_evidence_rcond(s->e) < STF_REGULAR_RCOND && d->confidence == STEIF_SURE)
    d->confidence = STEIF_PROBABLE;
}

/* Is a system Jacobian of callbacks regular beyond rounding, if only just? Then what the array takes for a null vector may be
 * none. */
static bool hardly_regular(const stf_evidence *e)
{
  const sunrealtype rounding = 4 * (sunrealtype)e->point->n * STF_EPS;
  return e->offsets.matched && e->point->analytic && stf_evidence_rcond(e) >= rounding;
}

static void decide_by_array(const stf_summary *s, steif_diagnosis *d)
{
  const bool same = s->low[1] == s->high[1];
  if (s->found[1] > 0 && !same)
    set(d, STEIF_VARIES, STEIF_PROBABLE, s->high[1]);
  else if (s->found[1] > 0 && array_everywhere(s)) {
    const bool grown = s->found[0] == 0 || (s->low[0] <= s->low[1] && s->high[0] >= s->low[1]);
    const bool enough = s->e->arrays >= 3 || s->e->point->system.linear;
    const bool sure = s->gap >= STF_CERTAIN_GAP && enough && grown;
    set(d, STEIF_REGULAR, sure ? STEIF_SURE : STEIF_PROBABLE, s->low[1]);
  } else if (s->stalls)
    set(d, s->singular ? STEIF_NO_SOLUTION : STEIF_NOT_UNIQUE,
        s->gap >= STF_CERTAIN_GAP && !hardly_regular(s->e) ? STEIF_SURE : STEIF_PROBABLE, -1);
  else
    set(d, STEIF_RANGE, STEIF_UNDECIDED, -1);
}

static void decide(const stf_summary *s, steif_diagnosis *d)
{
  const stf_offsets *S = &s->e->offsets;
  if (!S->matched && !s->found[1])
    set(d, STEIF_NO_SOLUTION, STEIF_SURE, -1);
  else if (stf_evidence_certified(s->e))
    decide_certified(s, d);
  else if (s->e->arrays)
    decide_by_array(s, d);
  else if (s->singular)
    set(d, STEIF_NO_SOLUTION, STEIF_PROBABLE, -1);
  else if (s->found[0] && s->low[0] == s->high[0])
    set(d, STEIF_REGULAR, STEIF_PROBABLE, s->low[0]);
  else
    set(d, STEIF_RANGE, STEIF_UNDECIDED, -1);
}

void stf_verdict(const stf_summary *s, steif_diagnosis *d)
{
  d->structural = s->e->offsets.index;
  d->growth = s->high[0];
  d->array = s->high[1];
  d->gap = isfinite(s->gap) ? s->gap : 0;
  d->rcond = stf_evidence_rcond(s->e);
  decide(s, d);
  fill_lists(s, d);
  bound_lists(s, d);
  fill_freedom(s, d);
}
