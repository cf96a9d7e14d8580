/* time.c: least processor time of a repeated piece of work.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "timing.h"
#include <math.h>
#include <steif/collection.h>
#include <time.h>

static sunrealtype seconds(clockid_t clock)
{
  struct timespec t;
  clock_gettime(clock, &t);
  return (sunrealtype)t.tv_sec + 1e-9 * (sunrealtype)t.tv_nsec;
}

sunrealtype stf_now(void) { return seconds(CLOCK_PROCESS_CPUTIME_ID); }

sunrealtype stf_clock(void) { return seconds(CLOCK_MONOTONIC); }

static sunrealtype batch(void (*work)(void *), void *data, long count)
{
  const sunrealtype from = stf_now();
  for (long i = 0; i < count; i++) work(data);
  return stf_now() - from;
}

sunrealtype stf_time(void (*work)(void *data), void *data)
{
  const sunrealtype enough = 4e-3;
  enum { BATCHES = 9 };
  long count = 1;
  sunrealtype took;
  while ((took = batch(work, data, count)) < enough && count < 1L << 40) count *= 2;
  sunrealtype least = took;
  for (int i = 0; i < BATCHES; i++) {
    took = batch(work, data, count);
    if (took < least) least = took;
  }
  return least / (sunrealtype)count;
}

int stf_time_steps(steif_context *ctx, const char *problem, const char *method, int steps,
                   sunrealtype h, sunrealtype *seconds)
{
  enum { RUNS = 5 };
  steif_problem p;
  int code = steif_problem_find(ctx, problem, &p);
  *seconds = INFINITY;
  for (int k = 0; !code && k < RUNS; k++) {
    steif_options o = steif_defaults();
    o.h = h;
    o.t1 = p.t0 + steps * h;
    steif_solver *s = steif_solver_new(ctx, &p, method, &o);
    code = s ? steif_solve_to(s, o.t1) : steif_status(ctx);
    if (!code) *seconds = fmin(*seconds, steif_statistics(s)->cpu_s / steps);
    steif_solver_free(&s);
  }
  steif_problem_clear(ctx, &p);
  return code;
}
