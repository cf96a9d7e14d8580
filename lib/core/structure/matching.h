/* matching.h: bipartite graphs of unknowns (columns) and equations (rows): a matching of most edges,
 * among these one of largest weight, and the parts that it divides the graph into.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_MATCHING_H
#define STF_MATCHING_H

#include "base.h"

/* The weight of an edge is 1 where the derivative of the unknown occurs in the equation (an entry of E
 * in a pencil s E + F), else 0. The matching belongs to integer duals u of columns and v of rows,
 *   weight <= 1 - u - v on all edges,  weight = 1 - u - v on matched ones. */
typedef struct stf_graph {
  sunindextype n;
  sunindextype *ptr, *row; /* by columns, a row at most once in each */
  unsigned char *weight;
  sunindextype *row_of, *column_of; /* partners; -1: free */
  sunindextype *u, *v;
} stf_graph;

/* By how much the duals exceed the weight of edge k of column j; 0: the edge is tight. */
static inline sunindextype stf_reduced_cost(const stf_graph *g, sunindextype j, sunindextype k)
{
  return 1 - g->weight[k] - g->u[j] - g->v[g->row[k]];
}

/* Allocated from the pool for the caller to fill in ptr, row and weight; nothing is matched. */
int stf_graph_allocate(stf_pool *pool, sunindextype n, sunindextype edges, stf_graph *g);
/* The same graph with the roles of rows and columns exchanged, matched alike. */
int stf_graph_transpose(stf_pool *pool, const stf_graph *g, stf_graph *t);
/* A matching of most edges, *rank of them, and if it is perfect one of largest weight. */
int stf_graph_match(stf_pool *pool, stf_graph *g, sunindextype *rank);
/* The weight of a perfect matching. */
sunindextype stf_graph_weight(const stf_graph *g);

/* reach[j] = 1 for the columns that alternating paths from a free column lead to: the unknowns of
 * the under-determined part of the Dulmage-Mendelsohn decomposition; of the transposed graph, the
 * equations of the over-determined part. */
int stf_graph_reach(stf_pool *pool, const stf_graph *g, unsigned char *reach);
/* Of this free column alone: the unknowns that may take its place. */
int stf_graph_reach_from(stf_pool *pool, const stf_graph *g, sunindextype column,
                         unsigned char *reach);
/* Of a perfect matching of largest weight: degree[j] = the largest exponent of s that the pattern
 * allows in row j of (s E + F)^{-1}. The largest of all plus one is the structural index. */
int stf_graph_degrees(stf_pool *pool, const stf_graph *g, sunindextype *degree);

#endif
