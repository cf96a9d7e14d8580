/* staircase.h: the infinite part of a dense pencil, found by singular values or by the generalised
 * Schur form. E and F: n x n by columns. Each fills what it knows of *structure (zeroed by the
 * caller), and of *impulse when sources are given (their derivatives as the index asks).
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_STAIRCASE_H
#define STF_STAIRCASE_H

#include "separated_parts.h"

/* parts NULL: none is wanted. */
int stf_staircase(steif_context *ctx, int n, const sunrealtype *E, const sunrealtype *F,
                  const steif_analysis *analysis, const stf_sources *sources,
                  steif_structure *structure, steif_impulse *impulse,
                  const stf_separated *parts);
/* With exactly as many infinite eigenvalues split off. */
int stf_schur(steif_context *ctx, int n, const sunrealtype *E, const sunrealtype *F,
              int infinite, const stf_sources *sources, steif_structure *structure,
              steif_impulse *impulse);
/* Finite eigenvalues by Jensen's formula from LU decompositions, where none is between these sizes,
 * `inner` 0: there are none, `outer` INFINITY: no infinite one shows; NaN where a matrix is singular. */
int stf_jensen(stf_pool *pool, int n, const sunrealtype *E, const sunrealtype *F,
               sunrealtype inner, sunrealtype outer, sunrealtype *count);

#endif
