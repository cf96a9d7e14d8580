/* solve_system.h: E x' = A x + f from files as a problem.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef SOLVE_SYSTEM_H
#define SOLVE_SYSTEM_H

#include "program.h"

/* What `work` returns for the system of all words but the last, which is the method: E.mtx A.mtx METHOD or
 * FILE.mat METHOD; an exit code after a sentence where it cannot be read. The words become file and
 * method. */
int solve_system(struct call *call, int (*work)(struct call *call, const steif_problem *p));

#endif
