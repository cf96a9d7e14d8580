/* declarations.c: what declares a name: parameters, states, abbreviations,
 * functions, tables. SPDX-License-Identifier: BSD-3-Clause */
#include "reader.h"
#include <string.h>

int stf_reader_fail(stf_reader *r, uint32_t at, const char *what)
{
  return stf_complain(&r->p.syntax->sources, at, STEIF_BAD_INPUT, "%s", what);
}

int stf_reader_keep(stf_reader *r, const stf_statement *s)
{
  stf_statement *to =
    stf_vector_push(r->p.syntax->sources.ctx, &r->p.syntax->statements, sizeof *to);
  if (!to) return STEIF_NO_MEMORY;
  *to = *s;
  return STEIF_OK;
}

stf_statement stf_reader_fresh(const stf_reader *r, int kind)
{
  const stf_token *t = stf_next(&r->p);
  stf_statement s = {
    .kind = (uint8_t)kind, .name = -1, .parent = r->parent, .at = t->at, .line = t->line};
  for (int i = 0; i < STF_DIMENSIONS; i++) s.range[i].name = -1;
  return s;
}

/* A name that may be declared. */
int stf_reader_name(stf_reader *r, stf_statement *s)
{
  const stf_token *t = stf_next(&r->p);
  char sentence[200];
  if (t->kind == STF_TOKEN_NUMBER && t > (const stf_token *)r->p.syntax->tokens.data + 1 &&
      t[-1].kind == STF_TOKEN_MARK && t[-1].word == ',' && t[-2].kind == STF_TOKEN_NUMBER) {
    snprintf(sentence, sizeof sentence, "'%.12g,%.12g': decimal point, %.12g.%.12g",
             t[-2].number, t->number, t[-2].number, t->number);
    return stf_reader_fail(r, t[-2].at, sentence);
  }
  if (t->kind != STF_TOKEN_NAME) return stf_expected(&r->p, "a name");
  int operands;
  const char *word = stf_word_text(&r->p.syntax->words, t->word);
  if (t->word < STF_WORDS_RESERVED || stf_function_of(word, &operands) >= 0) {
    snprintf(sentence, sizeof sentence, "'%s' is a word of the language; take another name",
             word);
    return stf_reader_fail(r, t->at, sentence);
  }
  s->name = t->word;
  s->at = t->at;
  s->line = t->line;
  r->p.at++;
  return STEIF_OK;
}

void stf_reader_unit(stf_reader *r, stf_statement *s)
{
  const stf_token *t = stf_next(&r->p);
  if (t->kind != STF_TOKEN_UNIT) return;
  s->string = t->at;
  s->strlength = t->length;
  r->p.at++;
}

int stf_reader_string(stf_reader *r, stf_statement *s)
{
  const stf_token *t = stf_next(&r->p);
  if (t->kind != STF_TOKEN_STRING) return stf_expected(&r->p, "a text in quotes");
  s->string = t->at;
  s->strlength = t->length;
  r->p.at++;
  return STEIF_OK;
}

int stf_reader_demand(stf_reader *r, int mark, const char *what)
{
  return stf_take(&r->p, mark) ? STEIF_OK : stf_expected(&r->p, what);
}

bool stf_reader_take(stf_reader *r, const char *text)
{
  const stf_token *t = stf_next(&r->p);
  const int word = stf_word_known(&r->p.syntax->words, text, strlen(text));
  return t->kind == STF_TOKEN_NAME && t->word == word && stf_take_word(&r->p, word);
}

/* ---- one after the other
 * ----------------------------------------------------------------------------
 */

int stf_reader_item(stf_reader *r, stf_statement *s)
{
  STEIF_TRY(stf_reader_name(r, s));
  STEIF_TRY(stf_reader_demand(r, '=', "'=' and one value (arrays are states or functions)"));
  STEIF_TRY(stf_parse_number(&r->p, &s->value));
  stf_reader_unit(r, s);
  s->whole = stf_take_word(&r->p, STF_WORD_WHOLE);
  if (!stf_take_word(&r->p, STF_WORD_IN)) return STEIF_OK;
  STEIF_TRY(stf_reader_demand(r, '[', "'[' and the least value"));
  STEIF_TRY(stf_parse_number(&r->p, &s->other));
  STEIF_TRY(stf_reader_demand(r, ',', "',' and the largest value"));
  STEIF_TRY(stf_parse_number(&r->p, &s->third));
  return stf_reader_demand(r, ']', "']'");
}

int stf_reader_state(stf_reader *r, stf_statement *s)
{
  STEIF_TRY(stf_reader_name(r, s));
  if (stf_take(&r->p, '[')) STEIF_TRY(stf_parse_ranges(&r->p, s->range, &s->dimensions));
  while (stf_take(&r->p, '\'')) s->primes++;
  s->start = stf_next_is(&r->p, '=') ? '=' : stf_next_is(&r->p, '~') ? '~' : 0;
  if (s->start) {
    r->p.at++;
    STEIF_TRY(stf_parse_number(&r->p, &s->value));
  }
  stf_reader_unit(r, s);
  if (stf_take_word(&r->p, STF_WORD_SCALE)) STEIF_TRY(stf_parse_number(&r->p, &s->other));
  if (stf_reader_take(r, "atol")) STEIF_TRY(stf_parse_number(&r->p, &s->third));
  stf_reader_unit(r, s);
  return STEIF_OK;
}

