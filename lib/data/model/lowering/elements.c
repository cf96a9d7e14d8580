/* elements.c: indices as whole numbers that depend on loop counters, and the
 * elements they choose. SPDX-License-Identifier: BSD-3-Clause */
#include "model.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { DEEP = 32, NEAR = 1000000000 };
static const int64_t FAR = 1000000000000; /* of indices on the way; elements lie within NEAR */

static int complain(const stf_builder *b, uint32_t at, const char *what)
{
  return stf_complain(&b->m->syntax.sources, at, STEIF_BAD_INPUT, "%s", what);
}

static bool fixed(const stf_affine *x)
{
  for (int d = 0; d < STF_LOOPS; d++)
    if (x->s[d]) return false;
  return true;
}

/* ---- indices
 * ---------------------------------------------------------------------------------
 */

static int whole(stf_builder *b, const stf_code *c, stf_affine *x)
{
  double value;
  const uint32_t from = (uint32_t)(c - STF_AT(b->m->syntax.codes, stf_code, 0));
  stf_formulas g = {.ctx = b->m->ctx};
  stf_builder own;
  int code = stf_builder_open(&own, b->m, &g, true);
  if (!code) code = stf_value(&own, &(stf_expression){from, from + 1}, &value);
  stf_builder_close(&own);
  stf_formulas_free(&g);
  STEIF_TRY(code);
  if (value == floor(value) && fabs(value) < (double)FAR) {
    *x = (stf_affine){.c = (int64_t)value};
    return STEIF_OK;
  }
  return stf_complain(&b->m->syntax.sources, c->at, STEIF_BAD_INPUT,
                      "an index or range must be a whole number, here '%s' = "
                      "%.12g; declare it 'whole'",
                      c->kind == STF_OP_NAME ? stf_named(b->m, c->a) : "it", value);
}

static int name(stf_builder *b, const stf_code *c, size_t scope, stf_affine *x)
{
  for (size_t i = b->bindings.count; i-- > scope;) {
    const stf_binding *local = STF_AT(b->bindings, stf_binding, i);
    if (local->word != c->a) continue;
    if (local->node < 0) {
      *x = local->at;
      return STEIF_OK;
    }
    const stf_node *n = stf_node_at(b->g, local->node);
    if (n->kind != STF_OP_NUMBER || n->number != floor(n->number) ||
        fabs(n->number) > (double)FAR)
      return complain(b, c->at,
                      "an argument of a function as index, and it is no whole number");
    *x = (stf_affine){.c = (int64_t)n->number};
    return STEIF_OK;
  }
  return whole(b, c, x);
}

static bool times(const stf_affine *x, const stf_affine *y, stf_affine *to)
{
  if (!fixed(x) && !fixed(y)) return false;
  const stf_affine *by = fixed(x) ? x : y, *of = fixed(x) ? y : x;
  to->c = of->c * by->c;
  for (int d = 0; d < STF_LOOPS; d++) to->s[d] = of->s[d] * by->c;
  return true;
}

static bool far(const stf_affine *x)
{
  bool is = x->c > FAR || x->c < -FAR;
  for (int d = 0; d < STF_LOOPS; d++) is = is || x->s[d] > FAR || x->s[d] < -FAR;
  return is;
}

/* div and mod of what depends on a counter need their passes one by one. */
static int divided(stf_builder *b, const stf_code *c, bool remainder, const stf_affine *x,
                   const stf_affine *y, stf_affine *to)
{
  if (!fixed(x) || !fixed(y)) b->fallback = true;
  if (!y->c) return complain(b, c->at, "division by zero in an index");
  const int64_t low = (x->c % y->c != 0) && ((x->c < 0) != (y->c < 0)),
                quotient = x->c / y->c - low;
  *to = (stf_affine){.c = remainder ? x->c - y->c * quotient : quotient};
  return STEIF_OK;
}

static int operate(stf_builder *b, const stf_code *c, stf_affine *x, const stf_affine *y)
{
  const stf_affine a = *x;
  const int sign = c->kind == STF_OP_SUBTRACT ? -1 : 1;
  if (c->kind == STF_OP_CALL) {
    const char *word = stf_named(b->m, c->a);
    if (!strcmp(word, "div") || !strcmp(word, "mod"))
      return divided(b, c, *word == 'm', &a, y, x);
  } else if (c->kind == STF_OP_DIVIDE && y->c && fixed(&a) && fixed(y) && a.c % y->c == 0) {
    x->c = a.c / y->c;
    return STEIF_OK;
  } else if (c->kind == STF_OP_POWER && fixed(&a) && fixed(y) && y->c >= 0) {
    const double value = pow((double)a.c, (double)y->c);
    if (!(fabs(value) <= (double)FAR)) return complain(b, c->at, "an index beyond 1e12");
    x->c = (int64_t)value;
    return STEIF_OK;
  } else if (c->kind == STF_OP_MULTIPLY) {
    if (!times(&a, y, x)) {
      b->fallback = true;
      *x = (stf_affine){0};
    }
    return far(x) ? complain(b, c->at, "an index beyond 1e12") : STEIF_OK;
  } else if (c->kind == STF_OP_ADD || c->kind == STF_OP_SUBTRACT) {
    x->c += sign * y->c;
    for (int d = 0; d < STF_LOOPS; d++) x->s[d] += sign * y->s[d];
    return far(x) ? complain(b, c->at, "an index beyond 1e12") : STEIF_OK;
  }
  return complain(b, c->at, "an index is made of + - *, div and mod of whole numbers");
}

