/* statements.c: statements, a line each. A wrong one is left out and the next
 * one read. SPDX-License-Identifier: BSD-3-Clause */
#include "base.h"
#include "reader.h"
#include <stdio.h>
#include <string.h>

static int loop(stf_reader *r, const stf_token *t)
{
  stf_statement s = stf_reader_fresh(r, STF_SAY_FOR);
  s.line = t->line;
  STEIF_TRY(stf_reader_name(r, &s));
  s.at = t->at;
  if (!stf_take_word(&r->p, STF_WORD_IN))
    return stf_expected(&r->p, "'in', as in 'for i in 1:n'");
  if (stf_reader_take(r, "range"))
    return stf_reader_fail(r, s.at, "a range is written 'for i in 1:n', with n the last value");
  s.range[0].name = s.name;
  s.range[0].low.from = s.range[0].low.to = 0;
  s.third.from = stf_next(&r->p)->at; /* place of the range */
  STEIF_TRY(stf_parse_number(&r->p, &s.range[0].low));
  STEIF_TRY(stf_reader_demand(r, ':', "':' and the end of the range"));
  STEIF_TRY(stf_parse_number(&r->p, &s.range[0].high));
  r->parent = (int32_t)r->p.syntax->statements.count;
  return stf_reader_keep(r, &s);
}

static int action(stf_reader *r)
{
  stf_statement s = stf_reader_fresh(r, STF_SAY_STOP);
  if (!stf_take_word(&r->p, STF_WORD_STOP)) {
    s.kind = STF_SAY_ASSIGN;
    STEIF_TRY(stf_reader_assignment(r, &s));
  } else if (stf_next(&r->p)->kind == STF_TOKEN_STRING) {
    STEIF_TRY(stf_reader_string(r, &s));
  }
  return stf_reader_keep(r, &s);
}

/* ": action", or ":" and lines up to "end". */
static int actions(stf_reader *r, const stf_statement *s, size_t place)
{
  STEIF_TRY(stf_reader_demand(r, ':', "':' and what happens"));
  const int32_t around = r->parent;
  *STF_AT(r->p.syntax->statements, stf_statement, place) = *s;
  r->parent = (int32_t)place;
  if (stf_next(&r->p)->kind == STF_TOKEN_END) return STEIF_OK;
  const int code = action(r);
  r->parent = around;
  return code;
}

static int when(stf_reader *r)
{
  stf_statement s = stf_reader_fresh(r, STF_SAY_WHEN);
  const size_t place = r->p.syntax->statements.count;
  STEIF_TRY(stf_reader_keep(r, &s));
  STEIF_TRY(stf_parse_any(&r->p, &s.value));
  const bool condition = r->p.boolean;
  s.whole = stf_reader_take(r, "rising")     ? 'r'
            : stf_reader_take(r, "falling")  ? 'f'
            : stf_reader_take(r, "crossing") ? 'c'
                                             : 0;
  if (!condition && stf_next_is(&r->p, '=')) return stf_equality(&r->p);
  if (condition == (s.whole != 0)) {
    const uint32_t at = s.at;
    return stf_reader_fail(r, at, "expected a condition such as v < 0, or 'v falling'");
  }
  return actions(r, &s, place);
}

static int instants(stf_reader *r)
{
  stf_statement s = stf_reader_fresh(r, STF_SAY_AT);
  const size_t place = r->p.syntax->statements.count;
  const int32_t around = r->parent;
  STEIF_TRY(stf_reader_keep(r, &s));
  r->parent = (int32_t)place;
  const int code = stf_reader_list(r, STF_SAY_INSTANT, stf_reader_value);
  r->parent = around;
  STEIF_TRY(code);
  return actions(r, &s, place);
}

static int every(stf_reader *r)
{
  stf_statement s = stf_reader_fresh(r, STF_SAY_EVERY);
  const size_t place = r->p.syntax->statements.count;
  STEIF_TRY(stf_reader_keep(r, &s));
  STEIF_TRY(stf_parse_number(&r->p, &s.value));
  if (stf_reader_take(r, "from")) STEIF_TRY(stf_parse_number(&r->p, &s.other));
  return actions(r, &s, place);
}

