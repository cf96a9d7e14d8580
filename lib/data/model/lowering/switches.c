/* switches.c: relations whose truth is kept between events, so that f is smooth
 * within a step, and functions with kinks or jumps by such relations.
 *
 * A relation of time alone that is linear in it is taken as it is: the time of
 * its change is a break.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "model.h"
#include <math.h>

/* Of g that depends on t alone, beside nodes: where it is 0 is not known; it is constant between known breaks. */
enum { NO_MEMORY = -1, NOT_LINEAR = -2, CONSTANT = -3 };

/* Has an operation more than one piece? */
static bool has_pieces(int kind)
{
  switch (kind) {
  case STF_OP_ABS:
  case STF_OP_SIGN:
  case STF_OP_STEP:
  case STF_OP_RAMP:
  case STF_OP_FLOOR:
  case STF_OP_MOD:
  case STF_OP_MIN:
  case STF_OP_MAX:
  case STF_OP_LOOKUP:
  case STF_OP_SELECT: return true;
  default: return false;
  }
}

/* Is node i constant between the times at which t is compared with numbers, and the nodes of tables of t? Operands
 * are known in `constant`. */
static bool stays(const stf_formulas *g, int32_t i, const int32_t *constant)
{
  int32_t child[3];
  const stf_node *n = stf_node_at(g, i);
  const int count = stf_children(n, child);
  if (!(n->on & STF_ON_TIME)) return true;
  bool all = count > 0;
  for (int k = 0; k < count; k++) all = all && constant[child[k]];
  if (all) return true;
  const bool compares = n->kind == STF_OP_LESS || n->kind == STF_OP_LESS_EQUAL,
             steps = n->kind == STF_OP_LOOKUP && n->c;
  for (int k = 0; k < count && (compares || steps); k++)
    if (!constant[child[k]] && stf_node_at(g, child[k])->kind != STF_OP_TIME) return false;
  return compares ? constant[child[0]] || constant[child[1]] : steps;
}

/* What g, of t alone, is: CONSTANT between known breaks, of one piece (0), or of several (NOT_LINEAR). */
static int32_t pieces_of(stf_formulas *g, int32_t root, stf_sweep *sweep)
{
  if (stf_reach(g, root, &sweep->mark, &sweep->list) ||
      stf_vector_resize(g->ctx, &sweep->adjoint, g->nodes.count, sizeof(int32_t)))
    return NO_MEMORY;
  int32_t *constant = sweep->adjoint.data;
  bool pieces = false;
  for (size_t k = 0; k < sweep->list.count; k++) {
    const int32_t i = *STF_AT(sweep->list, int32_t, k);
    const stf_node *n = stf_node_at(g, i);
    pieces = pieces || ((n->on & STF_ON_TIME) && has_pieces(n->kind));
    constant[i] = stays(g, i, constant);
  }
  const bool all = constant[root];
  for (size_t k = 0; k < sweep->list.count; k++) constant[*STF_AT(sweep->list, int32_t, k)] = 0;
  return all ? CONSTANT : pieces ? NOT_LINEAR : 0;
}

/* g = at_0 + rate t, nodes; 0, or what it is instead. */
static int32_t line_of(stf_builder *b, int32_t g, stf_sweep *sweep, stf_vector *partials,
                       int32_t *at_0, int32_t *rate)
{
  const int32_t pieces = pieces_of(b->g, g, sweep);
  if (pieces) return pieces;
  if (stf_formulas_differentiate(b->g, g, STF_OP_TIME, sweep, partials)) return NO_MEMORY;
  *rate = partials->count ? STF_AT(*partials, stf_partial, 0)->value : -1;
  if (*rate < 0 || (stf_node_at(b->g, *rate)->on & STF_ON_TIME)) return NOT_LINEAR;
  *at_0 = stf_without(b->g, g, STF_OP_TIME, sweep);
  return *at_0 < 0 ? NO_MEMORY : 0;
}

/* The time at which g, linear in t, is 0, a node; *falls: g < 0 after it. */
static int32_t zero_by(stf_builder *b, int32_t g, stf_sweep *sweep, stf_vector *partials,
                       bool *falls)
{
  double slope = 0;
  int32_t at_0, rate;
  const int32_t other = line_of(b, g, sweep, partials, &at_0, &rate);
  if (other) return other;
  if (stf_fixed_value(b->m, b->g, rate, &slope)) return NO_MEMORY;
  *falls = slope < 0;
  if (slope == 0) return NOT_LINEAR; /* of the parameters as they are */
  return stf_apply2(b->g, STF_OP_DIVIDE, stf_apply1(b->g, STF_OP_NEGATIVE, at_0), rate);
}

