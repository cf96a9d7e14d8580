/* lexer.c: numbers, names, strings, units and marks of a UTF-8 text.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "lexer.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static int wrong(stf_lexer *l, uint32_t at, const char *what)
{
  return stf_complain(l->sources, l->base + at, STEIF_BAD_INPUT, "%s", what);
}

static int push(stf_lexer *l, int kind, int word, uint32_t at, double number)
{
  stf_token *t = stf_vector_push(l->sources->ctx, l->tokens, sizeof *t);
  if (!t) return STEIF_NO_MEMORY;
  *t = (stf_token){.kind = (uint8_t)kind,
                   .word = word,
                   .at = l->base + at,
                   .length = l->at - at,
                   .line = l->line,
                   .number = number};
  return STEIF_OK;
}

/* ---- characters
 * ------------------------------------------------------------------------------
 */

/* The code point at `at`; *bytes 0 where it is no UTF-8. */
static uint32_t character(const stf_lexer *l, uint32_t at, uint32_t *bytes)
{
  const unsigned char *c = (const unsigned char *)l->text + at;
  const uint32_t left = l->length - at;
  const uint32_t count = c[0] < 0x80   ? 1
                         : c[0] < 0xC2 ? 0
                         : c[0] < 0xE0 ? 2
                         : c[0] < 0xF0 ? 3
                         : c[0] < 0xF5 ? 4
                                       : 0;
  *bytes = 0;
  if (!count || count > left) return 0;
  uint32_t code = count == 1 ? c[0] : c[0] & (0xFFu >> (count + 1));
  for (uint32_t i = 1; i < count; i++) {
    if ((c[i] & 0xC0) != 0x80) return 0;
    code = code << 6 | (c[i] & 0x3Fu);
  }
  const bool overlong = (count == 3 && code < 0x800) || (count == 4 && code < 0x10000);
  if (overlong || (code >= 0xD800 && code < 0xE000) || code > 0x10FFFF) return 0;
  *bytes = count;
  return code;
}

/* Letters beyond ASCII: no space, punctuation, sign, control or format
 * character. */
static bool foreign(uint32_t c)
{
  static const uint32_t none[][2] = {
    {0x80, 0xA9},     {0xAB, 0xB1},     {0xB4, 0xB4},     {0xB6, 0xB8},
    {0xBB, 0xBF},     {0xD7, 0xD7},     {0xF7, 0xF7},     {0x61C, 0x61C},
    {0x1680, 0x1680}, {0x180E, 0x180E}, {0x2000, 0x206F}, {0x2190, 0x2BFF},
    {0x2E00, 0x2E7F}, {0x3000, 0x3020}, {0xD800, 0xF8FF}, {0xFE00, 0xFE6F},
    {0xFEFF, 0xFEFF}, {0xFF00, 0xFF20}, {0xFFE0, 0xFFFF}, {0xE0000, 0x10FFFF}};
  if (c < 0xA1) return false;
  for (size_t i = 0; i < sizeof none / sizeof *none; i++)
    if (c >= none[i][0] && c <= none[i][1]) return false;
  return true;
}

static bool letter(uint32_t c)
{
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || foreign(c);
}

static bool digit(uint32_t c) { return c >= '0' && c <= '9'; }

static uint32_t byte(const stf_lexer *l, uint32_t at)
{
  return at < l->length ? (unsigned char)l->text[at] : 0;
}

/* ---- tokens
 * ----------------------------------------------------------------------------------
 */

static int number(stf_lexer *l)
{
  const uint32_t from = l->at;
  char copy[64], shown[200];
  while (digit(byte(l, l->at))) l->at++;
  if (byte(l, l->at) == '.' && byte(l, l->at + 1) == '.')
    return wrong(l, from,
                 "'..' between numbers: a range is written 1:2, an interval 'time 0 to 10'");
  if (byte(l, l->at) == '.') l->at++;
  while (digit(byte(l, l->at))) l->at++;
  const uint32_t e = byte(l, l->at), sign = byte(l, l->at + 1);
  const bool marked = sign == '+' || sign == '-';
  if ((e == 'e' || e == 'E') && digit(byte(l, l->at + 1 + marked))) {
    l->at += 1 + marked;
    while (digit(byte(l, l->at))) l->at++;
  }
  uint32_t bytes, end = l->at;
  while (end < l->length && letter(character(l, end, &bytes))) end += bytes;
  if (end > l->at && byte(l, l->at) == '_')
    return wrong(l, from, "a number with '_'; write it without");
  if (end > l->at && l->at - from == 1 && byte(l, from) == '0' && strchr("xX", l->text[l->at]))
    return wrong(l, from, "a hexadecimal number; write it as a decimal one");
  if (end > l->at) {
    snprintf(shown, sizeof shown, "'%.*s': write %.*s*%.*s",
             (int)(end - from < 40 ? end - from : 40), l->text + from,
             (int)(l->at - from < 40 ? l->at - from : 40), l->text + from,
             (int)(end - l->at < 40 ? end - l->at : 40), l->text + l->at);
    return wrong(l, from, shown);
  }
  if (l->at - from >= sizeof copy)
    return wrong(l, from, "a number of more than 63 characters; shorten it");
  memcpy(copy, l->text + from, l->at - from);
  copy[l->at - from] = 0;
  const double value = strtod(copy, NULL);
  if (!isfinite(value)) return wrong(l, from, "a number beyond 1.8e308; rescale");
  return push(l, STF_TOKEN_NUMBER, 0, from, value);
}

