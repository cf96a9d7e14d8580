/* builder.c: expressions into nodes, by a machine with frames of its own: no
 * expression of a file makes the stack of the program grow.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "model.h"
#include <math.h>
#include <string.h>

enum { FRAMES = 1000000, NODES_KEPT = 100000 };

typedef struct frame {
  uint32_t pc, end;
  size_t scope, bindings; /* first binding that is seen; how many to go back to */
  int32_t symbol;         /* whose value this is; -1: none */
  int literal;            /* of the expression around */
  /* a sum */
  int64_t next, last;
  uint32_t from;
  int32_t total; /* node; -1: this is no sum */
} frame;

static frame *top(const stf_builder *b)
{
  return STF_AT(b->frames, frame, b->frames.count - 1);
}
static int32_t *memo(const stf_builder *b, int32_t i) { return STF_AT(b->memo, int32_t, i); }
static int complain(const stf_builder *b, uint32_t at, const char *what)
{
  return stf_complain(&b->m->syntax.sources, at, STEIF_BAD_INPUT, "%s", what);
}

int stf_builder_open(stf_builder *b, stf_model *m, stf_formulas *g, bool numeric)
{
  *b = (stf_builder){.m = m, .g = g, .numeric = numeric};
  return stf_vector_resize(m->ctx, &b->memo, m->symbols.count, sizeof(int32_t));
}

void stf_builder_close(stf_builder *b)
{
  stf_vector *all[] = {&b->stack, &b->frames, &b->bindings, &b->memo, &b->switch_of, &b->turns};
  for (size_t i = 0; i < sizeof all / sizeof *all; i++) stf_vector_free(b->m->ctx, all[i]);
}

int stf_push_node(stf_builder *b, int32_t node)
{
  int32_t *to = node < 0 ? NULL : stf_vector_push(b->m->ctx, &b->stack, sizeof *to);
  if (!to) return STEIF_NO_MEMORY;
  *to = node;
  return STEIF_OK;
}

static int32_t pop(stf_builder *b) { return *STF_AT(b->stack, int32_t, --b->stack.count); }

static int bind(stf_builder *b, const stf_binding *binding)
{
  stf_binding *to = stf_vector_push(b->m->ctx, &b->bindings, sizeof *to);
  if (!to) return STEIF_NO_MEMORY;
  *to = *binding;
  return STEIF_OK;
}

int stf_bind_node(stf_builder *b, int32_t word, int32_t node)
{
  return bind(b, &(stf_binding){.word = word, .node = node});
}

int stf_bind_index(stf_builder *b, int32_t word, const stf_affine *at)
{
  return bind(b, &(stf_binding){.word = word, .node = -1, .at = *at});
}

/* ---- frames
 * ----------------------------------------------------------------------------------
 */

int stf_enter(stf_builder *b, const stf_expression *e, int32_t symbol, size_t scope)
{
  if (b->frames.count >= FRAMES)
    return complain(b, STF_NOWHERE, "abbreviations nested too deeply");
  frame *f = stf_vector_push(b->m->ctx, &b->frames, sizeof *f);
  if (!f) return STEIF_NO_MEMORY;
  *f = (frame){.pc = e->from,
               .end = e->to,
               .scope = scope,
               .bindings = scope,
               .symbol = symbol,
               .total = -1,
               .literal = b->literal};
  if (symbol >= 0 && stf_symbol_at(b->m, symbol)->kind != STF_IS_FUNCTION) b->literal = 0;
  return STEIF_OK;
}

size_t stf_scope(const stf_builder *b) { return b->frames.count ? top(b)->scope : 0; }

