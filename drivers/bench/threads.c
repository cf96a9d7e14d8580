/* threads.c: a step with new factors, by one thread and by two: wall-clock time, and the same
 * numbers bit for bit.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "kernels.h"
#include "timing.h"
#include <math.h>
#include <steif/collection.h>
#include <string.h>

typedef struct runner {
  steif_context *ctx;
  steif_problem problem;
  steif_solver *solver;
} runner;

/* Newton's iterations and one set of factors; steps of one size without end. */
static int step(runner *r)
{
  stf_step *s = &r->solver->step;
  if (s->count > 20) s->count = 10;
  s->newton.factored = false;
  STEIF_TRY(steif_pencil_update(s->system.pencil));
  return stf_advance(r->solver, r->solver->t1);
}

static int open(runner *r, int threads, const char *problem, const char *method, sunrealtype h)
{
  enum { WARM_UP = 5 };
  r->ctx = steif_context_new(&(steif_setup){.threads = threads});
  if (!r->ctx) return STEIF_NO_MEMORY;
  STEIF_TRY(steif_problem_find(r->ctx, problem, &r->problem));
  steif_options o = steif_defaults();
  o.h = h;
  o.t1 = r->problem.t0 + 100 * h;
  r->solver = steif_solver_new(r->ctx, &r->problem, method, &o);
  if (!r->solver) return steif_status(r->ctx);
  for (int k = 0; k < WARM_UP; k++) STEIF_TRY(step(r));
  return STEIF_OK;
}

static void close(runner *r)
{
  if (!r->ctx) return;
  steif_solver_free(&r->solver);
  steif_problem_clear(r->ctx, &r->problem);
  steif_context_free(&r->ctx);
}

static int measure(runner *r, sunrealtype *least)
{
  enum { ROUNDS = 12 };
  for (int k = 0; k < ROUNDS; k++)
    for (int i = 0; i < 2; i++) {
      const sunrealtype from = stf_clock();
      STEIF_TRY(step(&r[i]));
      least[i] = fmin(least[i], stf_clock() - from);
    }
  return STEIF_OK;
}

static bool agree(const runner *r)
{
  const steif_solver *a = r[0].solver, *b = r[1].solver;
  return !memcmp(N_VGetArrayPointer(a->step.y), N_VGetArrayPointer(b->step.y),
                 (size_t)a->problem->n * sizeof(sunrealtype));
}

int stf_bench_threads(steif_context *ctx, const char *problem, const char *method,
                      sunrealtype h, steif_bench_row *row)
{
  runner r[2] = {{0}};
  sunrealtype least[2] = {INFINITY, INFINITY};
  int code = STEIF_OK;
  for (int i = 0; i < 2 && !code; i++) code = open(&r[i], i + 1, problem, method, h);
  if (!code) code = measure(r, least);
  if (code)
    STEIF_FAIL(ctx, code, "%s", steif_message(r[r[1].ctx ? 1 : 0].ctx));
  else if (!agree(r))
    code =
      STEIF_FAIL(ctx, STEIF_NOT_CERTIFIED,
                 "two threads gave other numbers than one for '%s' of '%s'", method, problem);
  row->n = r[0].problem.n;
  row->step_s = least[1];
  row->floor_s = least[0];
  for (int i = 0; i < 2; i++) close(&r[i]);
  return code;
}
