/* impulse.c: the analysis of a large descriptor system against its factorisations and solves.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "impulse_cost.h"
#include "timing.h"
#include <klu.h>
#include <math.h>
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

/* ---- growth ----------------------------------------------------------------------------------- */

/* Length of "ladder" in "ladder:n=295". */
static size_t family(const char *problem) { return strcspn(problem, ":"); }

static bool related(const steif_bench_impulse *a, const steif_bench_impulse *b)
{
  const size_t length = family(a->problem);
  return length == family(b->problem) && !strncmp(a->problem, b->problem, length);
}

steif_bench_growth steif_bench_exponents(const steif_bench_impulse *row, size_t count,
                                         size_t of)
{
  steif_bench_growth g = {.rows = 0};
  sunrealtype mean = 0, square = 0, cpu = 0, floor = 0;
  snprintf(g.family, sizeof g.family, "%.*s", (int)family(row[of].problem), row[of].problem);
  for (size_t i = 0; i < count; i++)
    if (related(row + i, row + of)) {
      g.rows++;
      mean += log((sunrealtype)row[i].n);
    }
  mean /= (sunrealtype)g.rows;
  for (size_t i = 0; i < count; i++) {
    if (!related(row + i, row + of)) continue;
    const sunrealtype d = log((sunrealtype)row[i].n) - mean;
    square += d * d;
    cpu += d * log(row[i].cpu_s);
    floor += d * log(row[i].floor_s);
  }
  g.cpu = square > 0 ? cpu / square : NAN;
  g.floor = square > 0 ? floor / square : NAN;
  return g;
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
  row->cpu_s = stf_now() - cpu;
  row->wall_s = wall() - from;
  row->factors = s.cost.factors + i.cost.factors;
  row->refactors = s.cost.refactors + i.cost.refactors;
  row->solves = s.cost.solves + i.cost.solves;
  row->estimate = i.estimate;
  row->certified = i.certified;
  q->radius = s.radius;
  steif_impulse_clear(q->ctx, &i);
  steif_structure_clear(q->ctx, &s);
  return code;
}

/* Small systems several times, the least of them; as often the kernels. */
static int repeats(sunrealtype first)
{
  const sunrealtype enough = 0.3;
  enum { LEAST = 3, MOST = 9 };
  return first > 0 && first * MOST > enough ? (int)fmax(LEAST, enough / first) : MOST;
}

static int repeat(subject *q, steif_bench_impulse *row)
{
  STEIF_TRY(analyse(q, row));
  steif_bench_impulse least = *row;
  for (int k = repeats(row->cpu_s); k > 1; k--) {
    STEIF_TRY(analyse(q, row));
    least.wall_s = fmin(least.wall_s, row->wall_s);
    least.cpu_s = fmin(least.cpu_s, row->cpu_s);
  }
  *row = least;
  return STEIF_OK;
}

/* ---- the kernels --------------------------------------------------------------------------------- */

/* s E + F by columns, and what KLU makes of it. */
typedef struct kernel {
  SuiteSparse_long n, *at, *row;
  sunrealtype *e, *f, *value, *b;
  klu_l_common common;
  klu_l_symbolic *symbolic;
  klu_l_numeric *numeric;
} kernel;

/* Entries of column j of M; place: where row i of this column stands, if at or after the first of the column. */
static void put(kernel *k, SUNMatrix M, sunindextype j, sunrealtype *to,
                SuiteSparse_long *place, SuiteSparse_long *next)
{
  for (sunindextype p = SM_INDEXPTRS_S(M)[j]; p < SM_INDEXPTRS_S(M)[j + 1]; p++) {
    const sunindextype i = SM_INDEXVALS_S(M)[p];
    if (place[i] < k->at[j]) {
      place[i] = (*next)++;
      k->row[place[i]] = i;
    }
    to[place[i]] += SM_DATA_S(M)[p];
  }
}

static int unite(stf_pool *pool, const subject *q, kernel *k)
{
  SUNMatrix E = q->linear.E, F = q->linear.F;
  const sunindextype n = SM_COLUMNS_S(E);
  const size_t most = (size_t)(SM_INDEXPTRS_S(E)[n] + SM_INDEXPTRS_S(F)[n]);
  SuiteSparse_long *place = stf_pool_array(pool, (size_t)n, sizeof *place), next = 0;
  k->at = stf_pool_array(pool, (size_t)n + 1, sizeof *k->at);
  k->row = stf_pool_array(pool, most, sizeof *k->row);
  k->e = stf_pool_array(pool, 4 * most, sizeof *k->e);
  k->f = k->e + most;
  k->value = k->f + most;
  k->b = stf_pool_array(pool, 2 * (size_t)n, sizeof *k->b);
  k->n = n;
  if (!place || !k->at || !k->row || !k->e || !k->b) return STEIF_NO_MEMORY;
  for (sunindextype i = 0; i < n; i++) place[i] = -1;
  for (sunindextype j = 0; j < n; j++) {
    k->at[j] = next;
    put(k, E, j, k->e, place, &next);
    put(k, F, j, k->f, place, &next);
  }
  k->at[n] = next;
  return STEIF_OK;
}

