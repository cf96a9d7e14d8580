/* scale_run.c: one run of the grid problem.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "scale.h"
#include "timing.h"

static int solve(steif_context *ctx, scale_grid *g, const steif_problem *p, N_Vector like,
                 scale_run *run)
{
  steif_options o = steif_defaults();
  o.rtol = o.atol = run->rtol, o.like = like;
  steif_solver *s = steif_solver_new(ctx, p, run->method, &o);
  const double delay = run->network.delay;
  run->network = (scale_network){.delay = delay};
  const long before = steif_krylov_statistics(s)->reductions;
  const double cpu = stf_now(), clock = stf_clock();
  const int code = s ? steif_solve_to(s, p->t1) : steif_status(ctx);
  run->cpu_s = stf_now() - cpu, run->clock_s = stf_clock() - clock;
  const steif_stats *stats = steif_statistics(s);
  run->steps = stats->steps, run->iterations = stats->nli;
  run->reductions = steif_krylov_statistics(s)->reductions - before;
  if (!code) run->error = scale_grid_error(g, p->t1, steif_solution(s));
  steif_solver_free(&s);
  return code;
}

int scale_measure(steif_context *ctx, int side, double delay, scale_run *run)
{
  run->network = (scale_network){.delay = delay};
  scale_grid *g = scale_grid_new(side, &run->network);
  run->n = (sunindextype)side * side * side;
  N_Vector like = g ? scale_vector(run->n, steif_sundials(ctx), &run->network) : NULL;
  int code = STEIF_NO_MEMORY;
  if (like) {
    const steif_problem p = scale_grid_problem(g);
    run->levels = scale_grid_levels(g);
    code = solve(ctx, g, &p, like, run);
    N_VDestroy(like);
  } else
    STEIF_FAIL(ctx, STEIF_NO_MEMORY, "no memory for a grid of %d^3 points", side);
  scale_grid_free(g);
  return code;
}
