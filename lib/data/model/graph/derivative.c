/* derivative.c: derivatives by sweeps backwards over the nodes that a root
 * reaches. SPDX-License-Identifier: BSD-3-Clause */
#include "graph.h"
#include <math.h>
#include <stdlib.h>

static int ascending(const void *a, const void *b)
{
  const int32_t x = *(const int32_t *)a, y = *(const int32_t *)b;
  return (x > y) - (x < y);
}

static int add(const stf_formulas *g, int32_t node, stf_vector *mark, stf_vector *list)
{
  int32_t *m = STF_AT(*mark, int32_t, node);
  if (*m) return STEIF_OK;
  *m = 1;
  int32_t *next = stf_vector_push(g->ctx, list, sizeof *next);
  if (!next) return STEIF_NO_MEMORY;
  *next = node;
  return STEIF_OK;
}

int stf_reach(const stf_formulas *g, int32_t root, stf_vector *mark, stf_vector *list)
{
  int32_t child[3];
  list->count = 0;
  STEIF_TRY(stf_vector_resize(g->ctx, mark, g->nodes.count, sizeof(int32_t)));
  STEIF_TRY(add(g, root, mark, list));
  for (size_t i = 0; i < list->count; i++) {
    const stf_node *n = stf_node_at(g, *STF_AT(*list, int32_t, i));
    const int count = stf_children(n, child);
    for (int k = 0; k < count; k++) STEIF_TRY(add(g, child[k], mark, list));
  }
  for (size_t i = 0; i < list->count; i++)
    *STF_AT(*mark, int32_t, *STF_AT(*list, int32_t, i)) = 0;
  qsort(list->data, list->count, sizeof(int32_t), ascending);
  return STEIF_OK;
}

/* ---- the derivative of one node
 * -------------------------------------------------------------- */

#define N(x) stf_number(g, x)
#define NEG(a) stf_apply1(g, STF_OP_NEGATIVE, a)
#define ADD(a, b) stf_apply2(g, STF_OP_ADD, a, b)
#define SUB(a, b) stf_apply2(g, STF_OP_SUBTRACT, a, b)
#define MUL(a, b) stf_apply2(g, STF_OP_MULTIPLY, a, b)
#define DIV(a, b) stf_apply2(g, STF_OP_DIVIDE, a, b)
#define FUN(kind, a) stf_apply1(g, STF_OP_##kind, a)

/* d f(a)/da of node `self` = f(a), times w. */
static int32_t of_one(stf_formulas *g, const stf_node *n, int32_t self, int32_t w)
{
  const int32_t a = n->a;
  switch (n->kind) {
  case STF_OP_NEGATIVE: return NEG(w);
  case STF_OP_SIN: return MUL(w, FUN(COS, a));
  case STF_OP_COS: return NEG(MUL(w, FUN(SIN, a)));
  case STF_OP_TAN: return MUL(w, ADD(N(1), MUL(self, self)));
  case STF_OP_ASIN: return DIV(w, FUN(SQRT, SUB(N(1), MUL(a, a))));
  case STF_OP_ACOS: return NEG(DIV(w, FUN(SQRT, SUB(N(1), MUL(a, a)))));
  case STF_OP_ATAN: return DIV(w, ADD(N(1), MUL(a, a)));
  case STF_OP_SINH: return MUL(w, FUN(COSH, a));
  case STF_OP_COSH: return MUL(w, FUN(SINH, a));
  case STF_OP_TANH: return MUL(w, SUB(N(1), MUL(self, self)));
  case STF_OP_ASINH: return DIV(w, FUN(SQRT, ADD(MUL(a, a), N(1))));
  case STF_OP_ACOSH: return DIV(w, FUN(SQRT, SUB(MUL(a, a), N(1))));
  case STF_OP_ATANH: return DIV(w, SUB(N(1), MUL(a, a)));
  case STF_OP_EXP: return MUL(w, self);
  case STF_OP_EXPM1: return MUL(w, FUN(EXP, a));
  case STF_OP_LOG: return DIV(w, a);
  case STF_OP_LOG10: return DIV(w, MUL(a, N(log(10))));
  case STF_OP_LOG1P: return DIV(w, ADD(N(1), a));
  case STF_OP_SQRT: return DIV(w, MUL(N(2), self));
  case STF_OP_CBRT: return DIV(w, MUL(N(3), MUL(self, self)));
  case STF_OP_ERF: return MUL(w, MUL(N(2 / sqrt(acos(-1))), FUN(EXP, NEG(MUL(a, a)))));
  case STF_OP_ABS: return MUL(w, FUN(SIGN, a));
  case STF_OP_RAMP: return MUL(w, FUN(STEP, a));
  case STF_OP_LOOKUP: return n->c ? N(0) : MUL(w, stf_apply(g, STF_OP_TILT, a, n->b, 0));
  default: return N(0); /* sign, step, floor, not, the slope of a table */
  }
}

