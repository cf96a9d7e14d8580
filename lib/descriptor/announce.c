/* announce.c: the sentence on what the dense algorithms found of a pencil.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "pairing.h"
#include <math.h>
#include <stdio.h>

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
    int chain = 0;
    while (chain < s->weyr_count && s->weyr[chain] > c) chain++;
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

void stf_announce(steif_structure *s, const char *reason, const char *by)
{
  char *text = s->message;
  const size_t length = sizeof s->message;
  if (!s->regular)
    snprintf(text, length,
             "singular%s: det(s E + F) = 0 for all s %s (reciprocal condition %.1e at best), "
             "%lld equation%s and %lld unknown%s to blame",
             s->certified ? "" : " to rounding",
             s->certified ? "exactly" : "after relative changes of entries by rounding",
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
