/* step.c: a step against its kernels.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "kernels.h"
#include "timing.h"
#include "pencil.h"
#include <steif/collection.h>
#include <stdio.h>
#include <string.h>

enum kind { SPARSE, STAGES, SMALL, SPLITTING, THREADS, PRICE };

static const struct {
  enum kind kind;
  const char *problem, *method;
  sunrealtype h; /* PRICE: rtol */
} plan[] = {
  {SPARSE, "heat:n=4000,storage=sparse", "be", 1e-6},
  {SPARSE, "heat2d:n=64", "be", 1e-4},
  {SPARSE, "heat2d:n=64", "bdf:p=2", 1e-4},
  {SPARSE, "heat2d:n=64", "dirk:alexander2", 1e-4},
  {STAGES, "heat2d:n=64", "gauss:s=2", 1e-4},
  {STAGES, "heat2d:n=64", "radau:s=3", 1e-4},
  {STAGES, "heat2d:n=64", "gauss:s=4", 1e-4},
  {STAGES, "heat2d:n=64", "radau:s=5", 1e-4},
  {SMALL, "vdpol:mu=10", "be", 1e-4},
  {SMALL, "vdpol:mu=10", "bdf:p=2", 1e-4},
  {SMALL, "orego", "bdf:p=2", 1e-5},
  {SMALL, "hires", "bdf:p=2", 1e-3},
  {SMALL, "vdpol:mu=10", "dirk:alexander2", 1e-4},
  {SMALL, "hires", "dirk:alexander2", 1e-3},
  {SMALL, "vdpol:mu=10", "radau:s=3", 1e-4},
  {SMALL, "orego", "radau:s=3", 1e-5},
  {SMALL, "hires", "radau:s=3", 1e-3},
  {SPLITTING, "fpu:n=500000", "verlet", 1e-2},
  {THREADS, "bruss2d:n=64", "radau:s=3", 1e-2},
  {THREADS, "bruss2d:n=64", "radau:s=5", 1e-2},
  {PRICE, "vdpol", "cvode", 1e-6},
  {PRICE, "vdpol", "ida", 1e-6},
  {PRICE, "vdpol", "arkode", 1e-3},
  {PRICE, "hires", "cvode", 1e-6},
  {PRICE, "hires", "ida", 1e-6},
  {PRICE, "hires", "arkode", 1e-4},
  {PRICE, "bruss2d:n=16", "cvode", 1e-6},
  {PRICE, "bruss2d:n=16", "ida", 1e-6},
  {PRICE, "bruss2d:n=16", "arkode", 1e-4},
};

typedef struct subject {
  steif_context *ctx;
  steif_problem problem;
  steif_solver *solver;
  N_Vector y, out, im;
  sunrealtype *b;
  int slot;
} subject;

static void one_step(void *data)
{
  subject *s = data;
  stf_step *step = &s->solver->step;
  step->count = step->count > 100 ? 50 : step->count; /* the end never comes */
  stf_advance(s->solver, s->solver->t1);
}

static void one_rhs(void *data)
{
  subject *s = data;
  s->problem.f(0, s->y, s->out, s->problem.user);
}

static void one_kick(void *data)
{
  subject *s = data;
  s->problem.kick(0, s->y, s->out, s->problem.user);
}

static void one_update(void *data)
{
  subject *s = data;
  sunrealtype *y = N_VGetArrayPointer(s->y);
  const sunrealtype *f = N_VGetArrayPointer(s->out);
  for (sunindextype i = 0; i < s->problem.n; i++) y[i] += 1e-9 * f[i];
}

static void one_direct_solve(void *data)
{
  subject *s = data;
  stf_sparse_direct(s->solver->step.system.pencil, s->slot, s->b);
}

static void one_solve(void *data)
{
  subject *s = data;
  const stf_transform *transform = &s->solver->step.newton.transform;
  steif_pencil_solve(s->solver->step.system.pencil, s->slot, 1, &s->out,
                     transform->im[s->slot] != 0 ? &s->im : NULL);
}

static void one_factor(void *data)
{
  subject *s = data;
  stf_newton *newton = &s->solver->step.newton;
  steif_pencil_update(s->solver->step.system.pencil);
  newton->factored = false;
  stf_newton_prepare(newton, 0, newton->h, s->y, s->y, false);
}

static void one_jacobian(void *data)
{
  subject *s = data;
  stf_system *system = &s->solver->step.system;
  stf_system_linearise(system, 0, s->y, s->y);
}

static void close(subject *s)
{
  if (s->y) N_VDestroy(s->y);
  if (s->out) N_VDestroy(s->out);
  if (s->im) N_VDestroy(s->im);
  stf_release(s->ctx, s->b);
  steif_solver_free(&s->solver);
  steif_problem_clear(s->ctx, &s->problem);
}

