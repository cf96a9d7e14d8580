/* prime_field.h: ranks of a pencil exactly as it is given, modulo random primes near 2^62. For any
 * prime the rank never exceeds the true one: full rank of s E + F at one s proves a pencil regular. It
 * falls short of it only if the prime divides a certain minor that is not 0, a whole number of `bits`
 * bits at most by Hadamard's inequality, when entries m 2^e are scaled to whole numbers: of bits / 61
 * primes at most out of 5e16.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_PRIME_FIELD_H
#define STF_PRIME_FIELD_H

#include "base.h"
#include <stdint.h>
#include <sundials/sundials_matrix.h>

enum { STF_FIELD_PRIMES = 2 };

/* A pencil and the primes it is looked at by. The primes are drawn after the entries are known, so that
 * no pencil is made for them. */
typedef struct stf_field {
  SUNMatrix E, F; /* dense or CSC, of order n */
  bool
    snap; /* a diagonal entry within STF_SNAP_ULPS of the negative sum of its row is that sum exactly */
  uint64_t prime[STF_FIELD_PRIMES], point[STF_FIELD_PRIMES]; /* of s, random */
  sunrealtype bits;                                          /* of the rows of [E F] in all */
} stf_field;

enum { STF_SNAP_ULPS = 4 };

int stf_field_open(steif_context *ctx, SUNMatrix E, SUNMatrix F, bool snap, stf_field *field);

/* The rank modulo prime number `which` of s E + F at a random s (blocks = 0), or of blocks x blocks
 * blocks with E on the diagonal and F below it, whose kernel has the dimension w_1 + ... + w_blocks of
 * the Weyr characteristic at infinity. *rank -1: the factors would have had 64 times as many entries as
 * the matrix. */
int stf_field_rank(steif_context *ctx, const stf_field *field, int blocks, int which,
                   sunindextype *rank);

/* det(s E + F) = 0 for all s: "false" is proven, "true" is wrong with stf_field_doubt(field, 0). */
int stf_field_singular(steif_context *ctx, const stf_field *field, bool *singular);

/* The Weyr characteristic at infinity of a regular pencil, *count <= most numbers, by all primes; the
 * number of infinite eigenvalues is their sum. *count -1: not computed, or longer than `most`. */
int stf_field_chains(steif_context *ctx, const stf_field *field, int most, sunindextype *weyr,
                     int *count);

/* A bound of the probability that the ranks of so many blocks are wrong, all primes being unlucky. */
sunrealtype stf_field_doubt(const stf_field *field, int blocks);

/* Of a singular pencil: in_kernel[j] = 1 (n flags, 0 before) for the columns with a part in up to 64
 * vectors of the kernel of s E + F, each of which depends on the others. */
int stf_field_kernel(steif_context *ctx, const stf_field *field, unsigned char *in_kernel);

/* Diagonal entries of M within STF_SNAP_ULPS of the negative sum of their row, but not equal to it:
 * flags of n rows. */
int stf_field_rounded_rows(steif_context *ctx, SUNMatrix M, unsigned char *rounded);

#endif
