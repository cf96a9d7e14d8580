/* structural.c: the equations and unknowns that the pattern of a pencil s E + F, or its ranks, blame.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "structural.h"
#include "prime_field.h"
#include <sunmatrix/sunmatrix_sparse.h>

static sunindextype entries(SUNMatrix M) { return SM_INDEXPTRS_S(M)[SM_COLUMNS_S(M)]; }

/* Entries of column j of M that are not zero join the graph; seen[i] is one more than the edge of
 * row i, if that is after the first edge of the column. */
static void join(stf_graph *g, SUNMatrix M, sunindextype j, unsigned char weight,
                 sunindextype *seen)
{
  const sunindextype *row = SM_INDEXVALS_S(M);
  const sunrealtype *value = SM_DATA_S(M);
  for (sunindextype k = SM_INDEXPTRS_S(M)[j]; k < SM_INDEXPTRS_S(M)[j + 1]; k++) {
    if (value[k] == 0 || seen[row[k]] > g->ptr[j]) continue;
    g->row[g->ptr[j + 1]] = row[k];
    g->weight[g->ptr[j + 1]] = weight;
    seen[row[k]] = ++g->ptr[j + 1];
  }
}

/* The graph is what the index arrays say: they are looked at before use. */
static int check(steif_context *ctx, const char *name, SUNMatrix M)
{
  const sunindextype *ptr = SM_INDEXPTRS_S(M), *row = SM_INDEXVALS_S(M), n = SM_COLUMNS_S(M);
  bool good = ptr[0] == 0;
  for (sunindextype j = 0; good && j < n; j++) {
    good = ptr[j] <= ptr[j + 1] && ptr[j + 1] <= SM_NNZ_S(M);
    for (sunindextype k = ptr[j]; good && k < ptr[j + 1]; k++) good = row[k] >= 0 && row[k] < n;
    STEIF_CHECK(
      good, ctx, STEIF_BAD_INPUT,
      "column %lld of %s has pointers that do not rise within its %lld entries or a row index "
      "outside 0 .. %lld: check the index arrays",
      (long long)j + 1, name, (long long)SM_NNZ_S(M), (long long)n - 1);
  }
  STEIF_CHECK(good, ctx, STEIF_BAD_INPUT, "the column pointers of %s do not start at 0", name);
  return STEIF_OK;
}

int stf_structural_graph(steif_context *ctx, stf_pool *pool, SUNMatrix E, SUNMatrix F,
                         stf_graph *g)
{
  const sunindextype n = SM_COLUMNS_S(F);
  STEIF_TRY(check(ctx, "E", E));
  STEIF_TRY(check(ctx, "F", F));
  STEIF_TRY(stf_graph_allocate(pool, n, entries(E) + entries(F), g));
  sunindextype *seen = stf_pool_array(pool, (size_t)n, sizeof *seen);
  if (!seen) return STEIF_NO_MEMORY;
  for (sunindextype j = 0; j < n; j++) {
    g->ptr[j + 1] = g->ptr[j];
    join(g, E, j, 1, seen);
    join(g, F, j, 0, seen);
  }
  return STEIF_OK;
}

/* The numbers of the flags that are set. */
static int list(steif_context *ctx, sunindextype n, const unsigned char *chosen,
                sunindextype *count, sunindextype **out)
{
  sunindextype m = 0;
  for (sunindextype i = 0; i < n; i++) m += chosen[i];
  STEIF_TRY(stf_structure_list(ctx, m, out));
  *count = m;
  m = 0;
  for (sunindextype i = 0; i < n; i++)
    if (chosen[i]) (*out)[m++] = i;
  return STEIF_OK;
}

