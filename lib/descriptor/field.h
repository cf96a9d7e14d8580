/* field.h: ranks of a pencil exactly as it is given.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_FIELD_H
#define STF_FIELD_H

#include "structure.h"

/* The rank over the integers modulo a prime near 2^31, in which doubles are what they are, m 2^e:
 * of s E + F at a random s (blocks = 0), or of blocks x blocks blocks with E on the diagonal and F
 * below it, whose kernel has the dimension w_1 + ... + w_blocks of the Weyr characteristic at
 * infinity. It never exceeds the true rank and falls short of it once in about 2^31 / n matrices.
 * E and F: dense or CSC, of order n; *rank -1: the factors would have grown out of all bounds. */
int stf_field_rank(steif_context *ctx, SUNMatrix E, SUNMatrix F, int blocks,
                   sunindextype *rank);

/* det(s E + F) = 0 for all s, with two primes: "true" is wrong once in about (2^31 / n)^2. */
int stf_field_singular(steif_context *ctx, SUNMatrix E, SUNMatrix F, bool *singular);

/* The unknowns and equations in up to 64 vectors of the kernels of s E + F and its transpose, of a
 * pencil that is singular: each of them depends on the others of its list. E and F: CSC. */
int stf_field_offenders(steif_context *ctx, SUNMatrix E, SUNMatrix F,
                        steif_structure *structure);

#endif
