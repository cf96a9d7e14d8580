/* tape_compile.c: the nodes that outputs reach, in the order of their numbers,
 * as instructions. SPDX-License-Identifier: BSD-3-Clause */
#include "assembly.h"

typedef struct compiler {
  const stf_formulas *g;
  stf_tape *tape;
  stf_assembly assembly;
  stf_vector scalar, lane; /* 1 + register of each node; 0: none yet */
  stf_vector live;         /* uint8_t */
} compiler;

static int32_t *scalar(const compiler *c, int32_t node)
{
  return STF_AT(c->scalar, int32_t, node);
}
static int32_t *lane(const compiler *c, int32_t node) { return STF_AT(c->lane, int32_t, node); }
static bool live(const compiler *c, int32_t node) { return *STF_AT(c->live, uint8_t, node); }
static bool wide(const stf_node *n) { return n->on & STF_ON_PASS; }

static void *push(compiler *c, stf_vector *v, size_t size)
{
  return stf_vector_push(c->g->ctx, v, size);
}

/* Nodes that are needed, from the last to the first. */
static void mark(compiler *c, size_t count, const stf_store *outputs)
{
  int32_t child[3];
  for (size_t i = 0; i < count; i++) *STF_AT(c->live, uint8_t, outputs[i].from) = 1;
  for (int32_t i = (int32_t)c->g->nodes.count; i--;) {
    if (!live(c, i)) continue;
    const int operands = stf_children(stf_node_at(c->g, i), child);
    for (int k = 0; k < operands; k++) *STF_AT(c->live, uint8_t, child[k]) = 1;
  }
}

static int number(compiler *c, const stf_node *n, int32_t to)
{
  double *value = push(c, &c->tape->numbers, sizeof *value);
  int32_t *at = value ? push(c, &c->assembly.number_at, sizeof *at) : NULL;
  if (!at) return STEIF_NO_MEMORY;
  *value = n->number;
  *at = to;
  return STEIF_OK;
}

static int load(compiler *c, const stf_node *n, int32_t reg)
{
  stf_stretch *l = push(c, &c->tape->loads, sizeof *l);
  if (!l) return STEIF_NO_MEMORY;
  *l = (stf_stretch){n->kind, reg, n->kind == STF_OP_TIME ? 0 : n->a, 1};
  return STEIF_OK;
}

static int wide_load(compiler *c, const stf_node *n, int32_t reg)
{
  stf_load *l = push(c, &c->tape->wide_loads, sizeof *l);
  if (!l) return STEIF_NO_MEMORY;
  *l = (stf_load){.kind = n->kind, .to = reg, .a = n->a};
  if (n->kind >= STF_OP_STATE && n->kind <= STF_OP_MEMORY) {
    l->stride[0] = n->b;
    l->stride[1] = n->stride[0];
    l->stride[2] = n->stride[1];
  }
  return STEIF_OK;
}

static int instruction(compiler *c, stf_vector *code, const stf_node *n, int32_t to,
                       const int32_t child[3])
{
  stf_step_code *s = push(c, code, sizeof *s);
  if (!s) return STEIF_NO_MEMORY;
  *s = (stf_step_code){n->kind, to, child[0], child[1], child[2]};
  if (n->kind == STF_OP_LOOKUP || n->kind == STF_OP_TILT) s->b = n->b;
  return STEIF_OK;
}

static int scalar_node(compiler *c, int32_t i)
{
  const stf_node *n = stf_node_at(c->g, i);
  int32_t child[3] = {0, 0, 0}, from[3] = {0, 0, 0};
  const int32_t to = c->tape->registers++;
  *scalar(c, i) = to + 1;
  if (n->kind == STF_OP_NUMBER) return number(c, n, to);
  if (n->kind < STF_OP_NEGATIVE) return load(c, n, to);
  const int count = stf_children(n, child);
  for (int k = 0; k < count; k++) from[k] = *scalar(c, child[k]) - 1;
  return instruction(c, &c->assembly.code, n, to, from);
}

/* A lane register with a scalar value in it. */
static int32_t widened(compiler *c, int32_t i)
{
  if (*lane(c, i)) return *lane(c, i) - 1;
  stf_step_code *s = push(c, &c->tape->broadcasts, sizeof *s);
  if (!s) return -1;
  *s = (stf_step_code){.to = c->tape->lanes++, .a = *scalar(c, i) - 1};
  *lane(c, i) = s->to + 1;
  return s->to;
}

static int lane_node(compiler *c, int32_t i)
{
  const stf_node *n = stf_node_at(c->g, i);
  int32_t child[3] = {0, 0, 0}, from[3] = {0, 0, 0};
  const int count = stf_children(n, child);
  for (int k = 0; k < count; k++) {
    from[k] = wide(stf_node_at(c->g, child[k])) ? *lane(c, child[k]) - 1 : widened(c, child[k]);
    if (from[k] < 0) return STEIF_NO_MEMORY;
  }
  const int32_t to = c->tape->lanes++;
  *lane(c, i) = to + 1;
  if (n->kind < STF_OP_NEGATIVE) return wide_load(c, n, to);
  return instruction(c, &c->tape->wide, n, to, from);
}

