/* impulse.c: the analysis of a large descriptor system against its factorisations and solves.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "bench.h"
#include <klu.h>
#include <stdio.h>
#include <steif/collection.h>
#include <steif/impulse.h>
#include <string.h>
#include <sunmatrix/sunmatrix_sparse.h>
#include <sys/resource.h>
#include <time.h>

/* A node of the ladder has 3.4 unknowns, a mass of the chain 2.1. */
static const char *const plan[] = {"ladder:n=295",    "springs:n=476",    "ladder:n=2942",
                                   "springs:n=4762",  "ladder:n=29412",   "springs:n=47619",
                                   "ladder:n=247059", "springs:n=400000", "ladder:n=294118",
                                   "springs:n=476190"};

const char *steif_bench_system(size_t i)
{
  return i < sizeof plan / sizeof *plan ? plan[i] : NULL;
}

static sunrealtype peak(void)
{
  struct rusage used;
  return getrusage(RUSAGE_SELF, &used) ? 0 : 1024 * (sunrealtype)used.ru_maxrss;
}

static sunrealtype wall(void)
{
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (sunrealtype)t.tv_sec + 1e-9 * (sunrealtype)t.tv_nsec;
}

/* ---- the analysis -------------------------------------------------------------------------------- */

typedef struct subject {
  steif_context *ctx;
  steif_problem problem;
  steif_linear linear;
  sunrealtype radius; /* of the circles */
} subject;

static int analyse(subject *q, steif_bench_impulse *row)
{
  const steif_linear *l = &q->linear;
  const steif_analysis circles = {.algorithm = STEIF_CONTOUR};
  steif_structure s = {0};
  steif_impulse i = {0};
  const sunrealtype cpu = stf_now(), from = wall();
  int code = steif_structure_find(q->ctx, l->E, l->F, &circles, &s);
  if (!code)
    code =
      steif_impulse_find(q->ctx, l->E, l->F, q->problem.y0, 0, l->f, l->user, &circles, &s, &i);
  row->cpu_s = stf_now() - cpu, row->wall_s = wall() - from;
  row->factors = s.cost.factors + i.cost.factors;
  row->refactors = s.cost.refactors + i.cost.refactors;
  row->solves = s.cost.solves + i.cost.solves;
  row->estimate = i.estimate, row->certified = i.certified;
  q->radius = s.radius;
  steif_impulse_clear(q->ctx, &i);
  steif_structure_clear(q->ctx, &s);
  return code;
}

/* Small systems several times, the least of them. */
static int repeat(subject *q, steif_bench_impulse *row)
{
  const sunrealtype long_enough = 0.3;
  sunrealtype least, first;
  STEIF_TRY(analyse(q, row));
  least = first = row->cpu_s;
  for (int k = 1; k < 9 && (k + 1) * first < long_enough; k++) {
    const sunrealtype before = row->wall_s;
    STEIF_TRY(analyse(q, row));
    if (before < row->wall_s) row->wall_s = before;
    if (row->cpu_s < least) least = row->cpu_s;
  }
  row->cpu_s = least;
  return STEIF_OK;
}

/* ---- the kernels --------------------------------------------------------------------------------- */

/* s E + F by columns, s = R (cos 1 + i sin 1), and what KLU makes of it. */
typedef struct kernel {
  sunindextype n, *at, *row;
  sunrealtype *value, *b;
  klu_l_common common;
  klu_l_symbolic *symbolic;
  klu_l_numeric *numeric;
} kernel;

static void factor(void *data)
{
  kernel *k = data;
  if (k->numeric) klu_zl_free_numeric(&k->numeric, &k->common);
  k->numeric = klu_zl_factor(k->at, k->row, k->value, k->symbolic, &k->common);
}

static void refactor(void *data)
{
  kernel *k = data;
  klu_zl_refactor(k->at, k->row, k->value, k->symbolic, k->numeric, &k->common);
}

static void solve(void *data)
{
  kernel *k = data;
  klu_zl_solve(k->symbolic, k->numeric, k->n, 1, k->b, &k->common);
}

/* Entries of column j of M times s; place: where row i of this column stands, if at or behind
 * `first`. */
