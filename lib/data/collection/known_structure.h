/* known_structure.h: structure and start of the generated descriptor systems E x' + F x = f, known by closed
 * formulas.
 *
 * From x(0-) = problem->y0 the solution is x_smooth + sum_{i=0}^{k-2} c_i delta^(i). The formulas
 * ask for nothing but the blocks of the system and, where there are constraints, for solves with
 * a symmetric positive definite S = G W G^T, so that they can judge algorithms that know no more
 * than E, F and f.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_EXACT_H
#define STF_EXACT_H

#include "base.h"
#include <steif/problem.h>

typedef struct stf_exact_start {
  int index;           /* k of the pencil */
  sunindextype finite; /* eigenvalues */
  sunrealtype *x_plus; /* n: x(0+) */
  sunrealtype *c;      /* (k - 1) x n by rows: c_0, c_1, ...; NULL for k <= 1 */
} stf_exact_start;

/* STEIF_UNSUPPORTED for problems that do not know their start. Clear after use; on failure there
 * is nothing to clear. */
int stf_exact_start_find(steif_context *ctx, const steif_problem *problem,
                         stf_exact_start *out);
void stf_exact_start_clear(steif_context *ctx, stf_exact_start *out);

#endif
