/* slice_break.c: x(t+) of a linear system after a break of f, as one process finds it: on rank 0, for all.
 *
 * Of index 2 it is the jump by the pencil, which keeps the slow part of x(t-) and takes all else from f and f' after the
 * break: errors of x(t-) are carried on and not differentiated. Up to index 1 it is a start: unknowns with a derivative
 * stay where rows of E are 0 or regular.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "slice_start.h"
#include <math.h>
#include <string.h>

/* Matrices and structure, once. */
static int prepare(steif_context *ctx, const steif_problem *whole, slice_break *b)
{
  if (b->found) return STEIF_OK;
  int code = b->linear.E ? STEIF_OK : steif_linear_of(ctx, whole, &b->linear);
  if (!code) code = steif_structure_find(ctx, b->linear.E, b->linear.F, NULL, &b->structure);
  b->found = !code;
  return code;
}

static int jump(steif_context *ctx, const steif_problem *whole, sunrealtype t, slice_break *b,
                sunrealtype *x)
{
  steif_impulse i = {0};
  int code = prepare(ctx, whole, b);
  if (code) return code;
  const steif_linear *l = &b->linear;
  code = steif_impulse_find(ctx, l->E, l->F, x, t, l->f, l->user, NULL, &b->structure, &i);
  if (!code && !i.certified)
    code = steif_fail(ctx, STEIF_NOT_CERTIFIED,
                      "the jump of '%s' at its break t = %.12g is not certified (%.300s), and "
                      "unknowns of index 2 have no other value there: solve it in one process",
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

int slice_break_pass(steif_context *ctx, const steif_problem *whole, int index, sunrealtype t,
                     N_Vector one, slice_break *b, sunrealtype *x)
{
  int rank, code = STEIF_OK;
  MPI_Comm comm = NV_COMM_P(one);
  MPI_Comm_rank(comm, &rank);
  if (rank == 0)
    code = index > 1 ? jump(ctx, whole, t, b, x) : begin_anew(ctx, whole, t, x);
  code = steif_agree(ctx, one, code);
  if (!code) slice_spread(x, (size_t)whole->n * sizeof *x, comm);
  return code;
}

void slice_break_clear(steif_context *ctx, slice_break *b)
{
  if (b->found) steif_structure_clear(ctx, &b->structure);
  if (b->linear.E) SUNMatDestroy(b->linear.E);
  if (b->linear.F) SUNMatDestroy(b->linear.F);
  *b = (slice_break){.found = false};
}
