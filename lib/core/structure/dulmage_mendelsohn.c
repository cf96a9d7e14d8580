/* dulmage_mendelsohn.c: what a matching tells of a graph. Without a perfect one, the over- and
 * under-determined parts (A. L. Dulmage and N. S. Mendelsohn, Can. J. Math. 10, 1958); with one,
 * what raises the index: equations whose right-hand side is differentiated and unknowns that may
 * carry impulses, by the degrees of the entries of (s E + F)^{-1} that the pattern allows (cofactors
 * by longest alternating paths, as the offsets of J. D. Pryce, BIT 41, 2001).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "buckets.h"
#include "matching.h"

/* On from the columns that are reached. */
static int spread(stf_pool *pool, const stf_graph *g, unsigned char *reach)
{
  sunindextype *queue = stf_pool_array(pool, (size_t)g->n, sizeof *queue), last = 0;
  if (!queue) return STEIF_NO_MEMORY;
  for (sunindextype j = 0; j < g->n; j++)
    if (reach[j]) queue[last++] = j;
  for (sunindextype first = 0; first < last; first++) {
    const sunindextype j = queue[first];
    for (sunindextype k = g->ptr[j]; k < g->ptr[j + 1]; k++) {
      const sunindextype to = g->column_of[g->row[k]];
      if (to == FREE || reach[to]) continue;
      reach[to] = 1;
      queue[last++] = to;
    }
  }
  return STEIF_OK;
}

int stf_graph_reach(stf_pool *pool, const stf_graph *g, unsigned char *reach)
{
  for (sunindextype j = 0; j < g->n; j++) reach[j] = g->row_of[j] == FREE;
  return spread(pool, g, reach);
}

int stf_graph_reach_from(stf_pool *pool, const stf_graph *g, sunindextype column,
                         unsigned char *reach)
{
  for (sunindextype j = 0; j < g->n; j++) reach[j] = j == column;
  return spread(pool, g, reach);
}

/* degree_j = max over columns m of degree_m + weight(i, m) - weight(i, j) where row i, matched to j,
 * meets column m, and at least -weight(i, j). The duals u - min u satisfy this with >=, and what
 * they exceed it by is a shortest distance over reduced costs. */
static void shortest_slacks(const stf_graph *g, buckets *slack, sunindextype most)
{
  for (sunindextype d = 0, j; d <= most; d++)
    while ((j = bucket_take(slack, d)) != FREE)
      for (sunindextype k = g->ptr[j]; k < g->ptr[j + 1]; k++) {
        const sunindextype to = g->column_of[g->row[k]], key = d + stf_reduced_cost(g, j, k);
        if (key < slack->key[to]) bucket_move(slack, to, key);
      }
}

static sunindextype first_slack(const stf_graph *g, sunindextype j, sunindextype least)
{
  return g->u[j] - least + (1 - g->u[j] - g->v[g->row_of[j]]);
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
  buckets slack = {.key = stf_pool_array(pool, (size_t)(3 * n + most + 1), sizeof *degree)};
  if (!slack.key) return STEIF_NO_MEMORY;
  slack.next = slack.key + n;
  slack.previous = slack.next + n;
  slack.head = slack.previous + n;
  for (sunindextype d = 0; d <= most; d++) slack.head[d] = FREE;
  for (sunindextype j = 0; j < n; j++) slack.key[j] = FREE;
  for (sunindextype j = 0; j < n; j++) bucket_move(&slack, j, first_slack(g, j, least));
  shortest_slacks(g, &slack, most);
  for (sunindextype j = 0; j < n; j++) degree[j] = g->u[j] - least - slack.key[j];
  return STEIF_OK;
}
