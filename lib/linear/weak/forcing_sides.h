/* forcing_sides.h: f with breaks, taken from the side that a step sees: within a step that ends at a break
 * its end is a limit from the left, and the next step begins with the limit from the right.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_FORCING_SIDES_H
#define STF_FORCING_SIDES_H

#include <steif/problem.h>
#include <stddef.h>

typedef struct stf_sides {
  steif_forcing f;
  void *user;
  size_t count;
  const sunrealtype *breaks;  /* ascending */
  sunrealtype from, to, near; /* the step, and what counts as its ends; to <= from: no step */
} stf_sides;

#define STF_STEP_END 1e-6 /* near, for runs that add up their steps */

/* A forcing with a stf_sides as user data. */
int stf_sides_force(sunrealtype t, int derivative, N_Vector g, void *sides);
/* The step [from, to] is being made, times within `near` of it of an end are that end; from = to: none,
 * and limits are from the right. */
void stf_sides_step(stf_sides *sides, sunrealtype from, sunrealtype to, sunrealtype near);

#endif