static void put(kernel *k, SUNMatrix M, sunindextype j, const sunrealtype s[2],
                sunindextype *place, sunindextype *next)
{
  for (sunindextype p = SM_INDEXPTRS_S(M)[j]; p < SM_INDEXPTRS_S(M)[j + 1]; p++) {
    const sunindextype i = SM_INDEXVALS_S(M)[p];
    if (place[i] < k->at[j]) place[i] = (*next)++, k->row[place[i]] = i;
    k->value[2 * place[i]] += s[0] * SM_DATA_S(M)[p];
    k->value[2 * place[i] + 1] += s[1] * SM_DATA_S(M)[p];
  }
}

static int assemble(stf_pool *pool, const subject *q, kernel *k)
{
  SUNMatrix E = q->linear.E, F = q->linear.F;
  const sunrealtype s[2] = {0.5403 * q->radius, 0.8415 * q->radius}, one[2] = {1, 0};
  const sunindextype n = k->n = SM_COLUMNS_S(E);
  const size_t most = (size_t)(SM_INDEXPTRS_S(E)[n] + SM_INDEXPTRS_S(F)[n]);
  sunindextype *place = stf_claim(pool, (size_t)n, sizeof *place), next = 0;
  k->at = stf_claim(pool, (size_t)n + 1, sizeof *k->at);
  k->row = stf_claim(pool, most, sizeof *k->row);
  k->value = stf_claim(pool, 2 * most, sizeof *k->value);
  k->b = stf_claim(pool, 2 * (size_t)n, sizeof *k->b);
  if (!place || !k->at || !k->row || !k->value || !k->b) return STEIF_NO_MEMORY;
  for (sunindextype i = 0; i < n; i++) place[i] = -1, k->b[2 * i] = 1;
  for (sunindextype j = 0; j < n; j++) {
    k->at[j] = next;
    put(k, E, j, s, place, &next);
    put(k, F, j, one, place, &next);
  }
  k->at[n] = next;
  return STEIF_OK;
}

/* Once where it takes long. */
static sunrealtype seconds(void (*work)(void *), kernel *k)
{
  const sunrealtype from = stf_now();
  work(k);
  const sunrealtype took = stf_now() - from;
  return took > 0.1 ? took : stf_time(work, k);
}

static int direct(stf_pool *pool, subject *q, steif_bench_impulse *row)
{
  kernel k = {0};
  STEIF_TRY(assemble(pool, q, &k));
  klu_l_defaults(&k.common);
  k.symbolic = klu_l_analyze(k.n, k.at, k.row, &k.common);
  if (k.symbolic) row->floor_s = (sunrealtype)row->factors * seconds(factor, &k);
  const int good = k.symbolic && k.numeric && k.common.status == KLU_OK;
  if (good) row->floor_s += (sunrealtype)row->refactors * seconds(refactor, &k);
  if (good) row->floor_s += (sunrealtype)row->solves * seconds(solve, &k);
  if (k.numeric) klu_zl_free_numeric(&k.numeric, &k.common);
  if (k.symbolic) klu_l_free_symbolic(&k.symbolic, &k.common);
  STEIF_CHECK(good, q->ctx, STEIF_SINGULAR, "KLU could not factor '%s' directly, status %ld",
              row->problem, k.common.status);
  row->ratio = row->cpu_s / row->floor_s;
  return STEIF_OK;
}

static int measure(subject *q, steif_bench_impulse *row)
{
  STEIF_TRY(steif_problem_find(q->ctx, row->problem, &q->problem));
  STEIF_TRY(steif_linear_of(q->ctx, &q->problem, &q->linear));
  row->n = q->problem.n;
  const sunrealtype before = peak();
  STEIF_TRY(repeat(q, row));
  row->peak_mb = peak() / 1048576;
  row->bytes_per_unknown = (peak() - before) / (sunrealtype)row->n;
  stf_pool *pool = stf_pool_new(q->ctx);
  if (!pool) return STEIF_NO_MEMORY;
  const int code = direct(pool, q, row);
  stf_pool_free(&pool);
  return code;
}

int steif_bench_circles(steif_context *ctx, const char *problem, steif_bench_impulse *row)
{
  subject q = {.ctx = ctx};
  *row = (steif_bench_impulse){0};
  snprintf(row->problem, sizeof row->problem, "%s", problem);
  const int code = measure(&q, row);
  if (q.linear.E) SUNMatDestroy(q.linear.E), SUNMatDestroy(q.linear.F);
  steif_problem_clear(ctx, &q.problem);
  return code;
}
