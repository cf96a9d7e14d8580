/* separation.h: a dense pencil separated into its infinite and its finite part.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_SEPARATION_H
#define STF_SEPARATION_H

#include "dense_algebra.h"
#include "separated_parts.h"

/* P^T (s E + F) Q = s [E_inf E_12; 0 E_f] + [F_inf F_12; 0 F_f], P and Q orthogonal, the m
 * infinite eigenvalues first, and its decoupling
 *   [I L; 0 I] P^T (s E + F) Q [I R; 0 I] = s diag(E_inf, E_f) + diag(F_inf, F_f). */
enum { STF_SEPARATION_VECTORS = 4 };
typedef struct stf_separation {
  steif_context *ctx;
  int n, m;
  sunrealtype *E, *F, *P, *Q;
  sunrealtype *R, *L;             /* m x (n - m) */
  sunrealtype *N;                 /* F_inf^{-1} E_inf, m x m, nilpotent */
  sunrealtype *infinite, *finite; /* factors of F_inf and E_f */
  int *infinite_pivot, *finite_pivot;
  sunrealtype *vector[STF_SEPARATION_VECTORS];
} stf_separation;

int stf_separation_open(steif_context *ctx, stf_pool *pool, int n, stf_separation *s);
/* Allocate and fill N and the factors once m is known, and allocate R and L; STEIF_RETRY without a
 * message when F_inf or E_f is singular. */
int stf_separation_factor(stf_pool *pool, stf_separation *s);
/* B = A[i .. i+rows, j .. j+columns) of an n x n array, packed. */
void stf_separation_block(const stf_separation *s, const sunrealtype *A, int i, int j, int rows,
                          int columns, sunrealtype *B);
/* B = F_inf^{-1} B, packed columns of m; B = E_f^{-1} B or E_f^{-T} B, columns of n - m. */
void stf_separation_infinite(const stf_separation *s, int columns, sunrealtype *B);
void stf_separation_finite(const stf_separation *s, char op, int columns, sunrealtype *B);
/* x(0+) and c_i of index k from R, L and N. */
int stf_separation_impulse(const stf_separation *s, int k, const stf_sources *sources,
                           steif_impulse *impulse);
/* The slow projector Q [0 R; 0 I] Q^T; w = sum_j (-N)^j F_inf^{-1} [I L] P^T f^(j) above E_f v' +
 * F_f v = P_f^T f, in the unknowns x; the same in z = (w, v). */
int stf_separation_give(stf_pool *pool, const stf_separation *s, const stf_separated *parts);
/* ||F_inf^{-1} [I L] P^T||, by which changes of equations enter N. */
int stf_separation_rows(stf_pool *pool, const stf_separation *s, sunrealtype *norm);
/* Equations and unknowns that carry the leading Laurent coefficient Phi_{k-1}. */
int stf_separation_offenders(stf_pool *pool, stf_separation *s, int k,
                             steif_structure *structure);

#endif