static int32_t zero_of(stf_builder *b, int32_t g, bool *falls)
{
  stf_vector partials = {0};
  stf_sweep sweep = {{0}, {0}, {0}};
  const uint32_t at = b->g->at;
  const int32_t zero = zero_by(b, g, &sweep, &partials, falls);
  b->g->at = at;
  stf_sweep_free(b->m->ctx, &sweep);
  stf_vector_free(b->m->ctx, &partials);
  return zero;
}

/* Whether g < 0, linear in t, by comparing t itself with the break, which is kept: at the break it is what holds
 * after it, whatever rounding makes of g there. */
static int32_t truth_by_time(stf_builder *b, int32_t g)
{
  stf_model *m = b->m;
  bool falls = false;
  double value;
  const int32_t zero = zero_of(b, g, &falls);
  if (zero < 0) return zero;
  if (stf_fixed_value(m, b->g, zero, &value)) return NO_MEMORY;
  if (b->clock && !isfinite(value)) return NOT_LINEAR;
  double *to = stf_vector_push(m->ctx, &m->breaks, sizeof *to);
  if (!to) return NO_MEMORY;
  *to = value;
  const int32_t t = stf_leaf(b->g, STF_OP_TIME, 0, NULL);
  return falls ? stf_apply2(b->g, STF_OP_LESS_EQUAL, zero, t)
               : stf_apply2(b->g, STF_OP_LESS, t, zero);
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

/* What a relation is for the reader of the text: where it stands, and with which indices, the outermost first. */
static void describe(const stf_builder *b, stf_switch *s, bool negated)
{
  s->at = b->g->at, s->bare = b->bare, s->negated = negated != b->turned, s->kink = b->kink;
  s->indices = 0;
  for (size_t i = 0; i < b->bindings.count && s->indices < STF_LOOPS; i++) {
    const stf_binding *x = STF_AT(b->bindings, stf_binding, i);
    if (x->node < 0) s->index[s->indices++] = *x;
  }
}

/* `negated`: what is said in the text holds where g >= 0. */
static int32_t switched(stf_builder *b, int32_t g, bool negated)
{
  stf_model *m = b->m;
  if (stf_vector_resize(m->ctx, &b->switch_of, b->g->nodes.count, sizeof(int32_t))) return -1;
  int32_t *known = STF_AT(b->switch_of, int32_t, g);
  const bool fresh = !*known;
  if (fresh) {
    stf_switch *s = stf_vector_push(m->ctx, &b->block->switches, sizeof *s);
    if (!s || claim(b, s)) return -1;
    s->g = g, s->kink = true;
    s->on = stf_node_at(b->g, g)->on;
    *known = (int32_t)b->block->switches.count;
  }
  stf_switch *s = STF_AT(b->block->switches, stf_switch, *known - 1);
  if (fresh || (s->kink && !b->kink)) describe(b, s, negated);
  return stf_leaf(b->g, STF_OP_MEMORY, s->a, s->stride);
}

/* Of time alone, but not linear: a kink may turn at any time, a jump must be at a time that is known. */
static int32_t some_time(stf_builder *b, int32_t g, int32_t literal)
{
  if (!b->kink) {
    stf_complain(
      &b->m->syntax.sources, b->g->at, STEIF_BAD_INPUT,
      "a jump at a time that is not known: expected t - c, or a t + b with numbers a and b, "
      "a not 0");
    return -1;
  }
  int32_t *to = stf_vector_push(b->m->ctx, &b->turns, sizeof *to);
  if (!to) return -1;
  *to = g;
  return literal;
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
    const int32_t truth = truth_by_time(b, g);
    if (truth == CONSTANT) return literal;
    if (truth != NOT_LINEAR) return truth;
  }
  if (b->clock) return some_time(b, g, literal);
  if (kind == STF_OP_LESS)
    return switched(b, g, false); /* a <= c: not c < a, where a - c stays at 0 */
  const int32_t other = switched(b, stf_apply2(b->g, STF_OP_SUBTRACT, right, left), true);
  return other < 0 ? -1 : stf_apply1(b->g, STF_OP_NOT, other);
}

