/* matching.c: the matching of a pattern with most entries of E, by successive shortest augmenting
 * paths in rounds: inside the edges that the duals make tight, augmenting paths are taken many at
 * a time (J. E. Hopcroft and R. M. Karp, SIAM J. Comput. 2, 1973); when none is left the duals
 * rise by the length of the shortest path in reduced costs, whole numbers kept in buckets
 * (R. B. Dial, CACM 12, 1969). With costs 0 and 1 the rounds are about as many as the index.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "matching.h"
#include <string.h>
#include <sunmatrix/sunmatrix_sparse.h>

enum { FREE = -1 };

static sunindextype entries(SUNMatrix M) { return SM_INDEXPTRS_S(M)[SM_COLUMNS_S(M)]; }

static int claim(stf_pool *pool, sunindextype n, sunindextype edges, stf_graph *g)
{
  const size_t m = (size_t)n, size = sizeof(sunindextype);
  *g = (stf_graph){.n = n};
  g->ptr = stf_claim(pool, m + 1, size);
  g->row = stf_claim(pool, (size_t)edges, size);
  g->sigma = stf_claim(pool, (size_t)edges, 1);
  g->of_column = stf_claim(pool, m, size);
  g->of_row = stf_claim(pool, m, size);
  g->u = stf_claim(pool, m, size);
  g->v = stf_claim(pool, m, size);
  return g->ptr && g->row && g->sigma && g->of_column && g->of_row && g->u && g->v
           ? STEIF_OK
           : STEIF_NO_MEMORY;
}

/* Entries of column j of M that are not zero join the graph; seen[i] is one more than the edge of
 * row i, if that is after the first edge of the column. */
static void join(stf_graph *g, SUNMatrix M, sunindextype j, unsigned char sigma,
                 sunindextype *seen)
{
  const sunindextype *row = SM_INDEXVALS_S(M);
  const sunrealtype *value = SM_DATA_S(M);
  for (sunindextype k = SM_INDEXPTRS_S(M)[j]; k < SM_INDEXPTRS_S(M)[j + 1]; k++) {
    if (value[k] == 0 || seen[row[k]] > g->ptr[j]) continue;
    g->row[g->ptr[j + 1]] = row[k];
    g->sigma[g->ptr[j + 1]] = sigma;
    seen[row[k]] = ++g->ptr[j + 1];
  }
}

/* The frame of the graph is what the index arrays say: they are looked at before use. */
static int check(steif_context *ctx, const char *name, SUNMatrix M)
{
  const sunindextype *ptr = SM_INDEXPTRS_S(M), *row = SM_INDEXVALS_S(M), n = SM_COLUMNS_S(M);
  bool good = ptr[0] == 0;
  for (sunindextype j = 0; good && j < n; j++) {
    good = ptr[j] <= ptr[j + 1] && ptr[j + 1] <= SM_NNZ_S(M);
    for (sunindextype k = ptr[j]; good && k < ptr[j + 1]; k++) good = row[k] >= 0 && row[k] < n;
    STEIF_CHECK(
      good, ctx, STEIF_BAD_INPUT,
      "column %lld (from 0) of %s has pointers that do not rise within its %lld entries "
      "or a row outside 0 .. %lld: check the index arrays",
      (long long)j, name, (long long)SM_NNZ_S(M), (long long)n - 1);
  }
  STEIF_CHECK(good, ctx, STEIF_BAD_INPUT, "the column pointers of %s do not start at 0", name);
  return STEIF_OK;
}

int stf_graph_build(steif_context *ctx, stf_pool *pool, SUNMatrix E, SUNMatrix F, stf_graph *g)
{
  const sunindextype n = SM_COLUMNS_S(F);
  STEIF_TRY(check(ctx, "E", E));
  STEIF_TRY(check(ctx, "F", F));
  STEIF_TRY(claim(pool, n, entries(E) + entries(F), g));
  sunindextype *seen = stf_claim(pool, (size_t)n, sizeof *seen);
  if (!seen) return STEIF_NO_MEMORY;
  for (sunindextype j = 0; j < n; j++) {
    g->ptr[j + 1] = g->ptr[j];
    join(g, E, j, 1, seen);
    join(g, F, j, 0, seen);
    g->of_column[j] = g->of_row[j] = FREE;
  }
  return STEIF_OK;
}

int stf_graph_transpose(stf_pool *pool, const stf_graph *g, stf_graph *t)
{
  const sunindextype n = g->n;
  const size_t bytes = (size_t)n * sizeof(sunindextype);
  STEIF_TRY(claim(pool, n, g->ptr[n], t));
  for (sunindextype k = 0; k < g->ptr[n]; k++) t->ptr[g->row[k] + 1]++;
  for (sunindextype i = 0; i < n; i++) t->ptr[i + 1] += t->ptr[i];
  for (sunindextype j = 0; j < n; j++)
    for (sunindextype k = g->ptr[j]; k < g->ptr[j + 1]; k++) {
      const sunindextype to = t->ptr[g->row[k]]++;
      t->row[to] = j;
      t->sigma[to] = g->sigma[k];
    }
  for (sunindextype i = n; i > 0; i--) t->ptr[i] = t->ptr[i - 1];
  t->ptr[0] = 0;
  memcpy(t->of_column, g->of_row, bytes);
  memcpy(t->of_row, g->of_column, bytes);
  memcpy(t->u, g->v, bytes);
  memcpy(t->v, g->u, bytes);
  return STEIF_OK;
}

/* -- matching inside the tight edges ------------------------------------------------------- */

