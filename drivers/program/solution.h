/* solution.h: what one integration shows: the solution, digits, costs, events.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef SOLUTION_H
#define SOLUTION_H

#include "integration.h"
#include "trajectory.h"

/* The last word: PROBLEM METHOD, or E.mtx A.mtx METHOD. */
const char *solution_method(const struct call *call);

/* On stdout and in the files asked for; a failed run is shown up to where it came. The exit code of
 * the run, or of what could not be written. s may be NULL. */
int solution_present(struct call *call, const outcome *o, steif_solver *s, trajectory *tr);

#endif
