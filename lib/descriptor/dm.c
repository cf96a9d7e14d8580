/* dm.c: the equations and unknowns to blame. Without a perfect matching those of the over- and
 * under-determined parts (A. L. Dulmage and N. S. Mendelsohn, Can. J. Math. 10, 1958); with one,
 * those that raise the index: equations whose right-hand side is differentiated and unknowns that
 * may carry impulses, by the degrees of the entries of (s E + F)^{-1} that the pattern allows
 * (cofactors by longest alternating paths, as the offsets of J. D. Pryce, BIT 41, 2001).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "matching.h"

int stf_graph_reach(stf_pool *pool, const stf_graph *g, unsigned char *reach)
{
  sunindextype *queue = stf_claim(pool, (size_t)g->n, sizeof *queue), last = 0;
  if (!queue) return STEIF_NO_MEMORY;
  for (sunindextype j = 0; j < g->n; j++)
    if ((reach[j] = g->of_column[j] < 0)) queue[last++] = j;
  for (sunindextype first = 0; first < last; first++) {
    const sunindextype j = queue[first];
    for (sunindextype k = g->ptr[j]; k < g->ptr[j + 1]; k++) {
      const sunindextype to = g->of_row[g->row[k]];
      if (to < 0 || reach[to]) continue;
      reach[to] = 1;
      queue[last++] = to;
    }
  }
  return STEIF_OK;
}

/* degree_j = max over columns m of degree_m + sigma(i, m) - sigma(i, j) where row i, matched to j,
 * meets column m, and at least -sigma(i, j). The duals u - min u satisfy this with >=, and what
 * they exceed it by is a shortest distance over reduced costs. */
static void settle(const stf_graph *g, stf_buckets *slack, sunindextype most)
{
  for (sunindextype d = 0, j; d <= most; d++)
    while ((j = stf_bucket_take(slack, d)) >= 0)
      for (sunindextype k = g->ptr[j]; k < g->ptr[j + 1]; k++) {
        const sunindextype to = g->of_row[g->row[k]], key = d + stf_reduced(g, j, k);
        if (key < slack->key[to]) stf_bucket_move(slack, to, key);
      }
}

static sunindextype first_slack(const stf_graph *g, sunindextype j, sunindextype least)
{
  return g->u[j] - least + (1 - g->u[j] - g->v[g->of_column[j]]);
}

int stf_graph_degrees(stf_pool *pool, const stf_graph *g, sunindextype *degree)
{
  const sunindextype n = g->n;
  sunindextype least = g->u[0], most = 0;
  for (sunindextype j = 0; j < n; j++) least = g->u[j] < least ? g->u[j] : least;
  for (sunindextype j = 0; j < n; j++) {
    const sunindextype slack = first_slack(g, j, least);
    most = slack > most ? slack : most;
  }
  stf_buckets slack = {.key = stf_claim(pool, (size_t)(3 * n + most + 1), sizeof *degree)};
  if (!slack.key) return STEIF_NO_MEMORY;
  slack.next = slack.key + n, slack.before = slack.next + n, slack.head = slack.before + n;
  for (sunindextype d = 0; d <= most; d++) slack.head[d] = -1;
  for (sunindextype j = 0; j < n; j++) slack.key[j] = -1;
  for (sunindextype j = 0; j < n; j++) stf_bucket_move(&slack, j, first_slack(g, j, least));
  settle(g, &slack, most);
  for (sunindextype j = 0; j < n; j++) degree[j] = g->u[j] - least - slack.key[j];
  return STEIF_OK;
}

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
  sunindextype *degree = stf_claim(pool, (size_t)g->n, sizeof *degree);
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
  STEIF_TRY(stf_graph_build(ctx, pool, E, F, &g));
  STEIF_TRY(stf_graph_match(pool, &g, rank));
  STEIF_TRY(stf_graph_transpose(pool, &g, &t));
  unsigned char *chosen = stf_claim(pool, (size_t)g.n, 1);
  if (!chosen) return STEIF_NO_MEMORY;
  const bool perfect = *rank == g.n;
  *index = -1;
  structure->degree = perfect ? 0 : -1;
  for (sunindextype j = 0; perfect && j < g.n; j++)
    structure->degree += 1 - g.u[j] - g.v[g.of_column[j]];
  STEIF_TRY(blame(pool, &g, perfect, chosen, &highest));
  STEIF_TRY(list(ctx, g.n, chosen, &structure->unknowns_count, &structure->unknowns));
  STEIF_TRY(blame(pool, &t, perfect, chosen, &highest));
  if (perfect) *index = highest + 1;
  return list(ctx, g.n, chosen, &structure->equations_count, &structure->equations);
}

int stf_matching_index(steif_context *ctx, SUNMatrix E, SUNMatrix F, sunindextype *rank,
                       sunindextype *index, steif_structure *structure)
{
  stf_pool *pool = stf_pool_new(ctx);
  if (!pool) return STEIF_NO_MEMORY;
  const int code = analyse(ctx, pool, E, F, rank, index, structure);
  stf_pool_free(&pool);
  return code;
}

int stf_matching(steif_context *ctx, SUNMatrix E, SUNMatrix F, sunindextype *rank,
                 steif_structure *structure)
{
  sunindextype index;
  return stf_matching_index(ctx, E, F, rank, &index, structure);
}
