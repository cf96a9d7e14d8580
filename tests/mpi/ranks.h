/* ranks.h: a heat equation over ranks, and what every rank must agree on.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef RANKS_H
#define RANKS_H

#include <mpi.h>
#include <nvector/nvector_parallel.h>
#include <steif/steif.h>

/* u_t = u_xx - 5 u^2 on n inner points of 0..1, u = 0 at both ends; some rows to each rank. */
typedef struct rod {
  MPI_Comm comm;
  int rank, size;
  sunindextype n, first, rows;
  int *owned;       /* rows of each rank */
  int alone;        /* the rank that misbehaves; -1: none */
  int wrong, calls; /* what it does (enum), and calls of f so far */
  volatile int stop;
  sunrealtype c; /* of the preconditioner, which is diagonal */
} rod;

enum { NOTHING, RECOVERABLE, FATAL, NOT_A_NUMBER, STOP, LATE, LOCAL_EVENT };

/* Rows as even as can be, or 1, rest, 0, ... */
void rod_open(rod *r, MPI_Comm comm, sunindextype n, int uneven);
void rod_close(rod *r);
int rod_f(sunrealtype t, N_Vector y, N_Vector out, void *user);
int rod_setup(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, sunrealtype c, void *user);
int rod_solve(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, N_Vector b, N_Vector z,
              sunrealtype c, sunrealtype delta, void *user);
/* Start values of own rows, y0 with room for them. */
steif_problem rod_problem(rod *r, sunrealtype *y0);
N_Vector rod_vector(rod *r, steif_context *ctx);

/* Is the condition true on all ranks? Else rank 0 prints it, and the program fails. */
#define EVERYWHERE(r, condition) everywhere(r, condition, #condition, __FILE__, __LINE__)
int everywhere(const rod *r, int condition, const char *text, const char *file, int line);
extern int failures;

/* Sums over ranks so far, as MPI sees them. */
extern long allreduces;

/* Code and sentence are the same on all ranks. */
int same_answer(const rod *r, steif_context *ctx, int code);

void test_limits(MPI_Comm comm);
void test_arrays(MPI_Comm comm);
void test_runs(MPI_Comm comm);
void test_reductions(MPI_Comm comm);
void test_memory(MPI_Comm comm);
void test_parts(MPI_Comm comm);
void test_same(MPI_Comm comm);
void test_constraints(MPI_Comm comm);

#endif
