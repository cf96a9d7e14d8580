/* event_statements.c: when, at, every and require into reactions.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "integrands.h"
#include "reactions.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static stf_reaction *reaction(const stf_reactions *r, size_t i)
{
  return STF_AT(r->list, stf_reaction, i);
}

/* ---- triggers
 * --------------------------------------------------------------------------------
 */

static int32_t crossing(stf_builder *b, int32_t g, const stf_statement *s)
{
  const bool rises = s->whole == 'r';
  const int32_t zero = stf_number(b->g, 0);
  b->g->at = s->at, b->bare = true, b->turned = rises;
  const int32_t node =
    rises ? stf_relation(b, STF_OP_LESS, zero, g) : stf_relation(b, STF_OP_LESS, g, zero);
  b->bare = b->turned = false;
  return node;
}

static int condition(stf_model *m, stf_builder *b, const stf_statement *s, int32_t *node)
{
  (void)m;
  STEIF_TRY(stf_build(b, &s->value, node));
  if (s->kind == STF_SAY_WHEN && s->whole) *node = crossing(b, *node, s);
  if (s->kind == STF_SAY_REQUIRE) *node = stf_apply1(b->g, STF_OP_NOT, *node);
  return *node < 0 ? STEIF_NO_MEMORY : STEIF_OK;
}

