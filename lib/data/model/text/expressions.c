/* expressions.c: expressions and conditions by recursive descent into postfix
 * codes. any     = "if" cond "then" any { "elseif" cond "then" any } "else" any
 * | or or      = and { "or" and }         and = not { "and" not }      not =
 * "not" not | relation relation= sum [ (< | <= | > | >=) sum ] sum     =
 * product { (+|-) product }                product = signed { (*|/) signed }
 *   signed  = (+|-) signed | power     power = atom [ ^ signed ]
 * so that -x^2 = -(x^2), 2^3^2 = 2^9 and 2^-1 = 0.5.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "syntax.h"
#include "text.h"
#include <string.h>

enum { DEEPEST = 200 };

static int any(stf_parser *p);
static int signed_power(stf_parser *p);
static int sum(stf_parser *p);

static int complain(stf_parser *p, uint32_t at, const char *what)
{
  return stf_complain(&p->syntax->sources, at, STEIF_BAD_INPUT, "%s", what);
}

static int too_deep(stf_parser *p, uint32_t at)
{
  return complain(p, at,
                  p->syntax->sources.alone ? "nested more than 200 deep; simplify it"
                                           : "nested more than 200 deep; introduce a 'let'");
}

static stf_code *emit(stf_parser *p, int kind, uint32_t at)
{
  stf_code *c = stf_vector_push(p->syntax->sources.ctx, &p->syntax->codes, sizeof *c);
  if (c) *c = (stf_code){.kind = (uint8_t)kind, .at = at};
  return c;
}

static int operation(stf_parser *p, int kind, uint32_t at)
{
  return emit(p, kind, at) ? STEIF_OK : STEIF_NO_MEMORY;
}

static uint8_t primes(stf_parser *p)
{
  int count = 0;
  while (stf_take(p, '\'')) count++;
  return (uint8_t)(count < 9 ? count : 9);
}

/* ---- atoms
 * -----------------------------------------------------------------------------------
 */

static int one_range(stf_parser *p, stf_range *r)
{
  *r = (stf_range){.name = -1};
  const stf_token *t = stf_next(p);
  if (t->kind == STF_TOKEN_NAME && t[1].kind == STF_TOKEN_NAME && t[1].word == STF_WORD_IN) {
    r->name = t->word;
    p->at += 2;
  }
  STEIF_TRY(stf_parse_number(p, &r->low));
  if (stf_take(p, ':')) return stf_parse_number(p, &r->high);
  return r->name < 0 ? STEIF_OK : stf_expected(p, "':' and the end of the range");
}

int stf_parse_ranges(stf_parser *p, stf_range *range, uint8_t *dimensions)
{
  *dimensions = 0;
  do {
    if (*dimensions == STF_DIMENSIONS)
      return complain(p, stf_next(p)->at, "more than 3 indices; use fewer");
    STEIF_TRY(one_range(p, range + *dimensions));
    ++*dimensions;
  } while (stf_take(p, ','));
  return stf_take(p, ']') ? STEIF_OK : stf_expected(p, "']' or ','");
}

/* Codes that others read are skipped: SKIP over them. */
static int skipped(stf_parser *p, size_t from)
{
  STF_AT(p->syntax->codes, stf_code, from)->a = (int32_t)(p->syntax->codes.count - from - 1);
  return STEIF_OK;
}

static int element(stf_parser *p, const stf_token *t)
{
  const size_t skip = p->syntax->codes.count;
  const int32_t word = t->word;
  const uint32_t at = t->at;
  stf_range range[STF_DIMENSIONS];
  uint8_t count;
  STEIF_TRY(operation(p, STF_OP_SKIP, at));
  STEIF_TRY(stf_parse_ranges(p, range, &count));
  STEIF_TRY(skipped(p, skip));
  const size_t first = p->syntax->indices.count;
  for (int i = 0; i < count; i++) {
    if (range[i].high.to > range[i].high.from)
      return complain(p, at,
                      "a range in an expression; an element has one index for "
                      "each dimension");
    stf_range *r = stf_vector_push(p->syntax->sources.ctx, &p->syntax->indices, sizeof *r);
    if (!r) return STEIF_NO_MEMORY;
    *r = range[i];
  }
  stf_code *c = emit(p, STF_OP_ELEMENT, at);
  if (!c) return STEIF_NO_MEMORY;
  c->a = (int32_t)first;
  c->b = word;
  c->count = count;
  c->primes = primes(p);
  return STEIF_OK;
}

