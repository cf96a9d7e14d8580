/* loops.c: equations into blocks: one without loops, and some for each loop, whose passes are kept together
 * in rectangles as far as all indices exist in them: the interior of a grid, its faces, its edges. What is
 * left becomes equations of the first block.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "model.h"
#include <math.h>
#include <string.h>

enum { BOUND = 1000000000 };
enum { FEWEST = 8 }; /* passes that are worth a block of their own */

typedef struct loops {
  int dims;
  int32_t statement[STF_LOOPS], low[STF_LOOPS], high[STF_LOOPS];
} loops;

static stf_block *block_at(const stf_model *m, size_t i)
{
  return *STF_AT(m->blocks, stf_block *, i);
}

static stf_block *block_new(stf_model *m)
{
  stf_block *block = stf_pool_array(m->pool, 1, sizeof *block);
  stf_block **to = block ? stf_vector_push(m->ctx, &m->blocks, sizeof *to) : NULL;
  if (!to) return NULL;
  block->graph.ctx = m->ctx;
  *to = block;
  return block;
}

static stf_equation *equation_new(stf_model *m, stf_block *block, int32_t statement)
{
  stf_equation *e = stf_vector_push(m->ctx, &block->equations, sizeof *e);
  if (e) *e = (stf_equation){.statement = statement, .residual = -1, .value = -1};
  return e;
}

/* x' = f without derivatives in f: the row of x. */
static void explicit_row(stf_block *block, stf_equation *e, int32_t left, int32_t right)
{
  const stf_node *l = stf_node_at(&block->graph, left), *r = stf_node_at(&block->graph, right);
  if (l->kind != STF_OP_SLOPE || (r->on & STF_ON_SLOPE)) return;
  e->value = right;
  e->own = true;
  e->row = l->a;
  e->stride[0] = l->b;
  e->stride[1] = l->stride[0];
  e->stride[2] = l->stride[1];
}

static int equation(stf_model *m, stf_builder *b, stf_block *block, int32_t statement)
{
  const stf_statement *s = stf_statement_at(m, statement);
  int32_t left, right;
  STEIF_TRY(stf_build(b, &s->value, &left));
  STEIF_TRY(stf_build(b, &s->other, &right));
  stf_equation *e = equation_new(m, block, statement);
  if (!e) return STEIF_NO_MEMORY;
  explicit_row(block, e, left, right);
  block->graph.at = s->third.from;
  e->residual = stf_is_number(&block->graph, left, 0)
                  ? right
                  : stf_apply2(&block->graph, STF_OP_SUBTRACT, left, right);
  return e->residual < 0 ? STEIF_NO_MEMORY : STEIF_OK;
}

/* ---- loops
 * -----------------------------------------------------------------------------------
 */

static int bound(stf_builder *b, const stf_statement *s, const stf_expression *e,
                 int64_t *value)
{
  stf_affine x;
  STEIF_TRY(stf_index(b, e, s->third.from, &x));
  for (int d = 0; d < STF_LOOPS; d++)
    if (x.s[d]) b->fallback = true;
  *value = x.c;
  return STEIF_OK;
}

static int bounds(stf_model *m, stf_builder *b, loops *l, int d)
{
  const stf_statement *s = stf_statement_at(m, l->statement[d]);
  int64_t low, high;
  STEIF_TRY(bound(b, s, &s->range[0].low, &low));
  STEIF_TRY(bound(b, s, &s->range[0].high, &high));
  double passes = fmax((double)high - (double)low + 1, 0);
  for (int k = 0; k < d && k < STF_LOOPS; k++)
    passes *= fmax((double)l->high[k] - l->low[k] + 1, 0);
  if (passes > STF_PASSES_MOST)
    return stf_complain(&m->syntax.sources, s->third.from, STEIF_BAD_INPUT,
                        "a loop of %.4g passes; 1e8 is the most. Bounds are checked before a "
                        "product of them can overflow",
                        passes);
  if (low < -BOUND || high > BOUND)
    return stf_complain(&m->syntax.sources, s->third.from, STEIF_BAD_INPUT,
                        "the bounds of a loop lie between -1e9 and 1e9");
  l->low[d] = (int32_t)low;
  l->high[d] = (int32_t)(high < low ? low - 1 : high);
  return STEIF_OK;
}

