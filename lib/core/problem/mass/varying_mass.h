/* varying_mass.h: matrices M of M y' = f(t, y) that vary with t or y.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_VARYING_MASS_H
#define STF_VARYING_MASS_H

#include "problem.h"

enum stf_variation {
  STF_CONSTANT = 0,
  STF_OF_TIME = 1,
  STF_OF_STATE = 2
}; /* of both: their sum */

/* STEIF_UNSUPPORTED, in the name of `who`, where E of the mass form, or E or A of the descriptor form, is
 * another one at other times up to t1 or other states than y, that of the start. */
int stf_constant_matrices(steif_context *ctx, const steif_problem *problem, int form,
                          sunrealtype t1, N_Vector y, const char *who);
/* On what it depends, for the mass form; the same look. */
int stf_mass_variation(steif_context *ctx, const steif_problem *problem, sunrealtype t1,
                       N_Vector y, int *variation);

/* M(t, y) y' = f(t, y) stated as F = M(t, y) y' - f(t, y) = 0 with the callbacks of `problem`, which must live as
 * long as the pool; y is the state at the start. The slopes at the start are added where M determines them. */
int stf_mass_lower(stf_pool *pool, steif_context *ctx, const steif_problem *problem,
                   int variation, N_Vector y, const steif_problem **lowered);
/* Another problem in its place, of the same size and storage: *problem becomes F = 0. */
void stf_mass_lower_again(const steif_problem *lowered, steif_problem *problem);
/* Is it such a problem, and do its equations determine y' in all components that M multiplies? Then it is
 * y' = z, 0 = F(t, y, z), of index 1. */
bool stf_mass_regular(const steif_problem *problem);

#endif