static int name(stf_lexer *l)
{
  const uint32_t from = l->at;
  uint32_t bytes, c;
  while (l->at < l->length && (c = character(l, l->at, &bytes), letter(c) || digit(c)))
    l->at += bytes;
  if (l->at - from > STF_NAME_BYTES)
    return wrong(l, from, "a name of more than 100 bytes; shorten it");
  const int word = stf_word(l->words, l->text + from, l->at - from);
  return word < 0 ? STEIF_NO_MEMORY : push(l, STF_TOKEN_NAME, word, from, 0);
}

/* "..." or {...}: up to its end in the same line. */
static int enclosed(stf_lexer *l, int kind, char end)
{
  const uint32_t from = l->at;
  uint32_t at = from + 1;
  while (at < l->length && l->text[at] != end && l->text[at] != '\n') at++;
  if (byte(l, at) != (uint32_t)end)
    return wrong(l, from,
                 end == '"' ? "this string has no end; close it with '\"'"
                            : "this unit has no end; close it with '}'");
  l->at = at;
  STEIF_TRY(push(l, kind, 0, from + 1, 0));
  STF_AT(*l->tokens, stf_token, l->tokens->count - 1)->length = at - from - 1;
  l->at = at + 1;
  return STEIF_OK;
}

static int mark(stf_lexer *l, int word, uint32_t bytes)
{
  const uint32_t from = l->at;
  if (word == '(' || word == '[') l->open++;
  if ((word == ')' || word == ']') && l->open) l->open--;
  const bool doubled = byte(l, from + 1) == '=' && (word == '<' || word == '>' || word == '=');
  l->at += bytes + doubled;
  if (doubled) word = word == '<' ? 'l' : word == '>' ? 'g' : 'e';
  return push(l, STF_TOKEN_MARK, word, from, 0);
}

static bool goes_on(const stf_lexer *l)
{
  if (l->broken || l->single || !l->tokens->count) return false;
  if (l->open) return true;
  const stf_token *t = STF_AT(*l->tokens, stf_token, l->tokens->count - 1);
  return t->kind == STF_TOKEN_MARK && t->at >= l->base && strchr("+-*/^=,", t->word);
}

static int line_end(stf_lexer *l)
{
  const bool on = goes_on(l);
  if (!on) STEIF_TRY(push(l, STF_TOKEN_END, 0, l->at, 0));
  if (l->single) l->open = 0;
  l->at++;
  l->line++;
  return STEIF_OK;
}

/* A line of which nothing can be read is left out up to its end. */
static void leave(stf_lexer *l)
{
  while (l->at < l->length && l->text[l->at] != '\n') l->at++;
  l->open = 0;
  l->broken = true;
}

static int beyond_ascii(stf_lexer *l)
{
  uint32_t bytes;
  const uint32_t c = character(l, l->at, &bytes);
  if (!bytes) return wrong(l, l->at, "bytes that are not UTF-8; save the file as UTF-8");
  if (c == 0xA0) {
    l->at += bytes;
    return STEIF_OK;
  }
  if (c == 0x2019 || c == 0x2032) return mark(l, '\'', bytes);
  if (c == 0x2212) return mark(l, '-', bytes);
  if (c == 0xD7 || c == 0xB7) return mark(l, '*', bytes);
  if (foreign(c)) return name(l);
  return wrong(l, l->at, "a character that has no meaning here; remove it");
}

/* What two characters mean in other languages, and never here; NULL: nothing. */
static const char *pair(uint32_t c, uint32_t next)
{
  if (c == '*' && next == '*') return "'**': a power is written ^";
  if (c == '/' && next == '/') return "'//': a comment begins with #";
  if ((next == '=' && (c == '!' || c == '~')) || (c == '<' && next == '>'))
    return "there is no 'unequal' of computed numbers; use < or >, or abs(a - b) > 1e-9";
  if (c == ':' && next == '=') return "':=': an equation and an assignment have one '='";
  if (next == '=' && (c == '+' || c == '-' || c == '*' || c == '/'))
    return "an operator before '=': x += 1 is written x = x + 1";
  if (c == '.' && (next == '^' || next == '*' || next == '/'))
    return "'.' before an operator: write ^, *, / alone; elements stand in loops";
  if (c == '.' && letter(next)) return "'.' in a name: functions are written sin(x), exp(x)";
  if (c == '/' && next == '*') return "'/*': a comment begins with # and ends with the line";
  return NULL;
}

