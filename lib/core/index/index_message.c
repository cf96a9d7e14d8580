/* index_message.c: the sentence on the index.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "evidence.h"
#include "index_thresholds.h"

static void say_index(const stf_summary *s, steif_diagnosis *d)
{
  const stf_point *point = s->e->point;
  char *m = d->message;
  stf_point_say(m, "index %d (%s)", d->index, steif_confidence_name(d->confidence));
  if (d->verdict == STEIF_VARIES)
    stf_point_say(m,
                  ", the largest of those found near t = %g (%d to %d): a singular point is "
                  "near, numbers are for the largest",
                  point->t, s->found[1] ? s->low[1] : s->low[0], d->index);
  if (stf_point_any(point, d->number, 2)) {
    stf_point_say(m, "; numbers above 1: ");
    stf_point_list(point, m, false, d->number, 2, true);
  }
  if (stf_point_any(point, d->derivatives, 1)) {
    stf_point_say(m, "; equations differentiated on the way: ");
    stf_point_list(point, m, true, d->derivatives, 1, true);
  }
  if (d->freedom >= 0)
    stf_point_say(m, "; %lld degree%s of freedom", (long long)d->freedom,
                  d->freedom == 1 ? "" : "s");
  if (stf_point_any(point, d->prescribe, 1)) {
    stf_point_say(m, ", for example ");
    stf_point_list(point, m, false, d->prescribe, 1, false);
  }
  if (stf_evidence_certified(s->e) && d->rcond < STF_REGULAR_RCOND)
    stf_point_say(m, "; an unknown hangs on small entries (rcond %.1e of the system Jacobian)",
                  d->rcond);
  if (d->structural >= 0 && !stf_evidence_certified(s->e))
    stf_point_say(m, "; structure says %d, but its Jacobian is singular (cancellation)",
                  d->structural);
  else if (d->structural > d->index)
    stf_point_say(m, "; structure over-estimates: %d", d->structural);
}

static void say_small_entries(steif_diagnosis *d)
{
  if (d->confidence != STEIF_SURE && d->rcond > 0)
    stf_point_say(d->message,
                  ", unless small entries are meant as they stand: the system Jacobian "
                  "is regular with rcond %.1e",
                  d->rcond);
}

static void say_singular(const stf_summary *s, steif_diagnosis *d)
{
  const stf_point *point = s->e->point;
  const stf_offsets *S = &s->e->offsets;
  char *m = d->message;
  if (S->matched) {
    stf_point_say(m,
                  "singular: s E - A has no inverse for any s (rcond %.1e) and no number of "
                  "differentiations up to %d determines y'; look for equations that repeat "
                  "each other and unknowns that none of them fixes",
                  s->e->at[0].growth.rcond, STF_DEEPEST);
    say_small_entries(d);
    return;
  }
  stf_point_say(m, "singular: equations {");
  stf_point_list(point, m, true, S->surplus, 1, false);
  stf_point_say(m, "} are more than the unknowns they contain, and unknowns {");
  stf_point_list(point, m, false, S->unsolved, 1, false);
  stf_point_say(m, "} are more than the equations they are in");
}

void stf_index_message(const stf_summary *s, steif_diagnosis *d)
{
  switch (d->verdict) {
  case STEIF_REGULAR:
  case STEIF_VARIES: say_index(s, d); break;
  case STEIF_NO_SOLUTION: say_singular(s, d); break;
  case STEIF_NOT_UNIQUE:
    stf_point_say(
      d->message,
      "not unique: s E - A is regular (index %d of the frozen pencil), but no number "
      "of differentiations up to %d determines y': solutions through one start "
      "differ, a computed one means nothing",
      s->high[0], STF_DEEPEST);
    say_small_entries(d);
    break;
  default:
    stf_point_say(
      d->message,
      "undecided: index %d to %d by structure %d, growth %d, array %d; smallest gap "
      "of singular values %.1e (1e3 is needed): give Jacobians, typical sizes or "
      "another point",
      s->low[0] >= 0 ? s->low[0] : d->structural, s->high[1] >= 0 ? s->high[1] : d->structural,
      d->structural, d->growth, d->array, d->gap);
  }
}
