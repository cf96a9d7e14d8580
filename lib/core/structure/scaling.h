/* scaling.h: powers of 2 by which the rows and columns of matrices are multiplied, so that scaling
 * rounds nothing: by the largest entries, or by the logarithms of all entries.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_SCALING_H
#define STF_SCALING_H

#include "base.h"
#include <sundials/sundials_matrix.h>

/* -- by the largest entries: what large entries hide is rounding --------------------------------- */

/* factor |M|, M by columns: CSC, or with ptr NULL all n x n values. */
typedef struct stf_summand {
  const sunindextype *ptr, *row;
  const sunrealtype *value;
  sunrealtype factor;
} stf_summand;

typedef struct stf_scales {
  sunindextype n;
  sunrealtype *row, *column; /* n each, the caller's: filled with the scales */
  sunrealtype *largest;      /* 2 n, the caller's: largest entries of rows, then of columns */
  sunrealtype even;          /* where rows and columns are no further apart all scales are 1 */
  sunrealtype bits;          /* log2 of the product of all scales */
  bool empty;                /* a row or a column has no entry */
} stf_scales;

/* The largest entries of all rows and columns of the matrices, as scaled, come near to 1. */
void stf_scaling_largest(stf_scales *s, int count, const stf_summand *summand);

/* -- by all entries: units of equations and unknowns cancel --------------------------------------- */

enum stf_evenness {
  STF_EVEN_AS_GIVEN, /* entries are not far apart, exponents are 0 */
  STF_UNEVEN,        /* small entries remain beside large ones */
  STF_EVEN           /* all entries come near to one size */
};

/* Are entries of E, or of F, further apart than 2^40? */
bool stf_scaling_needed(SUNMatrix E, SUNMatrix F);
/* Exponents of 2 for n rows and, after them, n columns that bring the entries of E near to one size
 * and those of F near to one, where that is needed; near is within 2^26. E and F: dense or CSC, of
 * one order. */
int stf_scaling_logarithmic(steif_context *ctx, SUNMatrix E, SUNMatrix F, int *exponent,
                            enum stf_evenness *even);

#endif
