/* habits.c: what other languages write where a line cannot be read, and what stands for it here.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "syntax.h"
#include <string.h>

/* The line that is being read: its first token, the next one, and the one before that (NULL: none). */
typedef struct place {
  const stf_parser *p;
  const stf_token *first, *before, *t;
  const char *what; /* is expected */
} place;

static place here(const stf_parser *p, const char *what)
{
  const stf_token *all = p->syntax->tokens.data;
  size_t at = p->at;
  while (at > 0 && all[at - 1].kind != STF_TOKEN_END) at--;
  return (place){p, all + at, at < p->at ? all + p->at - 1 : NULL, all + p->at, what};
}

static bool mark(const stf_token *t, int mark)
{
  return t && t->kind == STF_TOKEN_MARK && t->word == mark;
}

static bool word(const stf_token *t, int word)
{
  return t && t->kind == STF_TOKEN_NAME && t->word == word;
}

static bool called(const place *l, const stf_token *t, const char *name)
{
  return t && t->kind == STF_TOKEN_NAME &&
         !strcmp(stf_word_text(&l->p->syntax->words, t->word), name);
}

static bool a_name(const stf_token *t)
{
  return t && t->kind == STF_TOKEN_NAME && t->word >= STF_WORDS_RESERVED;
}

/* An equation, or what declares values. */
static bool of_values(const place *l)
{
  static const int words[] = {
    STF_WORD_T,      STF_WORD_PI,        STF_WORD_SUM,     STF_WORD_IF,       STF_WORD_PARAM,
    STF_WORD_CONST,  STF_WORD_STATE,     STF_WORD_LET,     STF_WORD_DISCRETE, STF_WORD_FUNCTION,
    STF_WORD_OUTPUT, STF_WORD_INVARIANT, STF_WORD_BOUNDARY};
  if (l->first->kind != STF_TOKEN_NAME || l->first->word >= STF_WORDS_RESERVED) return true;
  for (size_t i = 0; i < sizeof words / sizeof *words; i++)
    if (l->first->word == words[i]) return true;
  return false;
}

static const char *of_interval(const place *l)
{
  const bool named = called(l, l->first, "tspan") || called(l, l->first, "from") ||
                     word(l->first, STF_WORD_T) || word(l->first, STF_WORD_TIME);
  const bool list = mark(l->t, '[') && !(l->before && l->before->kind == STF_TOKEN_NUMBER);
  const bool there = list || (mark(l->t, ':') && !strstr(l->what, "'to'")) ||
                     l->t->kind == STF_TOKEN_NUMBER || word(l->t, STF_WORD_IN);
  return named && there ? "an interval is written 'time 0 to 10'" : NULL;
}

static const char *of_bracket(const place *l)
{
  if (!mark(l->t, '[')) return NULL;
  if (!strcmp(l->what, "an expression"))
    return "there are no lists: an array is a state, 'state u[i in 1:3] = ...'";
  return strstr(l->what, "operator") ? "a unit is a label in braces, {1/s}" : NULL;
}

static const char *of_braces(const place *l)
{
  if (l->t->kind != STF_TOKEN_UNIT) return NULL;
  const char *text = stf_source_at(&l->p->syntax->sources, l->t->at);
  if (memchr(text, '=', l->t->length))
    return "braces are for units; the lines of a loop or an event stand up to 'end'";
  if (!strcmp(l->what, "an expression"))
    return "braces are for units, and there are no lists: an array is a state, 'state u[i in "
           "1:3] = ...'";
  return "a unit is the label of a value that is declared, and no part of an equation";
}

static const char *of_parenthesis(const place *l)
{
  const stf_token *t = l->t;
  if (mark(t, '\'') && mark(l->before, ')'))
    return "elements are written u[i], their derivatives u[i]'";
  if (!mark(t, '(')) return NULL;
  if (called(l, l->before, "reinit")) return "'reinit(x, 0)' is written x = 0";
  if (mark(l->before, '\''))
    return "unknowns are written without (t); a slope at the start is 'state x' = 1'";
  if (!word(l->first, STF_WORD_STATE) || !a_name(l->before)) return NULL;
  return t[1].kind == STF_TOKEN_NUMBER && mark(t + 2, ')')
           ? "a start is written 'state x = 3'"
           : "an array is written u[1:n], its elements u[i]";
}