/* The equations in the loop, for the counters that are bound. */
static int body(stf_model *m, stf_builder *b, stf_block *block, int32_t loop)
{
  for (size_t i = (size_t)loop + 1; i < m->syntax.statements.count; i++) {
    const stf_statement *s = stf_statement_at(m, (int32_t)i);
    if (s->parent < loop) break;
    if (s->kind == STF_SAY_EQUATION && s->parent == loop)
      STEIF_TRY(equation(m, b, block, (int32_t)i));
  }
  return STEIF_OK;
}

/* A rectangle of passes. */
typedef struct region {
  int32_t low[STF_LOOPS], high[STF_LOOPS];
} region;

/* Passes one by one; of a rectangle, where there is one. */
static int one_by_one(stf_model *m, stf_builder *b, const loops *l, const region *part, int d)
{
  if (d >= l->dims || d >= STF_LOOPS)
    return body(m, b, block_at(m, 0), l->statement[l->dims - 1]);
  loops own = *l;
  b->fallback = false;
  STEIF_TRY(bounds(m, b, &own, d));
  const int64_t low = part ? part->low[d] : own.low[d],
                high = part ? part->high[d] : own.high[d];
  for (int64_t i = low; i <= high; i++) {
    const size_t before = b->bindings.count;
    STEIF_TRY(
      stf_bind_index(b, stf_statement_at(m, l->statement[d])->name, &(stf_affine){.c = i}));
    STEIF_TRY(one_by_one(m, b, &own, part, d + 1));
    b->bindings.count = before;
  }
  return STEIF_OK;
}

/* The names of the loops: of those with one pass a number, of the others a counter; returns how many
 * counters, which are the loops `of`. */
static int bind_counters(stf_model *m, stf_builder *b, const loops *l, const region *part,
                         int *of)
{
  b->dims = 0;
  for (int d = 0; d < l->dims; d++) {
    stf_affine x = {.c = part->low[d]};
    if (part->high[d] > part->low[d]) {
      x = (stf_affine){0};
      x.s[b->dims] = 1;
      b->low[b->dims] = b->range_low[b->dims] = part->low[d];
      b->high[b->dims] = b->range_high[b->dims] = part->high[d];
      of[b->dims++] = d;
    }
    STEIF_TRY(stf_bind_index(b, stf_statement_at(m, l->statement[d])->name, &x));
  }
  return STEIF_OK;
}

static void drop_block(stf_model *m, stf_block *block)
{
  stf_formulas_free(&block->graph);
  stf_vector_free(m->ctx, &block->equations);
  stf_vector_free(m->ctx, &block->switches);
  m->blocks.count--;
}

/* The body once for the passes of a rectangle in which it holds, `done`; false: for none. */
static int together(stf_model *m, const loops *l, const region *part, region *done, bool *any)
{
  stf_builder b;
  int of[STF_LOOPS];
  stf_block *block = block_new(m);
  if (!block) return STEIF_NO_MEMORY;
  const int32_t memories = m->memories, switches = m->switches;
  int code = stf_builder_open(&b, m, &block->graph, false);
  b.events = true;
  b.block = block;
  if (!code) code = bind_counters(m, &b, l, part, of);
  if (!code) code = body(m, &b, block, l->statement[l->dims - 1]);
  int64_t passes = b.fallback || code ? 0 : 1;
  *done = *part;
  block->box = (stf_box){.dims = b.dims};
  for (int k = 0; k < b.dims; k++) {
    const int32_t count = b.high[k] < b.low[k] ? 0 : b.high[k] - b.low[k] + 1;
    block->box.low[k] = done->low[of[k]] = b.low[k];
    block->box.count[k] = count;
    done->high[of[k]] = b.high[k];
    passes *= count;
  }
  *any = passes >= FEWEST;
  stf_builder_close(&b);
  if (!*any) {
    drop_block(m, block);
    m->memories = memories;
    m->switches = switches;
  }
  return code;
}

