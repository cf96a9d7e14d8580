/* blame.c: which operation of which equation has no value at a point, and of what.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "model.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static double leaf(const stf_feed *f, const stf_node *n, const int32_t *counter)
{
  const int64_t at = n->a + (int64_t)n->b * counter[0] + (int64_t)n->stride[0] * counter[1] +
                     (int64_t)n->stride[1] * counter[2];
  switch (n->kind) {
  case STF_OP_NUMBER: return n->number;
  case STF_OP_TIME: return f->t;
  case STF_OP_PARAMETER: return f->p[n->a];
  case STF_OP_STATE: return f->y ? f->y[at] : 0;
  case STF_OP_SLOPE: return f->yp ? f->yp[at] : 0;
  case STF_OP_MEMORY: return f->memory[at];
  default: return counter[n->a];
  }
}

/* "t = 0, x = 2, k = 1": what the node depends on, a few of it. */
static void depends(const stf_model *m, const stf_formulas *g, const stf_feed *f,
                    const int32_t *counter, int32_t node, size_t room, char *text)
{
  stf_sweep sweep = {{0}, {0}, {0}};
  size_t used = (size_t)snprintf(text, room, "t = %.6g", f->t);
  if (!stf_reach(g, node, &sweep.mark, &sweep.list))
    for (size_t i = 0, shown = 0; i < sweep.list.count && shown < 3 && used < room; i++) {
      const stf_node *n = stf_node_at(g, *STF_AT(sweep.list, int32_t, i));
      if (n->kind != STF_OP_STATE) continue;
      const int64_t at = n->a + (int64_t)n->b * counter[0] +
                         (int64_t)n->stride[0] * counter[1] +
                         (int64_t)n->stride[1] * counter[2];
      used += (size_t)snprintf(text + used, room - used, ", %s = %.6g", m->unknown[at],
                               leaf(f, n, counter));
      shown++;
    }
  stf_sweep_free(m->ctx, &sweep);
}

/* The first node whose operands have values and which has none; its operands in x. */
static int32_t first_without(stf_model *m, const stf_formulas *g, const stf_feed *f,
                             const int32_t *counter, int32_t root, double x[3])
{
  stf_sweep sweep = {{0}, {0}, {0}};
  stf_vector values = {0};
  int32_t found = -1;
  if (stf_reach(g, root, &sweep.mark, &sweep.list) ||
      stf_vector_resize(m->ctx, &values, g->nodes.count, sizeof(double)))
    sweep.list.count = 0;
  double *v = values.data;
  for (size_t i = 0; i < sweep.list.count && found < 0; i++) {
    int32_t child[3];
    const int32_t k = *STF_AT(sweep.list, int32_t, i);
    const stf_node *n = stf_node_at(g, k);
    const int count = stf_children(n, child);
    for (int j = 0; j < 3; j++) x[j] = j < count ? v[child[j]] : 0;
    v[k] = count == 0                 ? leaf(f, n, counter)
           : n->kind == STF_OP_LOOKUP ? stf_lookup_value(f->lookups + n->b, x[0])
                                      : stf_operate(n->kind, x[0], x[1], x[2]);
    if (!isfinite(v[k])) found = k;
  }
  stf_vector_free(m->ctx, &values);
  stf_sweep_free(m->ctx, &sweep);
  return found;
}

/* ": 'x - x0' is 0" of the operand after the '/' at `at`, as it is written; "" where it is not short. */
static const char *operand(const stf_model *m, uint32_t at, size_t room, char *text)
{
  const char *from = stf_source_at(&m->syntax.sources, at);
  size_t length = 0;
  int depth = 0;
  if (*from++ != '/') return "";
  from += strspn(from, " \t");
  for (; from[length] && from[length] != '\n'; length++) {
    if (!depth && strchr("+-*/^,)]=<> \t#{:", from[length])) break;
    depth += strchr("([", from[length]) ? 1 : strchr(")]", from[length]) ? -1 : 0;
  }
  const bool bracket = *from == '(' && length > 2 && from[length - 1] == ')';
  if (!length || depth || length > 42) return "";
  snprintf(text, room, ": '%.*s' is 0", (int)length - 2 * bracket, from + bracket);
  return text;
}

static void describe(stf_model *m, const stf_block *block, const stf_feed *f,
                     const int32_t *counter, int32_t node, const double x[3], stf_blame *blame)
{
  char where[300], zero[60];
  const stf_node *n = stf_node_at(&block->graph, node);
  const char *word = stf_operation_word(n->kind);
  depends(m, &block->graph, f, counter, node, sizeof where, where);
  blame->at = n->at;
  if (n->kind == STF_OP_DIVIDE && x[1] == 0)
    snprintf(blame->what, sizeof blame->what, "division by zero (%s)%s", where,
             operand(m, n->at, sizeof zero, zero));
  else if (stf_operands(n->kind) == 2)
    snprintf(blame->what, sizeof blame->what, "%.6g %s %.6g is not finite (%s)", x[0], word,
             x[1], where);
  else
    snprintf(blame->what, sizeof blame->what, "%s of %.6g (%s)", *word ? word : "a value", x[0],
             where);
}

bool stf_find_blame(stf_model *m, const stf_feed *feed, int32_t row, stf_blame *blame)
{
  for (size_t i = 0; i < m->blocks.count; i++) {
    const stf_block *block = *STF_AT(m->blocks, stf_block *, i);
    const int64_t count = stf_passes(&block->box);
    for (size_t k = 0; k < block->equations.count; k++) {
      const stf_equation *e = STF_AT(block->equations, stf_equation, k);
      for (int64_t pass = 0; pass < count; pass++) {
        static const int32_t unit[STF_LOOPS][STF_LOOPS] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
        int32_t counter[STF_LOOPS];
        double x[3];
        if ((e->slot ? e->slot[pass] : stf_at_pass(&block->box, pass, e->row, e->stride)) !=
            row)
          continue;
        for (int d = 0; d < STF_LOOPS; d++)
          counter[d] = stf_at_pass(&block->box, pass, 0, unit[d]);
        const int32_t node = first_without(m, &block->graph, feed, counter, e->value, x);
        if (node < 0) return false;
        describe(m, block, feed, counter, node, x, blame);
        return true;
      }
    }
  }
  return false;
}
