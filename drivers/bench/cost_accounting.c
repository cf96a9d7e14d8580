/* cost_accounting.c: what is left of a whole run of `auto` without f, J, factorisations and solves, on every
 * problem of 3 to 30 unknowns.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "kernels.h"
#include "timing.h"
#include "irk_interleaved.h"
#include <math.h>
#include <steif/collection.h>
#include <stdio.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

enum { LEAST = 3, MOST = 30 };
static const sunrealtype rtols[] = {1e-3, 1e-6};
enum { RTOLS = sizeof rtols / sizeof *rtols };

/* A run at its end, and the kernels at the point where it is. */
typedef struct account {
  steif_problem problem;
  steif_solver *solver;
  N_Vector out;
  stf_rosenbrock rodas;
  double h, u[STF_RODAS_STAGES][STF_ROSENBROCK], Y[STF_ROSENBROCK];
} account;

static stf_step *step_of(void *data) { return &((account *)data)->solver->step; }

static void one_rhs(void *data)
{
  account *b = data;
  b->problem.f(b->solver->step.t, b->solver->step.y, b->out, b->problem.user);
}

static void one_residual(void *data)
{
  stf_step *s = step_of(data);
  stf_system_residual(&s->system, s->t, s->y, s->yp, ((account *)data)->out);
}

static void one_jacobian(void *data)
{
  stf_step *s = step_of(data);
  stf_system_matrices(&s->system, s->t, s->y, s->yp);
}

static void lanes_factor(void *data)
{
  stf_step *s = step_of(data);
  stf_interleaved_factor(((stf_irk_interleaved *)s->state)->L, SM_DATA_D(s->system.A),
                         ((account *)data)->h);
}

static void lanes_sweep(void *data)
{
  stf_step *s = step_of(data);
  stf_interleaved_sweep(((stf_irk_interleaved *)s->state)->L, STF_ARRAY(s->y),
                        STF_ARRAY(s->weights), ((account *)data)->h);
}

static void rodas_factor(void *data)
{
  account *b = data;
  stf_rosenbrock_factor(&b->rodas, SM_DATA_D(b->solver->step.system.A), 4 / b->h);
}

/* One in the middle. */
static void rodas_stage(void *data)
{
  enum { AT = 3 };
  static const double a[STF_RODAS_STAGES] = {0.3, 0.2, 0.5, 0.1}; /* any */
  account *b = data;
  const double *y = STF_ARRAY(b->solver->step.y);
  stf_rosenbrock_stage g = {
    .i = AT, .a = a, .c = a, .h = b->h, .f = STF_ARRAY(b->out), .y = y, .Y = b->Y};
  for (int i = 0; i <= AT; i++) g.u[i] = b->u[i];
  stf_rosenbrock_solve(&b->rodas, &g);
}

static void pencil_factor(void *data)
{
  stf_step *s = step_of(data);
  steif_pencil_update(s->system.pencil);
  s->newton.factored = false;
  stf_newton_prepare(&s->newton, s->t, ((account *)data)->h, s->y, s->yp, false);
}

static void pencil_solve(void *data)
{
  stf_step *s = step_of(data);
  N_Vector x = ((account *)data)->out, y = s->error;
  for (int k = 0; k < s->newton.transform.shifts; k++)
    steif_pencil_solve(s->system.pencil, k, 1, &x, s->newton.transform.im[k] != 0 ? &y : NULL);
}

/* Seconds in kernels, by the counters of the run. */
static sunrealtype kernels(account *b)
{
  stf_step *s = &b->solver->step;
  const steif_stats n = *steif_statistics(b->solver);
  const sunrealtype rhs = stf_time(b->problem.f ? one_rhs : one_residual, b);
  sunrealtype sum = (sunrealtype)n.nfe * rhs;
  if (!n.nlu) return sum;
  sum += (sunrealtype)n.nje * stf_time(one_jacobian, b);
  if (s->method == &steif_method_irk_interleaved) {
    const int lanes = (((stf_irk_interleaved *)s->state)->s + 1) / 2;
    return sum + (sunrealtype)n.nlu / lanes * stf_time(lanes_factor, b) +
           (sunrealtype)n.newton * stf_time(lanes_sweep, b);
  }
  if (!strncmp(b->solver->method, "rodas", 5) && s->problem->n <= STF_ROSENBROCK)
    return sum + (sunrealtype)n.nlu * stf_time(rodas_factor, b) +
           (sunrealtype)n.nsolve * stf_time(rodas_stage, b);
  const int lanes = s->newton.transform.shifts;
  return lanes < 1 ? sum
                   : sum + (sunrealtype)n.nlu / lanes * stf_time(pencil_factor, b) +
                       (sunrealtype)n.nsolve / lanes * stf_time(pencil_solve, b);
}

