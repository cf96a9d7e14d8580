/* hard_systems.c: solves over ranks where pivots must be sought, where units differ by hundreds of orders of magnitude, of
 * singular matrices of small whole numbers, and with numbers that are none; by differences beside large forces.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "checks.h"
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sunmatrix/sunmatrix_sparse.h>

enum { N = 14 };
enum { PLAIN, ROWS, COLUMNS, BOTH, KINDS };

/* A = -M, so that the matrix at c = 0 is M, known to all ranks. */
typedef struct whole {
  double m[N][N];
  sunindextype rows, first;
} whole;

static unsigned draw(unsigned *seed) { return *seed = *seed * 1664525u + 1013904223u; }

/* Whole numbers from -4 to 4, a quarter of the places, and 7 in one place of each row and column off the diagonal. */
static void numbers(whole *w, unsigned seed)
{
  memset(w->m, 0, sizeof w->m);
  for (int i = 0; i < N; i++)
    for (int j = 0; j < N; j++)
      if (i != j && draw(&seed) >> 30 == 0) w->m[i][j] = (int)(draw(&seed) >> 24) % 9 - 4;
  for (int i = 0; i < N; i++) w->m[i][(i + 5) % N] = 7;
  w->first = N * rank / ranks, w->rows = N * (rank + 1) / ranks - w->first;
}

/* Powers of two, which round nothing. */
static int exponent(int i, int kind, int of)
{
  const int size = kind == of ? 400 : kind == BOTH ? 150 : 0;
  return (i * 37) % 11 * size / 5 - size;
}

static int fill(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix A, void *user)
{
  const whole *w = user;
  sunindextype *at = SM_INDEXPTRS_S(A), used = 0;
  (void)t, (void)y, (void)yp;
  for (sunindextype i = 0; i < w->rows; i++) {
    at[i] = used;
    for (sunindextype j = 0; j < N; j++)
      if (w->m[w->first + i][j] != 0)
        SM_INDEXVALS_S(A)[used] = j, SM_DATA_S(A)[used++] = -w->m[w->first + i][j];
  }
  at[w->rows] = used;
  return 0;
}

static int no_force(sunrealtype t, int derivative, N_Vector out, void *user)
{
  (void)t, (void)derivative, (void)user;
  N_VConst(0, out);
  return 0;
}

static int identity(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  const whole *w = user;
  (void)t, (void)y, (void)yp;
  for (sunindextype i = 0; i <= w->rows; i++) SM_INDEXPTRS_S(E)[i] = i;
  for (sunindextype i = 0; i < w->rows; i++)
    SM_INDEXVALS_S(E)[i] = w->first + i, SM_DATA_S(E)[i] = 1;
  return 0;
}

typedef struct opened {
  steif_context *ctx;
  N_Vector like, b;
  steif_problem p;
  steif_mpi *m;
} opened;

static int open_system(opened *o, whole *w, const char *spec)
{
  o->ctx = steif_context_new(NULL);
  o->like = steif_mpi_vector(o->ctx, MPI_COMM_WORLD, w->rows);
  o->p = (steif_problem){.name = "whole",
                         .n = N,
                         .t1 = 1,
                         .E = identity,
                         .A = fill,
                         .g = no_force,
                         .storage = STEIF_SPARSE,
                         .nnz = N * N,
                         .user = w};
  o->b = N_VClone(o->like);
  o->m = steif_mpi_open(o->ctx, &o->p, spec, o->like);
  return o->m != NULL;
}

static void close_system(opened *o)
{
  steif_mpi_free(&o->m);
  N_VDestroy(o->b), N_VDestroy(o->like);
  steif_context_free(&o->ctx);
}

static int solve(opened *o, double c, int transposed)
{
  return steif_mpi_solve(o->m, 0, o->like, NULL, c, 0, transposed, 1, &o->b, &o->b);
}

/* x_j = (j - 5) 2^-exponent of its column, so that all terms are whole numbers times a power of the row. */
static double known(int j, int kind, int transposed)
{
  return ldexp(j - 5, -exponent(j, kind, transposed ? ROWS : COLUMNS));
}

static void right_side(opened *o, const whole *w, int kind, int transposed)
{
  double *b = N_VGetArrayPointer(o->b);
  for (int i = 0; i < (int)w->rows; i++) {
    const int k = (int)w->first + i;
    b[i] = 0;
    for (int j = 0; j < N; j++)
      b[i] += (transposed ? w->m[j][k] : w->m[k][j]) * known(j, kind, transposed);
  }
}

static double error(const opened *o, const whole *w, int kind, int transposed)
{
  const double *x = N_VGetArrayPointer(o->b);
  double most = 0;
  for (int i = 0; i < (int)w->rows; i++) {
    const int k = (int)w->first + i;
    const double unit = ldexp(1, exponent(k, kind, transposed ? ROWS : COLUMNS));
    const double off = fabs(x[i] - known(k, kind, transposed)) * unit;
    most = isfinite(off) ? fmax(most, off) : INFINITY;
  }
  return most;
}