/* "'a' needs 'b' (line 4), which needs 'a'" */
static int cycle(const stf_builder *b, int32_t symbol)
{
  const stf_model *m = b->m;
  size_t at = b->frames.count;
  while (at-- && STF_AT(b->frames, frame, at)->symbol != symbol) {}
  const stf_symbol *first = stf_symbol_at(m, symbol);
  const uint32_t place = stf_statement_at(m, first->statement)->at;
  const char *name = stf_named(m, first->word);
  char by[3 * STF_NAME_BYTES] = "";
  for (size_t i = at + 1; i < b->frames.count && strlen(by) < STF_NAME_BYTES; i++) {
    const int32_t next = STF_AT(b->frames, frame, i)->symbol;
    if (next < 0) continue;
    const stf_symbol *s = stf_symbol_at(m, next);
    snprintf(by + strlen(by), sizeof by - strlen(by), "'%s' (line %d), which needs ",
             stf_named(m, s->word), (int)stf_statement_at(m, s->statement)->line);
  }
  if (first->kind == STF_IS_FUNCTION)
    return stf_complain(&b->m->syntax.sources, place, STEIF_BAD_INPUT,
                        "function '%s' calls itself; recursion is not part of the language",
                        name);
  return stf_complain(
    &b->m->syntax.sources, place, STEIF_BAD_INPUT, "'%s' needs %s'%s'; %s", name, by, name,
    first->kind == STF_IS_LET ? "declare one of them as 'state' and the loop is "
                                "solved as an equation"
                              : "give one of them a number");
}

/* The value of a frame that has ended is on the stack. */
static int leave(stf_builder *b)
{
  frame *f = top(b);
  if (f->total >= 0) {
    const int32_t sum = stf_apply2(b->g, STF_OP_ADD, f->total, pop(b));
    if (sum < 0) return STEIF_NO_MEMORY;
    f->total = sum;
    if (f->next <= f->last) {
      STF_AT(b->bindings, stf_binding, f->bindings)->at.c = f->next++;
      f->pc = f->from;
      return STEIF_OK;
    }
    STEIF_TRY(stf_push_node(b, sum));
  }
  const int32_t node = *STF_AT(b->stack, int32_t, b->stack.count - 1);
  if (f->symbol >= 0) {
    stf_symbol *s = stf_symbol_at(b->m, f->symbol);
    if (s->kind == STF_IS_FUNCTION)
      s->visit = 0;
    else if (!s->dims)
      *memo(b, f->symbol) = node + 1;
    const bool valued = b->numeric && (s->kind == STF_IS_PARAMETER || s->kind == STF_IS_CONST);
    if (valued) {
      s->value = stf_node_at(b->g, node)->number;
      s->visit = 2;
    }
  }
  b->bindings.count = f->bindings;
  if (f->symbol >= 0) b->literal = f->literal;
  b->frames.count--;
  return STEIF_OK;
}

/* ---- names
 * -----------------------------------------------------------------------------------
 */

static int32_t index_node(stf_builder *b, const stf_affine *at)
{
  int32_t node = stf_number(b->g, (double)at->c);
  for (int d = 0; d < STF_LOOPS && node >= 0; d++) {
    if (!at->s[d]) continue;
    const int32_t counter = stf_leaf(b->g, STF_OP_COUNTER, d, NULL);
    const int32_t part =
      stf_apply2(b->g, STF_OP_MULTIPLY, counter, stf_number(b->g, (double)at->s[d]));
    node = stf_apply2(b->g, STF_OP_ADD, part, node);
  }
  return node;
}

static const stf_binding *bound(const stf_builder *b, int32_t word)
{
  const size_t scope = b->frames.count ? top(b)->scope : 0;
  for (size_t i = b->bindings.count; i-- > scope;)
    if (STF_AT(b->bindings, stf_binding, i)->word == word)
      return STF_AT(b->bindings, stf_binding, i);
  return NULL;
}

/* An abbreviation or parameter with an expression of its own. */
static int abbreviation(stf_builder *b, stf_symbol *s)
{
  const int32_t symbol = (int32_t)(s - stf_symbol_at(b->m, 0));
  int32_t *node = memo(b, symbol);
  if (*node > 0) return stf_push_node(b, *node - 1);
  if (*node < 0) return cycle(b, symbol);
  *node = -1;
  return stf_enter(b, &stf_statement_at(b->m, s->statement)->value, symbol, b->bindings.count);
}

