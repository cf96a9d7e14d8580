/* structure.c: test S: offsets of equations and unknowns from where y and y' occur.
 *
 * sigma_ij = 1 where y_j' occurs in F_i, 0 where only y_j does. A perfect matching T of
 * largest weight by the primal-dual method, with integer duals c_i, d_j >= 0, d_j - c_i >=
 * sigma_ij and equality on T; then the smallest such duals by sweeps from c = 0. If J_ij =
 * dF_i/dy_j^(d_j - c_i) is regular, y_j^(d_j) follows from equations differentiated c_i
 * times. The index is at most the largest c_i + (1 if d_j = 0) over the pairs where y_j
 * depends on equation i at all. From s^c (s E - A) s^-d = J + O(1/s) the number of unknown
 * j is at most 1 + c_i - d_j where it depends on i through J, and c_i - d_j where it does
 * otherwise. J. D. Pryce, BIT 41 (2001) 364-394; A. L. Dulmage and N. S. Mendelsohn,
 * Canad. J. Math. 10 (1958).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "diagnose.h"
#include <string.h>

typedef struct graph {
  size_t n;
  sunindextype *ptr, *col;      /* by rows */
  char *weight;                 /* sigma */
  sunindextype *row_of;         /* unknown -> equation */
  sunindextype *unknown_of;     /* equation -> unknown */
  sunindextype *queue, *parent; /* rows of the tree; row that reached unknown j */
  char *in_row, *in_col;
  int *c, *d;
  bool tight_only;
} graph;

static int claim(stf_pool *pool, graph *g, size_t nnz)
{
  const size_t n = g->n;
  g->ptr = stf_claim(pool, n + 2, sizeof *g->ptr);
  g->col = stf_claim(pool, nnz + 1, sizeof *g->col);
  g->weight = stf_claim(pool, nnz + 1, 1);
  g->queue = stf_claim(pool, 3 * n, sizeof *g->queue);
  g->in_row = stf_claim(pool, 2 * n, 1);
  if (!g->ptr || !g->col || !g->weight || !g->queue || !g->in_row) return STEIF_NO_MEMORY;
  g->parent = g->queue + n, g->row_of = g->queue + 2 * n, g->in_col = g->in_row + n;
  return STEIF_OK;
}

static void by_rows(const stf_view *v, graph *g)
{
  for (sunindextype k = 0; k < v->column[v->n]; k++) g->ptr[v->row[k] + 2]++;
  for (size_t i = 2; i < v->n + 2; i++) g->ptr[i] += g->ptr[i - 1];
  for (size_t j = 0; j < v->n; j++)
    for (sunindextype k = v->column[j]; k < v->column[j + 1]; k++) {
      const sunindextype to = g->ptr[v->row[k] + 1]++;
      g->col[to] = (sunindextype)j;
      g->weight[to] = (char)(v->has[k] & 1);
    }
}

static bool open_edge(const graph *g, sunindextype i, sunindextype k)
{
  return !g->tight_only || g->d[g->col[k]] - g->c[i] == g->weight[k];
}

/* Turn the path that reached the free unknown j. */
static void augment(graph *g, sunindextype j)
{
  while (j >= 0) {
    const sunindextype i = g->parent[j], next = g->unknown_of[i];
    g->row_of[j] = i, g->unknown_of[i] = j;
    j = next;
  }
}

/* Scan rows queue[from] ..; true when a free unknown was reached and the path turned. */
static bool grow(graph *g, size_t *from, size_t *count)
{
  while (*from < *count) {
    const sunindextype i = g->queue[(*from)++];
    for (sunindextype k = g->ptr[i]; k < g->ptr[i + 1]; k++) {
      const sunindextype j = g->col[k];
      if (g->in_col[j] || !open_edge(g, i, k)) continue;
      g->in_col[j] = 1, g->parent[j] = i;
      if (g->row_of[j] < 0) {
        augment(g, j);
        return true;
      }
      g->in_row[g->row_of[j]] = 1;
      g->queue[(*count)++] = g->row_of[j];
    }
  }
  return false;
}