int stf_index(stf_builder *b, const stf_expression *e, uint32_t at, stf_affine *index)
{
  stf_affine stack[DEEP];
  int used = 0;
  for (uint32_t i = e->from; i < e->to; i++) {
    const stf_code *c = STF_AT(b->m->syntax.codes, stf_code, i);
    if (used == DEEP) return complain(b, at, "an index that is nested too deeply");
    if (c->kind == STF_OP_NUMBER) {
      if (c->number != floor(c->number) || fabs(c->number) > (double)FAR)
        return complain(b, c->at, "an index that is no whole number");
      stack[used++] = (stf_affine){.c = (int64_t)c->number};
    } else if (c->kind == STF_OP_NAME) {
      STEIF_TRY(name(b, c, stf_scope(b), stack + used));
      used++;
    } else if (c->kind == STF_OP_NEGATIVE) {
      const stf_affine zero = {0}, y = stack[used - 1];
      const stf_code minus = {.kind = STF_OP_SUBTRACT, .at = c->at};
      stack[used - 1] = zero;
      STEIF_TRY(operate(b, &minus, stack + used - 1, &y));
    } else {
      if (used < 2)
        return complain(b, c->at, "an index is made of + - *, div and mod of whole numbers");
      used--;
      STEIF_TRY(operate(b, c, stack + used - 1, stack + used));
    }
  }
  if (used != 1)
    return complain(b, at, "an index is made of + - *, div and mod of whole numbers");
  *index = stack[0];
  return STEIF_OK;
}

/* ---- elements
 * --------------------------------------------------------------------------------
 */

int stf_state_leaf(stf_builder *b, const stf_symbol *s, int primes, const stf_affine *k,
                   uint32_t at)
{
  int32_t stride[STF_LOOPS];
  for (int d = 0; d < STF_LOOPS; d++) stride[d] = (int32_t)k->s[d];
  if (b->numeric) {
    if (!b->started || primes || !b->started[s->first[0] + k->c])
      return stf_complain(&b->m->syntax.sources, at, STEIF_BAD_INPUT,
                          "'%s' is an unknown; here only numbers, parameters "
                          "and fixed start values stand",
                          stf_named(b->m, s->word));
    return stf_push_node(b, stf_number(b->g, b->m->y0[s->first[0] + k->c]));
  }
  const int kind = primes < s->order ? STF_OP_STATE : STF_OP_SLOPE;
  const int level = primes < s->order ? primes : s->order - 1;
  return stf_push_node(b, stf_leaf(b->g, kind, s->first[level] + (int32_t)k->c, stride));
}

/* Passes in which low <= x <= high, of one counter; false: they must be looked
 * at one by one. */
static bool narrow(stf_builder *b, const stf_affine *x, int64_t low, int64_t high)
{
  int counter = -1;
  for (int d = 0; d < STF_LOOPS; d++)
    if (x->s[d]) {
      if (counter >= 0) return false;
      counter = d;
    }
  if (counter < 0) return x->c >= low && x->c <= high;
  const int64_t s = x->s[counter];
  const double first = (double)((s > 0 ? low : high) - x->c) / (double)s,
               last = (double)((s > 0 ? high : low) - x->c) / (double)s;
  if (ceil(first) > b->low[counter]) b->low[counter] = (int32_t)fmin(ceil(first), NEAR);
  if (floor(last) < b->high[counter]) b->high[counter] = (int32_t)fmax(floor(last), -NEAR);
  return true;
}

static int bounds_of(stf_builder *b, const stf_statement *s, int d, int64_t *low, int64_t *high)
{
  stf_affine first = {0}, last;
  STEIF_TRY(stf_index(b, &s->range[d].low, s->at, &first));
  last = first;
  if (s->range[d].high.to > s->range[d].high.from)
    STEIF_TRY(stf_index(b, &s->range[d].high, s->at, &last));
  *low = first.c;
  *high = last.c;
  return STEIF_OK;
}