/* d a^b/da times w = w b a^(b-1), 0 for b = 0 where a is 0, too. */
static int32_t of_base(stf_formulas *g, int32_t a, int32_t b, int32_t w)
{
  const int32_t slope = MUL(b, stf_apply2(g, STF_OP_POWER, a, SUB(b, N(1))));
  return MUL(w, stf_apply(g, STF_OP_SELECT, b, slope, N(0)));
}

/* d a^b/db times w = w a^b log a; where a is 0 that is 0 for b > 0, the limit, and else there is none. */
static int32_t of_exponent(stf_formulas *g, int32_t a, int32_t b, int32_t self, int32_t w)
{
  const int32_t log_a = FUN(LOG, a),
                at_0 =
                  stf_apply(g, STF_OP_SELECT, stf_apply2(g, STF_OP_LESS, N(0), b), N(0), log_a);
  return MUL(w, stf_apply(g, STF_OP_SELECT, a, MUL(self, log_a), at_0));
}

/* The same of node `self` = f(a, b) by a (first) or b. */
static int32_t of_two(stf_formulas *g, const stf_node *n, int32_t self, int32_t w, bool first)
{
  const int32_t a = n->a, b = n->b;
  switch (n->kind) {
  case STF_OP_ADD: return w;
  case STF_OP_SUBTRACT: return first ? w : NEG(w);
  case STF_OP_MULTIPLY: return MUL(w, first ? b : a);
  case STF_OP_DIVIDE: return first ? DIV(w, b) : NEG(DIV(MUL(w, self), b));
  case STF_OP_POWER: return first ? of_base(g, a, b, w) : of_exponent(g, a, b, self, w);
  case STF_OP_ATAN2: {
    const int32_t over = ADD(MUL(a, a), MUL(b, b));
    return first ? DIV(MUL(w, b), over) : NEG(DIV(MUL(w, a), over));
  }
  case STF_OP_MIN:
  case STF_OP_MAX: {
    const bool least = n->kind == STF_OP_MIN;
    const int32_t takes_a =
      least ? stf_apply2(g, STF_OP_LESS, a, b) : stf_apply2(g, STF_OP_LESS, b, a);
    return first ? stf_apply(g, STF_OP_SELECT, takes_a, w, N(0))
                 : stf_apply(g, STF_OP_SELECT, takes_a, N(0), w);
  }
  case STF_OP_MOD: return first ? w : NEG(MUL(w, FUN(FLOOR, DIV(a, b))));
  case STF_OP_HYPOT: return MUL(w, DIV(first ? a : b, self));
  default: return N(0);
  }
}

int32_t stf_partial_times(stf_formulas *g, int32_t self, int32_t w, int operand)
{
  const stf_node n = *stf_node_at(g, self);
  const int count = stf_operands(n.kind);
  if (count == 1) return of_one(g, &n, self, w);
  if (count == 2) return of_two(g, &n, self, w, operand == 0);
  if (operand == 0) return N(0);
  return operand == 1 ? stf_apply(g, STF_OP_SELECT, n.a, w, N(0))
                      : stf_apply(g, STF_OP_SELECT, n.a, N(0), w);
}

/* ---- sweeps
 * ----------------------------------------------------------------------------------
 */

static int32_t *adjoint(const stf_sweep *s, int32_t node)
{
  return STF_AT(s->adjoint, int32_t, node);
}

/* The adjoints of the operands of `node`, which is 1 + the number of a node or
 * 0. */
