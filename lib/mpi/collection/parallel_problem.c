/* parallel_problem.c: a problem of the collection over ranks, by its name.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "parallel_problem.h"
#include <string.h>

void steif_mpi_problem_free(steif_context *ctx, steif_problem **problem, N_Vector *like)
{
  if (like && *like) N_VDestroy(*like), *like = NULL;
  if (!problem || !*problem) return;
  parallel_problem *p = (parallel_problem *)*problem; /* its first member */
  p->release(ctx, p);
  *problem = NULL;
}

static int build(steif_context *ctx, const char *text, N_Vector one, parallel_problem **out)
{
  steif_spec spec;
  const bool named = text && !steif_spec_parse(ctx, text, &spec) && grid_named(spec.name);
  steif_forget(ctx);
  if (!text) return steif_fail(ctx, STEIF_BAD_INPUT, "the problem has no name; give one");
  return named ? grid_build(ctx, text, NV_COMM_P(one), out) : slice_build(ctx, text, one, out);
}

const char *steif_mpi_start(const steif_problem *problem)
{
  return ((const parallel_problem *)problem)->message;
}

sunindextype steif_mpi_number(const steif_problem *problem, sunindextype k)
{
  const parallel_problem *p = (const parallel_problem *)problem;
  return p->number(p, k);
}

steif_problem *steif_mpi_problem_new(steif_context *ctx, const char *spec, MPI_Comm comm,
                                     N_Vector *like)
{
  parallel_problem *p = NULL;
  int on = 0;
  MPI_Initialized(&on);
  if (!on) {
    steif_fail(ctx, STEIF_BAD_INPUT, "MPI is not initialised: call MPI_Init first");
    return NULL;
  }
  N_Vector one = steif_mpi_vector(ctx, comm, 1); /* to agree by */
  if (!one) return NULL;
  int code = steif_same(ctx, one, "the problem", spec, spec ? strlen(spec) : 0);
  if (!code) code = steif_agree(ctx, one, build(ctx, spec, one, &p));
  N_VDestroy(one);
  steif_problem *problem = p ? &p->problem : NULL;
  *like = code ? NULL : steif_mpi_vector(ctx, comm, p->rows);
  if (!*like)
    steif_mpi_problem_free(ctx, &problem, like);
  else
    problem->like = *like;
  return problem;
}
