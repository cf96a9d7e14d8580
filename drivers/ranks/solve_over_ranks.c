/* solve_over_ranks.c: `steif solve PROBLEM METHOD --parallel`.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "over_ranks.h"
#include <math.h>
#include <steif/extension.h>
#include <stdio.h>

static void present_head(const request *r, const steif_problem *p)
{
  printf(r->json
           ? "{\"problem\": \"%s\", \"method\": \"%s\", \"linear\": \"%s\", \"ranks\": %d, "
             "\"unknowns\": %lld, \"t\": %.17g, "
           : "%s with %s, linear systems by %s\nranks      %d\nunknowns   %lld\n"
             "t          %.12g\n",
         r->problem, r->method[0], r->linear, r->ranks, (long long)p->n, p->t1);
}

static void present_costs(const request *r, const ranks_run *run)
{
  char known[64];
  snprintf(known, sizeof known, "%s", r->json ? "null" : "-");
  if (isfinite(run->error)) snprintf(known, sizeof known, "%.3e", run->error);
  printf(r->json ? "\"steps\": %ld, \"setups\": %ld, \"solves\": %ld, \"halo_bytes\": %lld, "
                   "\"factor_megabytes\": %g, \"error\": %s}\n"
                 : "steps      %ld\nsetups     %ld\nsolves     %ld\nhalo bytes %lld\n"
                   "factors MB %g a rank at most\nerror      %s\n",
         run->stats.steps, run->linear.setups, run->linear.solves, run->linear.sent,
         run->linear.memory, known);
}

static int integrate(const request *r, steif_context *ctx, steif_problem *p, N_Vector like)
{
  ranks_run run;
  steif_options o = steif_defaults();
  N_Vector end = N_VClone(like);
  if (steif_agree(ctx, like, end ? STEIF_OK : STEIF_NO_MEMORY)) {
    if (end) N_VDestroy(end);
    return STEIF_NO_MEMORY;
  }
  if (r->tolerances) o.rtol = r->rtol[0];
  if (r->atol > 0) o.atol = r->atol;
  if (r->h > 0) o.h = r->h;
  if (r->t1 > 0) p->t1 = r->t1;
  o.like = like;
  run_over_ranks(ctx, p, like, r->linear, r->method[0], &o, NULL, end, &run);
  if (r->rank == 0 && *steif_mpi_start(p)) object(r, "%s", steif_mpi_start(p));
  if (!run.code) {
    if (r->rank == 0) present_head(r, p);
    show_solution(r, p, end);
    if (r->rank == 0) present_costs(r, &run);
  }
  N_VDestroy(end);
  return run.code;
}

int solve_over_ranks(const request *r)
{
  N_Vector like = NULL;
  steif_context *ctx = steif_context_new(NULL);
  steif_problem *p = steif_mpi_problem_new(ctx, r->problem, MPI_COMM_WORLD, &like);
  const int code = p ? integrate(r, ctx, p, like) : steif_status(ctx);
  if (code) object(r, "%s", steif_message(ctx));
  steif_mpi_problem_free(ctx, &p, &like);
  steif_context_free(&ctx);
  return exit_of_code(code);
}
