/* lorenz.c: the exponents of Lorenz' equations in a long run, timed.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "bench.h"
#include <math.h>
#include <steif/collection.h>
#include <steif/lyapunov.h>
#include <stdio.h>

/* Steps and tolerances of DOP853 that keep the sum of the exponents about equally well. */
static const struct {
  sunrealtype h, rtol;
} plan[] = {{0.01, 1e-4}, {0.004, 1e-6}};

int steif_bench_lorenz(steif_context *ctx, size_t i, steif_bench_attractor *row)
{
  steif_problem p;
  steif_lyapunov_facts facts;
  if (i >= sizeof plan / sizeof *plan) return STEIF_BAD_INPUT;
  *row = (steif_bench_attractor){
    .h = plan[i].h, .time = 2e4, .transient = 100, .rtol = plan[i].rtol};
  snprintf(row->method, sizeof row->method, "rk4");
  STEIF_TRY(steif_problem_find(ctx, "lorenz", &p));
  const steif_lyapunov_options o = {.h = row->h,
                                    .t1 = p.t0 + row->transient + row->time,
                                    .transient = row->transient,
                                    .error = row->error};
  const sunrealtype from = stf_now();
  const int code = steif_lyapunov(ctx, &p, row->method, &o, row->exponent, NULL, &facts);
  row->cpu_s = stf_now() - from;
  row->sum = -41.0 / 3; /* -(sigma + 1 + beta), the divergence */
  if (!code) row->defect = fabs(facts.sum - row->sum);
  steif_problem_clear(ctx, &p);
  return code;
}
