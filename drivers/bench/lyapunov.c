/* lyapunov.c: a step with Lyapunov exponents against the step alone and the kernels they take.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "kernels.h"
#include "timing.h"
#include "lapack.h"
#include "general.h"
#include "jacobian.h"
#include <klu.h>
#include <math.h>
#include <steif/collection.h>
#include <steif/lyapunov.h>
#include <stdio.h>
#include <string.h>

static const struct {
  const char *problem, *method;
  sunrealtype h;
  int count; /* exponents; 0: all */
} plan[] = {
  {"vdpol:mu=10", "rk4", 1e-3, 0},
  {"lorenz96:n=20", "rk4", 1e-2, 0},
  {"lorenz96:n=200", "rk4", 1e-2, 0},
  {"vdpol:mu=10", "bdf:p=2", 1e-3, 0},
  {"lorenz96:n=20", "bdf:p=2", 1e-2, 0},
  {"lorenz96:n=200", "bdf:p=2", 1e-2, 0},
  {"vdpol:mu=10", "radau:s=2", 1e-3, 0},
  {"lorenz96:n=20", "radau:s=2", 1e-2, 0},
  {"lorenz96:n=200", "radau:s=2", 1e-2, 0},
  {"lorenz96:n=200,storage=sparse", "rk4", 1e-2, 0},
  {"lorenz96:n=200,storage=sparse", "bdf:p=2", 1e-2, 0},
  {"lorenz96:n=200,storage=sparse", "radau:s=2", 1e-2, 0},
  {"lorenz96:n=10000", "rk4", 1e-2, 10},
  {"lorenz96:n=10000", "bdf:p=2", 1e-2, 10},
  {"lorenz96:n=10000", "radau:s=2", 1e-2, 10},
};

typedef struct subject {
  steif_context *ctx;
  steif_problem problem;
  const char *method;
  sunrealtype h;
  int d, m, order, length;
  bool dense;
  SUNMatrix J;
  N_Vector y, fy, tmp[3];
  sunrealtype *A, *B, *C, *W, *work;
  int *pivot;
  klu_l_common klu; /* of the stages of a sparse problem: entries in A */
  klu_l_symbolic *symbolic;
  klu_l_numeric *numeric;
  SuiteSparse_long *column, *row;
} subject;

/* ---- kernels ---- */

static void jacobian(void *data)
{
  subject *s = data;
  if (s->dense) stf_jacobian_clear(s->J);
  s->problem.jac(0, s->y, s->fy, s->J, s->problem.user, s->tmp[0], s->tmp[1], s->tmp[2]);
}

/* By dgemm; of a sparse J by the loop over its entries, each times a row of m numbers. */
static void product(void *data)
{
  subject *s = data;
  if (s->dense)
    stf_multiply(s->d, s->d, s->W, s->B, 0, s->C);
  else
    stf_jacobian_times(s->J, s->m, s->h, s->W, s->C);
}

/* Diagonally dominant: no pivot moves, the work is the same. */
static void elimination(void *data)
{
  subject *s = data;
  const int n = s->order;
  int info;
  if (!s->dense) {
    klu_l_refactor(s->column, s->row, s->A, s->symbolic, s->numeric, &s->klu);
    klu_l_solve(s->symbolic, s->numeric, n, s->m, s->B, &s->klu);
    return;
  }
  memset(s->A, 0, (size_t)n * (size_t)n * sizeof *s->A);
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) s->A[i * n + j] = i == j ? n : 0.5;
  dgetrf_(&n, &n, s->A, &n, s->pivot, &info);
  dgetrs_("T", &n, &s->m, s->A, &n, s->pivot, s->B, &n, &info, 1);
}

static void orthogonal(void *data)
{
  subject *s = data;
  int info;
  memcpy(s->C, s->W, (size_t)s->d * (size_t)s->m * sizeof *s->C);
  dgelqf_(&s->m, &s->d, s->C, &s->m, s->work, s->work + s->m, &s->length, &info);
}

static void division(void *data)
{
  subject *s = data;
  const sunrealtype one = 1;
  dtrsm_("L", "L", "N", "N", &s->m, &s->d, &one, s->W, &s->m, s->C, &s->m, 1, 1, 1, 1);
}

/* ---- a subject ---- */

static int run_of(subject *s, long steps, sunrealtype *exponent, sunrealtype *seconds)
{
  const steif_lyapunov_options o = {
    .h = s->h, .t1 = s->problem.t0 + (sunrealtype)steps * s->h, .linear = -1, .count = s->m};
  const sunrealtype from = stf_now();
  STEIF_TRY(steif_lyapunov(s->ctx, &s->problem, s->method, &o, exponent, NULL, NULL));
  *seconds = stf_now() - from;
  return STEIF_OK;
}