/* Where an operator could stand. */
static const char *of_product(const place *l)
{
  const stf_token *t = l->t;
  int operands;
  const bool declares = l->first->kind == STF_TOKEN_NAME && l->first->word >= STF_WORD_PARAM &&
                        l->first->word <= STF_WORD_LET;
  if (!l->before || !strstr(l->what, "operator")) return NULL;
  if (word(t, STF_WORD_IF)) return "a choice is written 'if a then b else c'";
  if (word(l->first, STF_WORD_TIME)) return "a unit is a label in braces, {s}";
  if (!of_values(l)) return NULL;
  if (declares && a_name(t) && (mark(t + 1, '=') || mark(t + 1, '~') || mark(t + 1, '\'')))
    return "write ',' between declarations, or lines of their own";
  if (called(l, l->first, "d") && mark(l->first + 1, '/') && a_name(t))
    return "the derivative of x is written x'";
  if (called(l, t, "mod")) return "a remainder is mod(a, b)";
  if (a_name(l->before) && a_name(t) &&
      stf_function_of(stf_word_text(&l->p->syntax->words, l->before->word), &operands) >= 0)
    return "an argument stands in parentheses, sin(x)";
  const bool factor = l->before->kind == STF_TOKEN_NUMBER || a_name(l->before) ||
                      mark(l->before, ')') || mark(l->before, ']');
  if (!factor) return NULL;
  if (declares && l->before->kind == STF_TOKEN_NUMBER && !l->p->syntax->sources.alone)
    return "a product needs *; a unit is a label in braces, {m}";
  return a_name(t) || mark(t, '(') ? "a product needs *" : NULL;
}

static bool called_if(const place *l)
{
  for (const stf_token *t = l->first; t < l->t; t++)
    if (word(t, STF_WORD_IF) && mark(t + 1, '(')) return true;
  return false;
}

static const char *of_choice(const place *l)
{
  const bool choice = strstr(l->what, "'then'") || strstr(l->what, "'else'");
  if (strstr(l->what, "a condition") && word(l->t, STF_WORD_THEN))
    return "a switch is a number: 'if s > 0.5 then'";
  if (mark(l->t, ',') && strstr(l->what, "')'") && called_if(l))
    return "a choice is written 'if a then b else c'";
  if (choice && word(l->first, STF_WORD_IF) && !l->p->syntax->sources.alone)
    return "what changes at a moment is written 'when x > 1: x = 0'; a choice between values "
           "x' = if a then b else c";
  return choice && l->t->kind == STF_TOKEN_END ? "each 'if' has its 'else'" : NULL;
}

static const char *of_lines(const place *l)
{
  if (word(l->first, STF_WORD_FOR) &&
      (mark(l->t, ':') || called(l, l->t, "loop") || called(l, l->t, "do")))
    return "'for i in 1:n' ends with its line, and the loop with 'end'";
  if (word(l->before, STF_WORD_END)) return "'end' stands alone";
  if (called(l, l->before, "terminate")) return "'terminate' is written stop";
  if (mark(l->first, '-') && mark(l->first + 1, '-')) return "a comment begins with #";
  if (mark(l->first, '+') || mark(l->first, '-') || mark(l->first, '*') || mark(l->first, '/'))
    return "a line goes on in the next one if an operator is its last sign, not the first of "
           "the next";
  return NULL;
}

const char *stf_habit(const stf_parser *p, const char *what)
{
  static const char *(*const habits[])(const place *) = {
    of_interval, of_braces, of_bracket, of_parenthesis, of_product, of_choice, of_lines};
  const place l = here(p, what);
  const char *told = NULL;
  const bool alone = p->syntax->sources.alone; /* no statements */
  for (size_t i = alone ? 4 : 0; !told && i < (alone ? 6 : sizeof habits / sizeof *habits); i++)
    told = habits[i](&l);
  return told;
}

int stf_equality(const stf_parser *p)
{
  const place l = here(p, "");
  const char *sign = mark(l.t, 'e') ? "==" : "=";
  bool compares = p->syntax->sources.alone;
  for (const stf_token *t = l.first; t < l.t; t++)
    compares |= word(t, STF_WORD_IF) || word(t, STF_WORD_ELSEIF) || word(t, STF_WORD_REQUIRE) ||
                mark(t, '=');
  if (word(l.first, STF_WORD_WHEN) && !compares)
    return stf_complain(&p->syntax->sources, l.t->at, STEIF_BAD_INPUT,
                        "'%s' in a 'when': write 'when x - 2 crossing: ...', or of the time "
                        "'at 2: ...'",
                        sign);
  if (!compares)
    return stf_complain(&p->syntax->sources, l.t->at, STEIF_BAD_INPUT,
                        "'==': an equation has one '='");
  return stf_complain(&p->syntax->sources, l.t->at, STEIF_BAD_INPUT,
                      "'%s' between computed numbers; use < or >, or abs(a - b) < 1e-9", sign);
}