/* Loops make equations only. */
static int event(stf_reader *r, const stf_token *t, int (*one)(stf_reader *))
{
  if (r->parent < 0) return one(r);
  return stf_complain(&r->p.syntax->sources, t->at, STEIF_BAD_INPUT,
                      "'%s' cannot stand in a 'for'; write one for each element, after the "
                      "'end' of the loop",
                      stf_word_text(&r->p.syntax->words, t->word));
}

static int interval(stf_reader *r)
{
  stf_statement s = stf_reader_fresh(r, STF_SAY_TIME);
  if (stf_next_is(&r->p, '=')) return stf_expected(&r->p, "an interval such as 'time 0 to 10'");
  STEIF_TRY(stf_parse_number(&r->p, &s.value));
  if (!stf_reader_take(r, "to"))
    return stf_expected(&r->p, "'to' and the end of the interval, as in 'time 0 to 10'");
  STEIF_TRY(stf_parse_number(&r->p, &s.other));
  stf_reader_unit(r, &s);
  return stf_reader_keep(r, &s);
}

static int reference_value(stf_reader *r, stf_statement *s)
{
  STEIF_TRY(stf_reader_assignment(r, s));
  s->kind = STF_SAY_VALUE;
  return STEIF_OK;
}

static int reference(stf_reader *r)
{
  stf_statement s = stf_reader_fresh(r, STF_SAY_REFERENCE);
  const size_t place = r->p.syntax->statements.count;
  const int32_t around = r->parent;
  STEIF_TRY(stf_reader_keep(r, &s));
  if (!stf_take_word(&r->p, STF_WORD_AT)) return stf_expected(&r->p, "'at' and a time");
  STEIF_TRY(stf_parse_number(&r->p, &s.value));
  r->parent = (int32_t)place;
  const int code = stf_take(&r->p, ',') ? stf_reader_list(r, STF_SAY_VALUE, reference_value)
                                        : stf_expected(&r->p, "',' and a value");
  r->parent = around;
  STEIF_TRY(code);
  if (stf_reader_take(r, "digits")) STEIF_TRY(stf_parse_number(&r->p, &s.other));
  if (stf_reader_take(r, "source")) STEIF_TRY(stf_reader_string(r, &s));
  *STF_AT(r->p.syntax->statements, stf_statement, place) = s;
  return STEIF_OK;
}

/* Is the value of s the name of s and nothing else? */
static bool is_itself(const stf_reader *r, const stf_statement *s)
{
  const stf_code *c = STF_AT(r->p.syntax->codes, stf_code, s->value.from);
  return !s->dimensions && !s->primes && s->value.to == s->value.from + 1 &&
         c->kind == STF_OP_NAME && c->a == s->name;
}

/* column = expression sd s: any expression but the unknown of that name is an output. */
static int column(stf_reader *r, stf_statement *s)
{
  STEIF_TRY(stf_reader_assignment(r, s));
  if (stf_reader_take(r, "sd")) STEIF_TRY(stf_parse_number(&r->p, &s->other));
  if (is_itself(r, s)) return STEIF_OK;
  stf_statement output = *s;
  output.kind = STF_SAY_OUTPUT, output.parent = -1, output.other = (stf_expression){0};
  return stf_reader_keep(r, &output);
}

static int data(stf_reader *r)
{
  stf_statement s = stf_reader_fresh(r, STF_SAY_DATA);
  const size_t place = r->p.syntax->statements.count;
  const int32_t around = r->parent;
  STEIF_TRY(stf_reader_string(r, &s));
  STEIF_TRY(stf_reader_keep(r, &s));
  r->parent = (int32_t)place;
  const int code = stf_take(&r->p, ',') ? stf_reader_list(r, STF_SAY_COLUMN, column) : STEIF_OK;
  r->parent = around;
  return code;
}

static int form(stf_reader *r)
{
  static const char *const names[] = {"ode", "mass", "implicit", "descriptor"};
  stf_statement s = stf_reader_fresh(r, STF_SAY_FORM);
  for (int i = 0; i < 4; i++)
    if (stf_reader_take(r, names[i])) s.whole = (uint8_t)(1 << i);
  return s.whole ? stf_reader_keep(r, &s)
                 : stf_expected(&r->p, "ode, mass, implicit or descriptor");
}

static int named_text(stf_reader *r, int kind)
{
  stf_statement s = stf_reader_fresh(r, kind);
  STEIF_TRY(stf_reader_string(r, &s));
  return stf_reader_keep(r, &s);
}