/* Does x lie between low and high in some of the passes that are left? */
static bool reaches(const stf_builder *b, const stf_affine *x, int64_t low, int64_t high)
{
  int64_t least = x->c, most = x->c;
  for (int d = 0; d < b->dims; d++) {
    const int64_t ends[] = {x->s[d] * b->low[d], x->s[d] * b->high[d]};
    least += ends[0] < ends[1] ? ends[0] : ends[1];
    most += ends[0] < ends[1] ? ends[1] : ends[0];
  }
  return most >= low && least <= high;
}

static bool no_passes(const stf_builder *b)
{
  for (int d = 0; d < b->dims; d++)
    if (b->low[d] > b->high[d]) return true;
  return false;
}

/* The boundary statement that gives an element outside; its names are bound. With counters it is the first
 * that some passes meet, and the others are left to themselves. */
static const stf_statement *boundary(stf_builder *b, const stf_code *c, const stf_affine *x,
                                     int *code)
{
  for (size_t i = 0; i < b->m->syntax.statements.count; i++) {
    const stf_statement *s = stf_statement_at(b->m, (int32_t)i);
    if (s->kind != STF_SAY_BOUNDARY || s->name != c->b || s->dimensions != c->count) continue;
    int64_t low[STF_DIMENSIONS], high[STF_DIMENSIONS];
    bool here = true;
    for (int d = 0; d < c->count && here && !*code; d++) {
      *code = bounds_of(b, s, d, low + d, high + d);
      here = fixed(x + d) ? x[d].c >= low[d] && x[d].c <= high[d]
                          : reaches(b, x + d, low[d], high[d]);
    }
    if (*code) return s;
    if (!here) continue;
    for (int d = 0; d < c->count; d++)
      if (!fixed(x + d) && !narrow(b, x + d, low[d], high[d])) b->fallback = true;
    return s;
  }
  return NULL;
}

/* "i = 4, j = 1; ": the indices that are bound now. */
static void say_pass(const stf_builder *b, size_t room, char *text)
{
  size_t used = 0;
  for (size_t i = 0; i < b->bindings.count && i < STF_LOOPS && used < room; i++) {
    const stf_binding *local = STF_AT(b->bindings, stf_binding, i);
    if (local->node < 0)
      used += (size_t)snprintf(text + used, room - used, "%s%.20s = %lld", used ? ", " : "",
                               stf_named(b->m, local->word), (long long)local->at.c);
  }
  if (used && used < room) snprintf(text + used, room - used, "; ");
}

/* "[4,0]", or with `ranges` "[i in 1:4, 0]": the element that is asked for, and where index d is outside. */
static void say_indices(const stf_builder *b, const stf_symbol *s, const stf_affine *x, int d,
                        bool ranges, size_t room, char *text)
{
  static const char *const letter[STF_DIMENSIONS] = {"i", "j", "k"};
  size_t used = 0;
  for (int k = 0; k < s->dims && used < room; k++) {
    const int32_t word = stf_statement_at(b->m, s->statement)->range[k].name;
    used += (size_t)snprintf(text + used, room - used, "%s", !k ? "[" : ranges ? ", " : ",");
    if (used < room && ranges && k != d)
      used += (size_t)snprintf(text + used, room - used, "%.20s in %d:%d",
                               word >= 0 ? stf_named(b->m, word) : letter[k], (int)s->low[k],
                               (int)(s->low[k] + s->count[k] - 1));
    else if (used < room)
      used += (size_t)snprintf(text + used, room - used, "%lld", (long long)x[k].c);
  }
  if (used < room) snprintf(text + used, room - used, "]");
}

static int no_element(stf_builder *b, const stf_symbol *s, const stf_code *c,
                      const stf_affine *x, int d)
{
  static const char *const ordinal[STF_DIMENSIONS] = {"first", "second", "third"};
  char pass[100] = "", where[60] = "end the loop earlier", element[80] = "", bound[120] = "",
       runs[STF_NAME_BYTES + 20];
  const char *name = stf_named(b->m, s->word);
  const stf_binding *local = b->bindings.data;
  const int64_t high = s->low[d] + s->count[d] - 1, beyond = x[d].c - high;
  say_pass(b, sizeof pass, pass);
  say_indices(b, s, x, d, false, sizeof element, element);
  say_indices(b, s, x, d, true, sizeof bound, bound);
  snprintf(runs, sizeof runs, s->dims > 1 ? "its %s index" : "%s",
           s->dims > 1 ? ordinal[d] : name);
  if (b->bindings.count == 1 && local->node < 0)
    snprintf(where, sizeof where, "%s the loop at %lld", beyond > 0 ? "end" : "begin",
             (long long)(local->at.c - (beyond > 0 ? beyond : x[d].c - s->low[d])));
  return stf_complain(&b->m->syntax.sources, c->at, STEIF_BAD_INPUT,
                      "%s%s does not exist (%s%s runs from %d to %lld); %s or add "
                      "'boundary %s%s = ...'",
                      name, element, pass, runs, s->low[d], (long long)high, where, name,
                      bound);
}