/* First what depends on parameters only, then what is the same for all passes,
 * then the rest. */
static int nodes(compiler *c)
{
  const int32_t count = (int32_t)c->g->nodes.count;
  for (int turn = 0; turn < 3; turn++) {
    for (int32_t i = 0; i < count; i++) {
      if (!live(c, i)) continue;
      const stf_node *n = stf_node_at(c->g, i);
      const bool fixed = !(n->on & ~STF_ON_PARAMETER);
      const int mine = wide(n) ? 2 : fixed ? 0 : 1;
      if (mine == turn) STEIF_TRY(turn < 2 ? scalar_node(c, i) : lane_node(c, i));
    }
    if (turn > 0) continue;
    c->assembly.fixed = c->assembly.code.count;
    c->tape->fixed_loads = c->tape->loads.count;
  }
  return STEIF_OK;
}

static int store(compiler *c, const stf_store *output)
{
  stf_store *s = push(c, &c->tape->stores, sizeof *s);
  if (!s) return STEIF_NO_MEMORY;
  *s = *output;
  s->from = wide(stf_node_at(c->g, output->from)) ? *lane(c, output->from) - 1
                                                  : widened(c, output->from);
  return s->from < 0 ? STEIF_NO_MEMORY : STEIF_OK;
}

static int result(compiler *c, const stf_store *output)
{
  stf_stretch *s = push(c, &c->tape->results, sizeof *s);
  if (!s) return STEIF_NO_MEMORY;
  *s = (stf_stretch){.at = *scalar(c, output->from) - 1,
                     .a = output->slot ? output->slot[0] : output->a,
                     .count = 1};
  return STEIF_OK;
}

/* What stands in lists by nodes, which a tape no longer needs when all is translated. */
static void forget_nodes(compiler *c)
{
  stf_vector *all[] = {&c->scalar, &c->lane, &c->live};
  for (size_t i = 0; i < sizeof all / sizeof *all; i++) stf_vector_free(c->g->ctx, all[i]);
}

static int translate(compiler *c, size_t count, const stf_store *outputs)
{
  stf_tape *t = c->tape;
  STEIF_TRY(nodes(c));
  for (size_t i = 0; i < count; i++)
    STEIF_TRY(t->box.dims ? store(c, outputs + i) : result(c, outputs + i));
  t->operations = (int64_t)(c->assembly.code.count - c->assembly.fixed) +
                  (t->box.dims ? stf_passes(&t->box) * (int64_t)t->wide.count : 0);
  forget_nodes(c);
  STEIF_TRY(stf_tape_fuse(&c->assembly));
  STEIF_TRY(stf_tape_sum(&c->assembly));
  STEIF_TRY(stf_tape_arrange(&c->assembly));
  STEIF_TRY(stf_tape_encode(&c->assembly));
  return stf_vector_resize(c->g->ctx, &t->at, (size_t)t->lanes, sizeof(double *));
}

int stf_tape_compile(const stf_formulas *g, const stf_box *box, size_t count,
                     const stf_store *outputs, stf_tape *tape)
{
  compiler c = {.g = g, .tape = tape, .assembly = {.ctx = g->ctx, .tape = tape}};
  const size_t nodes_count = g->nodes.count;
  *tape = (stf_tape){.box = *box};
  int code = stf_vector_resize(g->ctx, &c.scalar, nodes_count, sizeof(int32_t));
  if (!code && box->dims)
    code = stf_vector_resize(g->ctx, &c.lane, nodes_count, sizeof(int32_t));
  if (!code) code = stf_vector_resize(g->ctx, &c.live, nodes_count, 1);
  if (!code) {
    mark(&c, count, outputs);
    code = translate(&c, count, outputs);
  }
  forget_nodes(&c);
  stf_vector *all[] = {&c.assembly.uses,      &c.assembly.maker, &c.assembly.number_at,
                       &c.assembly.negatives, &c.assembly.code,  &c.assembly.factors};
  for (size_t i = 0; i < sizeof all / sizeof *all; i++) stf_vector_free(g->ctx, all[i]);
  if (code) stf_tape_free(g->ctx, tape);
  return code;
}

void stf_tape_free(steif_context *ctx, stf_tape *t)
{
  stf_vector *all[] = {&t->numbers,    &t->loads, &t->code,   &t->results, &t->wide_loads,
                       &t->broadcasts, &t->wide,  &t->stores, &t->at};
  for (size_t i = 0; i < sizeof all / sizeof *all; i++) stf_vector_free(ctx, all[i]);
}

size_t stf_tape_space(const stf_tape *t)
{
  return (size_t)t->registers + (size_t)t->lanes * STF_PASSES;
}