static int equation(stf_reader *r)
{
  stf_statement s = stf_reader_fresh(r, STF_SAY_EQUATION);
  const stf_token *t = stf_next(&r->p);
  if (t->kind == STF_TOKEN_NAME && t[1].kind == STF_TOKEN_MARK && t[1].word == ':') {
    s.name = t->word;
    r->p.at += 2;
  }
  STEIF_TRY(stf_parse_number(&r->p, &s.value));
  s.third.from = stf_next(&r->p)->at;
  STEIF_TRY(stf_reader_demand(r, '=', "'=' or an operator"));
  STEIF_TRY(stf_parse_number(&r->p, &s.other));
  return stf_reader_keep(r, &s);
}

static int end(stf_reader *r, uint32_t at)
{
  if (r->parent < 0) /* after an error it may be the end of a loop that was not read */
    return r->p.syntax->sources.errors
             ? STEIF_OK
             : stf_reader_fail(r, at, "'end' without 'for' or 'when'; remove it");
  r->parent = STF_AT(r->p.syntax->statements, stf_statement, r->parent)->parent;
  return STEIF_OK;
}

static bool acting(const stf_reader *r)
{
  if (r->parent < 0) return false;
  const int kind = STF_AT(r->p.syntax->statements, stf_statement, r->parent)->kind;
  return kind == STF_SAY_WHEN || kind == STF_SAY_AT || kind == STF_SAY_EVERY;
}

/* The statements of another file stand here. */
static int include(stf_reader *r, uint32_t at)
{
  enum { FILES = 64, DEEP = 8 };
  stf_syntax *x = r->p.syntax;
  stf_statement s = stf_reader_fresh(r, STF_SAY_TITLE);
  const char *path;
  STEIF_TRY(stf_reader_string(r, &s));
  if (r->parent >= 0)
    return stf_reader_fail(r, at, "include stands outside of loops and events");
  STEIF_TRY(stf_source_path(&x->sources, x->pool, s.string - 1,
                            stf_source_at(&x->sources, s.string), s.strlength, &path));
  if (x->depth == DEEP || x->sources.texts.count == FILES)
    return stf_reader_fail(
      r, at, "files included more than 8 deep, or more than 64; a file includes itself?");
  const size_t which = x->sources.texts.count;
  x->depth++;
  const bool read = !stf_source_read(&x->sources, x->pool, path, path);
  const int code = read ? stf_parse(x, which)
                        : stf_complain(&x->sources, at, steif_status(x->sources.ctx),
                                       "cannot read the included file");
  x->depth--;
  return code;
}

static int dispatch(stf_reader *r, const stf_token *t)
{
  switch (t->word) {
  case STF_WORD_MODEL: return named_text(r, STF_SAY_TITLE);
  case STF_WORD_PARAM: return stf_reader_list(r, STF_SAY_PARAM, stf_reader_item);
  case STF_WORD_CONST: return stf_reader_list(r, STF_SAY_CONST, stf_reader_item);
  case STF_WORD_STATE: return stf_reader_list(r, STF_SAY_STATE, stf_reader_state);
  case STF_WORD_DISCRETE: return stf_reader_list(r, STF_SAY_DISCRETE, stf_reader_assignment);
  case STF_WORD_LET: return stf_reader_list(r, STF_SAY_LET, stf_reader_assignment);
  case STF_WORD_FUNCTION: return stf_reader_function(r);
  case STF_WORD_BOUNDARY: return stf_reader_list(r, STF_SAY_BOUNDARY, stf_reader_assignment);
  case STF_WORD_TABLE: return stf_reader_table(r);
  case STF_WORD_INCLUDE: return include(r, t->at);
  case STF_WORD_FOR: return loop(r, t);
  case STF_WORD_WHEN: return event(r, t, when);
  case STF_WORD_AT: return event(r, t, instants);
  case STF_WORD_EVERY: return event(r, t, every);
  case STF_WORD_OUTPUT: return stf_reader_list(r, STF_SAY_OUTPUT, stf_reader_assignment);
  case STF_WORD_INVARIANT: return stf_reader_list(r, STF_SAY_INVARIANT, stf_reader_assignment);
  case STF_WORD_REQUIRE: return stf_reader_list(r, STF_SAY_REQUIRE, stf_reader_requirement);
  case STF_WORD_BREAKS: return stf_reader_list(r, STF_SAY_BREAK, stf_reader_value);
  case STF_WORD_TIME: return interval(r);
  case STF_WORD_TOLERANCE: return stf_reader_list(r, STF_SAY_TOLERANCE, stf_reader_tolerance);
  case STF_WORD_FORM: return form(r);
  case STF_WORD_REFERENCE: return reference(r);
  case STF_WORD_DATA: return data(r);
  case STF_WORD_FIT: return stf_reader_list(r, STF_SAY_FIT, stf_reader_fit);
  case STF_WORD_END: return end(r, t->at);
  default: r->p.at--; return equation(r);
  }
}

