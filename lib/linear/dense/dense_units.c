/* dense_units.c: the units a dense pencil is analysed in, by the largest entries of rows and columns or
 * by all entries.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "dense_units.h"
#include "dense_algebra.h"
#include "dense_thresholds.h"
#include "matching.h"
#include "prime_field.h"
#include "scaling.h"
#include "staircase.h"
#include <math.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

static void expand(SUNMatrix M, int n, sunrealtype *A)
{
  for (int j = 0; j < n; j++) {
    sunrealtype *a = A + (size_t)j * (size_t)n;
    if (SUNMatGetID(M) == SUNMATRIX_DENSE)
      memcpy(a, SM_COLUMN_D(M, j), (size_t)n * sizeof *a);
    else
      for (sunindextype p = SM_INDEXPTRS_S(M)[j]; p < SM_INDEXPTRS_S(M)[j + 1]; p++)
        a[SM_INDEXVALS_S(M)[p]] += SM_DATA_S(M)[p];
  }
}

/* A <- diag(2^row) A diag(2^column); nothing overflows on the way. */
static void shift(int n, const int *row, const int *column, sunrealtype *A)
{
  for (int j = 0; j < n; j++)
    for (int i = 0; i < n; i++) {
      sunrealtype *a = A + (size_t)j * (size_t)n + (size_t)i;
      if (*a != 0) *a = ldexp(*a, row[i] + column[j]);
    }
}

/* Rows and columns by their largest entries, on top of the exponents given. */
static void even(int *exponent, sunrealtype *work, stf_dense_units *u)
{
  const int n = u->n;
  shift(n, exponent, exponent + n, u->E);
  shift(n, exponent, exponent + n, u->F);
  stf_balance(n, u->E, u->F, u->row, u->column, work);
  for (int k = 0; k < 2 * n; k++) {
    sunrealtype *scale = k < n ? u->row + k : u->column + (k - n);
    const int more = ilogb(*scale);
    *scale = ldexp(*scale, exponent[k]);
    exponent[k] = more;
  }
  shift(n, exponent, exponent + n, u->E);
  shift(n, exponent, exponent + n, u->F);
}

static int fill(stf_pool *pool, SUNMatrix E, SUNMatrix F, int n, int *exponent,
                sunrealtype *work, stf_dense_units *u)
{
  *u = (stf_dense_units){.n = n, .other_index = -1};
  u->E = stf_pool_square(pool, n);
  u->F = stf_pool_square(pool, n);
  u->row = stf_pool_array(pool, 2 * (size_t)n, sizeof *u->row);
  if (!u->E || !u->F || !u->row) return STEIF_NO_MEMORY;
  u->column = u->row + n;
  expand(E, n, u->E);
  expand(F, n, u->F);
  even(exponent, work, u);
  return STEIF_OK;
}

static bool decided(const steif_structure *s) { return s->regular && s->index >= 0; }

/* The second units are taken for a regular pencil that seems singular in the first; what is singular
 * in its own numbers is so in all units. Else they only may raise a doubt. */
static int compare(steif_context *ctx, SUNMatrix E, SUNMatrix F, const steif_structure *one,
                   const steif_structure *two, bool *second, int *other_index)
{
  bool singular = true;
  stf_field field;
  if (!one->regular && two->regular) {
    STEIF_TRY(stf_field_open(ctx, E, F, false, &field));
    STEIF_TRY(stf_field_singular(ctx, &field, &singular));
  }
  *second = !singular;
  const bool differ = one->index != two->index || one->infinite != two->infinite;
  if (decided(one) && decided(two) && differ)
    *other_index = one->index < two->index ? one->index : two->index;
  else if (*second)
    *other_index = 0;
  return STEIF_OK;
}

static int look(steif_context *ctx, const steif_analysis *analysis, const stf_dense_units *u,
                steif_structure *found)
{
  return stf_staircase(ctx, u->n, u->E, u->F, analysis, NULL, found, NULL, NULL);
}

/* Both units are looked at. */
static int choose(steif_context *ctx, const steif_analysis *analysis, SUNMatrix E, SUNMatrix F,
                  const stf_dense_units *b, stf_dense_units *a)
{
  steif_structure one = {0}, two = {0};
  bool second = false;
  int other_index = -1;
  int code = look(ctx, analysis, a, &one);
  if (!code) code = look(ctx, analysis, b, &two);
  if (!code) code = compare(ctx, E, F, &one, &two, &second, &other_index);
  if (!code && second) *a = *b;
  a->other_index = other_index;
  steif_structure_clear(ctx, &one);
  steif_structure_clear(ctx, &two);
  return code;
}

