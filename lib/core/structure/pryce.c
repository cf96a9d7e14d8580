/* pryce.c: test S: offsets of equations and unknowns from where y and y' occur.
 *
 * sigma_ij = 1 where y_j' occurs in F_i, 0 where only y_j does. A perfect matching T of largest
 * weight belongs to integer duals c_i, d_j >= 0, d_j - c_i >= sigma_ij with equality on T; the
 * smallest such duals are found by sweeps from c = 0, whichever matching it is. If J_ij =
 * dF_i/dy_j^(d_j - c_i) is regular, y_j^(d_j) follows from equations differentiated c_i times. The
 * differentiation index is at most the largest c_i + (1 if d_j = 0) over the pairs where y_j depends
 * on equation i at all. From s^c (s E - A) s^-d = J + O(1/s) the perturbation index of component j is
 * at most 1 + c_i - d_j where it depends on i through J, and c_i - d_j where it does otherwise.
 * J. D. Pryce, BIT 41 (2001) 364-394; A. L. Dulmage and N. S. Mendelsohn, Canad. J. Math. 10 (1958).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "pryce.h"
#include "matching.h"
#include <string.h>

/* The transposed graph lists the unknowns of each equation; edges have the weight sigma. */
typedef struct pattern {
  const stf_graph *by_row;
  int *c, *d;
  bool tight_only; /* edges with d_j - c_i = sigma_ij alone, those of J */
} pattern;

static int graph_of(stf_pool *pool, size_t n, const sunindextype *column,
                    const sunindextype *row, const char *differential, stf_graph *g)
{
  const sunindextype edges = column[n];
  STEIF_TRY(stf_graph_allocate(pool, (sunindextype)n, edges, g));
  memcpy(g->ptr, column, (n + 1) * sizeof *g->ptr);
  memcpy(g->row, row, (size_t)edges * sizeof *g->row);
  for (sunindextype k = 0; k < edges; k++) g->weight[k] = differential[k] & 1;
  return STEIF_OK;
}

/* Equations that hold fewer unknowns than they are; unknowns that occur in fewer equations. */
static int name_violators(stf_pool *pool, const stf_graph *by_column, const stf_graph *by_row,
                          stf_offsets *s)
{
  const size_t n = (size_t)by_column->n;
  unsigned char *reach = stf_pool_array(pool, 2 * n, 1);
  if (!reach) return STEIF_NO_MEMORY;
  STEIF_TRY(stf_graph_reach(pool, by_column, reach));
  STEIF_TRY(stf_graph_reach(pool, by_row, reach + n));
  for (size_t i = 0; i < n; i++) {
    s->unsolved[i] = reach[i];
    s->surplus[i] = reach[n + i];
  }
  return STEIF_OK;
}

/* The smallest duals: d_j the least that edges ask for, then c_i by equality on the matching. */
static void smallest_offsets(const pattern *p)
{
  const stf_graph *g = p->by_row;
  for (bool more = true; more;) {
    more = false;
    for (sunindextype i = 0; i < g->n; i++)
      for (sunindextype k = g->ptr[i]; k < g->ptr[i + 1]; k++) {
        const int wanted = g->weight[k] + p->c[i];
        if (p->d[g->row[k]] < wanted) p->d[g->row[k]] = wanted;
      }
    for (sunindextype i = 0; i < g->n; i++)
      for (sunindextype k = g->ptr[i]; k < g->ptr[i + 1]; k++) {
        const int equal = p->d[g->row[k]] - g->weight[k];
        if (g->row[k] != g->row_of[i] || p->c[i] == equal) continue;
        p->c[i] = equal;
        more = true;
      }
  }
}

static bool is_open(const pattern *p, sunindextype i, sunindextype k)
{
  const stf_graph *g = p->by_row;
  return !p->tight_only || p->d[g->row[k]] - p->c[i] == g->weight[k];
}

/* -- dependence: strongly connected components in reverse topological order (Tarjan) ----- */

typedef struct walk {
  sunindextype *low, *order, *stack, *path, *edge;
  sunindextype clock;
  size_t height;
  int *reach; /* largest c of the equations on which the unknown of a row depends */
} walk;

static void close_component(const pattern *p, walk *w, sunindextype root)
{
  size_t from = w->height;
  int largest = 0;
  do {
    const sunindextype i = w->stack[--from];
    if (p->c[i] > largest) largest = p->c[i];
    if (w->reach[i] > largest) largest = w->reach[i];
  } while (w->stack[from] != root);
  for (size_t k = from; k < w->height; k++) {
    w->reach[w->stack[k]] = largest;
    w->low[w->stack[k]] = p->by_row->n + 1; /* closed */
  }
  w->height = from;
}

