/* refined_factor.h: factors of s E + B and of the system Jacobian, with refined solutions.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_REFINED_FACTOR_H
#define STF_REFINED_FACTOR_H

#include "lost_digits.h"

/* LU of a sparse matrix on the pattern of a view, both directions, with refinement. */
typedef struct stf_factor stf_factor;
int stf_factor_open(stf_point *point, const stf_view *view, stf_factor **factor);
void stf_factor_free(stf_factor **factor);
/* P = s E + B, or with offsets c and d the system Jacobian, equilibrated. STEIF_SINGULAR
 * is usual. */
int stf_factor_shift(stf_factor *f, const stf_view *view, sunrealtype s);
int stf_factor_jacobian(stf_factor *f, const stf_view *view, const int *c, const int *d);
/* The part of solutions of (s E + B) x = b, equilibrated, that is lost to rounding, by lost_digits.h, with factors of it
 * alone, or of it with entries rounded at random; no other solves after that. work: 4 n. */
int stf_factor_lost(stf_factor *f, const stf_view *view, sunrealtype s, bool rounded,
                    sunrealtype *work, sunrealtype *part);
int stf_factor_solve(stf_factor *f, bool transposed, sunrealtype *x);
/* Reciprocal condition of the equilibrated matrix in the 1-norm (W. W. Hager 1984). */
int stf_factor_rcond(stf_factor *f, sunrealtype *rcond);

#endif
