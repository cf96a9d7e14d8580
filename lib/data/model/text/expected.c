/* expected.c: the next token, and what stands there instead of what the
 * language wants. SPDX-License-Identifier: BSD-3-Clause */
#include "syntax.h"
#include "text.h"
#include <string.h>

const stf_token *stf_next(const stf_parser *p)
{
  return STF_AT(p->syntax->tokens, stf_token, p->at);
}

bool stf_next_is(const stf_parser *p, int mark)
{
  const stf_token *t = stf_next(p);
  return t->kind == STF_TOKEN_MARK && t->word == mark;
}

bool stf_next_word(const stf_parser *p, int word)
{
  const stf_token *t = stf_next(p);
  return t->kind == STF_TOKEN_NAME && t->word == word;
}

bool stf_take(stf_parser *p, int mark)
{
  const bool is = stf_next_is(p, mark);
  p->at += is;
  return is;
}

bool stf_take_word(stf_parser *p, int word)
{
  const bool is = stf_next_word(p, word);
  p->at += is;
  return is;
}

int stf_expected(stf_parser *p, const char *what)
{
  const stf_token *t = stf_next(p);
  const char *habit = stf_habit(p, what), *join = habit ? "; " : "";
  if (!habit) habit = "";
  if (t->kind == STF_TOKEN_END)
    return stf_complain(&p->syntax->sources, t->at, STEIF_BAD_INPUT,
                        "expected %s, found the end of the %s%s%s", what,
                        p->syntax->sources.pieces ? "expression" : "line", join, habit);
  const stf_text *text = p->syntax->sources.texts.data;
  for (size_t i = 0; i < p->syntax->sources.texts.count; i++, text++)
    if (t->at >= text->base && t->at <= text->base + text->length) break;
  char piece[STF_SHOWN], shown[STF_SHOWN];
  const size_t length = t->length < STF_SHOWN - 1 ? t->length : STF_SHOWN - 1;
  memcpy(piece, text->text + (t->at - text->base), length);
  piece[length] = 0;
  const bool unit = t->kind == STF_TOKEN_UNIT; /* its place is behind the brace */
  const char *open = unit ? "{" : "", *close = unit ? "}" : "";
  return stf_complain(&p->syntax->sources, t->at - unit, STEIF_BAD_INPUT,
                      "expected %s, found '%s%s%s'%s%s", what, open,
                      stf_input_shown(piece, shown), close, join, habit);
}
