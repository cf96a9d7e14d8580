/* dense_agreement.h: how far two ways to x(0+) and the impulses are apart, and how far rounding of the
 * entries moves them.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_DENSE_AGREEMENT_H
#define STF_DENSE_AGREEMENT_H

#include "dense_units.h"

/* Two answers of one index, in the units of the analysis. */
typedef struct stf_two_starts {
  steif_context *ctx;
  stf_pool *pool;
  const stf_dense_units *units;
  const steif_analysis *analysis;
  const stf_sources *sources;
  const sunrealtype *x0; /* x(0-), of which sources has E x(0-) */
  const steif_impulse *one, *two;
  sunrealtype *difference; /* scratch, n */
  sunrealtype *
    apart; /* n, the largest differences so far, those of stf_start_moves as STF_DRAW_FACTOR times
                              as large; NULL: not wanted */
} stf_two_starts;

/* ||x(0+) - x(0+)|| relative to stf_sources_measure. */
sunrealtype stf_starts_apart(const stf_two_starts *p);
/* Both x(0+) and all impulses are equal to the relative tolerance, or negligible in F c_0 = -E (x(0+) - x(0-)) and
 * F c_i = -E c_{i-1}. */
bool stf_starts_agree(const stf_two_starts *p, sunrealtype tolerance);
/* The largest change of x(0+), measured likewise, when every entry of E, F and x(0-) changes by up to one unit
 * in the last place at random, STF_DRAWS times: what algorithms that agree by luck, or share an error of the data,
 * do not tell. INFINITY where the index is another one then. */
int stf_start_moves(const stf_two_starts *p, sunrealtype *moved);

#endif
