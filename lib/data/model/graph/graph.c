/* graph.c: nodes found again by hashing; folding of what is exact only.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "graph.h"
#include <math.h>
#include <string.h>

static size_t hash(const stf_node *n)
{
  uint64_t bits, h = n->kind;
  memcpy(&bits, &n->number, sizeof bits);
  h = (h ^ (uint32_t)n->a) * 0x9E3779B97F4A7C15u;
  h = ((h ^ (h >> 29)) + (uint32_t)n->b) * 0xBF58476D1CE4E5B9u;
  h = ((h ^ (h >> 32)) + bits) * 0x94D049BB133111EBu;
  return (size_t)(h ^ (h >> 31));
}

static bool same(const stf_node *x, const stf_node *y)
{
  return x->kind == y->kind && x->a == y->a && x->b == y->b &&
         !memcmp(&x->number, &y->number, sizeof x->number);
}

/* A slot holds 1 + the number of a node, and half its hash: most others are told apart by that. */
static uint64_t entry_of(size_t h, int32_t node)
{
  return ((uint64_t)h & ~(uint64_t)UINT32_MAX) | (uint32_t)(node + 1);
}

static uint64_t *slot(const stf_formulas *g, const stf_node *n, size_t h)
{
  const size_t mask = g->slots.count - 1;
  for (size_t i = h;; i++) {
    uint64_t *s = STF_AT(g->slots, uint64_t, i & mask);
    if (!*s) return s;
    const bool alike = !((*s ^ h) >> 32);
    if (alike && same(n, stf_node_at(g, (int32_t)(uint32_t)*s - 1))) return s;
  }
}

static int widen(stf_formulas *g)
{
  stf_vector before = g->slots;
  g->slots = (stf_vector){0};
  size_t count = before.count ? 2 * before.count : 64;
  while (count < 2 * (g->nodes.count + 1)) count *= 2; /* they may have been given back */
  const int code = stf_vector_resize(g->ctx, &g->slots, count, sizeof(uint64_t));
  if (code) {
    g->slots = before;
    return code;
  }
  const size_t mask = g->slots.count - 1;
  for (int32_t i = 0; i < (int32_t)g->nodes.count; i++) {
    const size_t h = hash(stf_node_at(g, i));
    size_t at = h & mask;
    while (*STF_AT(g->slots, uint64_t, at)) at = (at + 1) & mask;
    *STF_AT(g->slots, uint64_t, at) = entry_of(h, i);
  }
  stf_vector_free(g->ctx, &before);
  return STEIF_OK;
}

static int32_t keep(stf_formulas *g, stf_node n)
{
  if (2 * (g->nodes.count + 1) > g->slots.count && widen(g)) return -1;
  const size_t h = hash(&n);
  uint64_t *s = slot(g, &n, h);
  if (*s) return (int32_t)(uint32_t)*s - 1;
  if (g->nodes.count >= STF_NODES) {
    STEIF_FAIL(g->ctx, STEIF_NO_MEMORY, "a model of more than %d operations; use loops",
               STF_NODES);
    return -1;
  }
  stf_node *to = stf_vector_push(g->ctx, &g->nodes, sizeof *to);
  if (!to) return -1;
  n.at = g->at;
  *to = n;
  *s = entry_of(h, (int32_t)g->nodes.count - 1);
  return (int32_t)g->nodes.count - 1;
}

int stf_children(const stf_node *n, int32_t child[3])
{
  const int count = stf_operands(n->kind);
  child[0] = n->a;
  child[1] = n->b;
  child[2] = n->c;
  return count;
}

int32_t stf_number(stf_formulas *g, double value)
{
  return keep(g, (stf_node){.kind = STF_OP_NUMBER, .number = value});
}

int32_t stf_leaf(stf_formulas *g, int kind, int32_t a, const int32_t stride[STF_LOOPS])
{
  static const uint8_t on[] = {
    [STF_OP_TIME] = STF_ON_TIME,     [STF_OP_PARAMETER] = STF_ON_PARAMETER,
    [STF_OP_STATE] = STF_ON_STATE,   [STF_OP_SLOPE] = STF_ON_SLOPE,
    [STF_OP_ALONG] = STF_ON_STATE,   [STF_OP_ALONG_SLOPE] = STF_ON_STATE,
    [STF_OP_WEIGHT] = STF_ON_STATE,  [STF_OP_ALONG_PARAMETER] = STF_ON_STATE,
    [STF_OP_MEMORY] = STF_ON_MEMORY, [STF_OP_COUNTER] = STF_ON_PASS};
  stf_node n = {.kind = (uint8_t)kind, .on = on[kind], .a = a};
  if (stride) {
    n.b = stride[0];
    n.stride[0] = stride[1];
    n.stride[1] = stride[2];
    if (stride[0] || stride[1] || stride[2]) n.on |= STF_ON_PASS;
  }
  return keep(g, n);
}

bool stf_is_number(const stf_formulas *g, int32_t i, double value)
{
  const stf_node *n = stf_node_at(g, i);
  return n->kind == STF_OP_NUMBER && n->number == value;
}

/* Products instead of powers 2, 3, 4. */
static int32_t power(stf_formulas *g, int32_t a, int32_t b)
{
  const int32_t square = stf_apply2(g, STF_OP_MULTIPLY, a, a);
  if (square < 0 || stf_is_number(g, b, 2)) return square;
  return stf_apply2(g, STF_OP_MULTIPLY, square, stf_is_number(g, b, 3) ? a : square);
}

