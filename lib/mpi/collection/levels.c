/* levels.c: unknowns numbered by levels of the graph, so that ranks of consecutive ones need few of the others'.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "parallel_problem.h"

typedef struct graph {
  sunindextype n, *at, *next; /* neighbours of i: next[at[i]] .. next[at[i + 1] - 1] */
  sunindextype *queue, *seen; /* seen: number of the pass that has been at i */
} graph;

static void release(steif_context *ctx, graph *g)
{
  steif_release(ctx, g->at), steif_release(ctx, g->next);
  steif_release(ctx, g->queue), steif_release(ctx, g->seen);
}

/* M + M^T without its diagonal; entries that are in both stand twice. */
static int open(steif_context *ctx, graph *g, const sunindextype *column,
                const sunindextype *row)
{
  const size_t n = (size_t)g->n, entries = 2 * (size_t)column[g->n];
  g->at = steif_allocate(ctx, n + 2, sizeof *g->at);
  g->next = steif_allocate(ctx, entries + 1, sizeof *g->next);
  g->queue = steif_allocate(ctx, n, sizeof *g->queue);
  g->seen = steif_allocate(ctx, n, sizeof *g->seen);
  if (!g->at || !g->next || !g->queue || !g->seen) return STEIF_NO_MEMORY;
  sunindextype *end = g->at + 1; /* of i, moved on while entries come */
  for (sunindextype j = 0; j < g->n; j++)
    for (sunindextype k = column[j]; k < column[j + 1]; k++)
      if (row[k] != j) end[row[k] + 1]++, end[j + 1]++;
  for (sunindextype i = 0; i < g->n; i++) end[i + 1] += end[i];
  for (sunindextype j = 0; j < g->n; j++)
    for (sunindextype k = column[j]; k < column[j + 1]; k++)
      if (row[k] != j) g->next[end[row[k]]++] = j, g->next[end[j]++] = row[k];
  return STEIF_OK;
}

/* All that can be reached from `first`, level by level, to the queue from `start` on; its new end. */
static sunindextype pass(graph *g, sunindextype first, sunindextype start, sunindextype number)
{
  sunindextype end = start;
  g->queue[end++] = first, g->seen[first] = number;
  for (sunindextype at = start; at < end; at++) {
    const sunindextype i = g->queue[at];
    for (sunindextype k = g->at[i]; k < g->at[i + 1]; k++)
      if (g->seen[g->next[k]] != number)
        g->seen[g->next[k]] = number, g->queue[end++] = g->next[k];
  }
  return end;
}

/* The last one of a pass is at the edge; the second pass starts there, and a third from what it reached last. */
int number_by_levels(steif_context *ctx, sunindextype n, const sunindextype *column,
                     const sunindextype *row, sunindextype *place)
{
  graph g = {.n = n};
  const int code = open(ctx, &g, column, row);
  sunindextype start = 0;
  for (sunindextype i = 0; !code && i < n; i++) {
    if (g.seen[i]) continue;
    sunindextype end = pass(&g, i, start, 1);
    end = pass(&g, g.queue[end - 1], start, 2);
    start = pass(&g, g.queue[end - 1], start, 3);
  }
  for (sunindextype k = 0; !code && k < n; k++) place[g.queue[k]] = k;
  release(ctx, &g);
  return code;
}
