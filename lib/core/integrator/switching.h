/* switching.h: `auto` on y' = f(t, y) keeps two methods open, an implicit and an explicit one, and changes
 * to the other when that gets to the end at less cost.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_RIVAL_H
#define STF_RIVAL_H

#include "integrator.h"

/* What parts of a step cost, in one unit. */
typedef struct stf_cost {
  double entries; /* of the Jacobian */
  double f, jacobian, factor, solve;
  double step, explicit_step; /* a usual step of the implicit method, one of the explicit one */
} stf_cost;

/* For an opened implicit method and so many explicit stages. */
void stf_cost_of(const stf_step *s, int stages, stf_cost *p);

#endif