/* A loop of a few passes that could be looked at one by one; -1: none. */
static int thinnest(const loops *l, const region *part)
{
  int found = -1;
  for (int d = 0; d < l->dims; d++) {
    const int32_t count = part->high[d] - part->low[d] + 1;
    if (count > 1 && count <= FEWEST &&
        (found < 0 || count < part->high[found] - part->low[found] + 1))
      found = d;
  }
  return found;
}

static int64_t passes_of(const loops *l, const region *part)
{
  int64_t count = 1;
  for (int d = 0; d < l->dims; d++) count *= (int64_t)part->high[d] - part->low[d] + 1;
  return count;
}

enum { REGIONS = 4096 };

/* What is left of `part` around `done`, in slabs: those of loop d lie inside `done` in the loops before. */
static int around(stf_model *m, const loops *l, region part, const region *done,
                  stf_vector *open)
{
  for (int d = 0; d < l->dims; d++) {
    region below = part, above = part;
    below.high[d] = done->low[d] - 1;
    above.low[d] = done->high[d] + 1;
    const region *const sides[] = {&below, &above};
    for (int k = 0; k < 2; k++) {
      if (passes_of(l, sides[k]) < 1) continue;
      region *to = stf_vector_push(m->ctx, open, sizeof *to);
      if (!to) return STEIF_NO_MEMORY;
      *to = *sides[k];
    }
    part.low[d] = done->low[d];
    part.high[d] = done->high[d];
  }
  return STEIF_OK;
}

/* One rectangle: together as far as possible, and what is left around it; or in layers. */
static int rectangle(stf_model *m, stf_builder *b, const loops *l, const region *part,
                     stf_vector *open)
{
  region done, layer = *part;
  bool any = false;
  if (passes_of(l, part) >= FEWEST && open->count < REGIONS)
    STEIF_TRY(together(m, l, part, &done, &any));
  if (any) return around(m, l, *part, &done, open);
  const int thin = passes_of(l, part) >= 2 * FEWEST ? thinnest(l, part) : -1;
  if (thin < 0) return one_by_one(m, b, l, part, 0);
  for (int32_t i = part->low[thin]; i <= part->high[thin]; i++) {
    layer.low[thin] = layer.high[thin] = i;
    region *to = stf_vector_push(m->ctx, open, sizeof *to);
    if (!to) return STEIF_NO_MEMORY;
    *to = layer;
  }
  return STEIF_OK;
}

/* Bounds that are numbers make a rectangle; others depend on counters around. */
static int is_rectangle(stf_model *m, loops *l, region *all, bool *yes)
{
  stf_builder b;
  stf_formulas g = {.ctx = m->ctx};
  int code = stf_builder_open(&b, m, &g, false);
  for (int d = 0; !code && d < l->dims; d++) {
    stf_affine x = {0};
    x.s[d] = 1;
    code = bounds(m, &b, l, d);
    if (!code) code = stf_bind_index(&b, stf_statement_at(m, l->statement[d])->name, &x);
    all->low[d] = l->low[d];
    all->high[d] = l->high[d];
  }
  *yes = !b.fallback;
  stf_builder_close(&b);
  stf_formulas_free(&g);
  return code;
}

static int rectangles(stf_model *m, stf_builder *b, const loops *l, const region *all)
{
  stf_vector open = {0};
  int code = STEIF_OK;
  region *first = passes_of(l, all) < 1 ? NULL : stf_vector_push(m->ctx, &open, sizeof *first);
  if (first) *first = *all;
  if (!first && passes_of(l, all) > 0) code = STEIF_NO_MEMORY;
  for (size_t i = 0; !code && i < open.count; i++) {
    const region part = *STF_AT(open, region, i);
    code = rectangle(m, b, l, &part, &open);
  }
  stf_vector_free(m->ctx, &open);
  return code;
}