/* Least processor time of several runs; the last one stays. */
static int run(steif_context *ctx, account *b, sunrealtype rtol, sunrealtype *least)
{
  enum { RUNS = 7 };
  *least = INFINITY;
  for (int k = 0; k < RUNS; k++) {
    steif_options o = steif_defaults();
    o.rtol = rtol;
    steif_solver_free(&b->solver);
    b->solver = steif_solver_new(ctx, &b->problem, "auto", &o);
    if (!b->solver) return steif_status(ctx);
    STEIF_TRY(steif_solve_to(b->solver, b->problem.t1));
    *least = fmin(*least, steif_statistics(b->solver)->cpu_s);
  }
  return STEIF_OK;
}

static int measure(steif_context *ctx, account *b, sunrealtype rtol, steif_bench_row *row)
{
  sunrealtype whole;
  const int code = run(ctx, b, rtol, &whole);
  if (code) return code;
  const stf_step *s = &b->solver->step;
  const sunrealtype steps = (sunrealtype)steif_statistics(b->solver)->steps;
  b->h = s->h;
  b->out = N_VClone(s->y);
  STEIF_CHECK(b->out, ctx, STEIF_NO_MEMORY, "no memory for a benchmark");
  if (s->system.A && s->problem->n <= STF_ROSENBROCK) {
    stf_rosenbrock_open(&b->rodas, (int)s->problem->n,
                        s->system.E ? SM_DATA_D(s->system.E) : NULL);
    rodas_factor(b);
  }
  row->floor_s = kernels(b) / steps;
  row->step_s = whole / steps - row->floor_s;
  snprintf(row->method, sizeof row->method, "%.*s",
           (int)fmin(sizeof row->method - 1.0, (double)strcspn(b->solver->method, " ")),
           b->solver->method);
  return STEIF_OK;
}

static bool wanted(const steif_problem *p)
{
  return p->n >= LEAST && p->n <= MOST && (p->f || p->F) && p->storage == STEIF_DENSE;
}

/* The problem of row i, and its tolerance; STEIF_BAD_INPUT past the end. */
static int find(steif_context *ctx, size_t i, steif_problem *p, const char **name,
                sunrealtype *rtol)
{
  size_t left = i / RTOLS;
  *rtol = rtols[i % RTOLS];
  for (size_t k = 0; (*name = steif_problem_name(k)); k++) {
    STEIF_TRY(steif_problem_find(ctx, *name, p));
    if (wanted(p) && left-- == 0) return STEIF_OK;
    steif_problem_clear(ctx, p);
  }
  return STEIF_BAD_INPUT;
}

int steif_bench_cost_accounting(steif_context *ctx, size_t i, steif_bench_row *row)
{
  account b = {.solver = NULL};
  const char *name;
  sunrealtype rtol;
  STEIF_TRY(find(ctx, i, &b.problem, &name, &rtol));
  *row = (steif_bench_row){.limit = 1, .n = b.problem.n, .rtol = rtol};
  row->atol = rtol * (b.problem.rtol_scale > 0 ? b.problem.rtol_scale : 1);
  snprintf(row->kind, sizeof row->kind, "rtol %.0e", rtol);
  snprintf(row->problem, sizeof row->problem, "%s", name);
  const int code = measure(ctx, &b, rtol, row);
  row->ratio = row->step_s / row->floor_s;
  if (b.out) N_VDestroy(b.out);
  steif_solver_free(&b.solver);
  steif_problem_clear(ctx, &b.problem);
  return code;
}