/* Raise the duals of the tree until an edge out of it becomes tight. */
static void raise(graph *g, size_t count)
{
  int least = 1 << 30;
  for (size_t q = 0; q < count; q++) {
    const sunindextype i = g->queue[q];
    for (sunindextype k = g->ptr[i]; k < g->ptr[i + 1]; k++) {
      const int slack = g->d[g->col[k]] - g->c[i] - g->weight[k];
      if (!g->in_col[g->col[k]] && slack < least) least = slack;
    }
  }
  for (size_t q = 0; q < count; q++) {
    const sunindextype i = g->queue[q];
    g->c[i] += least;
    if (q > 0) g->d[g->unknown_of[i]] += least; /* all rows but the root are matched */
  }
}

static void forget(graph *g, size_t count)
{
  for (size_t q = 0; q < count; q++) {
    const sunindextype i = g->queue[q];
    g->in_row[i] = 0;
    for (sunindextype k = g->ptr[i]; k < g->ptr[i + 1]; k++) g->in_col[g->col[k]] = 0;
  }
}

/* Match as many equations as open edges allow; with duals, all of them. Rows that are left
 * keep -1. */
static size_t match(graph *g)
{
  size_t matched = 0;
  for (size_t i = 0; i < g->n; i++) g->unknown_of[i] = g->row_of[i] = -1;
  for (size_t r = 0; r < g->n; r++) {
    size_t from = 0, count = 1;
    g->queue[0] = (sunindextype)r, g->in_row[r] = 1;
    bool done = grow(g, &from, &count);
    while (!done && g->tight_only) {
      raise(g, count);
      from = 0;
      done = grow(g, &from, &count);
    }
    forget(g, count);
    matched += done;
  }
  return matched;
}

/* Equations reached from unmatched ones hold fewer unknowns than they are; unknowns
 * reached from unmatched ones occur in fewer equations. */
static void name_violators(graph *g, stf_structure *s)
{
  size_t count = 0, from = 0;
  for (size_t i = 0; i < g->n; i++)
    if (g->unknown_of[i] < 0) g->queue[count++] = (sunindextype)i, g->in_row[i] = 1;
  grow(g, &from, &count);
  for (size_t i = 0; i < g->n; i++) s->surplus[i] = g->in_row[i];
  for (size_t j = 0; j < g->n; j++) s->unsolved[j] = g->row_of[j] < 0;
  for (bool more = true; more;) {
    more = false;
    for (size_t i = 0; i < g->n; i++) {
      const sunindextype own = g->unknown_of[i];
      if (own < 0 || s->unsolved[own]) continue;
      for (sunindextype k = g->ptr[i]; k < g->ptr[i + 1]; k++)
        if (s->unsolved[g->col[k]]) s->unsolved[own] = 1, more = true;
    }
  }
}

static void smallest_offsets(graph *g)
{
  memset(g->c, 0, g->n * sizeof *g->c);
  memset(g->d, 0, g->n * sizeof *g->d);
  for (bool more = true; more;) {
    more = false;
    for (size_t i = 0; i < g->n; i++)
      for (sunindextype k = g->ptr[i]; k < g->ptr[i + 1]; k++) {
        const int wanted = g->weight[k] + g->c[i];
        if (g->d[g->col[k]] < wanted) g->d[g->col[k]] = wanted;
      }
    for (size_t i = 0; i < g->n; i++)
      for (sunindextype k = g->ptr[i]; k < g->ptr[i + 1]; k++)
        if (g->col[k] == g->unknown_of[i] && g->c[i] != g->d[g->col[k]] - g->weight[k])
          g->c[i] = g->d[g->col[k]] - g->weight[k], more = true;
  }
}

/* -- dependence: strongly connected components in reverse topological order (Tarjan) ----- */

typedef struct walk {
  sunindextype *low, *order, *stack, *path, *edge;
  sunindextype clock;
  size_t height;
  int *reach; /* largest c of the equations on which the unknown of a row depends */
} walk;

static void close_component(const graph *g, walk *w, sunindextype root)
{
  size_t from = w->height;
  int largest = 0;
  do {
    const sunindextype i = w->stack[--from];
    if (g->c[i] > largest) largest = g->c[i];
    if (w->reach[i] > largest) largest = w->reach[i];
  } while (w->stack[from] != root);
  for (size_t k = from; k < w->height; k++) {
    w->reach[w->stack[k]] = largest;
    w->low[w->stack[k]] = (sunindextype)g->n + 1; /* closed */
  }
  w->height = from;
}

static void enter(const graph *g, walk *w, sunindextype i)
{
  w->order[i] = w->low[i] = ++w->clock;
  w->edge[i] = g->ptr[i];
  w->stack[w->height++] = i;
}

