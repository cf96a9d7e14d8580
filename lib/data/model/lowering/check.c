/* check.c: every name in an expression is known where it stands: declared, or
 * an argument or index there. SPDX-License-Identifier: BSD-3-Clause */
#include "model.h"
#include <stdio.h>
#include <string.h>

/* Is the word an index or an argument of a statement or of those around it? */
static bool local(const stf_model *m, const stf_statement *s, int32_t index, int32_t word)
{
  for (int d = 0; d < STF_DIMENSIONS; d++)
    if (s->range[d].name == word) return true;
  if (s->kind == STF_SAY_FUNCTION)
    for (size_t i = (size_t)index + 1; i < m->syntax.statements.count; i++) {
      const stf_statement *argument = stf_statement_at(m, (int32_t)i);
      if (argument->kind != STF_SAY_NAME || argument->parent != index) break;
      if (argument->name == word) return true;
    }
  return s->parent >= 0 && local(m, stf_statement_at(m, s->parent), s->parent, word);
}

bool stf_summed(const stf_model *m, const stf_expression *e, int32_t word)
{
  for (uint32_t i = e->from; i < e->to; i++) {
    const stf_code *c = STF_AT(m->syntax.codes, stf_code, i);
    if (c->kind == STF_OP_SUM && STF_AT(m->syntax.indices, stf_range, c->a)->name == word)
      return true;
  }
  return false;
}

static int unknown(stf_model *m, const stf_statement *s, const stf_code *c, int32_t word)
{
  const char *name = stf_named(m, word),
             *near = stf_nearest(name, m->names.data, m->names.count, sizeof(char *));
  char room[3 * STEIF_SPEC_WORD];
  int operands;
  const bool alone = s->kind == STF_SAY_EQUATION && s->value.to == s->value.from + 1 &&
                     c == STF_AT(m->syntax.codes, stf_code, s->value.from) && !c->primes;
  const char *here = stf_elsewhere(m, name, room, sizeof room);
  if (alone && !here) return stf_undeclared(m, c, name);
  if (here) return stf_complain(&m->syntax.sources, c->at, STEIF_UNKNOWN_NAME, "%s", here);
  if (stf_function_of(name, &operands) >= 0)
    return stf_complain(&m->syntax.sources, c->at, STEIF_BAD_INPUT,
                        "'%s' is a function; write %s(...)", name, name);
  if (!near || (!name[1] && !near[1])) /* names of one letter are all near */
    return stf_complain(&m->syntax.sources, c->at, STEIF_UNKNOWN_NAME,
                        "unknown name '%s'; declare it", name);
  return stf_complain(&m->syntax.sources, c->at, STEIF_UNKNOWN_NAME,
                      "unknown name '%s'; did you mean '%s'?", name, near);
}

static void check_call(stf_model *m, const stf_statement *s, const stf_code *c)
{
  const stf_symbol *f = stf_symbol_of(m, c->a);
  const char *name = stf_named(m, c->a);
  int wanted = 0;
  if (f && f->kind == STF_IS_TABLE) {
    wanted = 1;
  } else if (f && f->kind == STF_IS_FUNCTION) {
    for (size_t i = (size_t)f->statement + 1; i < m->syntax.statements.count; i++)
      wanted += stf_statement_at(m, (int32_t)i)->parent == f->statement;
  } else if (stf_function_of(name, &wanted) < 0) {
    if (!strcmp(name, "div")) wanted = 2;
    if (!wanted && f) stf_no_function(m, s, c, f);
    if (!wanted && !f) unknown(m, s, c, c->a);
    if (!wanted) return;
  }
  if (c->b != wanted)
    stf_complain(&m->syntax.sources, c->at, STEIF_BAD_INPUT, "'%s' takes %d argument%s, got %d",
                 name, wanted, wanted == 1 ? "" : "s", c->b);
}

