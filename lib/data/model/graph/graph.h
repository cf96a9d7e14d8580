/* graph.h: expressions as nodes that are kept once: an operation on older
 * nodes, so that the numbers of nodes are an order in which they can be
 * computed.
 *
 * A leaf such as u[i+1] inside loops is unknown a + stride . (values of the
 * loop counters): a block of equations is written once for all passes of its
 * loops, and its derivatives too.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_GRAPH_H
#define STF_GRAPH_H

#include "operations.h"
#include "vector.h"

enum { STF_LOOPS = 3 };

/* What a node depends on. */
enum stf_dependence {
  STF_ON_STATE = 1,
  STF_ON_SLOPE = 2,
  STF_ON_TIME = 4,
  STF_ON_PARAMETER = 8,
  STF_ON_MEMORY = 16,
  STF_ON_PASS = 32 /* differs from pass to pass of a loop */
};

typedef struct stf_node {
  uint8_t kind, on;
  uint32_t at; /* place in the text */
  int32_t a, b;
  union {
    double number;
    int32_t c;
    int32_t stride[2]; /* of leaves: those of loops 1 and 2; that of loop 0 is b */
  };
} stf_node;

typedef struct stf_formulas {
  steif_context *ctx;
  stf_vector nodes, slots;
  bool exact; /* 0*x = 0: in derivatives, not in what the user wrote */
  uint32_t at;
} stf_formulas;

enum { STF_NODES = 50000000 };

static inline const stf_node *stf_node_at(const stf_formulas *g, int32_t i)
{
  return STF_AT(g->nodes, stf_node, i);
}

/* All return the number of a node, -1 when memory is short. */
int32_t stf_number(stf_formulas *g, double value);
int32_t stf_leaf(stf_formulas *g, int kind, int32_t a, const int32_t stride[STF_LOOPS]);
int32_t stf_apply(stf_formulas *g, int kind, int32_t a, int32_t b, int32_t c);
static inline int32_t stf_apply1(stf_formulas *g, int kind, int32_t a)
{
  return stf_apply(g, kind, a, 0, 0);
}
static inline int32_t stf_apply2(stf_formulas *g, int kind, int32_t a, int32_t b)
{
  return stf_apply(g, kind, a, b, 0);
}
bool stf_is_number(const stf_formulas *g, int32_t i, double value);
/* b and c of a node are nodes where it has so many operands. */
int stf_children(const stf_node *n, int32_t child[3]);
/* What growing needs is given back; it can grow again. */
int stf_formulas_trim(stf_formulas *g);
void stf_formulas_free(stf_formulas *g);

/* The nodes that `root` reaches, ascending, into `list`; mark has an entry for
 * each node of the graph, 0 before and after. */
int stf_reach(const stf_formulas *g, int32_t root, stf_vector *mark, stf_vector *list);

/* derivative.c: the derivative of `root` by every leaf of kind STATE or SLOPE
 * (`kind`) or PARAMETER that it reaches, as nodes of the same graph, by one
 * sweep backwards. */
typedef struct stf_partial {
  int32_t leaf, value; /* nodes */
} stf_partial;
typedef struct stf_sweep {
  stf_vector mark, list, adjoint;
} stf_sweep;
int stf_formulas_differentiate(stf_formulas *g, int32_t root, int kind, stf_sweep *sweep,
                               stf_vector *partials);
void stf_sweep_free(steif_context *ctx, stf_sweep *sweep);
/* The derivative of node `self` by its operand of the given number, times w. */
int32_t stf_partial_times(stf_formulas *g, int32_t self, int32_t w, int operand);
/* `root` with all leaves of `kind` put to 0. */
int32_t stf_without(stf_formulas *g, int32_t root, int kind, stf_sweep *sweep);

#endif
