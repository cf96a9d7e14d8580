/* tangents.c: a node beside each node: the derivative along a direction.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "products.h"
#include <string.h>

typedef struct tangents {
  stf_formulas *g;
  stf_vector live, along; /* uint8_t; int32_t: 1 + node, 0: none */
} tangents;

static int32_t *along(const tangents *s, int32_t node)
{
  return STF_AT(s->along, int32_t, node);
}

/* The direction of a leaf; -2: it does not move. */
static int32_t of_leaf(stf_formulas *g, stf_node n)
{
  const int32_t stride[STF_LOOPS] = {n.b, n.stride[0], n.stride[1]};
  switch (n.kind) {
  case STF_OP_STATE: return stf_leaf(g, STF_OP_ALONG, n.a, stride);
  case STF_OP_SLOPE: return stf_leaf(g, STF_OP_ALONG_SLOPE, n.a, stride);
  case STF_OP_PARAMETER: return stf_leaf(g, STF_OP_ALONG_PARAMETER, n.a, NULL);
  default: return -2;
  }
}

/* Are there operands for which it has a value and no finite derivative? */
static bool singular(int kind)
{
  return kind == STF_OP_POWER || kind == STF_OP_SQRT || kind == STF_OP_CBRT ||
         kind == STF_OP_ASIN || kind == STF_OP_ACOS || kind == STF_OP_ACOSH ||
         kind == STF_OP_ATAN2 || kind == STF_OP_HYPOT;
}

/* What operand k, which moves along w, makes of node i. A leaf that stays contributes nothing, whatever its
 * derivative; w of another node may be 0 at this point alone. */
static int32_t part_of(tangents *s, int32_t i, int k, int32_t child, int32_t w)
{
  int32_t none[3];
  const bool guard =
    singular(stf_node_at(s->g, i)->kind) && stf_children(stf_node_at(s->g, child), none) == 0;
  const int32_t part = stf_partial_times(s->g, i, w, k);
  return guard ? stf_apply(s->g, STF_OP_SELECT, w, part, stf_number(s->g, 0)) : part;
}

static int of_node(tangents *s, int32_t i)
{
  int32_t child[3], sum = -2;
  const int count = stf_children(stf_node_at(s->g, i), child);
  s->g->at = stf_node_at(s->g, i)->at;
  if (!count) sum = of_leaf(s->g, *stf_node_at(s->g, i));
  for (int k = 0; k < count; k++) {
    if (!*along(s, child[k])) continue;
    const int32_t part = part_of(s, i, k, child[k], *along(s, child[k]) - 1);
    sum = sum == -2 ? part : stf_apply2(s->g, STF_OP_ADD, sum, part);
    if (sum < 0) return STEIF_NO_MEMORY;
  }
  if (sum == -1) return STEIF_NO_MEMORY;
  *along(s, i) = sum == -2 ? 0 : sum + 1;
  return STEIF_OK;
}

/* The nodes that the roots reach, from the last to the first. */
static void mark(const tangents *s, int32_t count)
{
  int32_t child[3];
  for (int32_t i = count; i--;) {
    if (!*STF_AT(s->live, uint8_t, i)) continue;
    const int operands = stf_children(stf_node_at(s->g, i), child);
    for (int k = 0; k < operands; k++) *STF_AT(s->live, uint8_t, child[k]) = 1;
  }
}

static int roots(stf_model *m, stf_block *block, stf_vector *stores)
{
  for (size_t k = 0; k < block->equations.count; k++) {
    const stf_equation *e = STF_AT(block->equations, stf_equation, k);
    stf_store *s = stf_vector_push(m->ctx, stores, sizeof *s);
    if (!s) return STEIF_NO_MEMORY;
    *s = (stf_store){.from = stf_residual_node(m, block, e), .a = e->row, .slot = e->slot};
    memcpy(s->stride, e->stride, sizeof s->stride);
    if (s->from < 0) return STEIF_NO_MEMORY;
  }
  return STEIF_OK;
}

/* What the stores take is the derivative of what they took; 0 where it does not move. */
static int replace(const tangents *s, stf_vector *stores)
{
  for (size_t k = 0; k < stores->count; k++) {
    stf_store *store = STF_AT(*stores, stf_store, k);
    store->from = *along(s, store->from) ? *along(s, store->from) - 1 : stf_number(s->g, 0);
    if (store->from < 0) return STEIF_NO_MEMORY;
  }
  return STEIF_OK;
}

int stf_tangents_of(stf_model *m, stf_block *block, stf_vector *stores, stf_quantity *q)
{
  tangents s = {.g = &block->graph};
  const bool before = s.g->exact;
  const int32_t count = (int32_t)s.g->nodes.count;
  int code = stf_vector_resize(m->ctx, &s.live, (size_t)count, 1);
  if (!code) code = stf_vector_resize(m->ctx, &s.along, (size_t)count, sizeof(int32_t));
  for (size_t k = 0; !code && k < stores->count; k++)
    *STF_AT(s.live, uint8_t, STF_AT(*stores, stf_store, k)->from) = 1;
  if (!code) mark(&s, count);
  s.g->exact = true;
  for (int32_t i = 0; !code && i < count; i++)
    if (*STF_AT(s.live, uint8_t, i)) code = of_node(&s, i);
  if (!code) code = replace(&s, stores);
  s.g->exact = before;
  if (!code) code = stf_compile_quantity(m, block, stores, q);
  stf_vector_free(m->ctx, &s.live);
  stf_vector_free(m->ctx, &s.along);
  return code;
}

int stf_tangent_tape(stf_model *m, stf_block *block, stf_quantity *q)
{
  stf_vector stores = {0};
  int code = roots(m, block, &stores);
  if (!code) code = stf_tangents_of(m, block, &stores, q);
  stf_vector_free(m->ctx, &stores);
  return code;
}
