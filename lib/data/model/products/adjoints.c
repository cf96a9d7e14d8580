/* adjoints.c: one sweep backwards from all rows, each with a weight.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "products.h"
#include <string.h>

typedef struct adjoints {
  stf_formulas *g;
  stf_vector of; /* int32_t: 1 + node, 0: none */
} adjoints;

static int add(const adjoints *s, int32_t node, int32_t part)
{
  int32_t *to = STF_AT(s->of, int32_t, node);
  const int32_t sum = part < 0 ? -1 : *to ? stf_apply2(s->g, STF_OP_ADD, *to - 1, part) : part;
  if (sum < 0) return STEIF_NO_MEMORY;
  *to = sum + 1;
  return STEIF_OK;
}

/* The weight of the row of an equation. Rows that are no multiples of counters have places of their
 * own, behind the others, pass by pass. */
static int32_t weight(const stf_block *block, stf_formulas *g, const stf_equation *e,
                      int64_t *rows)
{
  if (!e->slot) return stf_leaf(g, STF_OP_WEIGHT, e->row, e->stride);
  if (!block->box.dims) return stf_leaf(g, STF_OP_WEIGHT, e->slot[0], NULL);
  int32_t stride[STF_LOOPS] = {0};
  int64_t at = *rows, step = 1;
  for (int d = block->box.dims; d--;) {
    stride[d] = (int32_t)step;
    at -= step * block->box.low[d];
    step *= block->box.count[d];
  }
  *rows += step;
  return stf_leaf(g, STF_OP_WEIGHT, (int32_t)at, stride);
}

/* What reaches a leaf goes to the component that it stands for. */
static int leaf(stf_model *m, const stf_node *n, int32_t from, stf_vector *stores)
{
  const bool moves =
    n->kind == STF_OP_STATE || n->kind == STF_OP_SLOPE || n->kind == STF_OP_PARAMETER;
  if (!moves) return STEIF_OK;
  stf_store *s = stf_vector_push(m->ctx, stores, sizeof *s);
  if (!s) return STEIF_NO_MEMORY;
  const int32_t offset = n->kind == STF_OP_STATE   ? 0
                         : n->kind == STF_OP_SLOPE ? m->n
                                                   : 2 * m->n;
  *s = (stf_store){.from = from, .a = n->a + offset};
  if (n->kind == STF_OP_PARAMETER) return STEIF_OK;
  s->stride[0] = n->b;
  s->stride[1] = n->stride[0];
  s->stride[2] = n->stride[1];
  return STEIF_OK;
}

static int sweep(stf_model *m, const adjoints *s, int32_t count, stf_vector *stores)
{
  static const int wanted = STF_ON_STATE | STF_ON_SLOPE | STF_ON_PARAMETER;
  int32_t child[3];
  for (int32_t i = count; i--;) {
    const int32_t w = *STF_AT(s->of, int32_t, i) - 1;
    const stf_node n = *stf_node_at(s->g, i);
    if (w < 0) continue;
    s->g->at = n.at;
    const int operands = stf_children(&n, child);
    if (!operands) STEIF_TRY(leaf(m, &n, w, stores));
    for (int k = 0; k < operands; k++)
      if (stf_node_at(s->g, child[k])->on & wanted)
        STEIF_TRY(add(s, child[k], stf_partial_times(s->g, i, w, k)));
  }
  return STEIF_OK;
}

int stf_adjoint_tape(stf_model *m, stf_block *block, int64_t *rows, stf_quantity *q)
{
  adjoints s = {.g = &block->graph};
  stf_vector stores = {0}, roots = {0};
  const bool before = s.g->exact;
  int code = STEIF_OK;
  s.g->exact = true;
  for (size_t k = 0; !code && k < block->equations.count; k++) {
    const int32_t root = stf_residual_node(m, block, STF_AT(block->equations, stf_equation, k));
    int32_t *to = root < 0 ? NULL : stf_vector_push(m->ctx, &roots, sizeof *to);
    if (to) *to = root;
    if (!to) code = STEIF_NO_MEMORY;
  }
  const int32_t count = (int32_t)s.g->nodes.count;
  if (!code) code = stf_vector_resize(m->ctx, &s.of, (size_t)count, sizeof(int32_t));
  for (size_t k = 0; !code && k < block->equations.count; k++)
    code = add(&s, *STF_AT(roots, int32_t, k),
               weight(block, s.g, STF_AT(block->equations, stf_equation, k), rows));
  if (!code) code = sweep(m, &s, count, &stores);
  s.g->exact = before;
  if (!code) code = stf_compile_quantity(m, block, &stores, q);
  stf_vector_free(m->ctx, &s.of);
  stf_vector_free(m->ctx, &roots);
  stf_vector_free(m->ctx, &stores);
  return code;
}