/* sum(name in from : to : term) */
static int series(stf_parser *p, uint32_t at)
{
  stf_range range = {.name = -1};
  const size_t skip = p->syntax->codes.count;
  const stf_token *t = stf_next(p);
  if (t->kind != STF_TOKEN_NAME) return stf_expected(p, "the name of an index");
  range.name = t->word;
  p->at++;
  STEIF_TRY(operation(p, STF_OP_SKIP, at));
  if (!stf_take_word(p, STF_WORD_IN)) return stf_expected(p, "'in'");
  STEIF_TRY(stf_parse_number(p, &range.low));
  if (!stf_take(p, ':')) return stf_expected(p, "':'");
  STEIF_TRY(stf_parse_number(p, &range.high));
  if (!stf_take(p, ':')) return stf_expected(p, "':' and the terms of the sum");
  STEIF_TRY(skipped(p, skip));
  stf_range *r = stf_vector_push(p->syntax->sources.ctx, &p->syntax->indices, sizeof *r);
  const size_t place = p->syntax->codes.count;
  if (!r || !emit(p, STF_OP_SUM, at)) return STEIF_NO_MEMORY;
  *r = range;
  STF_AT(p->syntax->codes, stf_code, place)->a = (int32_t)p->syntax->indices.count - 1;
  STEIF_TRY(any(p));
  STF_AT(p->syntax->codes, stf_code, place)->b = (int32_t)(p->syntax->codes.count - place - 1);
  return stf_take(p, ')') ? STEIF_OK : stf_expected(p, "')' or an operator");
}

static int turn(stf_parser *p, uint32_t at, int by)
{
  stf_code *c = emit(p, STF_OP_LITERAL, at);
  if (c) c->a = by;
  return c ? STEIF_OK : STEIF_NO_MEMORY;
}

/* noevent(any), smooth(any): relations in it are taken as they are at the point
 * at hand. */
static int without_events(stf_parser *p, uint32_t at)
{
  STEIF_TRY(turn(p, at, 1));
  STEIF_TRY(any(p));
  if (!stf_take(p, ')')) return stf_expected(p, "')' or an operator");
  return turn(p, at, -1);
}

static int call(stf_parser *p, const stf_token *t)
{
  const int32_t word = t->word;
  const uint32_t at = t->at;
  int count = 0;
  const char *text = stf_word_text(&p->syntax->words, word);
  const bool literal = !strcmp(text, "noevent") || !strcmp(text, "smooth");
  if (literal) return without_events(p, at);
  if (word == STF_WORD_SUM) return series(p, at);
  do {
    STEIF_TRY(any(p));
    if (p->boolean) return complain(p, at, "a condition cannot be an argument; use 'if'");
    count++;
  } while (stf_take(p, ','));
  if (!stf_take(p, ')')) return stf_expected(p, "')', ',' or an operator");
  stf_code *c = emit(p, STF_OP_CALL, at);
  if (!c) return STEIF_NO_MEMORY;
  c->a = word;
  c->b = count;
  return STEIF_OK;
}

static int name(stf_parser *p)
{
  const stf_token t = *stf_next(p);
  const bool reserved = t.word < STF_WORDS_RESERVED && t.word != STF_WORD_T &&
                        t.word != STF_WORD_PI && t.word != STF_WORD_SUM;
  if (reserved) return stf_expected(p, "an expression");
  p->at++;
  if (stf_take(p, '[')) return element(p, &t);
  if (stf_take(p, '(')) return call(p, &t);
  stf_code *c = emit(p, STF_OP_NAME, t.at);
  if (!c) return STEIF_NO_MEMORY;
  c->a = t.word;
  c->primes = primes(p);
  return STEIF_OK;
}

static int atom(stf_parser *p)
{
  const stf_token *t = stf_next(p);
  p->boolean = false;
  if (t->kind == STF_TOKEN_NUMBER) {
    const double value = t->number;
    stf_code *c = emit(p, STF_OP_NUMBER, t->at);
    if (c) c->number = value;
    p->at++;
    return c ? STEIF_OK : STEIF_NO_MEMORY;
  }
  if (t->kind == STF_TOKEN_NAME) {
    STEIF_TRY(name(p));
    p->boolean = false;
    return STEIF_OK;
  }
  if (!stf_take(p, '(')) return stf_expected(p, "an expression");
  STEIF_TRY(any(p));
  return stf_take(p, ')') ? STEIF_OK : stf_expected(p, "')' or an operator");
}

/* ---- operators
 * -------------------------------------------------------------------------------
 */

static int arithmetic(stf_parser *p, uint32_t at)
{
  return p->boolean ? complain(p, at, "expected a number, found a condition; use 'if'")
                    : STEIF_OK;
}

static int power(stf_parser *p)
{
  STEIF_TRY(atom(p));
  const uint32_t at = stf_next(p)->at;
  if (!stf_take(p, '^')) return STEIF_OK;
  STEIF_TRY(arithmetic(p, at));
  STEIF_TRY(signed_power(p));
  STEIF_TRY(arithmetic(p, at));
  return operation(p, STF_OP_POWER, at);
}

static int signed_power(stf_parser *p)
{
  const uint32_t at = stf_next(p)->at;
  if (++p->level > DEEPEST) return too_deep(p, at);
  const bool minus = stf_take(p, '-');
  if (minus || stf_take(p, '+')) {
    STEIF_TRY(signed_power(p));
    STEIF_TRY(arithmetic(p, at));
    if (minus) STEIF_TRY(operation(p, STF_OP_NEGATIVE, at));
  } else {
    STEIF_TRY(power(p));
  }
  p->level--;
  return STEIF_OK;
}

