/* parts.h: what is known of impulses of every order, and of the smooth part, by themselves.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_PARTS_H
#define STF_PARTS_H

#include "measure.h"

enum { STF_SMOOTH = -2, STF_JUMP = -1 };

/* One part: impulses of order q >= 0; what the start leaves in values of the run; the smooth part. */
typedef struct part {
  int q, converges;
  bool doubtful; /* it may be rounding of the analysis */
  sunrealtype order, least,
    size; /* INFINITY: exact, NAN: not known, but `least` at least; size: of
                                     the impulses */
} part;

typedef struct parts {
  int count;
  bool known;        /* all of them are decided */
  part lowest;       /* of those that converge with a known order */
  part bad;          /* one of those that do not, impulses first; converges = 0: there is one */
  part open;         /* the one that is not known, with the smallest */
  sunrealtype least; /* order, as far as known */
  sunrealtype most;  /* the size of the largest impulses */
} parts;

void stf_parts_note(parts *all, const part *p);
/* What they say of the verdict by rows; whole: there are no other parts. */
void stf_parts_conclude(const parts *all, bool whole, steif_weak_result *result);

#endif
