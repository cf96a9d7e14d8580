/* integral_separation.h: sums of ln R_ii kept at some thousand times of a run, and what they say of pairs.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_INTEGRAL_SEPARATION_H
#define STF_INTEGRAL_SEPARATION_H

#include "base.h"
#include <steif/lyapunov.h>

typedef struct stf_gaps {
  int m;
  long stride, count; /* steps between points; points after the first, whose sums are 0 */
  sunrealtype *sum;   /* count + 1 rows of m */
} stf_gaps;

int stf_gaps_open(stf_pool *pool, long steps, int m, stf_gaps *s);
/* Sums after step n = 1, 2, ... */
void stf_gaps_record(stf_gaps *s, long n, const sunrealtype *now);
/* m - 1 pairs. */
void stf_gaps_judge(const stf_gaps *s, sunrealtype h, steif_separation *pair);

#endif