static int push_back(stf_formulas *g, int32_t node, int wanted, stf_sweep *s)
{
  int32_t child[3];
  const int count = stf_children(stf_node_at(g, node), child);
  const int32_t w = *adjoint(s, node) - 1;
  for (int k = 0; k < count; k++) {
    if (!(stf_node_at(g, child[k])->on & wanted)) continue;
    const int32_t part = stf_partial_times(g, node, w, k);
    if (part < 0) return STEIF_NO_MEMORY;
    int32_t *to = adjoint(s, child[k]);
    const int32_t sum = *to ? ADD(*to - 1, part) : part;
    if (sum < 0) return STEIF_NO_MEMORY;
    *to = sum + 1;
  }
  return STEIF_OK;
}

static int wanted_of(int kind)
{
  return kind == STF_OP_STATE   ? STF_ON_STATE
         : kind == STF_OP_SLOPE ? STF_ON_SLOPE
         : kind == STF_OP_TIME  ? STF_ON_TIME
                                : STF_ON_PARAMETER;
}

static int sweep_back(stf_formulas *g, int32_t root, int kind, stf_sweep *s,
                      stf_vector *partials)
{
  const int wanted = wanted_of(kind);
  *adjoint(s, root) = N(1) + 1;
  if (*adjoint(s, root) == 0) return STEIF_NO_MEMORY;
  for (size_t i = s->list.count; i--;) {
    const int32_t node = *STF_AT(s->list, int32_t, i);
    const stf_node *n = stf_node_at(g, node);
    if (!*adjoint(s, node) || !(n->on & wanted)) continue;
    g->at = n->at;
    if (n->kind == kind) {
      stf_partial *p = stf_vector_push(g->ctx, partials, sizeof *p);
      if (!p) return STEIF_NO_MEMORY;
      *p = (stf_partial){node, *adjoint(s, node) - 1};
    } else {
      STEIF_TRY(push_back(g, node, wanted, s));
    }
  }
  return STEIF_OK;
}

int stf_formulas_differentiate(stf_formulas *g, int32_t root, int kind, stf_sweep *s,
                               stf_vector *partials)
{
  partials->count = 0;
  if (!(stf_node_at(g, root)->on & wanted_of(kind))) return STEIF_OK;
  STEIF_TRY(stf_reach(g, root, &s->mark, &s->list));
  STEIF_TRY(stf_vector_resize(g->ctx, &s->adjoint, g->nodes.count, sizeof(int32_t)));
  const bool before = g->exact;
  g->exact = true;
  const int code = sweep_back(g, root, kind, s, partials);
  g->exact = before;
  for (size_t i = 0; i < s->list.count; i++) *adjoint(s, *STF_AT(s->list, int32_t, i)) = 0;
  return code;
}

int32_t stf_without(stf_formulas *g, int32_t root, int kind, stf_sweep *s)
{
  const int wanted = wanted_of(kind);
  if (!(stf_node_at(g, root)->on & wanted)) return root;
  if (stf_reach(g, root, &s->mark, &s->list) ||
      stf_vector_resize(g->ctx, &s->adjoint, g->nodes.count, sizeof(int32_t)))
    return -1;
  const bool before = g->exact;
  g->exact = true;
  int32_t result = root;
  for (size_t i = 0; i < s->list.count && result >= 0; i++) {
    int32_t child[3];
    const int32_t node = *STF_AT(s->list, int32_t, i);
    const stf_node n = *stf_node_at(g, node);
    const int count = stf_children(&n, child);
    for (int k = 0; k < count; k++) child[k] = *adjoint(s, child[k]) - 1;
    if (!(n.on & wanted))
      result = node;
    else if (n.kind == kind)
      result = N(0);
    else
      result =
        stf_apply(g, n.kind, child[0], count > 1 ? child[1] : n.b, count > 2 ? child[2] : n.c);
    *adjoint(s, node) = result + 1;
  }
  g->exact = before;
  for (size_t i = 0; i < s->list.count; i++) *adjoint(s, *STF_AT(s->list, int32_t, i)) = 0;
  return result;
}

void stf_sweep_free(steif_context *ctx, stf_sweep *s)
{
  stf_vector_free(ctx, &s->mark);
  stf_vector_free(ctx, &s->list);
  stf_vector_free(ctx, &s->adjoint);
}