static int open(steif_context *ctx, size_t i, subject *s)
{
  *s = (subject){.ctx = ctx};
  STEIF_TRY(steif_problem_find(ctx, plan[i].problem, &s->problem));
  steif_options o = steif_defaults();
  o.h = plan[i].h;
  o.t1 = 120 * o.h;
  s->solver = steif_solver_new(ctx, &s->problem, plan[i].method, &o);
  if (!s->solver) return steif_status(ctx);
  for (int k = 0; k < 60; k++) STEIF_TRY(steif_solve_step(s->solver));
  s->y = N_VClone(s->solver->step.y);
  s->out = N_VClone(s->y);
  s->im = N_VClone(s->y);
  s->b = stf_allocate(ctx, (size_t)(2 * s->problem.n), sizeof *s->b);
  STEIF_CHECK(s->y && s->out && s->im && s->b, ctx, STEIF_NO_MEMORY,
              "no memory for a benchmark");
  N_VScale(1, s->solver->step.y, s->y);
  N_VConst(0, s->im);
  return STEIF_OK;
}

/* Solves and right-hand sides per step, from the counters over some steps. */
typedef struct work {
  sunrealtype rhs, sweeps, jacobians, factors;
} work;

static work count(subject *s)
{
  enum { STEPS = 40 };
  const steif_stats before = *steif_statistics(s->solver);
  for (int k = 0; k < STEPS; k++) one_step(s);
  const steif_stats after = *steif_statistics(s->solver);
  return (work){(sunrealtype)(after.nfe - before.nfe) / STEPS,
                (sunrealtype)(after.newton - before.newton) / STEPS,
                (sunrealtype)(after.nje - before.nje) / STEPS,
                (sunrealtype)(after.nlu - before.nlu) / STEPS};
}

/* One solve with every lane, one after another as in a step: none finds its factors in the cache for
 * having been solved with just before. */
typedef struct round {
  subject *s;
  void (*solve)(void *);
} round;

static void one_round(void *data)
{
  const round *r = data;
  for (r->s->slot = 0; r->s->slot < r->s->solver->step.newton.transform.shifts; r->s->slot++)
    r->solve(r->s);
}

static sunrealtype lanes(subject *s, void (*solve)(void *))
{
  N_VConst(1, s->out);
  return stf_time(one_round, &(round){s, solve});
}

static void against_force(subject *s, steif_bench_row *row)
{
  row->step_s = stf_time(one_step, s);
  row->floor_s = stf_time(one_kick, s) + 2 * stf_time(one_update, s);
}

static void against_kernels(subject *s, enum kind kind, steif_bench_row *row)
{
  const work w = count(s);
  row->step_s = stf_time(one_step, s);
  row->floor_s = w.sweeps * lanes(s, one_direct_solve);
  if (kind == SPARSE) row->floor_s += w.rhs * stf_time(one_rhs, s);
}

/* Seconds per step of a whole CVODE run. */
static int cvode_step(steif_context *ctx, const char *name, sunrealtype *seconds)
{
  steif_problem p;
  int code = steif_problem_find(ctx, name, &p);
  *seconds = 1e300;
  for (int k = 0; !code && k < 15; k++) {
    steif_options o = steif_defaults();
    steif_solver *s = steif_solver_new(ctx, &p, "cvode", &o);
    code = s ? steif_solve_to(s, p.t1) : steif_status(ctx);
    const steif_stats *stats = s ? steif_statistics(s) : NULL;
    if (!code && stats->cpu_s / (sunrealtype)stats->steps < *seconds)
      *seconds = stats->cpu_s / (sunrealtype)stats->steps;
    steif_solver_free(&s);
  }
  steif_problem_clear(ctx, &p);
  return code;
}

static int bookkeeping(subject *s, const char *problem, steif_bench_row *row)
{
  const work w = count(s);
  const sunrealtype kernels = w.rhs * stf_time(one_rhs, s) + w.sweeps * lanes(s, one_solve) +
                              w.jacobians * stf_time(one_jacobian, s) +
                              w.factors * stf_time(one_factor, s);
  row->step_s = stf_time(one_step, s) - kernels;
  return cvode_step(s->ctx, problem, &row->floor_s);
}

int steif_bench_step(steif_context *ctx, size_t i, steif_bench_row *row)
{
  static const char *const names[] = {"sparse",    "stages",  "small",
                                      "splitting", "threads", "price"};
  if (i >= sizeof plan / sizeof *plan) return STEIF_BAD_INPUT;
  subject s;
  static const sunrealtype limits[] = {1.3, 1.3, 1, 1.2, 1 / 1.3, 1.05};
  *row = (steif_bench_row){.limit = limits[plan[i].kind]};
  *(plan[i].kind == PRICE ? &row->rtol : &row->h) = plan[i].h;
  snprintf(row->kind, sizeof row->kind, "%s", names[plan[i].kind]);
  snprintf(row->problem, sizeof row->problem, "%s", plan[i].problem);
  snprintf(row->method, sizeof row->method, "%s", plan[i].method);
  if (plan[i].kind == PRICE) return stf_bench_price(ctx, plan[i].problem, plan[i].method, row);
  if (plan[i].kind == THREADS) {
    const int code = stf_bench_threads(ctx, plan[i].problem, plan[i].method, plan[i].h, row);
    row->ratio = row->step_s / row->floor_s;
    return code;
  }
  int code = open(ctx, i, &s);
  row->n = s.problem.n;
  if (!code && plan[i].kind == SPLITTING) against_force(&s, row);
  if (!code && plan[i].kind < SMALL) against_kernels(&s, plan[i].kind, row);
  if (!code && plan[i].kind == SMALL) code = bookkeeping(&s, plan[i].problem, row);
  row->ratio = row->step_s / row->floor_s;
  close(&s);
  return code;
}
