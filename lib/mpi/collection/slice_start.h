/* slice_start.h: the start of a whole system, and its states later, the same on all ranks.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_MPI_SLICE_START_H
#define STEIF_MPI_SLICE_START_H

#include <stdbool.h>
#include <steif/extension.h>
#include <steif/linear.h>
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

/* slice_settle.c: what rank 0 keeps of a system of index 2. */
typedef struct slice_kept {
  steif_linear linear;
  steif_structure structure;
  bool found;
} slice_kept;

/* *settles: states of a system of this index can be settled: the structure of index 2 is certified. `one` as above. */
int slice_settle_open(steif_context *ctx, const steif_problem *whole, int index, N_Vector one,
                      slice_kept *k, bool *settles);
/* x (n, on rank 0), as it came at t, becomes the state from there on: x(t+) of x(t-). On all ranks. */
int slice_settle(steif_context *ctx, const steif_problem *whole, int index, sunrealtype t,
                 N_Vector one, slice_kept *k, sunrealtype *x);
void slice_settle_close(steif_context *ctx, slice_kept *k);

/* slice_start.c: more than what a count of MPI may be goes in parts. */
void slice_spread(void *data, size_t bytes, MPI_Comm comm);
/* The start of `whole` as one process finds it, into s->y and s->index; and its sentence. */
int slice_start_alone(steif_context *ctx, const steif_problem *whole, slice_start *s);

#endif