/* Does anything follow this character in its line? */
static bool more(const stf_lexer *l)
{
  uint32_t at = l->at + 1;
  while (byte(l, at) == ' ' || byte(l, at) == '\t' || byte(l, at) == '\r') at++;
  return at < l->length && byte(l, at) != '\n' && byte(l, at) != '#';
}

/* A character of other languages, and what stands for it here. */
static int meaningless(stf_lexer *l, int c)
{
  switch (c) {
  case ';':
    return wrong(l, l->at,
                 more(l) ? "';' between statements: each has a line of its own"
                         : "';' has no meaning: a statement ends with its line; remove it");
  case '?': return wrong(l, l->at, "'?': a choice is written 'if a then b else c'");
  case '\\':
    return wrong(l, l->at,
                 "'\\': a line goes on after an operator or ',' and in brackets; remove it");
  case '.':
    if (byte(l, l->at + 1) == '.' && byte(l, l->at + 2) == '.')
      return wrong(l, l->at,
                   "'...': a line goes on after an operator or ',' and in brackets; remove it");
    return wrong(l, l->at,
                 "a '.' without digits: an interval is written 'time 0 to 30', a range 1:2");
  case '%': return wrong(l, l->at, "'%': a comment begins with #, a remainder is mod(a, b)");
  case '!': return wrong(l, l->at, "'!': write 'not' in a condition; a comment begins with #");
  case '&': return wrong(l, l->at, "'&': write 'and'");
  case '|': return wrong(l, l->at, "'|': write 'or', and abs(x) for a modulus");
  default: return wrong(l, l->at, "a character that has no meaning here; remove it");
  }
}

static int token(stf_lexer *l)
{
  const uint32_t c = byte(l, l->at);
  if (c == ' ' || c == '\t' || c == '\r') {
    l->at++;
    return STEIF_OK;
  }
  if (c == '#') {
    while (l->at < l->length && l->text[l->at] != '\n') l->at++;
    return STEIF_OK;
  }
  if (c == '\n') return line_end(l);
  if (digit(c) || (c == '.' && digit(byte(l, l->at + 1)))) return number(l);
  if (c >= 0x80) return beyond_ascii(l);
  if (letter(c)) return name(l);
  if (c == '"') return enclosed(l, STF_TOKEN_STRING, '"');
  if (c == '{') return enclosed(l, STF_TOKEN_UNIT, '}');
  if (!c) return wrong(l, l->at, "byte 0 in the text; a model is a UTF-8 text file");
  const char *foreign_pair = pair(c, byte(l, l->at + 1));
  if (foreign_pair) return wrong(l, l->at, foreign_pair);
  if (strchr("+-*/^()[],:=<>'~", (int)c)) return mark(l, (int)c, 1);
  return meaningless(l, (int)c);
}

int stf_lex_open(stf_lexer *l, stf_sources *sources, size_t which, stf_words *words,
                 stf_vector *tokens)
{
  const stf_text *t = STF_AT(sources->texts, stf_text, which);
  *l = (stf_lexer){.sources = sources,
                   .words = words,
                   .tokens = tokens,
                   .text = t->text,
                   .base = t->base,
                   .length = t->length,
                   .line = 1};
  const unsigned char *head = (const unsigned char *)t->text;
  const bool wide =
    t->length > 1 && ((head[0] == 0xFF && head[1] == 0xFE) ||
                      (head[0] == 0xFE && head[1] == 0xFF) || !head[0] || !head[1]);
  if (wide)
    return wrong(l, 0,
                 "byte 0 in the text; a model is a UTF-8 text file (this "
                 "begins like UTF-16 or "
                 "binary: save it as UTF-8)");
  if (t->length > 2 && !memcmp(t->text, "\xEF\xBB\xBF", 3)) l->at = 3;
  return STEIF_OK;
}

/* The END of a text; the place of what is missing in front of it is behind the last token. */
static int finish(stf_lexer *l)
{
  l->ended = true;
  if (goes_on(l) && l->tokens->count) {
    const stf_token *last = STF_AT(*l->tokens, stf_token, l->tokens->count - 1);
    if (last->at >= l->base) l->at = last->at - l->base + last->length;
  }
  return push(l, STF_TOKEN_END, 0, l->at, 0);
}

int stf_lex_line(stf_lexer *l)
{
  const size_t before = l->tokens->count;
  l->broken = false;
  while (l->at < l->length && l->sources->errors < STF_ERRORS) {
    const bool new_line = l->text[l->at] == '\n';
    const int code = token(l);
    if (code == STEIF_NO_MEMORY) return code;
    if (code) leave(l);
    if (code && !byte(l, l->at)) break;
    if (new_line && l->tokens->count > before &&
        STF_AT(*l->tokens, stf_token, l->tokens->count - 1)->kind == STF_TOKEN_END)
      return STEIF_OK;
  }
  return finish(l);
}
