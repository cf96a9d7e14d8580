/* fit.h: scales of rows and columns of a pencil by the sizes of all its entries.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_FIT_H
#define STF_FIT_H

#include "structure.h"

enum stf_fitted {
  STF_FIT_NONE, /* no need: entries are not far apart, exponents are 0 */
  STF_FIT_SOME, /* small entries remain beside large ones */
  STF_FIT_ALL   /* all entries come near to one size */
};

/* Are entries of E, or of F, further apart than 2^40? */
bool stf_fit_needed(SUNMatrix E, SUNMatrix F);
/* Exponents of 2 for n rows and, behind them, n columns that bring the entries of E near to one size
 * and those of F near to one, where that is needed; near is within 2^26. E and F: dense or CSC, of
 * one order. */
int stf_fit(steif_context *ctx, SUNMatrix E, SUNMatrix F, int *exponent,
            enum stf_fitted *fitted);

#endif