/* The columns of g to blame; the highest degree when the matching is perfect. */
static int blame(stf_pool *pool, const stf_graph *g, bool perfect, unsigned char *chosen,
                 sunindextype *highest)
{
  if (!perfect) return stf_graph_reach(pool, g, chosen);
  sunindextype *degree = stf_pool_array(pool, (size_t)g->n, sizeof *degree);
  if (!degree) return STEIF_NO_MEMORY;
  STEIF_TRY(stf_graph_degrees(pool, g, degree));
  *highest = -1;
  for (sunindextype j = 0; j < g->n; j++) {
    chosen[j] = degree[j] > 0;
    *highest = degree[j] > *highest ? degree[j] : *highest;
  }
  return STEIF_OK;
}

static int analyse(steif_context *ctx, stf_pool *pool, SUNMatrix E, SUNMatrix F,
                   sunindextype *rank, sunindextype *index, steif_structure *structure)
{
  stf_graph g, t;
  sunindextype highest = -1;
  STEIF_TRY(stf_structural_graph(ctx, pool, E, F, &g));
  STEIF_TRY(stf_graph_match(pool, &g, rank));
  STEIF_TRY(stf_graph_transpose(pool, &g, &t));
  unsigned char *chosen = stf_pool_array(pool, (size_t)g.n, 1);
  if (!chosen) return STEIF_NO_MEMORY;
  const bool perfect = *rank == g.n;
  *index = -1;
  structure->degree = perfect ? stf_graph_weight(&g) : -1;
  STEIF_TRY(blame(pool, &g, perfect, chosen, &highest));
  STEIF_TRY(list(ctx, g.n, chosen, &structure->unknowns_count, &structure->unknowns));
  STEIF_TRY(blame(pool, &t, perfect, chosen, &highest));
  if (perfect) *index = highest + 1;
  return list(ctx, g.n, chosen, &structure->equations_count, &structure->equations);
}

int stf_structural_index(steif_context *ctx, SUNMatrix E, SUNMatrix F, sunindextype *rank,
                         sunindextype *index, steif_structure *structure)
{
  stf_pool *pool = stf_pool_new(ctx);
  if (!pool) return STEIF_NO_MEMORY;
  const int code = analyse(ctx, pool, E, F, rank, index, structure);
  stf_pool_free(&pool);
  return code;
}

int stf_structural_rank(steif_context *ctx, SUNMatrix E, SUNMatrix F, sunindextype *rank,
                        steif_structure *structure)
{
  sunindextype index;
  return stf_structural_index(ctx, E, F, rank, &index, structure);
}

static int dependent(steif_context *ctx, SUNMatrix E, SUNMatrix F, sunindextype *count,
                     sunindextype **out)
{
  const sunindextype n = SM_COLUMNS_S(E);
  stf_field field;
  STEIF_TRY(stf_field_open(ctx, E, F, false, &field));
  unsigned char *in_kernel = stf_allocate(ctx, (size_t)n, sizeof *in_kernel);
  if (!in_kernel) return STEIF_NO_MEMORY;
  int code = stf_field_kernel(ctx, &field, in_kernel);
  if (!code) code = list(ctx, n, in_kernel, count, out);
  stf_release(ctx, in_kernel);
  return code;
}

int stf_structural_dependent(steif_context *ctx, SUNMatrix E, SUNMatrix F, steif_structure *s)
{
  SUNMatrix rows_E = NULL, rows_F = NULL; /* by rows: the transposes by columns */
  STEIF_TRY(dependent(ctx, E, F, &s->unknowns_count, &s->unknowns));
  const bool good = !SUNSparseMatrix_ToCSR(E, &rows_E) && rows_E &&
                    !SUNSparseMatrix_ToCSR(F, &rows_F) && rows_F;
  const int code =
    good ? dependent(ctx, rows_E, rows_F, &s->equations_count, &s->equations)
         : STEIF_FAIL(ctx, STEIF_NO_MEMORY, "no memory for the transpose of a matrix");
  if (rows_E) SUNMatDestroy(rows_E);
  if (rows_F) SUNMatDestroy(rows_F);
  return code;
}
