/* norm.h: norms of the error of a run in H^-m.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_NORM_H
#define STF_NORM_H

#include "measure.h"

/* Gauss's points of a step where the smooth solution is known, and the largest m. */
enum { STF_NODES = 8, STF_SPACES = STEIF_SPACES };

/* What is subtracted from a run: impulses at 0 (rows of n: c_0, c_1, ...) and smooth values, STF_NODES
 * rows of n for each step; NULL: nothing. */
typedef struct stf_limit {
  int impulses;
  const sunrealtype *c, *x;
} stf_limit;

/* T^(1/2 - m) || I^m e ||_L2(0, T) of component `j` of events less limit, for m = 1 .. most into
 * norm[m - 1]; run in steps h. */
void stf_dual_norm(const stf_events *events, int n, int j, const stf_limit *limit,
                   long double h, size_t steps, long double t1, int most, long double *norm);

#endif
