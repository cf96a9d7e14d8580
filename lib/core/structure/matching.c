/* matching.c: a matching of most edges and largest weight, by successive shortest augmenting paths
 * in rounds: inside the edges that the duals make tight, augmenting paths are taken many at a time
 * (J. E. Hopcroft and R. M. Karp, SIAM J. Comput. 2, 1973); when none is left the duals rise by the
 * length of the shortest path in reduced costs, whole numbers kept in buckets (R. B. Dial, CACM 12,
 * 1969). With costs 0 and 1 the rounds are about as many as the index of a pencil.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "buckets.h"
#include "matching.h"
#include <string.h>

int stf_graph_allocate(stf_pool *pool, sunindextype n, sunindextype edges, stf_graph *g)
{
  const size_t m = (size_t)n, size = sizeof(sunindextype);
  *g = (stf_graph){.n = n};
  g->ptr = stf_pool_array(pool, m + 1, size);
  g->row = stf_pool_array(pool, (size_t)edges, size);
  g->weight = stf_pool_array(pool, (size_t)edges, 1);
  g->row_of = stf_pool_array(pool, m, size);
  g->column_of = stf_pool_array(pool, m, size);
  g->u = stf_pool_array(pool, m, size);
  g->v = stf_pool_array(pool, m, size);
  if (!g->ptr || !g->row || !g->weight || !g->row_of || !g->column_of || !g->u || !g->v)
    return STEIF_NO_MEMORY;
  for (sunindextype j = 0; j < n; j++) g->row_of[j] = g->column_of[j] = FREE;
  return STEIF_OK;
}

int stf_graph_transpose(stf_pool *pool, const stf_graph *g, stf_graph *t)
{
  const sunindextype n = g->n;
  const size_t bytes = (size_t)n * sizeof(sunindextype);
  STEIF_TRY(stf_graph_allocate(pool, n, g->ptr[n], t));
  for (sunindextype k = 0; k < g->ptr[n]; k++) t->ptr[g->row[k] + 1]++;
  for (sunindextype i = 0; i < n; i++) t->ptr[i + 1] += t->ptr[i];
  for (sunindextype j = 0; j < n; j++)
    for (sunindextype k = g->ptr[j]; k < g->ptr[j + 1]; k++) {
      const sunindextype to = t->ptr[g->row[k]]++;
      t->row[to] = j;
      t->weight[to] = g->weight[k];
    }
  for (sunindextype i = n; i > 0; i--) t->ptr[i] = t->ptr[i - 1];
  t->ptr[0] = 0;
  memcpy(t->row_of, g->column_of, bytes);
  memcpy(t->column_of, g->row_of, bytes);
  memcpy(t->u, g->v, bytes);
  memcpy(t->v, g->u, bytes);
  return STEIF_OK;
}

/* -- matching inside the tight edges ------------------------------------------------------- */

/* Scratch of both searches. */
typedef struct search {
  stf_graph *g;
  sunindextype *level, *queue, *arc, *path; /* of columns */
  buckets rows;                             /* by distance 0 .. n from the free columns */
} search;

static void pair(stf_graph *g, sunindextype j, sunindextype i)
{
  g->row_of[j] = i;
  g->column_of[i] = j;
}

/* Duals at first: u_j the least cost in column j; then what matches at once. */
static void start(stf_graph *g)
{
  for (sunindextype j = 0; j < g->n; j++) {
    g->u[j] = g->ptr[j] < g->ptr[j + 1];
    for (sunindextype k = g->ptr[j]; k < g->ptr[j + 1]; k++)
      if (g->weight[k]) g->u[j] = 0;
    for (sunindextype k = g->ptr[j]; k < g->ptr[j + 1] && g->row_of[j] == FREE; k++)
      if (g->column_of[g->row[k]] == FREE && stf_reduced_cost(g, j, k) == 0)
        pair(g, j, g->row[k]);
  }
}

/* Levels of columns by breadth from the free ones, down to where a free row is met. */
static bool layers(search *s)
{
  const stf_graph *g = s->g;
  sunindextype first = 0, last = 0, deepest = g->n;
  for (sunindextype j = 0; j < g->n; j++) {
    s->level[j] = g->row_of[j] == FREE ? 0 : FREE;
    s->arc[j] = g->ptr[j];
    if (!s->level[j]) s->queue[last++] = j;
  }
  while (first < last && s->level[s->queue[first]] < deepest) {
    const sunindextype j = s->queue[first++];
    for (sunindextype k = g->ptr[j]; k < g->ptr[j + 1]; k++) {
      if (stf_reduced_cost(g, j, k) != 0) continue;
      const sunindextype to = g->column_of[g->row[k]];
      if (to == FREE)
        deepest = s->level[j];
      else if (s->level[to] == FREE) {
        s->level[to] = s->level[j] + 1;
        s->queue[last++] = to;
      }
    }
  }
  return deepest < g->n;
}

