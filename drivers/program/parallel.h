/* parallel.h: --parallel: the program steif-mpi does the work; this one is not linked to MPI.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef PARALLEL_H
#define PARALLEL_H

#include "program.h"

/* Is --parallel among the words? */
bool parallel_asked(int argc, char **argv);
/* Become steif-mpi, which stands beside this program, with the same words; returns only when it cannot: an exit
 * code. */
int parallel_become(struct call *call, char **argv);

#endif
