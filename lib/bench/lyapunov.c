/* lyapunov.c: a step with Lyapunov exponents against the step alone and the kernels they take.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "bench.h"
#include "blas.h"
#include "general.h"
#include <math.h>
#include <steif/collection.h>
#include <steif/lyapunov.h>
#include <stdio.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

static const struct {
  const char *problem, *method;
  sunrealtype h;
} plan[] = {
  {"vdpol:mu=10", "rk4", 1e-3},          {"lorenz96:n=20", "rk4", 1e-2},
  {"lorenz96:n=200", "rk4", 1e-2},       {"vdpol:mu=10", "bdf:p=2", 1e-3},
  {"lorenz96:n=20", "bdf:p=2", 1e-2},    {"lorenz96:n=200", "bdf:p=2", 1e-2},
  {"vdpol:mu=10", "radau:s=2", 1e-3},    {"lorenz96:n=20", "radau:s=2", 1e-2},
  {"lorenz96:n=200", "radau:s=2", 1e-2},
};

typedef struct subject {
  steif_context *ctx;
  steif_problem problem;
  const char *method;
  sunrealtype h;
  int d, order, length;
  SUNMatrix J;
  N_Vector y, fy, tmp[3];
  sunrealtype *A, *B, *C, *W, *work;
  int *pivot;
} subject;

/* ---- kernels ---- */

static void jacobian(void *data)
{
  subject *s = data;
  SUNMatZero(s->J);
  s->problem.jac(0, s->y, s->fy, s->J, s->problem.user, s->tmp[0], s->tmp[1], s->tmp[2]);
}

static void product(void *data)
{
  subject *s = data;
  stf_multiply(s->d, s->d, s->W, s->B, 0, s->C);
}

/* Diagonally dominant: no pivot moves, the work is the same. */
static void elimination(void *data)
{
  subject *s = data;
  const int n = s->order;
  int info;
  memset(s->A, 0, (size_t)n * (size_t)n * sizeof *s->A);
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) s->A[i * n + j] = i == j ? n : 0.5;
  dgetrf_(&n, &n, s->A, &n, s->pivot, &info);
  dgetrs_("T", &n, &s->d, s->A, &n, s->pivot, s->B, &n, &info, 1);
}

static void orthogonal(void *data)
{
  subject *s = data;
  int info;
  memcpy(s->C, s->W, (size_t)s->d * (size_t)s->d * sizeof *s->C);
  dgelqf_(&s->d, &s->d, s->C, &s->d, s->work, s->work + s->d, &s->length, &info);
}

static void division(void *data)
{
  subject *s = data;
  const sunrealtype one = 1;
  dtrsm_("L", "L", "N", "N", &s->d, &s->d, &one, s->W, &s->d, s->C, &s->d, 1, 1, 1, 1);
}

/* ---- a subject ---- */

static int run_of(subject *s, long steps, sunrealtype *exponent, sunrealtype *seconds)
{
  const steif_lyapunov_options o = {
    .h = s->h, .t1 = s->problem.t0 + (sunrealtype)steps * s->h, .linear = -1};
  const sunrealtype from = stf_now();
  STEIF_TRY(steif_lyapunov(s->ctx, &s->problem, s->method, &o, exponent, NULL, NULL));
  *seconds = stf_now() - from;
  return STEIF_OK;
}

/* Of a step in the middle of a run: two lengths, the difference. */
static int whole_step(subject *s, sunrealtype *seconds)
{
  const long steps = s->d < 10 ? 4000 : s->d < 100 ? 400 : 20;
  sunrealtype least = INFINITY, more = INFINITY, took;
  for (int k = 0; k < 5; k++) {
    STEIF_TRY(run_of(s, steps, s->work, &took));
    least = fmin(least, took);
    STEIF_TRY(run_of(s, 3 * steps, s->work, &took));
    more = fmin(more, took);
  }
  *seconds = (more - least) / (2 * (sunrealtype)steps);
  return STEIF_OK;
}

