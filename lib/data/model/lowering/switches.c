/* switches.c: relations whose truth is kept between events, so that f is smooth
 * within a step, and functions with kinks or jumps by such relations.
 *
 * A relation of time alone that is linear in it is taken as it is: the time of
 * its change is a break.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "model.h"
#include <math.h>

/* 1: a break is kept, and *falls says whether g < 0 after it; 0: g is not linear in t; -1: failure. */
static int add_break(stf_builder *b, int32_t g, bool *falls)
{
  stf_model *m = b->m;
  double value = 0, slope = 0;
  stf_vector partials = {0};
  stf_sweep sweep = {{0}, {0}, {0}};
  int code = stf_formulas_differentiate(b->g, g, STF_OP_TIME, &sweep, &partials);
  const int32_t slope_node =
    !code && partials.count ? STF_AT(partials, stf_partial, 0)->value : -1;
  const int32_t at_zero = code ? -1 : stf_without(b->g, g, STF_OP_TIME, &sweep);
  const bool linear =
    slope_node >= 0 && at_zero >= 0 && !(stf_node_at(b->g, slope_node)->on & STF_ON_TIME);
  if (linear) {
    code = stf_fixed_value(m, b->g, at_zero, &value);
    if (!code) code = stf_fixed_value(m, b->g, slope_node, &slope);
    double *to = code ? NULL : stf_vector_push(m->ctx, &m->breaks, sizeof *to);
    if (to) *to = -value / slope;
    *falls = slope < 0;
    if (!to) code = STEIF_NO_MEMORY;
  }
  stf_sweep_free(m->ctx, &sweep);
  stf_vector_free(m->ctx, &partials);
  return code ? -1 : linear;
}

/* Places in memory for all passes of the loops. */
static int claim(stf_builder *b, stf_switch *s)
{
  int64_t size = 1;
  int32_t a = b->m->memories;
  for (int d = b->dims; d--;) {
    s->stride[d] = (int32_t)size;
    a -= (int32_t)size * b->range_low[d];
    size *= (int64_t)b->range_high[d] - b->range_low[d] + 1;
  }
  s->a = a;
  if (size > STF_UNKNOWNS - b->m->switches) {
    stf_complain(&b->m->syntax.sources, b->g->at, STEIF_BAD_INPUT,
                 "more than %d conditions that are events; use noevent(...)", STF_UNKNOWNS);
    return STEIF_BAD_INPUT;
  }
  b->m->memories += (int32_t)size;
  b->m->switches += (int32_t)size;
  return STEIF_OK;
}

static int32_t switched(stf_builder *b, int32_t g)
{
  stf_model *m = b->m;
  if (stf_vector_resize(m->ctx, &b->switch_of, b->g->nodes.count, sizeof(int32_t))) return -1;
  int32_t *known = STF_AT(b->switch_of, int32_t, g);
  if (!*known) {
    stf_switch *s = stf_vector_push(m->ctx, &b->block->switches, sizeof *s);
    if (!s || claim(b, s)) return -1;
    s->g = g, s->at = b->g->at;
    *known = (int32_t)b->block->switches.count;
  }
  const stf_switch *s = STF_AT(b->block->switches, stf_switch, *known - 1);
  return stf_leaf(b->g, STF_OP_MEMORY, s->a, s->stride);
}

int32_t stf_relation(stf_builder *b, int kind, int32_t left, int32_t right)
{
  const int32_t literal = stf_apply2(b->g, kind, left, right);
  const int32_t g = literal < 0 ? -1 : stf_apply2(b->g, STF_OP_SUBTRACT, left, right);
  if (g < 0) return -1;
  const int on = stf_node_at(b->g, g)->on;
  const bool moves = on & (STF_ON_STATE | STF_ON_TIME);
  if (!b->events || b->literal || !moves || (on & STF_ON_SLOPE)) return literal;
  const bool time_alone = !(on & ~(STF_ON_TIME | STF_ON_PARAMETER));
  if (time_alone && !b->times) {
    bool falls = false;
    const int linear = add_break(b, g, &falls);
    const int to_the_right = falls ? STF_OP_LESS_EQUAL : STF_OP_LESS;
    if (linear) return linear < 0 ? -1 : stf_apply2(b->g, to_the_right, left, right);
  }
  return switched(b, g);
}

/* a < c ? x : y */
static int32_t choose(stf_builder *b, int32_t a, int32_t c, int32_t x, int32_t y)
{
  const int32_t holds = stf_relation(b, STF_OP_LESS, a, c);
  return holds < 0 ? -1 : stf_apply(b->g, STF_OP_SELECT, holds, x, y);
}

int32_t stf_kinked(stf_builder *b, int kind, int32_t a, int32_t c)
{
  const int32_t plain = stf_apply2(b->g, kind, a, c);
  if (plain < 0 || !b->events || b->literal) return plain;
  const int on = stf_node_at(b->g, plain)->on;
  if (!(on & (STF_ON_STATE | STF_ON_TIME)) || (on & STF_ON_SLOPE)) return plain;
  const int32_t zero = stf_number(b->g, 0), one = stf_number(b->g, 1);
  switch (kind) {
  case STF_OP_ABS: return choose(b, a, zero, stf_apply1(b->g, STF_OP_NEGATIVE, a), a);
  case STF_OP_SIGN: return choose(b, a, zero, stf_number(b->g, -1), one);
  case STF_OP_STEP: return choose(b, a, zero, zero, one);
  case STF_OP_RAMP: return choose(b, a, zero, zero, a);
  case STF_OP_MIN: return choose(b, a, c, a, c);
  case STF_OP_MAX: return choose(b, a, c, c, a);
  default: return plain;
  }
}
