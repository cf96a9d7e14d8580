/* slice_start.h: the start of a whole system, the same on all ranks.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_MPI_SLICE_START_H
#define STEIF_MPI_SLICE_START_H

#include <steif/extension.h>
#include <steif/mpi.h>

typedef struct slice_start {
  sunrealtype *y; /* n */
  int *index, most;
  char message[1200];
} slice_start;

/* `one`: a vector over the ranks, to agree by. */
int slice_start_find(steif_context *ctx, const steif_problem *whole, N_Vector one,
                     slice_start *s);
void slice_start_clear(steif_context *ctx, slice_start *s);

#endif
