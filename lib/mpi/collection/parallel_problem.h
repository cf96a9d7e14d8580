/* parallel_problem.h: problems of the collection over ranks, behind their public form.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_MPI_PARALLEL_PROBLEM_H
#define STEIF_MPI_PARALLEL_PROBLEM_H

#include <stdbool.h>
#include <steif/extension.h>
#include <steif/mpi.h>

/* The first member of what each kind keeps. */
typedef struct parallel_problem parallel_problem;
struct parallel_problem {
  steif_problem problem;
  sunindextype rows;  /* own ones */
  char message[1200]; /* what was done about the start */
  /* Of own row k among the unknowns of one process. */
  sunindextype (*number)(const parallel_problem *p, sunindextype k);
  void (*release)(steif_context *ctx, parallel_problem *p);
};

bool grid_named(const char *name);
/* *out is there as soon as there is memory to release, also on failure. */
int grid_build(steif_context *ctx, const char *text, MPI_Comm comm, parallel_problem **out);
/* `one`: a vector over the ranks, to agree by, which is done where only some of them fail on the way. */
int slice_build(steif_context *ctx, const char *text, N_Vector one, parallel_problem **out);

/* Places 0 to n - 1 for the unknowns of matrices with this pattern by columns, such that neighbours in the graph of
 * M + M^T are near: levels around an unknown at the edge, as by E. Cuthill and J. McKee, Proc. 24th Nat. Conf. ACM,
 * 1969. */
int number_by_levels(steif_context *ctx, sunindextype n, const sunindextype *column,
                     const sunindextype *row, sunindextype *place);

#endif
