/* cluster.h: the eigenvalues of a real matrix in clusters, each with its invariant subspace:
 * A = X diag(T_1 .. T_m) X^{-1}, T_k upper triangular.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_CLUSTER_H
#define STF_CLUSTER_H

#include "base.h"
#include <complex.h>

typedef double complex stf_number;

typedef struct stf_cluster {
  int first, size;
  stf_number mean;
  double spread; /* of the eigenvalues about their mean */
  double radius; /* uncertainty of the mean and of the block: tolerance ||A|| ||Pi|| */
} stf_cluster;

typedef struct stf_spectrum {
  steif_context *ctx;
  int n, count; /* order of A; clusters */
  double norm, tolerance;
  stf_number *T, *X, *Y; /* n x n by columns; Y = X^{-1} */
  stf_cluster *cluster;
  void *memory;
} stf_spectrum;

/* Balances; clusters grow until each mean is certain enough to tell it from the others. */
int stf_spectrum_open(stf_spectrum *s, steif_context *ctx, int n, const double *A,
                      double tolerance);
void stf_spectrum_close(stf_spectrum *s);
/* N = T_k - mean, size x size. */
void stf_spectrum_block(const stf_spectrum *s, int k, stf_number *N);

/* Sizes of Jordan blocks of a nilpotent N, m x m: weyr[p] = dim ker N^(p+1) - dim ker N^p, m numbers,
 * ending with 0; singular values below `radius` count as 0. *sure = false where one is not above
 * STEIF_DOUBT radius, or N is not nilpotent. */
int stf_weyr(steif_context *ctx, int m, const stf_number *N, double radius, int *weyr,
             bool *sure);

/* The `count` right singular vectors of A, m x m, that belong to the least singular values: columns
 * of V, m x count. A is overwritten. */
int stf_null_vectors(steif_context *ctx, int m, stf_number *A, int count, stf_number *V);

/* C = alpha op(A) op(B), n x n. */
void stf_times(int n, const char *op_A, const stf_number *A, const char *op_B,
               const stf_number *B, stf_number *C);

#endif
