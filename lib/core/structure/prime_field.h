/* prime_field.h: ranks of a pencil exactly as it is given.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_PRIME_FIELD_H
#define STF_PRIME_FIELD_H

#include "base.h"
#include <sundials/sundials_matrix.h>

/* The rank over the integers modulo a prime near 2^31, in which doubles are what they are, m 2^e:
 * of s E + F at a random s (blocks = 0), or of blocks x blocks blocks with E on the diagonal and F
 * below it, whose kernel has the dimension w_1 + ... + w_blocks of the Weyr characteristic at
 * infinity. It never exceeds the true rank and falls short of it once in about 2^31 / n matrices.
 * E and F: dense or CSC, of order n; *rank -1: the factors would have had 64 times as many entries
 * as the matrix. */
int stf_field_rank(steif_context *ctx, SUNMatrix E, SUNMatrix F, int blocks,
                   sunindextype *rank);

/* det(s E + F) = 0 for all s, with two primes: "true" is wrong once in about (2^31 / n)^2. */
int stf_field_singular(steif_context *ctx, SUNMatrix E, SUNMatrix F, bool *singular);

/* Of a singular pencil: in_kernel[j] = 1 (n flags, 0 before) for the columns with a part in up to 64
 * vectors of the kernel of s E + F, each of which depends on the others. */
int stf_field_kernel(steif_context *ctx, SUNMatrix E, SUNMatrix F, unsigned char *in_kernel);

#endif
