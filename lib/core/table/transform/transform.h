/* transform.h: what the two splits of A^{-1} share.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_SPLIT_H
#define STF_SPLIT_H

#include "table.h"

typedef struct stf_transform_work {
  long double A[STEIF_STAGES * STEIF_STAGES], B[STEIF_STAGES * STEIF_STAGES];
  long double T[STEIF_STAGES * STEIF_STAGES], Tinv[STEIF_STAGES * STEIF_STAGES];
  long double S[STEIF_STAGES * STEIF_STAGES]; /* coupling */
  int shifts, row[STEIF_STAGES];
  stf_complex lambda[STEIF_STAGES];
} stf_transform_work;

/* False when a pivot of M is not larger than `tiny`. */
bool stf_transform_invert(int s, const long double *M, long double tiny, long double *inverse);

/* T, Tinv, S, shifts, row and lambda of the Schur split of w->B. */
int stf_transform_schur(steif_context *ctx, int s, stf_transform_work *w);

#endif