/* Of a step in the middle of a run: two lengths, the difference. */
static int whole_step(subject *s, sunrealtype *seconds)
{
  const long steps = s->d < 10 ? 4000 : s->d < 100 ? 400 : s->d < 1000 ? 20 : 10;
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
  N_Vector v[] = {s->y, s->fy, s->tmp[0], s->tmp[1], s->tmp[2]};
  for (int i = 0; i < 5; i++)
    if (v[i]) N_VDestroy(v[i]);
  if (s->numeric) klu_l_free_numeric(&s->numeric, &s->klu);
  if (s->symbolic) klu_l_free_symbolic(&s->symbolic, &s->klu);
  steif_problem_clear(s->ctx, &s->problem);
}

/* I - h J in each of blocks x blocks, as sparse as the stages are. */
static void fill_stages(subject *s)
{
  const int blocks = s->order / s->d;
  SuiteSparse_long used = 0;
  for (int at = 0; at < s->order; at++) {
    const stf_entries from = stf_jacobian_column(s->J, at % s->d);
    s->column[at] = used;
    for (int i = 0; i < blocks; i++)
      for (sunindextype e = 0; e < from.count; e++, used++) {
        s->row[used] = i * s->d + stf_row_of(&from, e);
        s->A[used] = (s->row[used] == at) - s->h / (1 + i) * from.value[e];
      }
  }
  s->column[s->order] = used;
}

static int open_sparse(stf_pool *pool, subject *s)
{
  const size_t blocks = (size_t)(s->order / s->d),
               most = blocks * blocks * (size_t)s->problem.nnz;
  s->A = stf_pool_array(pool, most, sizeof *s->A);
  s->row = stf_pool_array(pool, most, sizeof *s->row);
  s->column = stf_pool_array(pool, (size_t)s->order + 1, sizeof *s->column);
  if (!s->A || !s->row || !s->column) return STEIF_NO_MEMORY;
  jacobian(s);
  fill_stages(s);
  klu_l_defaults(&s->klu);
  s->klu.ordering = 0; /* AMD */
  s->symbolic = klu_l_analyze(s->order, s->column, s->row, &s->klu);
  if (s->symbolic) s->numeric = klu_l_factor(s->column, s->row, s->A, s->symbolic, &s->klu);
  STEIF_CHECK(s->numeric, s->ctx, STEIF_SINGULAR, "KLU could not factor the stages of '%s'",
              s->problem.name);
  return STEIF_OK;
}

static int open_dense(stf_pool *pool, subject *s)
{
  const size_t n = (size_t)s->order;
  s->A = stf_pool_array(pool, n * n, sizeof *s->A);
  s->pivot = stf_pool_array(pool, n, sizeof *s->pivot);
  return s->A && s->pivot ? STEIF_OK : STEIF_NO_MEMORY;
}

static int open(stf_pool *pool, subject *s, const steif_glm *g)
{
  const steif_problem *p = &s->problem;
  const size_t d = (size_t)p->n, m = s->m ? (size_t)s->m : d;
  s->d = (int)d;
  s->m = (int)m;
  s->dense = p->storage == STEIF_DENSE;
  s->order = stf_glm_shape(g) == STEIF_COLLOCATION ? g->r * s->d : s->d;
  s->length = 64 * s->m;
  s->y = N_VNew_Serial(p->n, steif_sundials(s->ctx));
  s->fy = s->y ? N_VClone(s->y) : NULL;
  for (int i = 0; i < 3; i++) s->tmp[i] = s->y ? N_VClone(s->y) : NULL;
  const size_t n = (size_t)s->order;
  s->J = stf_jacobian_new(pool, s->ctx, p->storage, p->n, p->lower, p->upper, p->nnz);
  s->B = stf_pool_array(pool, n * m + 2 * d * m + 65 * m, sizeof *s->B);
  STEIF_CHECK(s->J && s->fy && s->tmp[0] && s->tmp[1] && s->tmp[2] && s->B, s->ctx,
              STEIF_NO_MEMORY, "no memory for a benchmark");
  s->C = s->B + n * m;
  s->W = s->C + d * m;
  s->work = s->W + d * m;
  memcpy(N_VGetArrayPointer(s->y), p->y0, d * sizeof *s->W);
  for (size_t i = 0; i < n * m; i++) s->B[i] = sin((sunrealtype)i);
  for (size_t i = 0; i < d * m; i++)
    s->W[i] = i % (m + 1) ? cos((sunrealtype)i) / (sunrealtype)d : 1;
  if (p->f(0, s->y, s->fy, p->user)) return STEIF_CALLBACK;
  return s->dense ? open_dense(pool, s) : open_sparse(pool, s);
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
  subject s = {.ctx = ctx, .method = plan[i].method, .h = plan[i].h, .m = plan[i].count};
  *row = (steif_bench_row){.kind = "lyapunov", .limit = 1.3, .h = plan[i].h};
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
