/* eigenvalues_of.h: the finite eigenvalues that a call asks for.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef EIGENVALUES_OF_H
#define EIGENVALUES_OF_H

#include "answers.h"
#include "descriptor.h"

/* --near as a point, 0 where it is not given; an exit code. */
int read_near(const struct call *call, double near[2]);
/* All of dense and small pencils, of others those that are asked for; an exit code. */
int eigenvalues_of(struct call *call, const struct descriptor *l, struct structure_answer *a);

#endif