static int symbol(stf_builder *b, stf_symbol *s, const stf_code *c)
{
  const stf_affine component = {.c = 0};
  switch (s->kind) {
  case STF_IS_PARAMETER:
  case STF_IS_CONST:
    if (!b->numeric && s->assigned)
      return stf_push_node(b, stf_leaf(b->g, STF_OP_MEMORY, s->memory, NULL));
    if (b->numeric && s->visit == 2) return stf_push_node(b, stf_number(b->g, s->value));
    if (!b->numeric && s->which >= 0)
      return stf_push_node(b, stf_leaf(b->g, STF_OP_PARAMETER, s->which, NULL));
    return abbreviation(b, s);
  case STF_IS_DISCRETE:
    if (b->numeric)
      return complain(b, c->at, "a discrete value where a number is needed at once");
    return stf_push_node(b, stf_leaf(b->g, STF_OP_MEMORY, s->which, NULL));
  case STF_IS_STATE: return stf_state_leaf(b, s, c->primes, &component, c->at);
  default: return abbreviation(b, s);
  }
}

static int name(stf_builder *b, const stf_code *c)
{
  if (c->a == STF_WORD_PI) return stf_push_node(b, stf_number(b->g, acos(-1)));
  const stf_binding *local = bound(b, c->a);
  if (local)
    return stf_push_node(b, local->node >= 0 ? local->node : index_node(b, &local->at));
  if (c->a == STF_WORD_T) {
    if (b->numeric && !b->started)
      return complain(b, c->at, "'t' where a number is needed at once");
    return stf_push_node(b, stf_leaf(b->g, STF_OP_TIME, 0, NULL));
  }
  stf_symbol *s = stf_symbol_of(b->m, c->a);
  if (s) return symbol(b, s, c);
  return stf_complain(&b->m->syntax.sources, c->at, STEIF_UNKNOWN_NAME,
                      "'%s' is not known here", stf_named(b->m, c->a));
}

/* ---- calls and sums
 * -------------------------------------------------------------------------- */

static int user_function(stf_builder *b, stf_symbol *s, int count)
{
  const int32_t which = (int32_t)(s - stf_symbol_at(b->m, 0));
  const size_t scope = b->bindings.count, first = b->stack.count - (size_t)count;
  if (s->visit) return cycle(b, which);
  for (int i = 0; i < count; i++)
    STEIF_TRY(stf_bind_node(b, stf_statement_at(b->m, s->statement + 1 + i)->name,
                            *STF_AT(b->stack, int32_t, first + (size_t)i)));
  b->stack.count = first;
  s->visit = 1;
  return stf_enter(b, &stf_statement_at(b->m, s->statement)->value, which, scope);
}

static int table(stf_builder *b, const stf_symbol *s)
{
  const int32_t x = pop(b);
  if (b->numeric) return complain(b, b->g->at, "a table where a number is needed at once");
  return stf_push_node(b, stf_table_value(b, x, s->which));
}

static int call(stf_builder *b, const stf_code *c)
{
  stf_symbol *s = stf_symbol_of(b->m, c->a);
  int operands;
  if (s && s->kind == STF_IS_FUNCTION) return user_function(b, s, c->b);
  if (s && s->kind == STF_IS_TABLE) return table(b, s);
  const char *word = stf_named(b->m, c->a);
  const int kind = stf_function_of(word, &operands);
  if (kind >= 0) {
    const int32_t second = operands > 1 ? pop(b) : 0, first = pop(b);
    return stf_push_node(b, stf_kinked(b, kind, first, second));
  }
  const int32_t by = pop(b), of = pop(b);
  return stf_push_node(b,
                       stf_apply1(b->g, STF_OP_FLOOR, stf_apply2(b->g, STF_OP_DIVIDE, of, by)));
}

