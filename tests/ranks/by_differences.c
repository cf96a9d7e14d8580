/* by_differences.c: A and E by differences in a pattern of own rows, against rows that callbacks fill.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "checks.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sunmatrix/sunmatrix_sparse.h>

/* A problem of the collection over ranks without its A; F is y' - f where asked for. */
typedef struct bare {
  steif_problem *whole, p;
  N_Vector like;
  sunindextype *at, *column;
  steif_pattern pattern;
  int alone, calls;
} bare;

static int f(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  bare *b = user;
  const int code = b->whole->f(t, y, out, b->whole->user);
  return ++b->calls > 3 && rank == b->alone ? -1 : code;
}

static int F(sunrealtype t, N_Vector y, N_Vector yp, N_Vector out, void *user)
{
  bare *b = user;
  const int code = b->whole->f(t, y, out, b->whole->user);
  N_VLinearSum(2, yp, -1, out, out); /* E = 2 I */
  return code;
}

static int by_number(const void *a, const void *b)
{
  const sunindextype x = *(const sunindextype *)a, y = *(const sunindextype *)b;
  return (x > y) - (x < y);
}

/* The pattern is that of the rows which A fills; `lost` leaves out the last entry of this rank. */
static int open_bare(bare *b, steif_context *ctx, const char *name, int implicit, int lost)
{
  *b = (bare){.alone = -1};
  b->whole = steif_mpi_problem_new(ctx, name, MPI_COMM_WORLD, &b->like);
  if (!ALL(b->whole != NULL)) return 0;
  const sunindextype rows = NV_LOCLENGTH_P(b->like), room = b->whole->nnz;
  SUNMatrix M = SUNSparseMatrix(rows + 1, b->whole->n, room + 1, CSR_MAT, steif_sundials(ctx));
  b->whole->A(0, b->like, b->like, M, b->whole->user);
  b->at = calloc((size_t)rows + 1, sizeof *b->at);
  b->column = calloc((size_t)room + 1, sizeof *b->column);
  memcpy(b->at, SM_INDEXPTRS_S(M), ((size_t)rows + 1) * sizeof *b->at);
  memcpy(b->column, SM_INDEXVALS_S(M), (size_t)b->at[rows] * sizeof *b->column);
  SUNMatDestroy(M);
  for (sunindextype i = 0; i < rows; i++)
    qsort(b->column + b->at[i], (size_t)(b->at[i + 1] - b->at[i]), sizeof *b->column,
          by_number);
  if (lost && rows) b->at[rows]--;
  b->pattern = (steif_pattern){b->at, b->column};
  b->p = *b->whole;
  b->p.A = NULL, b->p.nnz = 0, b->p.pattern = &b->pattern, b->p.user = b;
  b->p.f = implicit ? NULL : f, b->p.F = implicit ? F : NULL, b->p.exact = NULL;
  return 1;
}

static void close_bare(bare *b, steif_context *ctx)
{
  steif_mpi_problem_free(ctx, &b->whole, &b->like);
  free(b->at), free(b->column);
}

/* Solutions with c E - A made both ways, at a y that is not the start; colours: those that the rule gives in one
 * process, for any number of ranks. */
static void same_matrix(const char *name, int implicit, int colours, sunrealtype tolerance)
{
  bare b;
  steif_context *ctx = steif_context_new(NULL);
  if (open_bare(&b, ctx, name, implicit, 0)) {
    N_Vector y = N_VClone(b.like), v = N_VClone(b.like), w = N_VClone(b.like);
    N_Vector x = N_VClone(b.like);
    memcpy(N_VGetArrayPointer(y), b.p.y0, (size_t)NV_LOCLENGTH_P(y) * sizeof(sunrealtype));
    N_VAddConst(y, 0.5, y), N_VConst(1, x), N_VConst(0, w);
    steif_mpi *m = steif_mpi_open(ctx, &b.p, "mumps", b.like);
    steif_mpi *known = steif_mpi_open(ctx, b.whole, "mumps", b.like);
    const int done = m && known && !steif_mpi_solve(m, 0, y, w, 30, 0, 0, 1, &x, &v) &&
                     !steif_mpi_solve(known, 0, y, w, implicit ? 60 : 30, 0, 0, 1, &x, &w);
    if (ALL(done)) {
      const steif_mpi_stats stats = steif_mpi_statistics(m);
      const long sweeps = 1 + (implicit ? 2 : 1) * stats.colours,
                 extra = b.p.linear ? 1 + implicit : 0;
      N_VLinearSum(1, v, -1, w, v);
      const sunrealtype off = N_VMaxNorm(v), size = N_VMaxNorm(w);
      if (!ALL(off <= tolerance * size) && rank == 0)
        printf("  %s: off by %g of %g\n", name, off, size);
      if (!(ALL(stats.colours == colours) & ALL(stats.evaluations == sweeps + extra)) &&
          rank == 0)
        printf("  %s: %d colours, %ld evaluations\n", name, stats.colours, stats.evaluations);
    } else if (rank == 0)
      printf("  %s: %s\n", name, steif_message(ctx));
    steif_mpi_free(&m), steif_mpi_free(&known);
    N_VDestroy(y), N_VDestroy(v), N_VDestroy(w), N_VDestroy(x);
  }
  close_bare(&b, ctx);
  steif_context_free(&ctx);
}