int stf_dense_units_choose(steif_context *ctx, stf_pool *pool, const steif_analysis *analysis,
                           SUNMatrix E, SUNMatrix F, stf_dense_units *u)
{
  const bool dense = SUNMatGetID(E) == SUNMATRIX_DENSE;
  const int n = (int)(dense ? SM_COLUMNS_D(E) : SM_COLUMNS_S(E));
  enum stf_evenness evenness;
  stf_dense_units b;
  int *none = stf_pool_array(pool, 4 * (size_t)n, sizeof *none);
  sunrealtype *work = stf_pool_array(pool, 2 * (size_t)n, sizeof *work);
  if (!none || !work) return STEIF_NO_MEMORY;
  int *exponent = none + 2 * n;
  STEIF_TRY(stf_scaling_logarithmic(ctx, E, F, exponent, &evenness));
  STEIF_TRY(fill(pool, E, F, n, evenness == STF_EVEN ? exponent : none, work, u));
  if (evenness != STF_UNEVEN) return STEIF_OK;
  STEIF_TRY(fill(pool, E, F, n, exponent, work, &b));
  return choose(ctx, analysis, E, F, &b, u);
}

/* -- what small entries carry -------------------------------------------------------------- */

static sunrealtype largest(size_t count, const sunrealtype *A)
{
  sunrealtype most = 0;
  for (size_t k = 0; k < count; k++) most = fmax(most, fabs(A[k]));
  return most;
}

/* The graph of the entries above `least_e` and `least_f`. */
static int graph(stf_pool *pool, int n, const sunrealtype *e, sunrealtype least_e,
                 const sunrealtype *f, sunrealtype least_f, stf_graph *g)
{
  const size_t m = (size_t)n;
  sunindextype count = 0;
  for (size_t k = 0; k < m * m; k++) count += fabs(e[k]) > least_e || fabs(f[k]) > least_f;
  STEIF_TRY(stf_graph_allocate(pool, n, count ? count : 1, g));
  count = 0;
  for (int j = 0; j < n; j++) {
    for (int i = 0; i < n; i++) {
      const size_t k = (size_t)j * m + (size_t)i;
      const bool differential = fabs(e[k]) > least_e;
      if (!differential && !(fabs(f[k]) > least_f)) continue;
      g->row[count] = i;
      g->weight[count++] = differential;
    }
    g->ptr[j + 1] = count;
  }
  return STEIF_OK;
}

/* -1: no perfect matching. */
static int degree(steif_context *ctx, int n, const sunrealtype *e, sunrealtype least_e,
                  const sunrealtype *f, sunrealtype least_f, sunindextype *out)
{
  sunindextype rank = 0;
  stf_graph g;
  stf_pool *pool = stf_pool_new(ctx);
  if (!pool) return STEIF_NO_MEMORY;
  int code = graph(pool, n, e, least_e, f, least_f, &g);
  if (!code) code = stf_graph_match(pool, &g, &rank);
  if (!code) *out = rank == n ? stf_graph_weight(&g) : -1;
  stf_pool_free(&pool);
  return code;
}

int stf_dense_degree(steif_context *ctx, const stf_dense_units *u, sunindextype *out)
{
  return degree(ctx, u->n, u->E, 0, u->F, 0, out);
}

int stf_dense_carried(steif_context *ctx, const stf_dense_units *u, sunindextype *carried)
{
  const int n = u->n;
  const size_t count = (size_t)n * (size_t)n;
  const sunrealtype *e = u->E, *f = u->F, noise = STF_RANK_NOISE * n * STF_EPS;
  const sunrealtype least_e = noise * largest(count, e);
  const sunrealtype least_f = noise * largest(count, f);
  sunindextype all, without;
  bool some = false;
  *carried = 0;
  for (size_t k = 0; k < count; k++)
    some |= (e[k] != 0 && fabs(e[k]) <= least_e) || (f[k] != 0 && fabs(f[k]) <= least_f);
  if (!some) return STEIF_OK;
  STEIF_TRY(degree(ctx, n, e, 0, f, 0, &all));
  STEIF_TRY(degree(ctx, n, e, least_e, f, least_f, &without));
  *carried = all > without ? all - without : 0;
  return STEIF_OK;
}
