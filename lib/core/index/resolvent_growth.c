/* resolvent_growth.c: test G: with which powers of s do rows and columns of (s E - A)^{-1} grow.
 *
 * Row j of the inverse applied to random vectors at s and 4 s: log_4 of the ratio is the
 * degree r_j once s is beyond the finite eigenvalues. 1 + max r_j is the Kronecker index,
 * 1 + r_j the number of unknown j, and a column of degree q_i >= 1 belongs to an equation
 * that is differentiated q_i times on the way to the solution.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "evidence.h"
#include "index_thresholds.h"
#include <math.h>
#include <string.h>

typedef struct growth_work {
  size_t n;
  int vectors;
  sunrealtype *right, *weight; /* 2 n units: of equations, then of unknowns */
  sunrealtype *top[2];         /* 2 n each: largest of row j, then of column i, at s and 4 s */
  int *degree;                 /* 2 n, of the level before */
  const int *bound;            /* n numbers that cannot be exceeded; NULL: none known */
} growth_work;

static int claim(stf_pool *pool, growth_work *w)
{
  w->right = stf_pool_array(pool, 7 * w->n, sizeof *w->right);
  w->degree = stf_pool_array(pool, 2 * w->n, sizeof *w->degree);
  if (!w->right || !w->degree) return STEIF_NO_MEMORY;
  w->weight = w->right + w->n;
  w->top[0] = w->right + 3 * w->n;
  w->top[1] = w->right + 5 * w->n;
  return STEIF_OK;
}

/* Units of equations (terms at the rate `base`) and reciprocal units of unknowns. */
static void weigh(const stf_point *s, const stf_view *v, sunrealtype base, growth_work *w)
{
  for (size_t j = 0; j < w->n; j++) {
    w->weight[w->n + j] = 1 / s->size[j];
    for (sunindextype k = v->column[j]; k < v->column[j + 1]; k++)
      w->weight[v->row[k]] =
        fmax(w->weight[v->row[k]], (fabs(v->b[k]) + base * fabs(v->e[k])) * s->size[j]);
  }
}

static int probe(stf_factor *f, const stf_view *v, sunrealtype s, growth_work *w,
                 sunrealtype *top)
{
  unsigned seed = 20131u;
  STEIF_TRY(stf_factor_shift(f, v, s));
  memset(top, 0, 2 * w->n * sizeof *top);
  for (int k = 0; k < 2 * w->vectors; k++) {
    const size_t at = k % 2 ? w->n : 0;
    for (size_t i = 0; i < w->n; i++) {
      const sunrealtype x = stf_point_random(&seed);
      w->right[i] = (x + (x < 0 ? -0.3 : 0.3)) * w->weight[at + i];
    }
    STEIF_TRY(stf_factor_solve(f, k % 2, w->right));
    for (size_t i = 0; i < w->n; i++) top[at + i] = fmax(top[at + i], fabs(w->right[i]));
  }
  return STEIF_OK;
}

/* Degrees of this level; true if they are near whole numbers. */
static bool read_degrees(const growth_work *w, int *degree)
{
  bool good = true;
  for (size_t i = 0; i < 2 * w->n; i++) {
    const sunrealtype x = log(w->top[1][i] / w->top[0][i]) / log(4);
    degree[i] = isfinite(x) ? (int)lround(x) : 99;
    good = good && fabs(x - degree[i]) < STF_WHOLE_DEGREE;
  }
  return good;
}

/* Beyond the bound of the structure s is among the finite eigenvalues still. */
static bool within(const growth_work *w, const int *degree)
{
  for (size_t j = 0; w->bound && j < w->n; j++)
    if (degree[j] >= w->bound[j]) return false;
  return true;
}

static int find_degrees(const stf_view *v, stf_factor *f, sunrealtype base, growth_work *w,
                        stf_resolvent_growth *g)
{
  bool before = false;
  sunrealtype s = base * STF_FIRST_SHIFT;
  for (int level = 0; level < STF_SHIFTS && !g->found; level++, s *= STF_SHIFT_RATIO) {
    for (int k = 0; k < 2; k++) {
      const int code = probe(f, v, k ? 4 * s : s, w, w->top[k]);
      if (code) return code == STEIF_SINGULAR ? STEIF_OK : code;
    }
    const bool now = read_degrees(w, g->row) && within(w, g->row);
    g->found = now && before && !memcmp(g->row, w->degree, 2 * w->n * sizeof *g->row);
    memcpy(w->degree, g->row, 2 * w->n * sizeof *g->row);
    before = now;
  }
  return STEIF_OK;
}

static int check_shifts(const stf_view *v, stf_factor *f, sunrealtype base,
                        stf_resolvent_growth *g)
{
  static const sunrealtype at[] = {0.37, 1.91, 7.3};
  g->rcond = 0;
  for (int k = 0; k < 3; k++) {
    sunrealtype rcond = 0;
    const int code = stf_factor_shift(f, v, at[k] * base);
    if (code && code != STEIF_SINGULAR) return code;
    if (!code) STEIF_TRY(stf_factor_rcond(f, &rcond));
    g->rcond = fmax(g->rcond, rcond);
  }
  g->singular = g->rcond < STF_SINGULAR_NOISE * (sunrealtype)v->n * STF_EPS;
  return STEIF_OK;
}

static int find(stf_point *point, stf_pool *pool, const stf_view *v, stf_factor *f,
                const int *bound, stf_resolvent_growth *g)
{
  growth_work w = {.n = v->n,
                   .bound = bound,
                   .vectors = v->n > STEIF_DIAGNOSE_LARGEST ? STF_RANDOM_VECTORS_LARGE
                                                            : STF_RANDOM_VECTORS};
  sunrealtype slowest, base;
  STEIF_TRY(claim(pool, &w));
  stf_view_rates(point, v, &slowest, &base);
  weigh(point, v, base, &w);
  g->found = g->singular = false, g->index = -1;
  if (!bound) STEIF_TRY(check_shifts(v, f, base, g)); /* else the pencil is regular */
  if (g->singular) return STEIF_OK;
  STEIF_TRY(find_degrees(v, f, base, &w, g));
  if (!g->found) return STEIF_OK;
  for (size_t j = 0; j < v->n; j++)
    g->index = g->row[j] + 1 > g->index ? g->row[j] + 1 : g->index;
  return STEIF_OK;
}

int stf_resolvent_growth_find(stf_point *point, const stf_view *v, stf_factor *f,
                              const int *bound, stf_resolvent_growth *g)
{
  if (!g->row) {
    if (!(g->row = stf_pool_array(point->pool, 2 * v->n, sizeof *g->row)))
      return STEIF_NO_MEMORY;
    g->column = g->row + v->n;
  }
  stf_pool *pool = stf_pool_new(point->ctx);
  if (!pool) return STEIF_NO_MEMORY;
  const int code = find(point, pool, v, f, bound, g);
  stf_pool_free(&pool);
  return code;
}