/* Two names side by side are no equation. Words that begin such lines in other languages: */
static int foreign_statement(stf_reader *r, const stf_token *t)
{
  static const struct {
    const char *word, *here;
  } words[] = {{"par", "param"},        {"params", "param"},      {"parameter", "param"},
               {"parameters", "param"}, {"constant", "const"},    {"constants", "const"},
               {"var", "state"},        {"variable", "state"},    {"variables", "state"},
               {"states", "state"},     {"unknown", "state"},     {"unknowns", "state"},
               {"init", "state"},       {"initial", "state"},     {"ic", "state"},
               {"aux", "output"},       {"def", "function"},      {"define", "let"},
               {"local", "let"},        {"event", "when"},        {"global", "when"},
               {"import", "include"},   {"der", "state"},         {"real", "state"},
               {"Real", "state"},       {"tspan", "time"},        {"rtol", "tolerance"},
               {"atol", "tolerance"},   {"constraint", "require"}};
  const char *name = stf_word_text(&r->p.syntax->words, t->word), *here = NULL;
  char guess[STF_GUESS];
  for (size_t i = 0; i < sizeof words / sizeof *words; i++)
    if (!strcmp(name, words[i].word)) here = words[i].here;
  if (here) snprintf(guess, sizeof guess, "; did you mean '%s'?", here);
  return stf_complain(&r->p.syntax->sources, t->at, STEIF_BAD_INPUT,
                      "'%.40s' begins no statement%s", name,
                      here ? guess
                           : ": a line is an equation, or begins with param, const, state, "
                             "discrete, let, function, table, when, output, time, ...");
}

static int statement(stf_reader *r)
{
  const stf_token *t = stf_next(&r->p);
  r->p.level = 0;
  if (t->kind == STF_TOKEN_END) return STEIF_OK;
  if (acting(r) && !stf_next_word(&r->p, STF_WORD_END)) return action(r);
  if (t->kind != STF_TOKEN_NAME) return equation(r);
  if (t->word >= STF_WORDS_RESERVED && t[1].kind == STF_TOKEN_NAME &&
      t[1].word >= STF_WORDS_RESERVED)
    return foreign_statement(r, t);
  r->p.at++;
  return dispatch(r, t);
}

/* One statement and the end of its line; after an error the rest of the line is
 * left out. */
static int line(stf_reader *r)
{
  int code = statement(r);
  if (!code && stf_next(&r->p)->kind != STF_TOKEN_END)
    code = stf_expected(&r->p, "an operator or the end of the line");
  if (code == STEIF_NO_MEMORY) return code;
  while (stf_next(&r->p)->kind != STF_TOKEN_END) r->p.at++;
  r->p.at++;
  return STEIF_OK;
}

/* Line by line: the tokens of one serve the next. Those of the text that includes this one stay in front. */
int stf_parse(stf_syntax *syntax, size_t which)
{
  const size_t first = syntax->tokens.count;
  stf_lexer lexer;
  stf_reader r = {.p = {.syntax = syntax, .at = first}, .parent = -1};
  STEIF_TRY(stf_lex_open(&lexer, &syntax->sources, which, &syntax->words, &syntax->tokens));
  while (!lexer.ended && syntax->sources.errors < STF_ERRORS) {
    STEIF_TRY(stf_lex_line(&lexer));
    r.p.at = first;
    if (!lexer.broken) STEIF_TRY(line(&r));
    syntax->tokens.count = first;
  }
  if (r.parent < 0) return STEIF_OK;
  const stf_statement *open = STF_AT(syntax->statements, stf_statement, r.parent);
  return stf_complain(&syntax->sources, open->at, STEIF_BAD_INPUT,
                      "this %s has no 'end'; close it",
                      open->kind == STF_SAY_FOR ? "loop" : "event");
}
