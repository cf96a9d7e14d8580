/* split.h: what the two splits of A^{-1} share.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_SPLIT_H
#define STF_SPLIT_H

#include "table.h"

typedef struct stf_split_work {
  long double A[STEIF_STAGES * STEIF_STAGES], B[STEIF_STAGES * STEIF_STAGES];
  long double T[STEIF_STAGES * STEIF_STAGES], Tinv[STEIF_STAGES * STEIF_STAGES];
  long double S[STEIF_STAGES * STEIF_STAGES]; /* coupling */
  int lanes, row[STEIF_STAGES];
  stf_complex lambda[STEIF_STAGES];
} stf_split_work;

/* False when a pivot of M is not larger than `tiny`. */
bool stf_split_invert(int s, const long double *M, long double tiny, long double *inverse);

/* T, Tinv, S, lanes, row and lambda of the Schur split of w->B. */
int stf_split_schur(steif_context *ctx, int s, stf_split_work *w);

#endif