/* The same factors serve M and M^T by turns. */
static void units(void)
{
  for (unsigned seed = 1; seed <= 6; seed++)
    for (int kind = 0; kind < KINDS; kind++) {
      whole w;
      opened o;
      numbers(&w, seed);
      for (int i = 0; i < N; i++)
        for (int j = 0; j < N; j++)
          w.m[i][j] = ldexp(w.m[i][j], exponent(i, kind, ROWS) + exponent(j, kind, COLUMNS));
      if (!ALL(open_system(&o, &w, seed % 2 ? "mumps" : "mumps:order=amd"))) continue;
      for (int turn = 0; turn < 4; turn++) {
        right_side(&o, &w, kind, turn % 2);
        const int fine = ALL(solve(&o, 0, turn % 2) == STEIF_OK) &
                         ALL(error(&o, &w, kind, turn % 2) <= 1e-11) &
                         ALL(steif_mpi_statistics(o.m).backward_error <= 1e-13);
        if (!fine && rank == 0)
          printf("  seed %u, units %d, turn %d: error %.1e, backward %.1e, %s\n", seed, kind,
                 turn, error(&o, &w, kind, turn % 2), steif_mpi_statistics(o.m).backward_error,
                 steif_message(o.ctx));
      }
      close_system(&o);
    }
}

/* A row that is the sum of others, times two; whole numbers, so that it is so exactly. */
static void singular(void)
{
  for (unsigned seed = 1; seed <= 8; seed++) {
    whole w;
    opened o;
    numbers(&w, seed);
    for (int j = 0; j < N; j++) w.m[9][j] = 2 * (w.m[2][j] + w.m[4][j] - w.m[12][j]);
    if (!ALL(open_system(&o, &w, "mumps"))) continue;
    right_side(&o, &w, PLAIN, 0);
    ALL(solve(&o, 0, seed % 2) == STEIF_SINGULAR);
    ALL(same(o.ctx) && strstr(steif_message(o.ctx), "singular") != NULL);
    ALL(solve(&o, 0.3, 0) == STEIF_OK); /* another shift is regular */
    close_system(&o);
  }
}

static void no_numbers(void)
{
  static const double bad[] = {NAN, INFINITY};
  whole w;
  opened o;
  numbers(&w, 3);
  if (!ALL(open_system(&o, &w, "mumps"))) return;
  for (int k = 0; k < 2; k++) {
    right_side(&o, &w, PLAIN, 0);
    ALL(solve(&o, bad[k], 0) == STEIF_BAD_INPUT && same(o.ctx));
    if (rank == ranks - 1) N_VGetArrayPointer(o.b)[w.rows - 1] = bad[k];
    ALL(solve(&o, 0, 0) == STEIF_NOT_FINITE && same(o.ctx));
    ALL(strstr(steif_message(o.ctx), "row 13 ") != NULL);
  }
  close_system(&o);
  for (int i = 0; i < N; i++)
    for (int j = 0; j < N; j++) w.m[i][j] = ldexp(w.m[i][j], -900);
  if (!ALL(open_system(&o, &w, "mumps"))) return;
  N_VConst(1e200, o.b);
  ALL(solve(&o, 0, 0) == STEIF_NOT_FINITE && same(o.ctx));
  ALL(strstr(steif_message(o.ctx), "beyond the largest number") != NULL);
  close_system(&o);
}

/* PT-Scotch calls MPI from threads, which MPI_Init does not allow. */
static void threads_of_scotch(void)
{
  whole w;
  opened o;
  int level;
  numbers(&w, 1);
  MPI_Query_thread(&level);
  unsetenv("SCOTCH_PTHREAD_NUMBER");
  const int made = open_system(&o, &w, "mumps:order=ptscotch");
  if (level < MPI_THREAD_MULTIPLE && ranks > 1)
    ALL(!made && steif_status(o.ctx) == STEIF_UNSUPPORTED && same(o.ctx) &&
        strstr(steif_message(o.ctx), "SCOTCH_PTHREAD_NUMBER=1") != NULL);
  else
    ALL(made);
  close_system(&o);
}

/* y' = -2 y + force, with a pattern that has the diagonal, or not. */
static int forced(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  const double force = *(const double *)user;
  (void)t;
  for (sunindextype i = 0; i < NV_LOCLENGTH_P(y); i++)
    NV_Ith_P(out, i) = force - 2 * NV_Ith_P(y, i);
  return 0;
}

static void forces(void)
{
  static double force[] = {0, 1, 1e8, -1e10};
  static const sunindextype none[N + 1];
  sunindextype at[N + 1], column[N + 1];
  steif_context *ctx = steif_context_new(NULL);
  const sunindextype first = N * rank / ranks, rows = N * (rank + 1) / ranks - first;
  N_Vector like = steif_mpi_vector(ctx, MPI_COMM_WORLD, rows), y = N_VClone(like);
  for (sunindextype i = 0; i <= rows; i++) at[i] = i, column[i] = first + i;
  for (int k = 0; k < 4; k++)
    for (int lacks = 0; lacks < 2; lacks++) {
      const steif_pattern pattern = {lacks ? none : at, column};
      const steif_problem p = {.name = "forced",
                               .n = N,
                               .t1 = 1,
                               .f = forced,
                               .pattern = &pattern,
                               .linear = 1,
                               .user = &force[k]};
      steif_mpi *m = steif_mpi_open(ctx, &p, "mumps", like);
      N_VConst(1, y);
      const int code =
        m ? steif_mpi_solve(m, 0, y, NULL, 3, 0, 0, 1, &y, &y) : steif_status(ctx);
      ALL(code == (lacks ? STEIF_BAD_INPUT : STEIF_OK));
      ALL(!lacks ||
          strstr(steif_message(ctx), "the pattern of problem 'forced' does not have"));
      ALL(lacks || fabs(N_VMaxNorm(y) - 0.2) <= 1e-6);
      steif_forget(ctx);
      steif_mpi_free(&m);
    }
  N_VDestroy(y), N_VDestroy(like);
  steif_context_free(&ctx);
}

void test_hard_systems(void)
{
  units(), singular(), no_numbers(), threads_of_scotch(), forces();
}