/* The matrix at s = R e^{i angle} and a right-hand side: work of the analysis, not of KLU. */
static void assemble(kernel *k, sunrealtype R, sunrealtype angle)
{
  const sunrealtype re = R * cos(angle), im = R * sin(angle);
  for (SuiteSparse_long p = 0; p < k->at[k->n]; p++) {
    k->value[2 * p] = re * k->e[p] + k->f[p];
    k->value[2 * p + 1] = im * k->e[p];
  }
  for (SuiteSparse_long i = 0; i < k->n; i++) {
    k->b[2 * i] = 1;
    k->b[2 * i + 1] = 0;
  }
}

static bool call(kernel *k, bool pivots, long solves)
{
  if (pivots && k->numeric) klu_zl_free_numeric(&k->numeric, &k->common);
  if (pivots)
    k->numeric = klu_zl_factor(k->at, k->row, k->value, k->symbolic, &k->common);
  else
    klu_zl_refactor(k->at, k->row, k->value, k->symbolic, k->numeric, &k->common);
  for (; solves > 0 && k->numeric; solves--)
    klu_zl_solve(k->symbolic, k->numeric, k->n, 1, k->b, &k->common);
  return k->numeric && k->common.status == KLU_OK;
}

/* As many factorisations, with pivots and without, and solves as the analysis took, around its
 * circle and each on a matrix of its own. */
static bool replay(kernel *k, const subject *q, steif_bench_impulse *row)
{
  const long points = row->factors + row->refactors;
  sunrealtype spent = 0, passed = 0;
  bool good = true;
  for (long i = 0; i < points && good; i++) {
    assemble(k, q->radius, 3.14159265358979 * ((double)i + 0.5) / (double)points);
    const long solves = (i + 1) * row->solves / points - i * row->solves / points;
    const sunrealtype cpu = stf_now(), from = wall();
    good = call(k, i < row->factors, solves);
    spent += stf_now() - cpu;
    passed += wall() - from;
  }
  row->floor_s = fmin(row->floor_s, spent);
  row->floor_wall_s = fmin(row->floor_wall_s, passed);
  return good;
}

static int direct(stf_pool *pool, subject *q, steif_bench_impulse *row)
{
  kernel k = {0};
  STEIF_TRY(unite(pool, q, &k));
  klu_l_defaults(&k.common);
  const sunrealtype from = stf_now();
  k.symbolic = klu_l_analyze(k.n, k.at, k.row, &k.common);
  row->analyse_s = stf_now() - from;
  row->floor_s = row->floor_wall_s = INFINITY;
  bool good = k.symbolic != NULL;
  for (int left = repeats(row->cpu_s); good && left > 0; left--) good = replay(&k, q, row);
  if (k.numeric) klu_zl_free_numeric(&k.numeric, &k.common);
  if (k.symbolic) klu_l_free_symbolic(&k.symbolic, &k.common);
  STEIF_CHECK(good, q->ctx, STEIF_SINGULAR, "KLU could not factor '%s' directly, status %d",
              row->problem, (int)k.common.status);
  row->ratio = row->cpu_s / row->floor_s;
  return STEIF_OK;
}

static int open(subject *q, steif_bench_impulse *row)
{
  STEIF_TRY(steif_problem_find(q->ctx, row->problem, &q->problem));
  STEIF_TRY(steif_linear_of(q->ctx, &q->problem, &q->linear));
  row->n = q->problem.n;
  return STEIF_OK;
}

static void close(subject *q)
{
  if (q->linear.E) {
    SUNMatDestroy(q->linear.E);
    SUNMatDestroy(q->linear.F);
  }
  steif_problem_clear(q->ctx, &q->problem);
}

static int measure(subject *q, steif_bench_impulse *row)
{
  STEIF_TRY(open(q, row));
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

/* The same with as many threads as there are, in wall-clock time. */
static int together(subject *q, steif_bench_impulse *row)
{
  steif_bench_impulse now = *row;
  STEIF_TRY(open(q, &now));
  STEIF_TRY(repeat(q, &now));
  row->wall_s = now.wall_s;
  row->wall_ratio = now.wall_s / row->floor_wall_s;
  row->threads = stf_threads(q->ctx);
  return STEIF_OK;
}

static int in_context(steif_context *ctx, int (*run)(subject *q, steif_bench_impulse *row),
                      steif_bench_impulse *row)
{
  subject q = {.ctx = ctx};
  const int code = run(&q, row);
  close(&q);
  return code;
}

int steif_bench_circles(steif_context *ctx, const char *problem, steif_bench_impulse *row)
{
  steif_context *alone = steif_context_new(&(steif_setup){.threads = 1});
  STEIF_CHECK(alone, ctx, STEIF_NO_MEMORY, "no memory for a context of one thread");
  *row = (steif_bench_impulse){0};
  snprintf(row->problem, sizeof row->problem, "%s", problem);
  const int code = in_context(alone, measure, row);
  if (code) STEIF_FAIL(ctx, code, "%s", steif_message(alone));
  steif_context_free(&alone);
  return code ? code : in_context(ctx, together, row);
}