static void enter(const pattern *p, walk *w, sunindextype i)
{
  w->order[i] = w->low[i] = ++w->clock;
  w->edge[i] = p->by_row->ptr[i];
  w->stack[w->height++] = i;
}

static void visit(const pattern *p, walk *w, sunindextype root)
{
  const sunindextype closed = p->by_row->n + 1;
  size_t depth = 1;
  w->path[0] = root;
  enter(p, w, root);
  while (depth > 0) {
    const sunindextype i = w->path[depth - 1], k = w->edge[i];
    if (k == p->by_row->ptr[i + 1]) {
      if (w->low[i] == w->order[i]) close_component(p, w, i);
      depth--;
      continue;
    }
    const sunindextype to = p->by_row->column_of[p->by_row->row[k]];
    if (!is_open(p, i, k)) {
      w->edge[i]++;
    } else if (!w->order[to]) {
      w->path[depth++] = to;
      enter(p, w, to); /* the edge is looked at again on return */
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
static void walk_all(const pattern *p, walk *w)
{
  memset(w->low, 0, 5 * (size_t)p->by_row->n * sizeof *w->low);
  memset(w->reach, 0, (size_t)p->by_row->n * sizeof *w->reach);
  w->clock = 0;
  w->height = 0;
  for (sunindextype i = 0; i < p->by_row->n; i++)
    if (!w->order[i]) visit(p, w, i);
}

static int raised(int value, int to) { return to > value ? to : value; }

static int dependence(stf_pool *pool, pattern *p, stf_offsets *s)
{
  const stf_graph *g = p->by_row;
  const size_t n = (size_t)g->n;
  walk w = {.low = stf_pool_array(pool, 5 * n, sizeof *w.low)};
  w.reach = stf_pool_array(pool, n, sizeof *w.reach);
  if (!w.low || !w.reach) return STEIF_NO_MEMORY;
  w.order = w.low + n;
  w.stack = w.low + 2 * n;
  w.path = w.low + 3 * n;
  w.edge = w.low + 4 * n;
  s->index = 0;
  s->degrees_of_freedom = 0;
  p->tight_only = true;
  walk_all(p, &w);
  for (sunindextype i = 0; i < g->n; i++) {
    const sunindextype j = g->row_of[i];
    s->component_index[j] = raised(1, 1 + w.reach[i] - p->d[j]);
    s->degrees_of_freedom += p->d[i] - p->c[i];
  }
  p->tight_only = false;
  walk_all(p, &w);
  for (sunindextype i = 0; i < g->n; i++) {
    const sunindextype j = g->row_of[i];
    s->index = raised(s->index, w.reach[i] + (p->d[j] == 0));
    s->component_index[j] = raised(s->component_index[j], w.reach[i] - p->d[j]);
  }
  return STEIF_OK;
}

static int find(stf_pool *pool, stf_graph *by_column, stf_offsets *s)
{
  stf_graph by_row;
  sunindextype rank;
  STEIF_TRY(stf_graph_match(pool, by_column, &rank));
  STEIF_TRY(stf_graph_transpose(pool, by_column, &by_row));
  s->matched = rank == by_row.n;
  s->index = -1;
  s->degrees_of_freedom = -1;
  if (!s->matched) return name_violators(pool, by_column, &by_row, s);
  pattern p = {.by_row = &by_row, .c = s->c, .d = s->d};
  smallest_offsets(&p);
  return dependence(pool, &p, s);
}

static int allocate(stf_pool *pool, size_t n, stf_offsets *s)
{
  if (!s->c) s->c = stf_pool_array(pool, 5 * n, sizeof *s->c);
  if (!s->c) return STEIF_NO_MEMORY;
  s->d = s->c + n;
  s->component_index = s->c + 2 * n;
  s->surplus = s->c + 3 * n;
  s->unsolved = s->c + 4 * n;
  memset(s->c, 0, 5 * n * sizeof *s->c);
  return STEIF_OK;
}

int stf_offsets_find(steif_context *ctx, stf_pool *pool, size_t n, const sunindextype *column,
                     const sunindextype *row, const char *differential, stf_offsets *s)
{
  stf_graph by_column;
  STEIF_TRY(allocate(pool, n, s));
  stf_pool *work = stf_pool_new(ctx);
  if (!work) return STEIF_NO_MEMORY;
  int code = graph_of(work, n, column, row, differential, &by_column);
  if (!code) code = find(work, &by_column, s);
  stf_pool_free(&work);
  return code;
}
