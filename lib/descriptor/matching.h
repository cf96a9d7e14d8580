/* matching.h: the pattern of a pencil s E + F as a bipartite graph of unknowns (columns) and
 * equations (rows), a matching of most edges, and of these one with most entries of E.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_MATCHING_H
#define STF_MATCHING_H

#include "structure.h"

/* An edge is an entry of E or F that is not zero; sigma = 1 for those of E, else 0. The matching
 * belongs to integer duals u of columns and v of rows with
 *   sigma <= 1 - u - v on all edges,  sigma = 1 - u - v on matched ones. */
typedef struct stf_graph {
  sunindextype n;
  sunindextype *ptr, *row; /* by columns, a row at most once in each */
  unsigned char *sigma;
  sunindextype *of_column, *of_row; /* partners; -1: free */
  sunindextype *u, *v;
} stf_graph;

/* Items 0 .. n-1 in doubly linked lists by a small key >= 0; key -1: in no list yet. */
typedef struct stf_buckets {
  sunindextype *key, *next, *before, *head; /* head of keys 0 .. most */
} stf_buckets;

/* Into the list of `key`, out of the one it was in. */
void stf_bucket_move(stf_buckets *b, sunindextype item, sunindextype key);
/* The first item of a list leaves it, keeping its key; -1: none. */
sunindextype stf_bucket_take(stf_buckets *b, sunindextype key);

/* What an edge costs beyond the duals: 0 for tight ones. */
static inline sunindextype stf_reduced(const stf_graph *g, sunindextype j, sunindextype k)
{
  return 1 - g->sigma[k] - g->u[j] - g->v[g->row[k]];
}

/* Claimed from the pool, nothing matched; index arrays out of order are refused. */
int stf_graph_build(steif_context *ctx, stf_pool *pool, SUNMatrix E, SUNMatrix F, stf_graph *g);
/* The same graph with the roles of rows and columns exchanged, matched alike. */
int stf_graph_transpose(stf_pool *pool, const stf_graph *g, stf_graph *t);
/* A matching of most edges, and if it is perfect one of largest sum of sigma. */
int stf_graph_match(stf_pool *pool, stf_graph *g, sunindextype *rank);

/* reach[j] = 1 for the columns that alternating paths from a free column lead to: the unknowns of
 * the under-determined part of the Dulmage-Mendelsohn decomposition. */
int stf_graph_reach(stf_pool *pool, const stf_graph *g, unsigned char *reach);
/* Of a perfect matching of largest weight: degree[j] = the largest exponent of s that the pattern
 * allows in row j of (s E + F)^{-1}. The largest of all plus one is the structural index. */
int stf_graph_degrees(stf_pool *pool, const stf_graph *g, sunindextype *degree);

/* stf_matching together with the structural index; -1 without a perfect matching. */
int stf_matching_index(steif_context *ctx, SUNMatrix E, SUNMatrix F, sunindextype *rank,
                       sunindextype *index, steif_structure *structure);

#endif
