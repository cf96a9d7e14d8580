/* dense_message.c: the sentences on what the dense algorithms have found of a pencil.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "dense_algorithm.h"
#include "dense_thresholds.h"
#include "weyr.h"
#include <math.h>
#include <stdio.h>

/* The index itself is open. */
static const char *open_index(const stf_both_ways *p, char *text, size_t length)
{
  const steif_structure *a = p->staircase, *b = p->schur;
  if (p->other_index >= 0)
    return "small entries decide, in other units of equations and unknowns the index is "
           "another one: set those to 0 that are rounding";
  if (b->index < 0 && a->index > 1)
    snprintf(
      text, length,
      "%.80s; rounding of the entries alone brings eigenvalues of a chain of %d from infinity "
      "down to some eps^(-1/%d) = %.1e",
      b->message, a->index, a->index, pow(STF_EPS, -1.0 / a->index));
  else if (b->index < 0)
    return b->message;
  else if (p->carried > 0)
    snprintf(
      text, length,
      "entries that are rounding beside the largest carry %lld more finite eigenvalue%s: "
      "set those to 0 that are rounding",
      (long long)p->carried, p->carried == 1 ? "" : "s");
  else if (a->index < 0)
    return "the singular values of the staircase leave the index open";
  else if (a->index != b->index)
    snprintf(text, length, "the staircase finds index %d, the generalised Schur form %d",
             a->index, b->index);
  else
    return NULL;
  return text;
}

const char *stf_dense_objection(const stf_both_ways *p, char *text, size_t length)
{
  const steif_structure *a = p->staircase, *b = p->schur;
  const char *first = open_index(p, text, length);
  if (first) return first;
  if (!(fabs(a->count - (sunrealtype)a->finite) <= STF_COUNT_OFF))
    snprintf(text, length,
             "%lld finite eigenvalues by staircase and generalised Schur form, but %.3f by "
             "Jensen's formula",
             (long long)a->finite, a->count);
  else if (!(p->resolution >= b->radius))
    snprintf(
      text, length,
      "rounding of the entries hides finite eigenvalues beyond |s| = %.1e, and there are "
      "some up to %.1e",
      p->resolution, b->radius);
  else if (!p->agreed)
    snprintf(text, length,
             "staircase and generalised Schur form give x(0+) apart by %.1e or other impulses",
             p->off);
  else if (!isfinite(p->moved))
    return "a change of the entries in the last place alone changes the index";
  else if (p->moved > STF_AGREEMENT)
    snprintf(text, length,
             "a change of the entries in the last place alone moves x(0+) by %.1e", p->moved);
  else
    return NULL;
  return text;
}

/* "2 infinite in a chain of 2": the chains are the conjugate partition of the Weyr numbers. */
static int chains(const steif_structure *s, char *text, size_t length)
{
  const long long count = (long long)s->weyr[0], all = (long long)s->infinite;
  if (s->index == 1) return snprintf(text, length, "%lld infinite", all);
  if (count == 1)
    return snprintf(text, length, "%lld infinite in a chain of %d", all, s->index);
  int used = snprintf(text, length, "%lld infinite in %lld chains, the longest of", all, count);
  if (count <= 6) used = snprintf(text, length, "%lld infinite in chains of", all);
  for (long long c = 0; c < (count <= 6 ? count : 1); c++) {
    const int chain = stf_weyr_block(s->weyr, s->weyr_count, c);
    used += snprintf(text + used, length - (size_t)used, "%s %d", c ? "," : "", chain);
  }
  return used;
}

static void describe(const steif_structure *s, const char *reason, const char *by,
                     char *message, size_t length)
{
  char fast[160] = "none infinite", largest[40] = "", up_to[96] = "";
  if (s->infinite > 0) chains(s, fast, sizeof fast);
  if (s->finite > 0) snprintf(largest, sizeof largest, " (largest %.3g)", s->radius);
  if (!reason && isfinite(s->resolution))
    snprintf(up_to, sizeof up_to,
             " for |s| up to %.1e, beyond which rounding of E and F would hide more",
             s->resolution);
  snprintf(message, length,
           "regular, index %d: %lld finite eigenvalue%s%s, %s; gap %.0e; %s%s%s", s->index,
           (long long)s->finite, s->finite == 1 ? "" : "s", largest, fast, s->gap,
           reason ? "not certified: " : "certified by the ", reason ? reason : by, up_to);
}

void stf_dense_message(steif_structure *s, const char *reason, const char *by)
{
  char *text = s->message;
  const size_t length = sizeof s->message;
  if (!s->regular)
    snprintf(text, length,
             "%s: det(s E + F) = 0 for all s %s (reciprocal condition %.1e at best), %lld "
             "equation%s and %lld "
             "unknown%s to blame",
             s->certified ? "singular" : "singular to rounding",
             s->certified
               ? "exactly"
               : "after relative changes of entries by rounding, not exactly as given",
             s->rcond, (long long)s->equations_count, s->equations_count == 1 ? "" : "s",
             (long long)s->unknowns_count, s->unknowns_count == 1 ? "" : "s");
  else if (s->index < 0)
    snprintf(text, length,
             "regular, index undecided, at least %d: gap %.0e; not certified: %s; scale the "
             "equations or give them more exactly",
             s->index_least, s->gap, reason);
  else
    describe(s, reason, by, text, length);
}