/* Scratch of both searches. */
typedef struct search {
  stf_graph *g;
  sunindextype *level, *queue, *arc, *path; /* of columns */
  stf_buckets rows;                         /* by distance 0 .. n from the free columns */
} search;

static void pair(stf_graph *g, sunindextype j, sunindextype i)
{
  g->of_column[j] = i;
  g->of_row[i] = j;
}

/* Duals at first: u_j the least cost in column j; then what matches at once. */
static void start(stf_graph *g)
{
  for (sunindextype j = 0; j < g->n; j++) {
    g->u[j] = g->ptr[j] < g->ptr[j + 1];
    for (sunindextype k = g->ptr[j]; k < g->ptr[j + 1]; k++)
      if (g->sigma[k]) g->u[j] = 0;
    for (sunindextype k = g->ptr[j]; k < g->ptr[j + 1] && g->of_column[j] == FREE; k++)
      if (g->of_row[g->row[k]] == FREE && stf_reduced(g, j, k) == 0) pair(g, j, g->row[k]);
  }
}

/* Levels of columns by breadth from the free ones, down to where a free row is met. */
static bool layers(search *s)
{
  const stf_graph *g = s->g;
  sunindextype first = 0, last = 0, deepest = g->n;
  for (sunindextype j = 0; j < g->n; j++) {
    s->level[j] = g->of_column[j] == FREE ? 0 : FREE;
    s->arc[j] = g->ptr[j];
    if (!s->level[j]) s->queue[last++] = j;
  }
  while (first < last && s->level[s->queue[first]] < deepest) {
    const sunindextype j = s->queue[first++];
    for (sunindextype k = g->ptr[j]; k < g->ptr[j + 1]; k++) {
      if (stf_reduced(g, j, k) != 0) continue;
      const sunindextype to = g->of_row[g->row[k]];
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

/* One step from column j along its next tight edge that leads a level down: the column behind it,
 * FREE when the row is free, j itself when no edge is left. */
static sunindextype advance(search *s, sunindextype j)
{
  const stf_graph *g = s->g;
  while (s->arc[j] < g->ptr[j + 1]) {
    const sunindextype k = s->arc[j]++, to = g->of_row[g->row[k]];
    if (stf_reduced(g, j, k) != 0) continue;
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
      if (s->g->of_column[j] == FREE) augment(s, j);
}

/* -- raising the duals --------------------------------------------------------------------- */

static void take_out(stf_buckets *b, sunindextype i)
{
  if (b->before[i] == FREE)
    b->head[b->key[i]] = b->next[i];
  else
    b->next[b->before[i]] = b->next[i];
  if (b->next[i] != FREE) b->before[b->next[i]] = b->before[i];
}

void stf_bucket_move(stf_buckets *b, sunindextype item, sunindextype key)
{
  if (b->key[item] != FREE) take_out(b, item);
  b->key[item] = key;
  b->before[item] = FREE;
  b->next[item] = b->head[key];
  if (b->head[key] != FREE) b->before[b->head[key]] = item;
  b->head[key] = item;
}

sunindextype stf_bucket_take(stf_buckets *b, sunindextype key)
{
  const sunindextype item = b->head[key];
  if (item != FREE) take_out(b, item);
  return item;
}

/* Column j is at distance d: nearer rows move. Paths to free rows are no longer than n. */
static void relax(search *s, sunindextype j, sunindextype d)
{
  const stf_graph *g = s->g;
  for (sunindextype k = g->ptr[j]; k < g->ptr[j + 1]; k++) {
    const sunindextype i = g->row[k], to = d + stf_reduced(g, j, k), now = s->rows.key[i];
    if (to <= g->n && (now == FREE || to < now)) stf_bucket_move(&s->rows, i, to);
  }
}

/* Distances of rows from the free columns until a free row is met: its distance, FREE for none. */
static sunindextype distances(search *s)
{
  const stf_graph *g = s->g;
  for (sunindextype i = 0; i < g->n; i++) s->rows.key[i] = s->rows.head[i] = FREE;
  s->rows.head[g->n] = FREE;
  for (sunindextype j = 0; j < g->n; j++)
    if (g->of_column[j] == FREE) relax(s, j, 0);
  for (sunindextype d = 0, i; d <= g->n; d++)
    while ((i = stf_bucket_take(&s->rows, d)) != FREE) {
      if (g->of_row[i] == FREE) return d;
      relax(s, g->of_row[i], d);
    }
  return FREE;
}

static void raise(search *s, sunindextype shortest)
{
  stf_graph *g = s->g;
  for (sunindextype j = 0; j < g->n; j++)
    if (g->of_column[j] == FREE) g->u[j] += shortest;
  for (sunindextype i = 0; i < g->n; i++) {
    const sunindextype nearer = shortest - s->rows.key[i];
    if (s->rows.key[i] == FREE || nearer <= 0) continue;
    g->u[g->of_row[i]] += nearer;
    g->v[i] -= nearer;
  }
}

static sunindextype matched(const stf_graph *g)
{
  sunindextype count = 0;
  for (sunindextype j = 0; j < g->n; j++) count += g->of_column[j] != FREE;
  return count;
}

int stf_graph_match(stf_pool *pool, stf_graph *g, sunindextype *rank)
{
  const size_t n = (size_t)g->n, size = sizeof(sunindextype);
  search s = {.g = g};
  s.level = stf_claim(pool, 5 * n + 1, size);
  if (!s.level) return STEIF_NO_MEMORY;
  s.queue = s.level + n, s.arc = s.queue + n, s.path = s.arc + n;
  s.rows = (stf_buckets){s.level, s.queue, s.arc, s.path + n}; /* the searches take turns */
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