/* One step from column j along its next tight edge that leads a level down: the column reached,
 * FREE when the row is free, j itself when no edge is left. */
static sunindextype advance(search *s, sunindextype j)
{
  const stf_graph *g = s->g;
  while (s->arc[j] < g->ptr[j + 1]) {
    const sunindextype k = s->arc[j]++, to = g->column_of[g->row[k]];
    if (stf_reduced_cost(g, j, k) != 0) continue;
    if (to == FREE || s->level[to] == s->level[j] + 1) return to;
  }
  return j;
}

/* By depth from the free column j through the layers; the rows on the path are those before the
 * arcs of its columns. */
static bool augment(search *s, sunindextype j)
{
  sunindextype depth = 0;
  s->path[0] = j;
  for (;;) {
    const sunindextype at = s->path[depth], to = advance(s, at);
    if (to == FREE) break;
    if (to != at)
      s->path[++depth] = to;
    else if (depth-- == 0)
      return false;
  }
  for (; depth >= 0; depth--) pair(s->g, s->path[depth], s->g->row[s->arc[s->path[depth]] - 1]);
  return true;
}

static void match_tight(search *s)
{
  while (layers(s))
    for (sunindextype j = 0; j < s->g->n; j++)
      if (s->g->row_of[j] == FREE) augment(s, j);
}

/* -- raising the duals --------------------------------------------------------------------- */

/* Column j is at distance d: nearer rows move. Paths to free rows are no longer than n. */
static void relax(search *s, sunindextype j, sunindextype d)
{
  const stf_graph *g = s->g;
  for (sunindextype k = g->ptr[j]; k < g->ptr[j + 1]; k++) {
    const sunindextype i = g->row[k], to = d + stf_reduced_cost(g, j, k), now = s->rows.key[i];
    if (to <= g->n && (now == FREE || to < now)) bucket_move(&s->rows, i, to);
  }
}

/* Distances of rows from the free columns until a free row is met: its distance, FREE for none. */
static sunindextype distances(search *s)
{
  const stf_graph *g = s->g;
  for (sunindextype i = 0; i < g->n; i++) s->rows.key[i] = s->rows.head[i] = FREE;
  s->rows.head[g->n] = FREE;
  for (sunindextype j = 0; j < g->n; j++)
    if (g->row_of[j] == FREE) relax(s, j, 0);
  for (sunindextype d = 0, i; d <= g->n; d++)
    while ((i = bucket_take(&s->rows, d)) != FREE) {
      if (g->column_of[i] == FREE) return d;
      relax(s, g->column_of[i], d);
    }
  return FREE;
}

static void raise(search *s, sunindextype shortest)
{
  stf_graph *g = s->g;
  for (sunindextype j = 0; j < g->n; j++)
    if (g->row_of[j] == FREE) g->u[j] += shortest;
  for (sunindextype i = 0; i < g->n; i++) {
    const sunindextype nearer = shortest - s->rows.key[i];
    if (s->rows.key[i] == FREE || nearer <= 0) continue;
    g->u[g->column_of[i]] += nearer;
    g->v[i] -= nearer;
  }
}

static sunindextype matched(const stf_graph *g)
{
  sunindextype count = 0;
  for (sunindextype j = 0; j < g->n; j++) count += g->row_of[j] != FREE;
  return count;
}

int stf_graph_match(stf_pool *pool, stf_graph *g, sunindextype *rank)
{
  const size_t n = (size_t)g->n, size = sizeof(sunindextype);
  search s = {.g = g};
  s.level = stf_pool_array(pool, 5 * n + 1, size);
  if (!s.level) return STEIF_NO_MEMORY;
  s.queue = s.level + n;
  s.arc = s.queue + n;
  s.path = s.arc + n;
  s.rows = (buckets){s.level, s.queue, s.arc, s.path + n}; /* the searches take turns */
  start(g);
  for (;;) {
    match_tight(&s);
    *rank = matched(g);
    if (*rank == g->n) return STEIF_OK;
    const sunindextype shortest = distances(&s);
    if (shortest == FREE) return STEIF_OK;
    raise(&s, shortest);
  }
}

sunindextype stf_graph_weight(const stf_graph *g)
{
  sunindextype sum = 0;
  for (sunindextype j = 0; j < g->n; j++) sum += 1 - g->u[j] - g->v[g->row_of[j]];
  return sum;
}