static void check_symbol(stf_model *m, const stf_code *c, int32_t word)
{
  const stf_symbol *f = stf_symbol_of(m, word);
  const char *name = stf_named(m, word);
  if (!f) return;
  if (f->kind == STF_IS_FUNCTION || f->kind == STF_IS_TABLE)
    stf_complain(&m->syntax.sources, c->at, STEIF_BAD_INPUT, "'%s' needs an argument: %s(...)",
                 name, name);
  else if (c->primes && f->kind != STF_IS_STATE)
    stf_complain(&m->syntax.sources, c->at, STEIF_BAD_INPUT,
                 "the derivative of '%s', which is no state; declare it as state", name);
  else if (f->kind == STF_IS_STATE || f->kind == STF_IS_LET) {
    const int dims = stf_statement_at(m, f->statement)->dimensions;
    if (dims != c->count)
      stf_complain(&m->syntax.sources, c->at, STEIF_BAD_INPUT, "'%s' has %d ind%s, here %d%s",
                   name, dims, dims == 1 ? "ex" : "ices", c->count,
                   c->count ? "" : "; elements stand in a loop, 'for i in 1:n'");
  } else if (c->count) {
    stf_complain(&m->syntax.sources, c->at, STEIF_BAD_INPUT, "'%s' is no array", name);
  }
}

static void check(stf_model *m, int32_t index, const stf_expression *e)
{
  const stf_statement *s = stf_statement_at(m, index);
  for (uint32_t i = e->from; i < e->to; i++) {
    const stf_code *c = STF_AT(m->syntax.codes, stf_code, i);
    if (c->kind == STF_OP_CALL) check_call(m, s, c);
    if (c->kind != STF_OP_NAME && c->kind != STF_OP_ELEMENT) continue;
    const int32_t word = c->kind == STF_OP_NAME ? c->a : c->b;
    if (word < STF_WORDS_RESERVED || stf_summed(m, e, word) || local(m, s, index, word))
      continue;
    if (stf_symbol_of(m, word))
      check_symbol(m, c, word);
    else
      unknown(m, s, c, word);
  }
}

static void check_target(stf_model *m, const stf_statement *s)
{
  const stf_symbol *f = stf_symbol_of(m, s->name);
  char guess[STF_GUESS];
  if (!f)
    stf_complain(
      &m->syntax.sources, s->at, STEIF_UNKNOWN_NAME, "unknown name '%s'%s",
      stf_named(m, s->name),
      stf_guess(stf_named(m, s->name), m->names.data, m->names.count, sizeof(char *), guess));
  else if (f->kind != STF_IS_STATE && f->kind != STF_IS_DISCRETE && f->kind != STF_IS_PARAMETER)
    stf_complain(&m->syntax.sources, s->at, STEIF_BAD_INPUT,
                 "'%s' cannot be assigned; only states, discrete values and "
                 "parameters can",
                 stf_named(m, s->name));
}

/* `data "d.csv", conc = conc` of an output: outputs have no symbol. */
static bool names_output(const stf_model *m, const stf_statement *s)
{
  const stf_code *c = STF_AT(m->syntax.codes, stf_code, s->value.from);
  if (s->kind != STF_SAY_COLUMN || s->value.to != s->value.from + 1) return false;
  if (c->kind != STF_OP_NAME || c->a != s->name || c->primes) return false;
  for (size_t i = 0; i < m->syntax.statements.count; i++) {
    const stf_statement *output = stf_statement_at(m, (int32_t)i);
    if (output->kind == STF_SAY_OUTPUT && output->name == s->name) return true;
  }
  return false;
}

int stf_check_names(stf_model *m)
{
  for (size_t i = 0; i < m->syntax.statements.count; i++) {
    const stf_statement *s = stf_statement_at(m, (int32_t)i);
    if (s->kind == STF_SAY_ASSIGN || s->kind == STF_SAY_VALUE || s->kind == STF_SAY_BOUNDARY)
      check_target(m, s);
    if (s->kind == STF_SAY_STATE && s->primes && !stf_symbol_of(m, s->name))
      stf_complain(&m->syntax.sources, s->at, STEIF_UNKNOWN_NAME,
                   "this is the slope of '%s' at the start, and no 'state %s = ...' declares "
                   "it; an equation has no 'state' before it",
                   stf_named(m, s->name), stf_named(m, s->name));
    if (!names_output(m, s)) check(m, (int32_t)i, &s->value);
    if (s->kind != STF_SAY_FOR) check(m, (int32_t)i, &s->other);
    if (s->kind == STF_SAY_PARAM || s->kind == STF_SAY_STATE) check(m, (int32_t)i, &s->third);
    for (int d = 0; d < STF_DIMENSIONS; d++) {
      const bool loop = s->kind == STF_SAY_FOR && d == 0;
      if (d >= s->dimensions && !loop) continue;
      check(m, (int32_t)i, &s->range[d].low);
      check(m, (int32_t)i, &s->range[d].high);
    }
  }
  return stf_complaints(&m->syntax.sources);
}