static int ascending(const void *a, const void *b)
{
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* Times of the statement as they are with the present parameters; their number where r->times is NULL. */
static int instants(stf_model *m, stf_reaction *r)
{
  int32_t count = 0;
  for (size_t i = (size_t)r->statement + 1; i < m->syntax.statements.count; i++) {
    const stf_statement *s = stf_statement_at(m, (int32_t)i);
    if (s->parent != r->statement) break;
    if (s->kind != STF_SAY_INSTANT) continue;
    if (r->times) STEIF_TRY(stf_number_of(m, &s->value, r->times + count));
    count++;
  }
  if (r->times) qsort(r->times, (size_t)count, sizeof *r->times, ascending);
  r->time_count = count;
  return STEIF_OK;
}

/* Decimal numbers as whole ones: 3 * 0.1 is not 0.3, but 3 * 1 / 10 is, the number that is meant by "0.3". */
static void count_in_decimals(stf_reaction *r)
{
  const double most = 4503599627370496; /* 2^52 */
  for (double unit = 1; unit <= 1e9; unit *= 10) {
    const double from = nearbyint(r->from * unit), period = nearbyint(r->period * unit);
    if (fabs(from) > most || period > most) return;
    if (from / unit != r->from || period / unit != r->period) continue;
    r->from = from, r->period = period, r->unit = unit;
    return;
  }
}

int stf_timer_read(stf_model *m, stf_reaction *r)
{
  const stf_statement *s = stf_statement_at(m, r->statement);
  if (s->kind == STF_SAY_AT) return instants(m, r);
  r->from = m->t0;
  STEIF_TRY(stf_number_of(m, &s->value, &r->period));
  if (s->other.to > s->other.from) STEIF_TRY(stf_number_of(m, &s->other, &r->from));
  r->unit = 1;
  if (r->period > 0 && isfinite(r->from)) {
    count_in_decimals(r);
    return STEIF_OK;
  }
  stf_complain(&m->syntax.sources, s->at, STEIF_BAD_INPUT,
               "the period %.12g; it must be positive", r->period);
  return stf_complaints(&m->syntax.sources);
}

static int timer(stf_model *m, stf_reaction *r, const stf_statement *s)
{
  r->trigger = STF_TIMER;
  m->timers++;
  if (s->kind != STF_SAY_AT) return stf_timer_read(m, r);
  STEIF_TRY(instants(m, r));
  r->times = stf_pool_array(m->pool, (size_t)r->time_count, sizeof *r->times);
  return r->times ? instants(m, r) : STEIF_NO_MEMORY;
}

/* ---- actions
 * ---------------------------------------------------------------------------------
 */

static int target(stf_model *m, stf_builder *b, int32_t statement)
{
  const stf_statement *s = stf_statement_at(m, statement);
  const stf_symbol *symbol = stf_symbol_of(m, s->name);
  stf_target *to = stf_vector_push(m->ctx, &m->reactions->targets, sizeof *to);
  if (!to) return STEIF_NO_MEMORY;
  *to = (stf_target){.state = -1, .memory = -1, .statement = statement};
  if (symbol->kind != STF_IS_STATE) {
    to->memory = symbol->kind == STF_IS_DISCRETE ? symbol->which : symbol->memory;
    return STEIF_OK;
  }
  int32_t state = 0;
  STEIF_TRY(stf_component(m, b, s, &state));
  STF_AT(m->reactions->targets, stf_target, m->reactions->targets.count - 1)->state = state;
  return STEIF_OK;
}

/* A discrete value that depends on y, t or p would have derivatives of its own. */
static void note_varying(stf_model *m, const stf_builder *b, const stf_statement *s,
                         int32_t node)
{
  const stf_symbol *symbol = stf_symbol_of(m, s->name);
  const int varying = STF_ON_STATE | STF_ON_SLOPE | STF_ON_TIME | STF_ON_PARAMETER;
  if (symbol->kind != STF_IS_STATE && (stf_node_at(b->g, node)->on & varying))
    m->varying = stf_named(m, s->name);
}

static int actions(stf_model *m, stf_builder *b, stf_reaction *r)
{
  stf_vector stores = {0};
  int code = STEIF_OK;
  r->first = (int32_t)m->reactions->targets.count;
  for (size_t i = (size_t)r->statement + 1; !code && i < m->syntax.statements.count; i++) {
    const stf_statement *s = stf_statement_at(m, (int32_t)i);
    if (s->parent != r->statement) break;
    r->stops = r->stops || s->kind == STF_SAY_STOP;
    if (s->kind != STF_SAY_ASSIGN) continue;
    int32_t node = 0;
    stf_store *to = stf_vector_push(m->ctx, &stores, sizeof *to);
    code = to ? stf_build(b, &s->value, &node) : STEIF_NO_MEMORY;
    if (!code) code = target(m, b, (int32_t)i);
    if (!code) note_varying(m, b, s, node);
    if (!code)
      *STF_AT(stores, stf_store, stores.count - 1) = (stf_store){.from = node, .a = r->count++};
  }
  const stf_box none = {0};
  if (!code && r->count)
    code = stf_tape_compile(b->g, &none, stores.count, stores.data, &r->tape);
  if (!code && r->count)
    r->space = stf_pool_array(m->pool, stf_tape_space(&r->tape), sizeof *r->space);
  if (!code && r->count && !r->space) code = STEIF_NO_MEMORY;
  if (!code && r->count) stf_tape_prepare(&r->tape, &m->feed, r->space);
  stf_vector_free(m->ctx, &stores);
  return code;
}

/* ---- all
 * -------------------------------------------------------------------------------------
 */

/* x >= 0 and the like are constraints of the problem. */
static bool handled_elsewhere(const stf_model *m, int32_t statement)
{
  return m->constraint_of && m->constraint_of[statement];
}

static int statement(stf_model *m, stf_builder *b, stf_vector *conditions, int32_t i)
{
  const stf_statement *s = stf_statement_at(m, i);
  const bool when =
    s->kind == STF_SAY_WHEN || (s->kind == STF_SAY_REQUIRE && !handled_elsewhere(m, i));
  const bool timed = s->kind == STF_SAY_AT || s->kind == STF_SAY_EVERY;
  if (!when && !timed) return STEIF_OK;
  stf_reaction *r = stf_vector_push(m->ctx, &m->reactions->list, sizeof *r);
  stf_store *store = r ? stf_vector_push(m->ctx, conditions, sizeof *store) : NULL;
  int32_t node = 0;
  if (!store) return STEIF_NO_MEMORY;
  r->statement = i;
  r->trigger = s->kind == STF_SAY_REQUIRE ? STF_REQUIREMENT
               : s->whole == 'c'          ? STF_CHANGES
                                          : STF_BECOMES_TRUE;
  b->events = b->times = true;
  if (when) STEIF_TRY(condition(m, b, s, &node));
  if (timed) STEIF_TRY(timer(m, r, s));
  b->events = false;
  if (!when) node = stf_number(b->g, 0);
  *STF_AT(*conditions, stf_store, conditions->count - 1) =
    (stf_store){.from = node, .a = (int32_t)m->reactions->list.count - 1};
  return actions(m, b, r);
}

static int quantity(stf_model *m, const stf_block *block, const stf_vector *stores,
                    stf_quantity *q)
{
  return stores->count ? stf_compile_quantity(m, block, stores, q) : STEIF_OK;
}

static void mark_used(stf_model *m, const stf_block *block, const stf_switch *s)
{
  const int64_t count = stf_passes(&block->box);
  for (int64_t k = 0; k < count; k++)
    m->switch_used[stf_at_pass(&block->box, k, s->a, s->stride) - m->discretes] =
      !(s->on & (STF_ON_STATE | STF_ON_MEMORY)) ? STF_OF_TIME
      : s->on & STF_ON_MEMORY                   ? STF_OF_OTHERS
                                                : STF_OF_STATE;
}

static int switches(stf_model *m, stf_block *block)
{
  stf_vector stores = {0};
  int code = STEIF_OK;
  for (size_t i = 0; !code && i < block->switches.count; i++) {
    const stf_switch *s = STF_AT(block->switches, stf_switch, i);
    stf_store *to = stf_vector_push(m->ctx, &stores, sizeof *to);
    if (!to) code = STEIF_NO_MEMORY;
    if (code) break;
    *to = (stf_store){.from = s->g, .a = s->a - m->discretes};
    memcpy(to->stride, s->stride, sizeof to->stride);
    mark_used(m, block, s);
    code = stf_name_relation(m, block, s);
  }
  if (!code) code = quantity(m, block, &stores, &m->events);
  stf_vector_free(m->ctx, &stores);
  return code;
}

static int timers(stf_model *m)
{
  stf_vector stores = {0};
  int code = STEIF_OK;
  int32_t next = m->switches;
  stf_formulas *g = &m->event_block->graph;
  for (size_t i = 0; !code && i < m->reactions->list.count; i++) {
    const stf_reaction *r = reaction(m->reactions, i);
    if (r->trigger != STF_TIMER) continue;
    stf_store *to = stf_vector_push(m->ctx, &stores, sizeof *to);
    const int32_t time = stf_leaf(g, STF_OP_TIME, 0, NULL),
                  at = stf_leaf(g, STF_OP_MEMORY, r->memory, NULL);
    if (!to) code = STEIF_NO_MEMORY;
    if (code) break;
    m->event_list[next].direction = 1;
    code = stf_name_timer(m, stf_statement_at(m, r->statement), next);
    *to = (stf_store){.from = stf_apply2(g, STF_OP_SUBTRACT, time, at), .a = next++};
    if (to->from < 0) code = STEIF_NO_MEMORY;
  }
  if (!code) code = quantity(m, m->event_block, &stores, &m->events);
  stf_vector_free(m->ctx, &stores);
  return code;
}

/* Next times stand behind the truths of all relations, which follow each other. */
static void place_timers(stf_model *m)
{
  for (size_t i = 0; i < m->reactions->list.count; i++)
    if (reaction(m->reactions, i)->trigger == STF_TIMER)
      reaction(m->reactions, i)->memory = m->memories++;
}

static int arrays(stf_model *m)
{
  const size_t events = (size_t)(m->switches + m->timers), memories = (size_t)m->memories;
  stf_reactions *r = m->reactions;
  m->switch_used = stf_pool_array(m->pool, events, 1);
  m->event_shift = stf_pool_array(m->pool, 2 * events, sizeof *m->event_shift);
  if (!m->event_shift) return STEIF_NO_MEMORY;
  m->event_range = m->event_shift + events;
  m->switch_open = stf_pool_array(m->pool, events, 1);
  m->event_list = stf_pool_array(m->pool, events, sizeof *m->event_list);
  m->event_sort = stf_pool_array(m->pool, events, sizeof *m->event_sort);
  m->memory = stf_pool_array(m->pool, memories, sizeof *m->memory);
  m->memory_start = stf_pool_array(m->pool, memories, sizeof *m->memory);
  m->memory_literal = stf_pool_array(m->pool, memories + (size_t)m->n, sizeof *m->memory);
  m->event_slope = stf_pool_array(m->pool, (size_t)m->n, sizeof *m->event_slope);
  for (int k = 0; k < 2; k++)
    m->event_values[k] = stf_pool_array(m->pool, events, sizeof(double));
  r->truths = stf_pool_array(m->pool, r->list.count, sizeof *r->truths);
  r->values = stf_pool_array(m->pool, r->targets.count, sizeof *r->values);
  const bool all = m->switch_used && m->switch_open && m->event_list && m->event_sort &&
                   m->memory && m->event_slope && m->memory_start && m->memory_literal &&
                   m->event_values[0] && m->event_values[1] && r->truths && r->values;
  m->feed.memory = m->memory;
  return all ? STEIF_OK : STEIF_NO_MEMORY;
}

/* Start values of discrete values, and of parameters that events change. */
static int starts(stf_model *m)
{
  for (size_t i = 0; i < m->symbols.count; i++) {
    const stf_symbol *s = stf_symbol_at(m, (int32_t)i);
    if (s->kind == STF_IS_PARAMETER && s->assigned) m->memory_start[s->memory] = s->value;
    if (s->kind == STF_IS_DISCRETE)
      STEIF_TRY(stf_number_of(m, &stf_statement_at(m, s->statement)->value,
                              m->memory_start + s->which));
  }
  return STEIF_OK;
}

static int look_at_starts(stf_model *m, stf_builder *b)
{
  for (size_t i = 0; i < m->symbols.count; i++) {
    const stf_symbol *s = stf_symbol_at(m, (int32_t)i);
    if (s->kind != STF_IS_DISCRETE) continue;
    int32_t node;
    const stf_statement *said = stf_statement_at(m, s->statement);
    STEIF_TRY(stf_build(b, &said->value, &node));
    if (stf_node_at(b->g, node)->on & STF_ON_PARAMETER) m->varying = stf_named(m, s->word);
  }
  return STEIF_OK;
}

int stf_build_events(stf_model *m)
{
  stf_builder b;
  stf_vector conditions = {0};
  STEIF_TRY(stf_integrands_build(m));
  m->reactions->equation_switches = m->switches;
  int code = stf_builder_open(&b, m, &m->event_block->graph, false);
  b.block = m->event_block;
  for (size_t i = 0; code != STEIF_NO_MEMORY && i < m->syntax.statements.count; i++)
    code = statement(m, &b, &conditions, (int32_t)i);
  if (!code && !m->syntax.sources.errors) code = look_at_starts(m, &b);
  stf_builder_close(&b);
  if (m->syntax.sources.errors) code = stf_complaints(&m->syntax.sources);
  place_timers(m);
  if (!code) code = arrays(m);
  if (!code) code = stf_order_statements(m);
  for (size_t i = 0; !code && i < m->blocks.count; i++)
    code = switches(m, *STF_AT(m->blocks, stf_block *, i));
  if (!code) code = switches(m, m->event_block);
  if (!code) code = timers(m);
  if (!code) code = quantity(m, m->event_block, &conditions, &m->reactions->conditions);
  if (!code) code = starts(m);
  if (!code) code = stf_integrands_compile(m);
  stf_vector_free(m->ctx, &conditions);
  return code;
}

void stf_reactions_free(stf_model *m)
{
  if (!m->reactions) return;
  for (size_t i = 0; i < m->reactions->list.count; i++)
    stf_tape_free(m->ctx, &reaction(m->reactions, i)->tape);
  stf_vector_free(m->ctx, &m->reactions->list);
  stf_vector_free(m->ctx, &m->reactions->targets);
}