/* x = *from + *rate t, numbers; 0, or what it is instead. */
static int32_t numbers_of_line(stf_builder *b, int32_t x, double *from, double *rate)
{
  int32_t at_0, slope;
  stf_vector partials = {0};
  stf_sweep sweep = {{0}, {0}, {0}};
  int32_t other = line_of(b, x, &sweep, &partials, &at_0, &slope);
  if (!other &&
      (stf_fixed_value(b->m, b->g, at_0, from) || stf_fixed_value(b->m, b->g, slope, rate)))
    other = NO_MEMORY;
  stf_sweep_free(b->m->ctx, &sweep);
  stf_vector_free(b->m->ctx, &partials);
  return other ? other : *rate == 0 ? NOT_LINEAR : 0;
}

/* Breaks at the nodes of a table of time alone; 0, or what its argument is instead. */
static int32_t breaks_of(stf_builder *b, int32_t x, const stf_lookup *l)
{
  double from = 0, rate = 1;
  const bool time = stf_node_at(b->g, x)->kind == STF_OP_TIME;
  const int32_t other = time ? 0 : numbers_of_line(b, x, &from, &rate);
  for (size_t k = 0; !other && k < l->count; k++) {
    double *to = stf_vector_push(b->m->ctx, &b->m->breaks, sizeof *to);
    if (!to) return NO_MEMORY;
    *to = (l->x[k] - from) / rate;
  }
  return other;
}

/* The part of a table that is kept between events. */
static int32_t kept_part(stf_builder *b, int32_t x, int32_t which, int32_t below)
{
  const int32_t tables = b->m->tables;
  const bool steps = b->m->lookups[which].kind == STF_STEPS_TABLE;
  return stf_apply(b->g, STF_OP_SELECT, below,
                   stf_apply(b->g, STF_OP_LOOKUP, x, 2 * tables + which, steps),
                   stf_apply(b->g, STF_OP_LOOKUP, x, 3 * tables + which, steps));
}

/* Kinks in tables of states are left to the error control: materials in a grid have one in each cell. */
int32_t stf_table_value(stf_builder *b, int32_t x, int32_t which)
{
  const stf_lookup *l = b->m->lookups + which;
  const int on = stf_node_at(b->g, x)->on;
  const bool moves = on & (STF_ON_TIME | STF_ON_STATE), steps = l->kind == STF_STEPS_TABLE;
  const int32_t literal = stf_apply(b->g, STF_OP_LOOKUP, x, which, steps);
  if (!b->events || b->literal || !moves || (on & STF_ON_SLOPE) || l->kind == STF_CUBIC_TABLE)
    return literal;
  if (!(on & ~(STF_ON_TIME | STF_ON_PARAMETER))) {
    const int32_t found = breaks_of(b, x, l);
    if (found != NOT_LINEAR) return found == NO_MEMORY ? -1 : literal;
  }
  if (b->clock || (!steps && (on & STF_ON_STATE))) return literal;
  if (stf_table_wave(b->m, which)) return -1;
  stf_note_piece(b, x, stf_lookup_spacing(l));
  const int32_t wave = stf_apply(b->g, STF_OP_LOOKUP, x, b->m->tables + which, false);
  const int32_t below = wave < 0 ? -1 : switched(b, wave, false);
  return below < 0 ? -1 : kept_part(b, x, which, below);
}

/* a < c ? x : y */
static int32_t choose(stf_builder *b, int32_t a, int32_t c, int32_t x, int32_t y)
{
  const int32_t holds = stf_relation(b, STF_OP_LESS, a, c);
  return holds < 0 ? -1 : stf_apply(b->g, STF_OP_SELECT, holds, x, y);
}

/* The same, told of c - a. */
static int32_t turned(stf_builder *b, int32_t a, int32_t c, int32_t x, int32_t y)
{
  b->turned = true;
  const int32_t node = choose(b, a, c, x, y);
  b->turned = false;
  return node;
}

static int32_t with_relation(stf_builder *b, int kind, int32_t a, int32_t c)
{
  const int32_t zero = stf_number(b->g, 0), one = stf_number(b->g, 1);
  switch (kind) {
  case STF_OP_ABS: return choose(b, a, zero, stf_apply1(b->g, STF_OP_NEGATIVE, a), a);
  case STF_OP_SIGN:
    return choose(b, a, zero, stf_number(b->g, -1), turned(b, zero, a, one, zero));
  case STF_OP_STEP: return choose(b, a, zero, zero, one);
  case STF_OP_RAMP: return choose(b, a, zero, zero, a);
  case STF_OP_MIN: return choose(b, a, c, a, c);
  default: return choose(b, a, c, c, a);
  }
}