/* let q[i] = ...: the index is a name of its own. */
static void name_indices(const stf_reader *r, stf_statement *s)
{
  for (int d = 0; d < s->dimensions; d++) {
    const stf_expression *low = &s->range[d].low;
    const stf_code *c = STF_AT(r->p.syntax->codes, stf_code, low->from);
    if (s->range[d].name < 0 && low->to == low->from + 1 && c->kind == STF_OP_NAME)
      s->range[d].name = c->a;
  }
}

/* name[...]' = value */
int stf_reader_assignment(stf_reader *r, stf_statement *s)
{
  STEIF_TRY(stf_reader_name(r, s));
  if (stf_take(&r->p, '[')) STEIF_TRY(stf_parse_ranges(&r->p, s->range, &s->dimensions));
  while (stf_take(&r->p, '\'')) s->primes++;
  if (s->kind == STF_SAY_LET) name_indices(r, s);
  STEIF_TRY(stf_reader_demand(r, '=', "'=' and a value"));
  STEIF_TRY(stf_parse_number(&r->p, &s->value));
  stf_reader_unit(r, s);
  return STEIF_OK;
}

int stf_reader_requirement(stf_reader *r, stf_statement *s)
{
  return stf_parse_condition(&r->p, &s->value);
}

int stf_reader_value(stf_reader *r, stf_statement *s)
{
  return stf_parse_number(&r->p, &s->value);
}

int stf_reader_tolerance(stf_reader *r, stf_statement *s)
{
  s->whole = stf_reader_take(r, "rtol") ? 'r' : stf_reader_take(r, "atol") ? 'a' : 0;
  return s->whole ? stf_reader_value(r, s) : stf_expected(&r->p, "rtol or atol");
}

int stf_reader_fit(stf_reader *r, stf_statement *s)
{
  STEIF_TRY(stf_reader_name(r, s));
  if (stf_next(&r->p)->kind == STF_TOKEN_NAME) s->whole = stf_reader_take(r, "log");
  return STEIF_OK;
}

/* What is declared one after the other, separated by commas. */
int stf_reader_list(stf_reader *r, int kind, int (*one)(stf_reader *, stf_statement *))
{
  do {
    stf_statement s = stf_reader_fresh(r, kind);
    STEIF_TRY(one(r, &s));
    STEIF_TRY(stf_reader_keep(r, &s));
  } while (stf_take(&r->p, ','));
  return STEIF_OK;
}

/* ---- functions and tables
 * ---------------------------------------------------------------------- */

int stf_reader_function(stf_reader *r)
{
  stf_statement s = stf_reader_fresh(r, STF_SAY_FUNCTION);
  STEIF_TRY(stf_reader_name(r, &s));
  STEIF_TRY(stf_reader_demand(r, '(', "'(' and the names of the arguments"));
  const size_t place = r->p.syntax->statements.count;
  const int32_t around = r->parent;
  STEIF_TRY(stf_reader_keep(r, &s));
  r->parent = (int32_t)place;
  const int code = stf_reader_list(r, STF_SAY_NAME, stf_reader_name);
  r->parent = around;
  STEIF_TRY(code);
  STEIF_TRY(stf_reader_demand(r, ')', "')' or ','"));
  STEIF_TRY(stf_reader_demand(r, '=', "'=' and an expression"));
  STEIF_TRY(stf_parse_number(&r->p, &s.value));
  STF_AT(r->p.syntax->statements, stf_statement, place)->value = s.value;
  return STEIF_OK;
}

static int pair(stf_reader *r, stf_statement *s)
{
  STEIF_TRY(stf_reader_demand(r, '(', "'(' of a pair (x, y)"));
  STEIF_TRY(stf_parse_number(&r->p, &s->value));
  STEIF_TRY(stf_reader_demand(r, ',', "','"));
  STEIF_TRY(stf_parse_number(&r->p, &s->other));
  return stf_reader_demand(r, ')', "')'");
}

static int table_source(stf_reader *r, stf_statement *s)
{
  if (stf_next(&r->p)->kind != STF_TOKEN_STRING) return stf_reader_list(r, STF_SAY_PAIR, pair);
  STEIF_TRY(stf_reader_string(r, s));
  if (!stf_reader_take(r, "column"))
    return stf_expected(&r->p, "column and its name or number, such as column 2,");
  stf_statement column = stf_reader_fresh(r, STF_SAY_PAIR);
  const stf_token *t = stf_next(&r->p);
  if (t->kind == STF_TOKEN_STRING) {
    STEIF_TRY(stf_reader_string(r, &column));
  } else {
    STEIF_TRY(stf_parse_number(&r->p, &column.value));
  }
  return stf_reader_keep(r, &column);
}

int stf_reader_table(stf_reader *r)
{
  stf_statement s = stf_reader_fresh(r, STF_SAY_TABLE);
  STEIF_TRY(stf_reader_name(r, &s));
  STEIF_TRY(stf_reader_demand(r, '=', "'=' and a file or pairs"));
  const size_t place = r->p.syntax->statements.count;
  const int32_t around = r->parent;
  STEIF_TRY(stf_reader_keep(r, &s));
  r->parent = (int32_t)place;
  const int code = table_source(r, &s);
  r->parent = around;
  STEIF_TRY(code);
  static const char *const kinds[] = {"linear", "cubic", "steps"};
  int which = 0;
  while (which < 3 && !stf_reader_take(r, kinds[which])) which++;
  if (which == 3) return stf_expected(&r->p, "linear, cubic or steps");
  s.whole = (uint8_t)which;
  if (stf_reader_take(r, "outside")) {
    s.error = stf_reader_take(r, "error");
    if (!s.error && !stf_reader_take(r, "hold")) return stf_expected(&r->p, "hold or error");
  }
  *STF_AT(r->p.syntax->statements, stf_statement, place) = s;
  return STEIF_OK;
}
