/* dense.h: what the dense analyses of a pencil share: products, factors, and the pencil split
 * into its infinite and its finite part. Arrays are column-major.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_DENSE_H
#define STF_DENSE_H

#include "structure.h"
#include <stdint.h>

/* C = alpha op(A) op(B) + beta C, op 'N' or 'T', C m x n; nothing when m or n is 0. */
void stf_gemm(char opA, char opB, int m, int n, int k, sunrealtype alpha, const sunrealtype *A,
              int lda, const sunrealtype *B, int ldb, sunrealtype beta, sunrealtype *C,
              int ldc);
sunrealtype stf_frobenius(int m, int n, const sunrealtype *A, int lda);
sunrealtype stf_length(int n, const sunrealtype *x);
/* A room x room array; NULL with the message set when memory is short. */
sunrealtype *stf_claim_square(stf_pool *pool, int n);

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

/* Powers of 2 for rows and columns of w |E| + |F|, w = max |F| / max |E|: all 1 when its rows
 * and columns are within 2^10 of each other already. room: n. */
void stf_balance(int n, const sunrealtype *E, const sunrealtype *F, sunrealtype *row,
                 sunrealtype *column, sunrealtype *room);
/* s of the three samples where the resolvent is looked at. */
enum { STF_SAMPLES = 3 };
void stf_samples(int n, const sunrealtype *E, const sunrealtype *F, unsigned seed,
                 sunrealtype *s);
/* The best reciprocal condition of the equilibrated s E + F over the samples. */
int stf_best_rcond(stf_pool *pool, int n, const sunrealtype *E, const sunrealtype *F,
                   unsigned seed, sunrealtype *rcond);
/* Claim the list of the entries of x >= 0 that are at least a tenth of the largest. */
int stf_list_large(steif_context *ctx, int n, const sunrealtype *x, sunindextype *count,
                   sunindextype **list);
/* Equations and unknowns in the null vectors of s E + F of a singular pencil. room: 3 n. */
int stf_null_offenders(steif_context *ctx, stf_svd *svd, int n, const sunrealtype *E,
                       const sunrealtype *F, unsigned seed, sunrealtype *room,
                       steif_structure *structure);

/* P^T (s E + F) Q = s [E_inf E_12; 0 E_f] + [F_inf F_12; 0 F_f], P and Q orthogonal, the m
 * infinite eigenvalues first, and its decoupling
 *   [I L; 0 I] P^T (s E + F) Q [I R; 0 I] = s diag(E_inf, E_f) + diag(F_inf, F_f). */
enum { STF_SPLIT_VECTORS = 4 };
typedef struct stf_split {
  steif_context *ctx;
  int n, m;
  sunrealtype *E, *F, *P, *Q;
  sunrealtype *R, *L;             /* m x (n - m) */
  sunrealtype *N;                 /* F_inf^{-1} E_inf, m x m, nilpotent */
  sunrealtype *infinite, *finite; /* factors of F_inf and E_f */
  int *infinite_pivot, *finite_pivot;
  sunrealtype *vector[STF_SPLIT_VECTORS];
} stf_split;

int stf_split_open(steif_context *ctx, stf_pool *pool, int n, stf_split *split);
/* Claim and fill N and the factors once m is known, and claim R and L; STEIF_RETRY without a
 * message when F_inf or E_f is singular. */
int stf_split_factor(stf_pool *pool, stf_split *split);
/* B = A[i .. i+rows, j .. j+columns) of an n x n array, packed. */
void stf_split_block(const stf_split *split, const sunrealtype *A, int i, int j, int rows,
                     int columns, sunrealtype *B);
/* B = F_inf^{-1} B, packed columns of m; B = E_f^{-1} B or E_f^{-T} B, columns of n - m. */
void stf_split_infinite(const stf_split *split, int columns, sunrealtype *B);
void stf_split_finite(const stf_split *split, char op, int columns, sunrealtype *B);
/* x(0+) and c_i of index k from R, L and N. */
int stf_split_impulse(const stf_split *split, int k, const stf_sources *sources,
                      steif_impulse *impulse);
/* The slow projector Q [0 R; 0 I] Q^T; w = sum_j (-N)^j F_inf^{-1} [I L] P^T f^(j) above E_f v' +
 * F_f v = P_f^T f, in the unknowns x; the same in z = (w, v). */
int stf_split_give(stf_pool *pool, const stf_split *split, const stf_pieces *parts);
/* ||F_inf^{-1} [I L] P^T||, by which changes of equations enter N. */
int stf_split_rows(stf_pool *pool, const stf_split *split, sunrealtype *norm);
/* Finite eigenvalues by Jensen's formula from LU decompositions, where none is between these sizes,
 * `inner` 0: there are none, `outer` INFINITY: no infinite one shows; NaN where a matrix is singular. */
int stf_jensen(stf_pool *pool, int n, const sunrealtype *E, const sunrealtype *F,
               sunrealtype inner, sunrealtype outer, sunrealtype *count);
/* Equations and unknowns that carry the leading Laurent coefficient Phi_{k-1}. */
int stf_split_offenders(stf_pool *pool, stf_split *split, int k, steif_structure *structure);

#endif