static long steps_of(steif_context *ctx, const steif_problem *p, const char *spec,
                     const char *method, N_Vector like, N_Vector end)
{
  long steps = -1;
  steif_options o = steif_defaults();
  o.rtol = 1e-5, o.like = like;
  steif_mpi *m = steif_mpi_open(ctx, p, spec, like);
  steif_solver *s = m ? steif_solver_new(ctx, steif_mpi_problem(m), method, &o) : NULL;
  if (s && steif_solve_to(s, p->linear ? 0.01 : 0.1) == STEIF_OK) {
    steps = steif_statistics(s)->steps;
    N_VScale(1, steif_solution(s), end);
  } else if (rank == 0)
    printf("  %s: %s\n", method, steif_message(ctx));
  steif_solver_free(&s), steif_mpi_free(&m);
  return steps;
}

/* A user with f and a pattern gets what one with A gets: solutions within the tolerance. */
static void same_run(const char *name, const char *spec, const char *method)
{
  bare b;
  steif_context *ctx = steif_context_new(NULL);
  if (open_bare(&b, ctx, name, 0, 0)) {
    N_Vector one = N_VClone(b.like), two = N_VClone(b.like);
    const long given = steps_of(ctx, b.whole, spec, method, b.like, one),
               found = steps_of(ctx, &b.p, spec, method, b.like, two);
    N_VLinearSum(1, one, -1, two, two);
    if (!(ALL(given > 0 && labs(given - found) <= 1 + given / 20) &
          ALL(N_VMaxNorm(two) <= 1e-4)) &&
        rank == 0)
      printf("  %s %s %s: %ld and %ld steps\n", name, spec, method, given, found);
    N_VDestroy(one), N_VDestroy(two);
  }
  close_bare(&b, ctx);
  steif_context_free(&ctx);
}

/* The code, the same sentence on all ranks, and a word of it; nobody waits. */
static void refused(const char *what, const char *name, int expected, const char *word)
{
  bare b;
  steif_context *ctx = steif_context_new(NULL);
  const int last = rank == ranks - 1, lost = !strcmp(what, "lost") && last;
  if (open_bare(&b, ctx, name, 0, lost)) {
    N_Vector x = N_VClone(b.like);
    N_VConst(1, x);
    if (!strcmp(what, "fails")) b.alone = ranks - 1;
    if (!strcmp(what, "outside") && last) b.column[0] = b.p.n;
    if (!strcmp(what, "none")) b.p.pattern = NULL;
    if (!strcmp(what, "one has none") && last) b.p.pattern = NULL;
    steif_mpi *m = steif_mpi_open(ctx, &b.p, "mumps", b.like);
    const int code =
      m ? steif_mpi_solve(m, 0, b.like, b.like, 1, 0, 0, 1, &x, &x) : steif_status(ctx);
    if (!(ALL(code == expected) & ALL(strstr(steif_message(ctx), word) != NULL)) && rank == 0)
      printf("  %s %s: %d, %s\n", what, name, code, steif_message(ctx));
    ALL(same(ctx));
    steif_mpi_free(&m);
    N_VDestroy(x);
  }
  close_bare(&b, ctx);
  steif_context_free(&ctx);
}

void test_differences(void)
{
  same_matrix("heat2d:n=9", 0, 7, 1e-12);
  same_matrix("heat3d:n=6", 0, 10, 1e-12);
  same_matrix("heat2d:n=9", 1, 7, 1e-12);
  same_matrix("bruss2d:n=7", 0, 12, 1e-6);
  same_matrix("heat2d:n=2", 0, 4, 1e-12); /* ranks without rows */
  same_run("heat3d:n=6", "amg", "radau:s=3");
  same_run("bruss2d:n=6", "mumps", "bdf");
  same_run("bruss2d:n=6", "amg:functions=2", "rodas4");
  refused("fails", "heat2d:n=9", STEIF_CALLBACK, "returned -1 at t = 0 on rank");
  refused("fails", "bruss2d:n=6", STEIF_CALLBACK, "for differences");
  refused("outside", "heat2d:n=9", STEIF_BAD_INPUT, "must ascend");
  refused("lost", "heat2d:n=9", STEIF_BAD_INPUT, "pattern of problem 'heat2d' does not have");
  refused("none", "heat2d:n=9", STEIF_BAD_INPUT, "neither .A nor .pattern");
  refused("one has none", "heat2d:n=9", STEIF_BAD_INPUT,
          ranks > 1 ? "ranks disagree" : "neither .A nor .pattern");
}