static void release(subject *s)
{
  if (s->J) SUNMatDestroy(s->J);
  N_Vector v[] = {s->y, s->fy, s->tmp[0], s->tmp[1], s->tmp[2]};
  for (int i = 0; i < 5; i++)
    if (v[i]) N_VDestroy(v[i]);
  steif_problem_clear(s->ctx, &s->problem);
}

static int open(stf_pool *pool, subject *s, const steif_glm *g)
{
  const size_t d = (size_t)s->problem.n;
  s->d = (int)d;
  s->order = stf_glm_shape(g) == STEIF_COLLOCATION ? g->r * s->d : s->d;
  s->length = 64 * s->d;
  s->y = N_VNew_Serial(s->problem.n, steif_sundials(s->ctx));
  s->J = SUNDenseMatrix(s->problem.n, s->problem.n, steif_sundials(s->ctx));
  s->fy = s->y ? N_VClone(s->y) : NULL;
  for (int i = 0; i < 3; i++) s->tmp[i] = s->y ? N_VClone(s->y) : NULL;
  const size_t n = (size_t)s->order;
  s->A = stf_claim(pool, n * n + n * d + 2 * d * d + 65 * d, sizeof *s->A);
  s->pivot = stf_claim(pool, n, sizeof *s->pivot);
  STEIF_CHECK(s->J && s->fy && s->tmp[0] && s->tmp[1] && s->tmp[2] && s->A && s->pivot, s->ctx,
              STEIF_NO_MEMORY, "no memory for a benchmark");
  s->B = s->A + n * n, s->C = s->B + n * d, s->W = s->C + d * d, s->work = s->W + d * d;
  memcpy(N_VGetArrayPointer(s->y), s->problem.y0, d * sizeof *s->W);
  for (size_t i = 0; i < n * d; i++) s->B[i] = sin((sunrealtype)i);
  for (size_t i = 0; i < d * d; i++)
    s->W[i] = i % (d + 1) ? cos((sunrealtype)i) / (sunrealtype)d : 1;
  return s->problem.f(0, s->y, s->fy, s->problem.user) ? STEIF_CALLBACK : STEIF_OK;
}

/* Kernels of a step: J and its product for every stage, the stage systems, Q R, X R^{-1}. */
static sunrealtype kernels(subject *s, const steif_glm *g)
{
  const enum steif_table_kind shape = stf_glm_shape(g);
  const int systems = shape == STEIF_EXPLICIT ? 0 : shape == STEIF_DIRK ? g->r : 1;
  sunrealtype sum = g->r * (stf_time(jacobian, s) + stf_time(product, s));
  if (systems) sum += systems * stf_time(elimination, s);
  return sum + stf_time(orthogonal, s) + g->k * stf_time(division, s);
}

int steif_bench_lyapunov(steif_context *ctx, size_t i, steif_bench_row *row)
{
  if (i >= sizeof plan / sizeof *plan) return STEIF_BAD_INPUT;
  subject s = {.ctx = ctx, .method = plan[i].method, .h = plan[i].h};
  *row = (steif_bench_row){.kind = "lyapunov", .limit = 1.3};
  snprintf(row->problem, sizeof row->problem, "%s", plan[i].problem);
  snprintf(row->method, sizeof row->method, "%s", plan[i].method);
  sunrealtype alone = 0;
  stf_pool *pool = stf_pool_new(ctx);
  steif_glm *g = steif_glm_new(ctx, s.method);
  int code =
    pool && g ? steif_problem_find(ctx, plan[i].problem, &s.problem) : steif_status(ctx);
  if (!code) code = open(pool, &s, g);
  row->n = s.problem.n;
  if (!code) code = whole_step(&s, &row->step_s);
  if (!code)
    code = stf_time_steps(ctx, plan[i].problem, s.method, s.d < 100 ? 2000 : 50, s.h, &alone);
  if (!code) row->floor_s = alone + kernels(&s, g);
  row->ratio = row->step_s / row->floor_s;
  release(&s);
  steif_glm_free(ctx, &g);
  stf_pool_free(&pool);
  return code;
}
