/* slice_start.h: the start of a whole system, and x(t+) after its breaks, the same on all ranks.
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

/* slice_break.c: what rank 0 keeps for the breaks of a system of index 2. */
typedef struct slice_break {
  steif_linear linear;
  steif_structure structure;
  bool found;
} slice_break;

/* x (n, the same on all ranks): x(t-), which becomes x(t+). `one` as above. */
int slice_break_pass(steif_context *ctx, const steif_problem *whole, int index, sunrealtype t,
                     N_Vector one, slice_break *b, sunrealtype *x);
void slice_break_clear(steif_context *ctx, slice_break *b);

/* slice_start.c: more than what a count of MPI may be goes in parts. */
void slice_spread(void *data, size_t bytes, MPI_Comm comm);
/* The start of `whole` as one process finds it, into s->y and s->index; and its sentence. */
int slice_start_alone(steif_context *ctx, const steif_problem *whole, slice_start *s);

#endif
