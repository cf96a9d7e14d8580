/* narrow.h: LU of narrow band matrices without a library call.
 *
 * Storage and pivoting are those of LAPACK's dgbtrf: entry (i, j) at kl + ku + i - j of column j,
 * ld = 2 kl + ku + 1, the multipliers below the diagonal, row j exchanged with row pivot[j]; only
 * the diagonal holds the reciprocals of the pivots. Complex entries are interleaved. A factorisation
 * returns 0, or k when the pivot of column k (from 1) vanished.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_NARROW_H
#define STF_NARROW_H

#include <sundials/sundials_types.h>

/* Up to this kl + ku the calls of a blocked LU cost more than they gain. */
enum { STF_NARROW = 24 };

typedef struct stf_narrow {
  sunindextype n;
  int kl, ku;
} stf_narrow;

sunindextype stf_narrow_factor(const stf_narrow *b, double *ab, int *pivot);
void stf_narrow_solve(const stf_narrow *b, const double *ab, const int *pivot, double *x);
sunindextype stf_narrow_zfactor(const stf_narrow *b, double *ab, int *pivot);
void stf_narrow_zsolve(const stf_narrow *b, const double *ab, const int *pivot, double *x);

#endif
