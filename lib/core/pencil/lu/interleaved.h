/* interleaved.h: all shifts of a collocation method side by side: the state of the files of interleaved.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_INTERLEAVED_H
#define STF_INTERLEAVED_H

#include "bitset.h"

enum { STF_INTERLEAVED_LANES = 2 * STF_LANES }; /* shifts at most */

/* Entry (i, j) of the LU holds re[lane], im[lane] of all lanes. */
typedef struct stf_shifts {
  stf_interleaved face;                          /* what others see */
  const struct stf_interleaved_kernels *kernels; /* of the instruction set there is */
  int lanes;                                     /* 1, 2, 4 or 8 */
  double lambda[2 * STF_INTERLEAVED_LANES];      /* re, im; padding lanes repeat the first */
  double gain
    [STF_INTERLEAVED_LANES]; /* weight of |omega_k|^2 in the norm: 1 real, 4 pair, 0 padding */
  double Vinv[STF_INTERLEAVED_STAGES]
             [2 * STF_INTERLEAVED_LANES]; /* column j of V^{-1}: re, im by lane */
  double V[2 * STF_INTERLEAVED_LANES]
          [STF_INTERLEAVED_STAGES]; /* Z_j = sum_k V[k][j] re_k + V[lanes + k][j] im_k */
  double *lu;                       /* n x n by columns, 2 lanes each */
  int *order;                       /* rows in the order of elimination */
  bool sparse,
    full; /* zeros are skipped, the order is `column`; known to be too full for that */
  uint64_t pattern[STF_INTERLEAVED]; /* rows of M and of all J so far, by columns */
  int column[STF_INTERLEAVED];       /* unknowns in the order of elimination */
  int lower[STF_INTERLEAVED + 1], upper[STF_INTERLEAVED]; /* columns: lists in `row` */
  unsigned char *row; /* rows below the pivot of step k: lower[k] .., above: upper[k] .. */
  double *omega, *rhs, *work; /* n x 2 lanes */
  const double *M;            /* n x n by rows; NULL: identity */
} stf_shifts;

#endif
