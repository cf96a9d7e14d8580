/* verdict.c: one verdict out of structure, growth and array at all points, and how sure it
 * is.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "diagnose.h"
#include <math.h>
#include <string.h>

/* Gaps of singular values that count at all, and that count as certain. */
static const sunrealtype least_gap = 1e3, certain_gap = 1e6;

typedef struct summary {
  const stf_evidence *e;
  int low[2], high[2];   /* smallest and largest index of growth and of the array */
  int found[2];          /* at how many points */
  bool stalls, singular; /* the array at all points; the pencil at all points */
  sunrealtype gap;
} summary;

static void note(summary *s, int which, int index)
{
  if (!s->found[which] || index < s->low[which]) s->low[which] = index;
  if (!s->found[which] || index > s->high[which]) s->high[which] = index;
  s->found[which]++;
}

static summary summarise(const stf_evidence *e)
{
  summary s = {.e = e, .stalls = e->arrays > 0, .singular = true, .gap = INFINITY};
  s.low[0] = s.high[0] = s.low[1] = s.high[1] = -1;
  for (int k = 0; k < e->points; k++) {
    const stf_growth *g = &e->at[k].growth;
    const stf_array *a = &e->at[k].array;
    if (g->row && g->found) note(&s, 0, g->index);
    s.singular = s.singular && (!g->row || g->singular);
    if (k >= e->arrays) continue;
    s.gap = fmin(s.gap, a->gap);
    s.stalls = s.stalls && !a->closed && a->stalls;
    if (a->closed && a->gap >= least_gap) note(&s, 1, a->index);
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
static void fill_lists(const summary *s, steif_diagnosis *d)
{
  const stf_evidence *e = s->e;
  const size_t n = e->lens->n;
  const bool array = s->found[1] > 0;
  for (size_t j = 0; j < n; j++) {
    d->number[j] = 1, d->derivatives[j] = 0, d->determined[j] = -1;
    d->c[j] = e->structure.c[j], d->d[j] = e->structure.d[j];
    if (!s->found[0] && !array && e->structure.matched) {
      d->number[j] = e->structure.number[j];
      d->derivatives[j] = e->structure.c[j];
    }
    for (int k = 0; k < e->points; k++) {
      const stf_growth *g = &e->at[k].growth;
      const stf_array *a = &e->at[k].array;
      if (g->row && g->found) {
        raise(&d->number[j], 1 + g->row[j]);
        raise(&d->derivatives[j], g->column[j]);
      }
      if (k >= e->arrays || !a->closed || a->gap < least_gap) continue;
      raise(&d->determined[j], a->determined[j]);
      if (!s->found[0]) {
        raise(&d->number[j], a->determined[j]);
        raise(&d->derivatives[j], a->derivatives[j]);
      }
    }
  }
}

static void fill_freedom(const summary *s, steif_diagnosis *d)
{
  const stf_evidence *e = s->e;
  d->freedom = -1;
  if (d->verdict != STEIF_REGULAR && d->verdict != STEIF_VARIES) return;
  if (stf_evidence_certified(e)) d->freedom = e->structure.freedom;
  for (int k = e->arrays - 1; k >= 0; k--) {
    const stf_array *a = &e->at[k].array;
    if (!a->closed || a->gap < least_gap || a->index != d->index) continue;
    d->freedom = a->freedom;
    memcpy(d->prescribe, a->prescribe, e->lens->n * sizeof *d->prescribe);
  }
}

/* -- decisions --------------------------------------------------------------------------- */

static void set(steif_diagnosis *d, enum steif_verdict verdict,
                enum steif_confidence confidence, int index)
{
  d->verdict = verdict, d->confidence = confidence, d->index = index;
}

static bool array_everywhere(const summary *s)
{
  return s->e->arrays > 0 && s->found[1] == s->e->arrays;
}

/* The structure is certified: the growth must agree with it, or the array decides. */
static void decide_certified(const summary *s, steif_diagnosis *d)
{
  const int S = s->e->structure.index;
  const bool grown = s->found[0] > 0 && s->low[0] == S && s->high[0] == S;
  const bool closed = array_everywhere(s);
  if (closed && s->low[1] == s->high[1] && s->low[1] <= S) {
    const bool sure = (grown && s->low[1] == S) || s->gap >= certain_gap;
    set(d, STEIF_REGULAR, sure ? STEIF_SURE : STEIF_PROBABLE, s->low[1]);
  } else if (grown)
    set(d, STEIF_REGULAR, s->found[1] && s->high[1] != S ? STEIF_PROBABLE : STEIF_SURE, S);
  else if (s->found[0] && s->low[0] == s->high[0] && s->high[0] <= S)
    set(d, STEIF_REGULAR, STEIF_PROBABLE, s->high[0]);
  else if (s->found[0])
    set(d, STEIF_VARIES, STEIF_PROBABLE, s->high[0] > S ? S : s->high[0]);
  else
    set(d, STEIF_REGULAR, STEIF_PROBABLE, S);
}

static void decide_by_array(const summary *s, steif_diagnosis *d)
{
  const bool same = s->low[1] == s->high[1];
  if (s->found[1] > 0 && !same)
    set(d, STEIF_VARIES, STEIF_PROBABLE, s->high[1]);
  else if (s->found[1] > 0 && array_everywhere(s)) {
    const bool grown = s->found[0] == 0 || (s->low[0] <= s->low[1] && s->high[0] >= s->low[1]);
    const bool enough = s->e->arrays >= 3 || s->e->lens->system.linear;
    const bool sure = s->gap >= certain_gap && enough && grown;
    set(d, STEIF_REGULAR, sure ? STEIF_SURE : STEIF_PROBABLE, s->low[1]);
  } else if (s->stalls)
    set(d, s->singular ? STEIF_NO_SOLUTION : STEIF_NOT_UNIQUE,
        s->gap >= certain_gap ? STEIF_SURE : STEIF_PROBABLE, -1);
  else
    set(d, STEIF_RANGE, STEIF_UNDECIDED, -1);
}

static void decide(const summary *s, steif_diagnosis *d)
{
  const stf_structure *S = &s->e->structure;
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

/* -- sentence ---------------------------------------------------------------------------- */

static bool any(const int *flag, size_t n, int least)
{
  for (size_t i = 0; i < n; i++)
    if (flag[i] >= least) return true;
  return false;
}

static void say_index(const summary *s, steif_diagnosis *d)
{
  const stf_lens *lens = s->e->lens;
  char *m = d->message;
  stf_diagnose_say(m, "index %d (%s)", d->index, steif_confidence_name(d->confidence));
  if (d->verdict == STEIF_VARIES)
    stf_diagnose_say(m,
                     ", the largest of those found near t = %g (%d to %d): a singular point is "
                     "near, numbers are for the largest",
                     lens->t, s->found[1] ? s->low[1] : s->low[0], d->index);
  if (any(d->number, lens->n, 2)) {
    stf_diagnose_say(m, "; numbers above 1: ");
    stf_diagnose_list(lens, m, false, d->number, 2, true);
  }
  if (any(d->derivatives, lens->n, 1)) {
    stf_diagnose_say(m, "; equations differentiated on the way: ");
    stf_diagnose_list(lens, m, true, d->derivatives, 1, true);
  }
  if (d->freedom >= 0)
    stf_diagnose_say(m, "; %lld degree%s of freedom", (long long)d->freedom,
                     d->freedom == 1 ? "" : "s");
  if (any(d->prescribe, lens->n, 1)) {
    stf_diagnose_say(m, ", for example ");
    stf_diagnose_list(lens, m, false, d->prescribe, 1, false);
  }
  if (d->structural >= 0 && !stf_evidence_certified(s->e))
    stf_diagnose_say(m, "; structure says %d, but its Jacobian is singular (cancellation)",
                     d->structural);
  else if (d->structural > d->index)
    stf_diagnose_say(m, "; structure over-estimates: %d", d->structural);
}

static void say_singular(const summary *s, steif_diagnosis *d)
{
  const stf_lens *lens = s->e->lens;
  const stf_structure *S = &s->e->structure;
  char *m = d->message;
  if (S->matched) {
    stf_diagnose_say(m,
                     "singular: s E - A has no inverse for any s (rcond %.1e) and no number of "
                     "differentiations up to %d determines y'; look for equations that repeat "
                     "each other and unknowns that none of them fixes",
                     s->e->at[0].growth.rcond, STF_DEEPEST);
    return;
  }
  stf_diagnose_say(m, "singular: equations {");
  stf_diagnose_list(lens, m, true, S->surplus, 1, false);
  stf_diagnose_say(m, "} are more than the unknowns they contain, and unknowns {");
  stf_diagnose_list(lens, m, false, S->unsolved, 1, false);
  stf_diagnose_say(m, "} are more than the equations they are in");
}

static void say(const summary *s, steif_diagnosis *d)
{
  switch (d->verdict) {
  case STEIF_REGULAR:
  case STEIF_VARIES: say_index(s, d); break;
  case STEIF_NO_SOLUTION: say_singular(s, d); break;
  case STEIF_NOT_UNIQUE:
    stf_diagnose_say(
      d->message,
      "not unique: s E - A is regular (index %d of the frozen pencil), but no number "
      "of differentiations up to %d determines y': solutions through one start "
      "differ, a computed one means nothing",
      s->high[0], STF_DEEPEST);
    break;
  default:
    stf_diagnose_say(
      d->message,
      "undecided: index %d to %d by structure %d, growth %d, array %d; smallest gap "
      "of singular values %.1e (1e3 is needed): give Jacobians, typical sizes or "
      "another point",
      s->low[0] >= 0 ? s->low[0] : d->structural, s->high[1] >= 0 ? s->high[1] : d->structural,
      d->structural, d->growth, d->array, d->gap);
  }
}

int stf_verdict(const stf_evidence *e, steif_diagnosis *d)
{
  const summary s = summarise(e);
  d->structural = e->structure.index;
  d->growth = s.high[0], d->array = s.high[1];
  d->gap = isfinite(s.gap) ? s.gap : 0;
  d->rcond = e->points ? INFINITY : 0;
  for (int k = 0; k < e->points; k++) d->rcond = fmin(d->rcond, e->at[k].rcond);
  decide(&s, d);
  fill_lists(&s, d);
  fill_freedom(&s, d);
  say(&s, d);
  return STEIF_OK;
}
