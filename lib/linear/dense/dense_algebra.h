/* dense_algebra.h: products, singular values and resolvents of dense matrices, by columns.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_DENSE_ALGEBRA_H
#define STF_DENSE_ALGEBRA_H

#include "linear_system.h"
#include <stdint.h>

/* C = alpha op(A) op(B) + beta C, op 'N' or 'T', C m x n; nothing when m or n is 0. */
void stf_gemm(char opA, char opB, int m, int n, int k, sunrealtype alpha, const sunrealtype *A,
              int lda, const sunrealtype *B, int ldb, sunrealtype beta, sunrealtype *C,
              int ldc);
sunrealtype stf_frobenius(int m, int n, const sunrealtype *A, int lda);
sunrealtype stf_length(int n, const sunrealtype *x);
/* An n x n array; NULL with the message set when memory is short. */
sunrealtype *stf_pool_square(stf_pool *pool, int n);

/* Singular values and both bases of matrices up to n x n. */
typedef struct stf_svd {
  steif_context *ctx;
  int n, lwork;
  sunrealtype *block, *U, *VT, *sigma, *work; /* block is overwritten; leading dimension n */
  int *iwork;
} stf_svd;
int stf_svd_open(steif_context *ctx, stf_pool *pool, int n, stf_svd *svd);
/* Of the m x k matrix A; with vectors only for m = k. */
int stf_svd_find(stf_svd *svd, int m, int k, const sunrealtype *A, int lda, bool vectors);

/* Numbers in (-1, 1) from a seed. */
sunrealtype stf_draw(uint64_t *state);

/* Powers of 2 for rows and columns by the largest entries of w |E| and |F|, w = max |F| / max |E|:
 * all 1 when rows and columns are within 2^10 of each other already. work: 2 n. */
void stf_balance(int n, const sunrealtype *E, const sunrealtype *F, sunrealtype *row,
                 sunrealtype *column, sunrealtype *work);
/* The best reciprocal condition of the equilibrated s E + F over three random s. */
int stf_best_rcond(stf_pool *pool, int n, const sunrealtype *E, const sunrealtype *F,
                   unsigned seed, sunrealtype *rcond);
/* Allocate the list of the entries of x >= 0 that are at least a tenth of the largest. */
int stf_list_large(steif_context *ctx, int n, const sunrealtype *x, sunindextype *count,
                   sunindextype **list);
/* Equations and unknowns in the null vectors of s E + F of a singular pencil. work: 4 n. */
int stf_null_offenders(steif_context *ctx, stf_svd *svd, int n, const sunrealtype *E,
                       const sunrealtype *F, unsigned seed, sunrealtype *work,
                       steif_structure *structure);

#endif