/* operand { sign operand }, from the left; signs and their kinds. */
static int chain(stf_parser *p, int (*operand)(stf_parser *), const int sign[2],
                 const int kind[2])
{
  STEIF_TRY(operand(p));
  for (;;) {
    const uint32_t at = stf_next(p)->at;
    const int which = stf_take(p, sign[0]) ? 0 : stf_take(p, sign[1]) ? 1 : -1;
    if (which < 0) return STEIF_OK;
    STEIF_TRY(arithmetic(p, at));
    STEIF_TRY(operand(p));
    STEIF_TRY(arithmetic(p, at));
    STEIF_TRY(operation(p, kind[which], at));
  }
}

static int product(stf_parser *p)
{
  static const int sign[] = {'*', '/'}, kind[] = {STF_OP_MULTIPLY, STF_OP_DIVIDE};
  return chain(p, signed_power, sign, kind);
}

static int sum(stf_parser *p)
{
  static const int sign[] = {'+', '-'}, kind[] = {STF_OP_ADD, STF_OP_SUBTRACT};
  return chain(p, product, sign, kind);
}

/* a > b is b < a, whose g = lhs - rhs keeps its sign by the marker in `primes`.
 */
static int relation(stf_parser *p)
{
  STEIF_TRY(sum(p));
  const uint32_t at = stf_next(p)->at;
  if (stf_next_is(p, 'e')) return stf_equality(p);
  static const int marks[] = {'<', 'l', '>', 'g'};
  for (int i = 0; i < 4; i++) {
    if (!stf_take(p, marks[i])) continue;
    STEIF_TRY(arithmetic(p, at));
    STEIF_TRY(sum(p));
    STEIF_TRY(arithmetic(p, at));
    stf_code *c = emit(p, i % 2 ? STF_OP_LESS_EQUAL : STF_OP_LESS, at);
    if (!c) return STEIF_NO_MEMORY;
    c->a = i > 1; /* operands change places */
    p->boolean = true;
    return STEIF_OK;
  }
  return STEIF_OK;
}

static int condition(stf_parser *p)
{
  if (!p->boolean && stf_next_is(p, '=')) return stf_equality(p);
  return p->boolean ? STEIF_OK : stf_expected(p, "a condition such as v < 0");
}

static int negation(stf_parser *p)
{
  const uint32_t at = stf_next(p)->at;
  if (++p->level > DEEPEST) return too_deep(p, at);
  if (stf_take_word(p, STF_WORD_NOT)) {
    STEIF_TRY(negation(p));
    STEIF_TRY(condition(p));
    STEIF_TRY(operation(p, STF_OP_NOT, at));
  } else {
    STEIF_TRY(relation(p));
  }
  p->level--;
  return STEIF_OK;
}

static int logic(stf_parser *p, int (*operand)(stf_parser *), int word, int kind)
{
  STEIF_TRY(operand(p));
  for (;;) {
    const uint32_t at = stf_next(p)->at;
    if (!stf_take_word(p, word)) return STEIF_OK;
    STEIF_TRY(condition(p));
    STEIF_TRY(operand(p));
    STEIF_TRY(condition(p));
    STEIF_TRY(operation(p, kind, at));
  }
}

static int both(stf_parser *p) { return logic(p, negation, STF_WORD_AND, STF_OP_AND); }
static int either(stf_parser *p) { return logic(p, both, STF_WORD_OR, STF_OP_OR); }

static int choice(stf_parser *p, uint32_t at)
{
  STEIF_TRY(either(p));
  STEIF_TRY(condition(p));
  if (!stf_take_word(p, STF_WORD_THEN)) return stf_expected(p, "'then'");
  STEIF_TRY(any(p));
  STEIF_TRY(arithmetic(p, at));
  const uint32_t next = stf_next(p)->at;
  if (stf_take_word(p, STF_WORD_ELSEIF)) {
    if (++p->level > DEEPEST) return too_deep(p, next);
    STEIF_TRY(choice(p, next));
    p->level--;
  } else {
    if (!stf_take_word(p, STF_WORD_ELSE)) return stf_expected(p, "'else' or 'elseif'");
    STEIF_TRY(any(p));
  }
  STEIF_TRY(arithmetic(p, at));
  return operation(p, STF_OP_SELECT, at);
}

static int any(stf_parser *p)
{
  const uint32_t at = stf_next(p)->at;
  if (!stf_take_word(p, STF_WORD_IF)) return either(p);
  if (++p->level > DEEPEST) return too_deep(p, at);
  STEIF_TRY(choice(p, at));
  p->boolean = false;
  p->level--;
  return STEIF_OK;
}

int stf_parse_any(stf_parser *p, stf_expression *e)
{
  e->from = (uint32_t)p->syntax->codes.count;
  if (p->level > DEEPEST) p->level = 0;
  STEIF_TRY(any(p));
  e->to = (uint32_t)p->syntax->codes.count;
  return STEIF_OK;
}

int stf_parse_number(stf_parser *p, stf_expression *e)
{
  const uint32_t at = stf_next(p)->at;
  STEIF_TRY(stf_parse_any(p, e));
  return arithmetic(p, at);
}

int stf_parse_condition(stf_parser *p, stf_expression *e)
{
  STEIF_TRY(stf_parse_any(p, e));
  return condition(p);
}
