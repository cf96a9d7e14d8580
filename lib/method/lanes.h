/* lanes.h: collocation for small dense systems, all shifts factored and solved together.
 *
 * The lanes of a split (one per real eigenvalue and per conjugate pair of A^{-1}) are the innermost
 * index of every array: entry (i, j) of the LU holds re[lane], im[lane], so that one pass over the
 * matrix serves all shifts in vector registers. A real shift rides along with zero imaginary part.
 * Stage values are kept by component, padded to `wide` stages. A matrix whose LU is mostly zeros is
 * eliminated in an order of little fill, its zeros skipped.
 *
 *   (lambda_k / h M - J) d omega_k = [V^{-1} F]_k - (lambda_k / h) M omega_k,   Z = V omega
 *
 * with eigenvectors scaled to last component 1 (Hairer and Wanner, Solving ODEs II, IV.8).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_LANES_H
#define STF_LANES_H

#include "table.h"
#include <stdint.h>

enum { STF_LANES = 8, STF_WIDE = 16, STF_LANES_LARGEST = 64 };

struct stf_lanes_kernels;

typedef struct stf_lanes {
  const struct stf_lanes_kernels *kernels; /* of the instruction set there is */
  int n, s, lanes, wide;        /* lanes: 1, 2, 4 or 8; wide: stages padded to 4, 8 or 16 */
  double lambda[2 * STF_LANES]; /* re, im; padding lanes repeat the first */
  double gain[STF_LANES]; /* weight of |omega_k|^2 in the norm: 1 real, 4 pair, 0 padding */
  double Vinv[STF_WIDE][2 * STF_LANES]; /* column j of V^{-1}: re, im by lane */
  double V[2 * STF_LANES][STF_WIDE];    /* Z_j = sum_k V[k][j] re_k + V[lanes + k][j] im_k */
  double *lu;                           /* n x n by columns, 2 lanes each */
  int *order;                           /* rows in the order of elimination */
  bool thin, full; /* zeros are skipped, the order is `column`; known to be too full for that */
  uint64_t pattern[STF_LANES_LARGEST];  /* rows of M and of all J so far, by columns */
  int column[STF_LANES_LARGEST];        /* unknowns in the order of elimination */
  int lower[STF_LANES_LARGEST + 1], upper[STF_LANES_LARGEST]; /* columns: lists in `row` */
  unsigned char *row; /* rows below the pivot of step k: lower[k] .., above: upper[k] .. */
  double *omega, *rhs, *work;           /* n x 2 lanes */
  double *Z;                            /* n x wide */
  double *F, *Y;                        /* s x n, by stages: callbacks write and read them */
  const double *M;                      /* n x n by rows; NULL: identity */
  bool whole;                           /* filter keeps stiff components: by the real part */
  bool bare; /* F holds whole residuals F - M Z'/h: nothing of omega is taken off them */
} stf_lanes;

/* Lanes of an eigen split (no coupling) for n components; claimed from the pool. */
int stf_lanes_open(stf_pool *pool, const stf_split *split, int n, const double *M,
                   stf_lanes *L);

/* Order the unknowns for J when its pattern has entries not seen before (thin.c). */
void stf_lanes_look(stf_lanes *L, const double *J);

/* LU of all lanes; J n x n by columns. 0, or 1 + the column whose pivot vanished. */
int stf_lanes_factor(stf_lanes *L, const double *J, double h);
/* Z_j = sum_{k < count} a_k x_j^(k+1), omega = V^{-1} Z and Y = y + Z; a by components, `wide` each,
 * x of `wide` numbers. */
void stf_lanes_begin(stf_lanes *L, int count, const double *a, const double *x,
                     const double *y);
/* One Newton sweep from F: omega and Y are moved; returns sum_i weight_i^2 sum_k gain |d omega|^2. */
double stf_lanes_sweep(stf_lanes *L, const double *y, const double *weight, double h);
/* Z from omega. */
void stf_lanes_end(stf_lanes *L);
/* a_k = sum_j K[j][k] Z_j, by components. */
void stf_lanes_keep(stf_lanes *L, double (*K)[STF_WIDE], double *a);
/* x = (lambda_0 / h M - J)^{-1} x, by the real lane 0; of a pair the quadratic filter or, if `whole`,
 * the real part. */
void stf_lanes_filter(stf_lanes *L, double *x);

#endif