/* Of the sign of (-1)^floor(a), without rounding: with q = a - 2 floor(a/2) it is q up to 1/2, 1 - q up to 3/2 and
 * q - 2 beyond; at odd whole numbers, where some arguments stay, a little less than 0. */
static int32_t parity(stf_builder *b, int32_t a)
{
  stf_formulas *g = b->g;
  const int32_t one = stf_number(g, 1), two = stf_number(g, 2);
  const int32_t pairs = stf_apply1(g, STF_OP_FLOOR, stf_apply2(g, STF_OP_DIVIDE, a, two));
  const int32_t q =
    stf_apply2(g, STF_OP_SUBTRACT, a, stf_apply2(g, STF_OP_MULTIPLY, two, pairs));
  const int32_t wave =
    stf_apply2(g, STF_OP_MIN, q,
               stf_apply2(g, STF_OP_MAX, stf_apply2(g, STF_OP_SUBTRACT, one, q),
                          stf_apply2(g, STF_OP_SUBTRACT, q, two)));
  const int32_t odd = stf_apply2(g, STF_OP_AND, stf_apply2(g, STF_OP_LESS_EQUAL, q, one),
                                 stf_apply2(g, STF_OP_LESS_EQUAL, one, q));
  return stf_apply(g, STF_OP_SELECT, odd, stf_number(g, -1e-300), wave);
}

/* floor(a) = p + 2 floor((a - p)/2 + 1/4), p = 0 or 1: whether it is odd, which is kept between events. What is left of
 * floor jumps half a unit away from where p changes: a frozen value lasts as far beyond its event. */
static int32_t whole_part(stf_builder *b, int32_t a)
{
  const int32_t one = stf_number(b->g, 1), two = stf_number(b->g, 2),
                zero = stf_number(b->g, 0);
  stf_note_piece(b, a, 1);
  const int32_t odd = choose(b, parity(b, a), zero, one, zero);
  if (odd < 0) return -1;
  const int32_t half =
    stf_apply2(b->g, STF_OP_DIVIDE, stf_apply2(b->g, STF_OP_SUBTRACT, a, odd), two);
  const int32_t pairs =
    stf_apply1(b->g, STF_OP_FLOOR, stf_apply2(b->g, STF_OP_ADD, half, stf_number(b->g, 0.25)));
  return stf_apply2(b->g, STF_OP_ADD, odd, stf_apply2(b->g, STF_OP_MULTIPLY, two, pairs));
}

/* floor(a), and mod(a, c) = a - c floor(a/c); of t alone they have a jump after the other. */
static int32_t jumps(stf_builder *b, int kind, int32_t a, int32_t c)
{
  if (b->clock) {
    stf_complain(&b->m->syntax.sources, b->g->at, STEIF_BAD_INPUT,
                 "'%s' of t jumps without end: add up terms with step(t - c)",
                 stf_operation_word(kind));
    return -1;
  }
  if (kind == STF_OP_FLOOR) return whole_part(b, a);
  const int32_t whole = whole_part(b, stf_apply2(b->g, STF_OP_DIVIDE, a, c));
  return whole < 0
           ? -1
           : stf_apply2(b->g, STF_OP_SUBTRACT, a, stf_apply2(b->g, STF_OP_MULTIPLY, c, whole));
}

int32_t stf_kinked(stf_builder *b, int kind, int32_t a, int32_t c)
{
  const int32_t plain = stf_apply2(b->g, kind, a, c);
  if (plain < 0 || !b->events || b->literal) return plain;
  const int on = stf_node_at(b->g, plain)->on;
  if (!(on & (STF_ON_STATE | STF_ON_TIME)) || (on & STF_ON_SLOPE)) return plain;
  const bool kink =
    kind == STF_OP_ABS || kind == STF_OP_RAMP || kind == STF_OP_MIN || kind == STF_OP_MAX;
  if (kind == STF_OP_FLOOR || kind == STF_OP_MOD) return jumps(b, kind, a, c);
  if (!kink && kind != STF_OP_SIGN && kind != STF_OP_STEP) return plain;
  b->kink = kink;
  const int32_t node = with_relation(b, kind, a, c);
  b->kink = false;
  return node;
}