static bool holds_equations(const stf_model *m, int32_t loop)
{
  for (size_t i = (size_t)loop + 1; i < m->syntax.statements.count; i++) {
    const stf_statement *s = stf_statement_at(m, (int32_t)i);
    if (s->parent < loop) return false;
    if (s->kind == STF_SAY_EQUATION && s->parent == loop) return true;
  }
  return false;
}

static int loop(stf_model *m, stf_builder *b, int32_t statement)
{
  loops l = {.dims = 0};
  region all = {{0}, {0}};
  bool yes = false;
  int32_t chain[STF_LOOPS + 1];
  int depth = 0;
  if (!holds_equations(m, statement)) return STEIF_OK;
  for (int32_t i = statement; i >= 0; i = stf_statement_at(m, i)->parent) {
    if (depth == STF_LOOPS)
      return stf_complain(&m->syntax.sources, stf_statement_at(m, statement)->at,
                          STEIF_BAD_INPUT, "loops nested more than 3 deep");
    chain[depth++] = i;
  }
  while (depth) l.statement[l.dims++] = chain[--depth];
  STEIF_TRY(is_rectangle(m, &l, &all, &yes));
  return yes ? rectangles(m, b, &l, &all) : one_by_one(m, b, &l, NULL, 0);
}

/* ---- velocities
 * ------------------------------------------------------------------------------
 */

/* (x^(k))' = x^(k+1) for the derivatives that are unknowns. */
static int velocities(stf_model *m)
{
  for (size_t i = 0; i < m->symbols.count; i++) {
    const stf_symbol *s = stf_symbol_at(m, (int32_t)i);
    for (int k = 0; s->kind == STF_IS_STATE && k + 1 < s->order; k++) {
      const bool one = s->size < FEWEST;
      stf_block *block = one ? block_at(m, 0) : block_new(m);
      if (!block) return STEIF_NO_MEMORY;
      if (!one) block->box = (stf_box){.dims = 1, .count = {s->size}};
      const int32_t stride[STF_LOOPS] = {!one, 0, 0};
      for (int32_t j = 0; j < (one ? s->size : 1); j++) {
        const int32_t value =
          stf_leaf(&block->graph, STF_OP_STATE, s->first[k + 1] + j, stride);
        const int32_t slope = stf_leaf(&block->graph, STF_OP_SLOPE, s->first[k] + j, stride);
        stf_equation *e = value < 0 || slope < 0 ? NULL : equation_new(m, block, -1);
        if (!e) return STEIF_NO_MEMORY;
        explicit_row(block, e, slope, value);
        e->residual = stf_apply2(&block->graph, STF_OP_SUBTRACT, slope, value);
        if (e->residual < 0) return STEIF_NO_MEMORY;
      }
    }
  }
  return STEIF_OK;
}

int stf_build_blocks(stf_model *m)
{
  stf_builder b;
  if (!block_new(m)) return STEIF_NO_MEMORY;
  STEIF_TRY(velocities(m));
  int code = stf_builder_open(&b, m, &block_at(m, 0)->graph, false);
  b.events = true;
  b.block = block_at(m, 0);
  for (size_t i = 0; code != STEIF_NO_MEMORY && i < m->syntax.statements.count &&
                     m->syntax.sources.errors < STF_ERRORS;
       i++) {
    const stf_statement *s = stf_statement_at(m, (int32_t)i);
    if (s->kind == STF_SAY_FOR) code = loop(m, &b, (int32_t)i);
    if (s->kind == STF_SAY_EQUATION && s->parent < 0)
      code = equation(m, &b, block_at(m, 0), (int32_t)i);
    b.bindings.count = 0;
  }
  stf_builder_close(&b);
  const int told = stf_complaints(&m->syntax.sources);
  return told ? told : code;
}
