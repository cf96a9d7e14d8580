/* separated_parts.h: what the separation of a pencil into its infinite and its finite part gives.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_SEPARATED_PARTS_H
#define STF_SEPARATED_PARTS_H

#include "linear_system.h"

/* A system of index 1 with the smooth solutions of a given one, E x' + F x = sum_j G_j f^(j): the
 * first rows of E are 0, the others have full rank. n x n by columns each. */
typedef struct stf_reduction {
  int terms;              /* of the sum: the index, or 0 */
  int algebraic;          /* out: how many rows of E are 0 */
  sunrealtype *E, *F, *G; /* G: terms of them */
} stf_reduction;

/* The system in coordinates z in which its infinite and finite part are decoupled, diag(N, E_f) z' +
 * diag(I, F_f) z = G f with N strictly upper triangular: z = to x, x = back z. All n x n. */
typedef struct stf_decoupling {
  sunrealtype *E, *F, *G, *to, *back;
} stf_decoupling;

/* What is NULL is not wanted. */
typedef struct stf_separated {
  sunrealtype *slow; /* projector, n x n */
  stf_reduction *reduction;
  const stf_decoupling *decoupling;
} stf_separated;

/* Of a pencil dense or CSC, checked already; STEIF_NOT_CERTIFIED where the index is undecided. */
int stf_dense_parts(steif_context *ctx, SUNMatrix E, SUNMatrix F,
                    const steif_analysis *analysis, const stf_separated *parts);

#endif
