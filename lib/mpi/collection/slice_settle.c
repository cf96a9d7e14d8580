/* slice_settle.c: states of a linear system whose unknowns follow from each other, as one process finds them: on rank 0,
 * for all.
 *
 * Of index 2 it is the jump by the pencil, which keeps the slow part of x(t-) and takes all else from f and f' at t: errors
 * of x(t-) are carried on and not differentiated. Up to index 1 it is a start: unknowns with a derivative stay where rows
 * of E are 0 or regular.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "slice_start.h"
#include <math.h>
#include <string.h>

/* Matrices and structure, once. */
static int prepare(steif_context *ctx, const steif_problem *whole, slice_kept *k)
{
  if (k->found) return STEIF_OK;
  int code = k->linear.E ? STEIF_OK : steif_linear_of(ctx, whole, &k->linear);
  if (!code) code = steif_structure_find(ctx, k->linear.E, k->linear.F, NULL, &k->structure);
  k->found = !code;
  return code;
}

int slice_settle_open(steif_context *ctx, const steif_problem *whole, int index, N_Vector one,
                      slice_kept *k, bool *settles)
{
  int rank, code = STEIF_OK;
  MPI_Comm_rank(NV_COMM_P(one), &rank);
  *settles = index < 2 && whole->break_count > 0;
  if (index != 2) return STEIF_OK;
  if (rank == 0) code = prepare(ctx, whole, k);
  if (code && code != STEIF_NO_MEMORY) steif_forget(ctx), code = STEIF_OK;
  code = steif_agree(ctx, one, code);
  int can = k->found && k->structure.certified && k->structure.index == index;
  MPI_Bcast(&can, 1, MPI_INT, 0, NV_COMM_P(one));
  *settles = can;
  return code;
}

static int jump(steif_context *ctx, const steif_problem *whole, sunrealtype t, slice_kept *k,
                sunrealtype *x)
{
  steif_impulse i = {0};
  const steif_linear *l = &k->linear;
  int code = steif_impulse_find(ctx, l->E, l->F, x, t, l->f, l->user, NULL, &k->structure, &i);
  if (!code && !i.certified)
    code = steif_fail(ctx, STEIF_NOT_CERTIFIED,
                      "unknowns of index 2 of '%s' are not certified at t = %.12g (%.300s): "
                      "solve it in one process",
                      whole->name, t, i.message);
  if (!code) memcpy(x, i.x_plus, (size_t)i.n * sizeof *x);
  steif_impulse_clear(ctx, &i);
  return code;
}

static int begin_anew(steif_context *ctx, const steif_problem *whole, sunrealtype t,
                      sunrealtype *x)
{
  const size_t n = (size_t)whole->n;
  steif_problem from = *whole;
  slice_start s = {.y = steif_allocate(ctx, n + 1, sizeof *s.y),
                   .index = steif_allocate(ctx, n + 1, sizeof *s.index)};
  from.t0 = t, from.t1 = t + fmax(1, fabs(t));
  from.y0 = x, from.yp0 = NULL, from.start = NULL;
  from.breaks = NULL, from.break_count = 0;
  const int code = s.y && s.index ? slice_start_alone(ctx, &from, &s) : STEIF_NO_MEMORY;
  if (!code) memcpy(x, s.y, n * sizeof *x);
  slice_start_clear(ctx, &s);
  return code;
}

int slice_settle(steif_context *ctx, const steif_problem *whole, int index, sunrealtype t,
                 N_Vector one, slice_kept *k, sunrealtype *x)
{
  int rank, code = STEIF_OK;
  MPI_Comm comm = NV_COMM_P(one);
  MPI_Comm_rank(comm, &rank);
  if (rank == 0) code = index > 1 ? jump(ctx, whole, t, k, x) : begin_anew(ctx, whole, t, x);
  code = steif_agree(ctx, one, code);
  if (!code) slice_spread(x, (size_t)whole->n * sizeof *x, comm);
  return code;
}

void slice_settle_close(steif_context *ctx, slice_kept *k)
{
  if (k->found) steif_structure_clear(ctx, &k->structure);
  if (k->linear.E) SUNMatDestroy(k->linear.E);
  if (k->linear.F) SUNMatDestroy(k->linear.F);
  *k = (slice_kept){.found = false};
}