static int series(stf_builder *b, const stf_code *c)
{
  const stf_range *r = STF_AT(b->m->syntax.indices, stf_range, c->a);
  stf_affine low, high;
  frame *f = top(b);
  const stf_expression body = {f->pc, f->pc + (uint32_t)c->b};
  STEIF_TRY(stf_index(b, &r->low, c->at, &low));
  STEIF_TRY(stf_index(b, &r->high, c->at, &high));
  for (int d = 0; d < STF_LOOPS; d++)
    if (low.s[d] || high.s[d]) {
      b->fallback = true;
      low.s[d] = high.s[d] = 0;
    }
  f->pc = body.to;
  if (high.c - low.c >= STF_PASSES_MOST)
    return complain(b, c->at, "a sum of more than 1e8 terms");
  if (high.c < low.c) return stf_push_node(b, stf_number(b->g, 0));
  const size_t scope = f->scope, bindings = b->bindings.count;
  STEIF_TRY(stf_bind_index(b, r->name, &(stf_affine){.c = low.c}));
  STEIF_TRY(stf_enter(b, &body, -1, scope));
  f = top(b);
  f->bindings = bindings;
  f->from = body.from;
  f->next = low.c + 1;
  f->last = high.c;
  f->total = stf_number(b->g, 0);
  return f->total < 0 ? STEIF_NO_MEMORY : STEIF_OK;
}

/* ---- the machine
 * -----------------------------------------------------------------------------
 */

static int apply(stf_builder *b, const stf_code *c)
{
  const int count = stf_operands(c->kind);
  int32_t x[3] = {0, 0, 0};
  for (int i = count; i--;) x[i] = pop(b);
  if (c->kind != STF_OP_LESS && c->kind != STF_OP_LESS_EQUAL)
    return stf_push_node(b, stf_apply(b->g, c->kind, x[0], x[1], x[2]));
  return stf_push_node(b, stf_relation(b, c->kind, x[c->a], x[!c->a]));
}

static int step(stf_builder *b)
{
  frame *f = top(b);
  const stf_code c = *STF_AT(b->m->syntax.codes, stf_code, f->pc++);
  b->g->at = c.at;
  switch (c.kind) {
  case STF_OP_NUMBER: return stf_push_node(b, stf_number(b->g, c.number));
  case STF_OP_NAME: return name(b, &c);
  case STF_OP_ELEMENT: return stf_element(b, &c);
  case STF_OP_CALL: return call(b, &c);
  case STF_OP_SKIP: f->pc += (uint32_t)c.a; return STEIF_OK;
  case STF_OP_SUM: return series(b, &c);
  case STF_OP_LITERAL: b->literal += c.a; return STEIF_OK;
  default: return apply(b, &c);
  }
}

/* After an error nothing is half done. */
static void reset(stf_builder *b)
{
  for (size_t i = 0; i < b->frames.count; i++) {
    const int32_t s = STF_AT(b->frames, frame, i)->symbol;
    if (s < 0) continue;
    if (stf_symbol_at(b->m, s)->kind == STF_IS_FUNCTION)
      stf_symbol_at(b->m, s)->visit = 0;
    else
      *memo(b, s) = 0;
  }
  b->frames.count = b->stack.count = 0;
  b->literal = 0;
}

int stf_build(stf_builder *b, const stf_expression *e, int32_t *node)
{
  const size_t bindings = b->bindings.count;
  int code = stf_enter(b, e, -1, 0);
  if (!code) top(b)->bindings = bindings;
  while (!code && b->frames.count) code = top(b)->pc == top(b)->end ? leave(b) : step(b);
  if (!code)
    *node = pop(b);
  else
    reset(b);
  b->bindings.count = bindings;
  return code;
}

int stf_value(stf_builder *b, const stf_expression *e, double *value)
{
  int32_t node = 0;
  if (b->g->nodes.count > NODES_KEPT) {
    stf_formulas_free(b->g);
    memset(b->memo.data, 0, b->memo.count * sizeof(int32_t));
  }
  STEIF_TRY(stf_build(b, e, &node));
  const stf_node *n = stf_node_at(b->g, node);
  *value = n->kind == STF_OP_NUMBER ? n->number : NAN;
  return STEIF_OK;
}