static int outside(stf_builder *b, const stf_symbol *s, const stf_code *c, const stf_affine *x,
                   int d)
{
  int code = STEIF_OK;
  const stf_statement *said = boundary(b, c, x, &code);
  STEIF_TRY(code);
  if (no_passes(b)) {
    b->fallback = true;
    return stf_push_node(b, stf_number(b->g, 0));
  }
  if (!said || c->primes) return no_element(b, s, c, x, d);
  const size_t scope = b->bindings.count;
  for (int k = 0; k < c->count; k++)
    if (said->range[k].name >= 0) STEIF_TRY(stf_bind_index(b, said->range[k].name, x + k));
  if (b->frames.count > 1000)
    return complain(b, said->at, "boundaries that refer to each other");
  return stf_enter(b, &said->value, -1, scope);
}

static int array(stf_builder *b, const stf_symbol *s, const stf_code *c, const stf_affine *x)
{
  stf_affine k = {0};
  for (int d = 0; d < c->count; d++) {
    const int64_t low = s->low[d], high = low + s->count[d] - 1;
    if (llabs(x[d].c) > NEAR && !fixed(x + d)) return complain(b, c->at, "an index beyond 1e9");
    if (fixed(x + d)) {
      if (x[d].c < low || x[d].c > high) return outside(b, s, c, x, d);
    } else if (!narrow(b, x + d, low, high)) {
      b->fallback = true;
    }
    k.c = k.c * s->count[d] + x[d].c - low;
    for (int l = 0; l < STF_LOOPS; l++) k.s[l] = k.s[l] * s->count[d] + x[d].s[l];
  }
  return stf_state_leaf(b, s, c->primes, &k, c->at);
}

/* An abbreviation with indices: its expression with the names of the indices
 * bound. */
static int abbreviation(stf_builder *b, const stf_symbol *s, const stf_code *c,
                        const stf_affine *x)
{
  const stf_statement *said = stf_statement_at(b->m, s->statement);
  const size_t scope = b->bindings.count;
  for (int d = 0; d < c->count; d++) {
    const int32_t word = said->range[d].name;
    if (word < 0)
      return complain(b, said->at,
                      "the indices of an abbreviation are names, 'let q[i] = ...'");
    STEIF_TRY(stf_bind_index(b, word, x + d));
  }
  if (b->frames.count > 100000)
    return complain(b, said->at, "abbreviations with indices that refer to each other");
  return stf_enter(b, &said->value, -1, scope);
}

int stf_element(stf_builder *b, const stf_code *c)
{
  const stf_symbol *s = stf_symbol_of(b->m, c->b);
  stf_affine x[STF_DIMENSIONS];
  if (!s || (s->kind != STF_IS_STATE && s->kind != STF_IS_LET))
    return stf_complain(&b->m->syntax.sources, c->at, STEIF_BAD_INPUT, "'%s' is no array",
                        stf_named(b->m, c->b));
  for (int d = 0; d < c->count; d++)
    STEIF_TRY(
      stf_index(b, &STF_AT(b->m->syntax.indices, stf_range, c->a + d)->low, c->at, x + d));
  return s->kind == STF_IS_STATE ? array(b, s, c, x) : abbreviation(b, s, c, x);
}

int stf_component(stf_model *m, stf_builder *b, const stf_statement *s, int32_t *component)
{
  const stf_symbol *symbol = stf_symbol_of(m, s->name);
  const bool fits = symbol && symbol->kind == STF_IS_STATE && s->primes < symbol->order &&
                    s->dimensions == symbol->dims;
  if (!fits)
    return stf_complain(&m->syntax.sources, s->at, STEIF_BAD_INPUT,
                        "'%s' is no single unknown; name one", stf_named(m, s->name));
  int64_t k = 0;
  for (int d = 0; d < symbol->dims; d++) {
    stf_affine x = {0};
    STEIF_TRY(stf_index(b, &s->range[d].low, s->at, &x));
    if (x.c < symbol->low[d] || x.c >= symbol->low[d] + symbol->count[d])
      return stf_complain(&m->syntax.sources, s->at, STEIF_BAD_INPUT,
                          "%s[%lld] does not exist (%s runs from %d to %d)",
                          stf_named(m, s->name), (long long)x.c, stf_named(m, s->name),
                          (int)symbol->low[d], (int)(symbol->low[d] + symbol->count[d] - 1));
    k = k * symbol->count[d] + x.c - symbol->low[d];
  }
  *component = symbol->first[s->primes] + (int32_t)k;
  return STEIF_OK;
}