static bool power_of_two(double x)
{
  int exponent;
  return isfinite(x) && fabs(frexp(x, &exponent)) == 0.5 && isnormal(1 / x);
}

/* What is 0 unless a condition holds, c ? u : 0, or c ? 0 : u. A derivative of
 * the branch that is not taken may be infinite or no number: it must not be
 * multiplied by that 0. */
static bool guarded(const stf_formulas *g, int32_t i)
{
  const stf_node *n = stf_node_at(g, i);
  return n->kind == STF_OP_SELECT && (stf_is_number(g, n->b, 0) || stf_is_number(g, n->c, 0));
}

/* The operation inside the branch of the first operand. */
static int32_t inside(stf_formulas *g, int kind, int32_t a, int32_t b)
{
  const stf_node n = *stf_node_at(g, a);
  const bool first = stf_is_number(g, n.c, 0);
  const int32_t u = stf_apply2(g, kind, first ? n.b : n.c, b);
  return first ? stf_apply(g, STF_OP_SELECT, n.a, u, n.c)
               : stf_apply(g, STF_OP_SELECT, n.a, n.b, u);
}

/* What is the same number for every operand; -1: nothing. */
static int32_t fold(stf_formulas *g, int kind, int32_t a, int32_t b)
{
  const bool zero = stf_is_number(g, a, 0) || stf_is_number(g, b, 0);
  switch (kind) {
  case STF_OP_ADD: return stf_is_number(g, b, 0) ? a : stf_is_number(g, a, 0) ? b : -1;
  case STF_OP_SUBTRACT:
    if (stf_is_number(g, b, 0)) return a;
    return stf_is_number(g, a, 0) ? stf_apply1(g, STF_OP_NEGATIVE, b) : -1;
  case STF_OP_MULTIPLY:
    if (g->exact && zero) return stf_number(g, 0);
    if (stf_is_number(g, b, -1)) return stf_apply1(g, STF_OP_NEGATIVE, a);
    if (stf_is_number(g, a, -1)) return stf_apply1(g, STF_OP_NEGATIVE, b);
    return stf_is_number(g, b, 1) ? a : stf_is_number(g, a, 1) ? b : -1;
  case STF_OP_DIVIDE:
    if (g->exact && stf_is_number(g, a, 0)) return a;
    if (stf_node_at(g, b)->kind == STF_OP_NUMBER && power_of_two(stf_node_at(g, b)->number))
      return stf_apply2(g, STF_OP_MULTIPLY, a, stf_number(g, 1 / stf_node_at(g, b)->number));
    return -1;
  case STF_OP_POWER:
    if (stf_is_number(g, b, 1)) return a;
    if (stf_is_number(g, b, 0)) return stf_number(g, 1);
    if (stf_is_number(g, b, 2) || stf_is_number(g, b, 3) || stf_is_number(g, b, 4))
      return power(g, a, b);
    return -1;
  default: return -1;
  }
}

/* Of constants. */
static bool constant(const stf_formulas *g, const stf_node *n, int count, const int32_t *child)
{
  if (n->kind == STF_OP_LOOKUP || n->kind == STF_OP_TILT) return false;
  for (int i = 0; i < count; i++)
    if (stf_node_at(g, child[i])->kind != STF_OP_NUMBER) return false;
  return true;
}

int32_t stf_apply(stf_formulas *g, int kind, int32_t a, int32_t b, int32_t c)
{
  stf_node n = {.kind = (uint8_t)kind, .a = a, .b = b};
  int32_t child[3] = {a, b, c};
  const int count = stf_operands(kind);
  n.number = 0;
  if (kind == STF_OP_SELECT || kind == STF_OP_LOOKUP) n.c = c;
  for (int i = 0; i < count; i++) {
    if (child[i] < 0) return -1;
    n.on |= stf_node_at(g, child[i])->on;
  }
  if (constant(g, &n, count, child)) {
    double x[3] = {0, 0, 0};
    for (int i = 0; i < count; i++) x[i] = stf_node_at(g, child[i])->number;
    return stf_number(g, stf_operate(kind, x[0], x[1], x[2]));
  }
  if (kind == STF_OP_NEGATIVE && stf_node_at(g, a)->kind == STF_OP_NEGATIVE)
    return stf_node_at(g, a)->a;
  if (kind == STF_OP_SELECT && b == c) return b;
  if (kind == STF_OP_SELECT && stf_node_at(g, a)->kind == STF_OP_NUMBER)
    return stf_node_at(g, a)->number != 0 ? b : c;
  const bool product =
    kind == STF_OP_MULTIPLY || kind == STF_OP_DIVIDE || kind == STF_OP_NEGATIVE;
  if (g->exact && product && guarded(g, a)) return inside(g, kind, a, b);
  const int32_t folded = count == 2 ? fold(g, kind, a, b) : -1;
  return folded >= 0 ? folded : keep(g, n);
}

int stf_formulas_trim(stf_formulas *g)
{
  stf_vector_free(g->ctx, &g->slots);
  return stf_vector_trim(g->ctx, &g->nodes, sizeof(stf_node));
}

void stf_formulas_free(stf_formulas *g)
{
  stf_vector_free(g->ctx, &g->nodes);
  stf_vector_free(g->ctx, &g->slots);
}
