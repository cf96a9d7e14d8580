/* splitting.h: schemes that split y' = f into q' = T_p(p), the drift, and p' = -V_q(q), the
 * kick.
 *
 * One step is a sequence of passes: a kick of length kick_i h, then a drift of length
 * drift_i h. The time of a kick is that of the positions, the sum of the drifts before it;
 * the time of a drift is the sum of the kicks before it: so the order is kept when T and V
 * depend on t.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_SPLITTING_H
#define STF_SPLITTING_H

#include "base.h"

/* Given numbers, of which symmetry and consistency leave the rest. */
enum stf_splitting_kind {
  STF_EULER,      /* the two flows, one after the other; no numbers */
  STF_VERLET,     /* Verlet steps of lengths w_1 .. w_k, 1 - 2 sum, w_k .. w_1: k numbers */
  STF_ALTERNATING /* the two flows in turn, from both ends: k numbers, then what is missing of the
                     one flow to 1/2, and in the middle what is missing of the other to 1 */
};

enum { STF_GIVEN = 12, STF_PASSES = 2 * STF_GIVEN + 2 };

typedef struct stf_splitting {
  const char *name, *about;
  int order;
  enum stf_splitting_kind kind;
  bool kick_first; /* may be chosen by the user unless the flows have numbers of their own */
  int count;
  long double given[STF_GIVEN];
} stf_splitting;

extern const stf_splitting stf_splittings[];
extern const size_t stf_splitting_count;

typedef struct stf_passes {
  int count,
    kicks; /* kicks: evaluations of p' in a step, one less where the last serves the next */
  bool kick_first,
    reuses; /* reuses: the last kick has the positions of the next step's first */
  sunrealtype kick[STF_PASSES], drift[STF_PASSES];
  sunrealtype kick_at[STF_PASSES], drift_at[STF_PASSES];
} stf_passes;

/* NULL if there is none of that name. */
const stf_splitting *stf_splitting_find(const char *name);
/* The passes of a step; `kick_first` is heeded by schemes that may begin with either flow. */
void stf_splitting_passes(const stf_splitting *scheme, bool kick_first, stf_passes *passes);

#endif
