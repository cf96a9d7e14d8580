/* singular_pencils.c: pencils one of whose equations is twice another one, so that they are singular at every c, exactly;
 * their entries fill up the mantissa, so that rounding hides it from the pivots.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "checks.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sunmatrix/sunmatrix_sparse.h>

enum { LARGEST = 64, SEEDS = 60 };

typedef struct pencil {
  double E[LARGEST][LARGEST], A[LARGEST][LARGEST];
  sunindextype n, first, rows;
} pencil;

static double draw(unsigned *seed)
{
  *seed = *seed * 1664525u + 1013904223u;
  return (double)*seed / 2147483648.0 - 1;
}

/* Some three entries a row, and a place of its own in each column. */
static void make(pencil *s, unsigned seed, int twice)
{
  memset(s, 0, sizeof *s);
  s->n = 8 + (sunindextype)((draw(&seed) + 1) * 28);
  for (sunindextype i = 0; i < s->n; i++) {
    for (int k = 0; k < 3; k++) {
      const sunindextype j = (sunindextype)((draw(&seed) + 1) / 2 * (double)s->n) % s->n;
      s->A[i][j] = draw(&seed);
      if (k < 2) s->E[i][(j * 5 + 1) % s->n] = draw(&seed);
    }
    s->A[i][(i + 5) % s->n] += 1.25;
  }
  for (sunindextype j = 0; twice && j < s->n; j++)
    s->E[2][j] = 2 * s->E[1][j], s->A[2][j] = 2 * s->A[1][j];
  s->first = s->n * rank / ranks, s->rows = s->n * (rank + 1) / ranks - s->first;
}

static int fill(const pencil *s, const double (*of)[LARGEST], SUNMatrix M)
{
  sunindextype *at = SM_INDEXPTRS_S(M), used = 0;
  for (sunindextype i = 0; i < s->rows; i++) {
    at[i] = used;
    for (sunindextype j = 0; j < s->n; j++)
      if (of[s->first + i][j] != 0)
        SM_INDEXVALS_S(M)[used] = j, SM_DATA_S(M)[used++] = of[s->first + i][j];
  }
  at[s->rows] = used;
  return 0;
}

static int fill_E(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  (void)t, (void)y, (void)yp;
  return fill(user, (const double(*)[LARGEST])((pencil *)user)->E, E);
}

static int fill_A(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix A, void *user)
{
  (void)t, (void)y, (void)yp;
  return fill(user, (const double(*)[LARGEST])((pencil *)user)->A, A);
}

static int force(sunrealtype t, int derivative, N_Vector out, void *user)
{
  (void)t, (void)user;
  N_VConst(derivative ? 0 : 1, out);
  return 0;
}

/* The code of a solve at c, or with `method` of a run; -1: nothing was opened. */
static int outcome(pencil *s, double re, double im, const char *method)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_options o = steif_defaults();
  N_Vector like = o.like = steif_mpi_vector(ctx, MPI_COMM_WORLD, s->rows);
  N_Vector b[] = {N_VClone(like), N_VClone(like)};
  sunrealtype *start = calloc((size_t)s->rows + 1, sizeof *start);
  const steif_problem p = {.name = "twice",
                           .n = s->n,
                           .t1 = 1,
                           .y0 = start,
                           .E = fill_E,
                           .A = fill_A,
                           .g = force,
                           .dae_index = 1,
                           .storage = STEIF_SPARSE,
                           .nnz = LARGEST * s->rows,
                           .nnz_E = LARGEST * s->rows,
                           .linear = 1,
                           .user = s};
  steif_mpi *m = steif_mpi_open(ctx, &p, "mumps", like);
  N_VConst(1, b[0]), N_VConst(0, b[1]);
  int code = -1;
  if (m && !method) code = steif_mpi_solve(m, 0, like, like, re, im, 0, 1, b, b);
  steif_solver *r =
    m && method ? steif_solver_new(ctx, steif_mpi_problem(m), method, &o) : NULL;
  if (m && method) code = r ? steif_solve_to(r, 1) : steif_status(ctx);
  ALL(same(ctx));
  steif_solver_free(&r);
  steif_mpi_free(&m);
  N_VDestroy(b[0]), N_VDestroy(b[1]), N_VDestroy(like);
  steif_context_free(&ctx);
  free(start);
  return code;
}

void test_singular_pencils(void)
{
  static pencil s;
  for (unsigned seed = 1; seed <= SEEDS; seed++) {
    make(&s, seed, 1);
    ALL(outcome(&s, 0.75, seed % 2 ? 1.3 : 0, NULL) == STEIF_SINGULAR);
    make(&s, seed, 0);
    ALL(outcome(&s, 0.75, seed % 2 ? 1.3 : 0, NULL) == STEIF_OK);
  }
  for (unsigned seed = 1; seed <= 6; seed++) {
    make(&s, seed, 1);
    ALL(outcome(&s, 0, 0, "bdf") == STEIF_SINGULAR);
    ALL(outcome(&s, 0, 0, "radau:s=3") == STEIF_SINGULAR);
  }
}