static void visit(const graph *g, walk *w, sunindextype root)
{
  const sunindextype closed = (sunindextype)g->n + 1;
  size_t depth = 1;
  w->path[0] = root;
  enter(g, w, root);
  while (depth > 0) {
    const sunindextype i = w->path[depth - 1], k = w->edge[i];
    if (k == g->ptr[i + 1]) {
      if (w->low[i] == w->order[i]) close_component(g, w, i);
      depth--;
      continue;
    }
    const sunindextype to = g->row_of[g->col[k]];
    if (!open_edge(g, i, k)) {
      w->edge[i]++;
    } else if (!w->order[to]) {
      w->path[depth++] = to;
      enter(g, w, to); /* the edge is looked at again on return */
    } else {
      w->edge[i]++;
      if (w->low[to] == closed)
        w->reach[i] = w->reach[to] > w->reach[i] ? w->reach[to] : w->reach[i];
      else if (w->low[to] < w->low[i])
        w->low[i] = w->low[to];
    }
  }
}

/* reach[i] over all edges or the tight ones. */
static void walk_all(const graph *g, walk *w)
{
  memset(w->low, 0, 5 * g->n * sizeof *w->low);
  memset(w->reach, 0, g->n * sizeof *w->reach);
  w->clock = 0, w->height = 0;
  for (size_t i = 0; i < g->n; i++)
    if (!w->order[i]) visit(g, w, (sunindextype)i);
}

static int dependence(stf_pool *pool, graph *g, stf_structure *s)
{
  const size_t n = g->n;
  walk w = {.low = stf_claim(pool, 5 * n, sizeof *w.low)};
  w.reach = stf_claim(pool, n, sizeof *w.reach);
  if (!w.low || !w.reach) return STEIF_NO_MEMORY;
  w.order = w.low + n, w.stack = w.low + 2 * n, w.path = w.low + 3 * n, w.edge = w.low + 4 * n;
  s->index = 0, s->freedom = 0;
  walk_all(g, &w);
  for (size_t i = 0; i < n; i++) {
    const sunindextype j = g->unknown_of[i];
    const int order = 1 + w.reach[i] - g->d[j];
    s->number[j] = order > 1 ? order : 1;
    s->freedom += g->d[i] - g->c[i];
  }
  g->tight_only = false;
  walk_all(g, &w);
  for (size_t i = 0; i < n; i++) {
    const sunindextype j = g->unknown_of[i];
    const int order = w.reach[i] + (g->d[j] == 0), number = w.reach[i] - g->d[j];
    s->index = order > s->index ? order : s->index;
    s->number[j] = number > s->number[j] ? number : s->number[j];
  }
  return STEIF_OK;
}

static int find(stf_pool *pool, const stf_view *v, stf_structure *s)
{
  graph g = {.n = v->n, .c = s->c, .d = s->d, .unknown_of = s->match};
  STEIF_TRY(claim(pool, &g, (size_t)v->column[v->n]));
  by_rows(v, &g);
  s->matched = match(&g) == v->n;
  s->index = -1, s->freedom = -1;
  if (!s->matched) {
    name_violators(&g, s);
    return STEIF_OK;
  }
  for (size_t j = 0; j < v->n; j++) g.c[j] = g.d[j] = 0;
  for (size_t i = 0; i < v->n; i++)
    for (sunindextype k = g.ptr[i]; k < g.ptr[i + 1]; k++)
      if (g.weight[k]) g.d[g.col[k]] = 1;
  g.tight_only = true;
  match(&g);
  smallest_offsets(&g);
  return dependence(pool, &g, s);
}

int stf_structure_find(stf_lens *lens, const stf_view *v, stf_structure *s)
{
  const size_t n = v->n;
  if (!s->c) {
    s->c = stf_claim(lens->pool, 5 * n, sizeof *s->c);
    s->match = stf_claim(lens->pool, n, sizeof *s->match);
    if (!s->c || !s->match) return STEIF_NO_MEMORY;
    s->d = s->c + n, s->number = s->c + 2 * n;
    s->surplus = s->c + 3 * n, s->unsolved = s->c + 4 * n;
  }
  memset(s->c, 0, 5 * n * sizeof *s->c);
  stf_pool *pool = stf_pool_new(lens->ctx);
  if (!pool) return STEIF_NO_MEMORY;
  const int code = find(pool, v, s);
  stf_pool_free(&pool);
  return code;
}
