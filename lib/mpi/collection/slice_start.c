/* slice_start.c: the consistent start of a linear system and the index of its unknowns, as one process finds them: on rank
 * 0, for all.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "slice_start.h"
#include <limits.h>
#include <string.h>

/* Tolerance of the start. */
#define START_RTOL 1e-9

int slice_start_alone(steif_context *ctx, const steif_problem *whole, slice_start *s)
{
  steif_options o = steif_defaults();
  o.rtol = START_RTOL;
  steif_solver *solver = steif_solver_new(ctx, whole, "radau:s=3", &o);
  if (!solver) return steif_status(ctx);
  const steif_repair *found = steif_initial_used(solver);
  const sunrealtype *y = found->y ? found->y : whole->y0;
  for (sunindextype i = 0; i < whole->n; i++) {
    const int index = found->number ? found->number[i] : whole->index ? whole->index[i] : 1;
    if (y) s->y[i] = y[i];
    s->index[i] = index;
    if (index > s->most) s->most = index;
  }
  snprintf(s->message, sizeof s->message, "%s", found->message);
  steif_solver_free(&solver);
  return STEIF_OK;
}

void slice_spread(void *data, size_t bytes, MPI_Comm comm)
{
  char *at = data;
  for (size_t part; bytes; bytes -= part, at += part) {
    part = bytes < INT_MAX ? bytes : INT_MAX;
    MPI_Bcast(at, (int)part, MPI_BYTE, 0, comm);
  }
}

int slice_start_find(steif_context *ctx, const steif_problem *whole, N_Vector one,
                     slice_start *s)
{
  int rank;
  const size_t n = (size_t)whole->n;
  MPI_Comm comm = NV_COMM_P(one);
  MPI_Comm_rank(comm, &rank);
  *s = (slice_start){.most = 0};
  s->y = steif_allocate(ctx, n + 1, sizeof *s->y);
  s->index = steif_allocate(ctx, n + 1, sizeof *s->index);
  int code = steif_agree(ctx, one, s->y && s->index ? STEIF_OK : STEIF_NO_MEMORY);
  if (code) return code;
  code = steif_agree(ctx, one, rank == 0 ? slice_start_alone(ctx, whole, s) : STEIF_OK);
  if (code) return code;
  slice_spread(s->y, n * sizeof *s->y, comm),
    slice_spread(s->index, n * sizeof *s->index, comm);
  MPI_Bcast(&s->most, 1, MPI_INT, 0, comm);
  MPI_Bcast(s->message, sizeof s->message, MPI_CHAR, 0, comm);
  return STEIF_OK;
}

void slice_start_clear(steif_context *ctx, slice_start *s)
{
  steif_release(ctx, s->y), steif_release(ctx, s->index);
  s->y = NULL, s->index = NULL;
}
