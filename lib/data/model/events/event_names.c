/* event_names.c: events in the words of the text: "x < -1 (line 7)".
 * SPDX-License-Identifier: BSD-3-Clause */
#include "reactions.h"
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Passes of loops beyond which events of one relation share a name; bytes of the text that a name shows. */
enum { NAMED_PASSES = 10000, SHOWN = 40, PLACE = 100, ROOM = 200 };

/* A part of the text. */
typedef struct piece {
  const char *from;
  size_t length;
} piece;

static bool in_name(char c)
{
  return isalnum((unsigned char)c) || c == '_' || (unsigned char)c >= 0x80;
}

/* Does one of the words that stand beside conditions begin (or end) at p? */
static bool at_word(const char *p, const char *begin, bool ends)
{
  static const char *const word[] = {"if",  "then", "else",   "elseif",  "and",      "or",
                                     "not", "when", "rising", "falling", "crossing", "require"};
  for (size_t i = 0; i < sizeof word / sizeof *word; i++) {
    const size_t n = strlen(word[i]);
    if (ends && (size_t)(p - begin) + 1 < n) continue;
    const char *from = ends ? p + 1 - n : p;
    if (strncmp(from, word[i], n) || in_name(from[n])) continue;
    if (from == begin || !in_name(from[-1])) return true;
  }
  return false;
}

/* The end of an operand that begins at p: where a bracket closes that it has not opened, or a mark or word follows
 * that is no part of it. */
static const char *end_of(const char *p, const char *begin, const char *marks)
{
  int depth = 0;
  for (; *p; p++) {
    if (strchr(")]", *p) && depth-- == 0) break;
    if (strchr("([", *p)) depth++;
    if (depth <= 0 && (strchr(marks, *p) || at_word(p, begin, false))) break;
  }
  return p;
}

/* The beginning of an operand that ends before p. */
static const char *begin_of(const char *p, const char *begin)
{
  int depth = 0;
  while (p > begin) {
    const char c = p[-1];
    if (strchr("([", c) && depth-- == 0) break;
    if (strchr(")]", c)) depth++;
    if (depth <= 0 && (strchr(",=:;\n", c) || at_word(p - 1, begin, true))) break;
    p--;
  }
  return p;
}

static piece trimmed(const char *from, const char *to)
{
  while (from < to && isspace((unsigned char)*from)) from++;
  while (from < to && isspace((unsigned char)to[-1])) to--;
  return (piece){from, (size_t)(to - from)};
}

/* The relation or function at p, or all from there up to one of the marks `until`. */
static piece piece_at(const char *p, const char *begin, const char *until)
{
  static const char marks[] = ",:;#{<>=\n";
  if (until) return trimmed(p, end_of(p, begin, until));
  if (*p == '<' || *p == '>') {
    const char *right = p + 1 + (p[1] == '=');
    return trimmed(begin_of(p, begin), end_of(right, begin, marks));
  }
  const char *after = p;
  while (in_name(*after)) after++;
  if (*after != '(') return trimmed(p, end_of(p, begin, marks));
  for (int depth = 0; *after; after++) {
    depth += (*after == '(') - (*after == ')');
    if (!depth) return (piece){p, (size_t)(after + 1 - p)};
  }
  return (piece){p, 0};
}

/* What is printable of a piece, blanks as one, at most SHOWN bytes of it. */
static void show(piece part, size_t room, char *to)
{
  size_t used = 0;
  bool blank = false;
  for (size_t i = 0; i < part.length && used < SHOWN; i++) {
    const unsigned char c = (unsigned char)part.from[i];
    if (!isspace(c) && blank) to[used++] = ' ';
    blank = isspace(c);
    if (!blank) to[used++] = c < 0x20 || c == 0x7f ? '?' : (char)c;
  }
  const bool cut = used >= SHOWN;
  while (cut && used && ((unsigned char)to[used - 1] & 0xc0) == 0x80) used--;
  if (cut && used && (unsigned char)to[used - 1] >= 0xc0) used--;
  snprintf(to + used, room - used, "%s", cut ? "..." : "");
}

/* ---- where in the text ---- */

static int by_place(const void *a, const void *b)
{
  const uint32_t x = ((const stf_placed *)a)->at, y = ((const stf_placed *)b)->at;
  return (x > y) - (x < y);
}

int stf_order_statements(stf_model *m)
{
  const size_t count = m->syntax.statements.count;
  stf_placed *all = stf_pool_array(m->pool, count + 1, sizeof *all);
  if (!all) return STEIF_NO_MEMORY;
  for (size_t i = 0; i < count; i++)
    all[i] = (stf_placed){stf_statement_at(m, (int32_t)i)->at, (int32_t)i};
  qsort(all, count, sizeof *all, by_place);
  m->reactions->placed = all;
  return STEIF_OK;
}

/* The statement in which a place lies: the last that begins there or before. */
static int32_t statement_at(const stf_model *m, uint32_t at)
{
  const stf_placed *all = m->reactions->placed;
  size_t low = 0, high = m->syntax.statements.count;
  while (high - low > 1) {
    const size_t middle = low + (high - low) / 2;
    if (all[middle].at <= at)
      low = middle;
    else
      high = middle;
  }
  return all[low].statement;
}

/* Its line, counted from where its statement begins. */
static int line_at(const stf_model *m, uint32_t at)
{
  const stf_statement *s = stf_statement_at(m, statement_at(m, at));
  const char *text = stf_source_at(&m->syntax.sources, s->at);
  int line = (int)s->line;
  for (uint32_t i = 0; i < at - s->at; i++) line += text[i] == '\n';
  return line;
}

/* "x < -1 (line 7": what stands at a place of the model's own file; of included ones the line alone. */
static void place_name(const stf_model *m, uint32_t at, const char *until, char *to)
{
  char text[SHOWN + 8] = "";
  const stf_text *source = stf_text_of(&m->syntax.sources, at);
  if (source == m->syntax.sources.texts.data)
    show(piece_at(stf_source_at(&m->syntax.sources, at), source->text, until), sizeof text,
         text);
  snprintf(to, PLACE, "%.60s (line %d", *text ? text : source->name, line_at(m, at));
}

/* What `stop` says of the reaction to a condition; NULL: nothing, or there is no stop. */
static const stf_statement *stop_of(const stf_model *m, uint32_t at)
{
  const int32_t when = statement_at(m, at);
  if (stf_statement_at(m, when)->kind != STF_SAY_WHEN) return NULL;
  for (size_t i = (size_t)when + 1; i < m->syntax.statements.count; i++) {
    const stf_statement *s = stf_statement_at(m, (int32_t)i);
    if (s->parent != when) break;
    if (s->kind == STF_SAY_STOP && s->strlength) return s;
  }
  return NULL;
}

/* ---- names ---- */

static char *kept(stf_model *m, const char *text, size_t length)
{
  char *to = stf_pool_array(m->pool, length + 1, 1);
  if (to) memcpy(to, text, length);
  return to;
}

/* ", i = 3, k = 4" of a pass. */
static void add_pass(const stf_model *m, const stf_box *box, int64_t pass, const stf_switch *s,
                     char *to)
{
  size_t used = strlen(to);
  for (int i = 0; i < s->indices && used < ROOM; i++) {
    const stf_affine *at = &s->index[i].at;
    int32_t by[STF_LOOPS];
    for (int d = 0; d < STF_LOOPS; d++) by[d] = (int32_t)at->s[d];
    used +=
      (size_t)snprintf(to + used, ROOM - used, ", %.20s = %d", stf_named(m, s->index[i].word),
                       (int)stf_at_pass(box, pass, (int32_t)at->c, by));
  }
}

/* Is the function at p one that turns where its argument, or the difference of two, is 0? */
static bool has_kink(const char *p)
{
  static const char *const word[] = {"abs", "max", "min", "ramp", "sign", "step"};
  for (size_t i = 0; i < sizeof word / sizeof *word; i++) {
    const size_t n = strlen(word[i]);
    if (!strncmp(p, word[i], n) && !in_name(p[n])) return true;
  }
  return false;
}

static uint8_t sort_of(const stf_model *m, const stf_switch *s)
{
  const char *p = stf_source_at(&m->syntax.sources, s->at);
  if (s->bare || has_kink(p)) return s->negated ? STF_TURN_BACK : STF_TURN;
  if (*p != '<' && *p != '>') return STF_OTHER_PART;
  return s->negated ? STF_TRUE_RISING : STF_TRUE_FALLING;
}

int stf_name_relation(stf_model *m, const stf_block *block, const stf_switch *s)
{
  char text[ROOM];
  const stf_statement *stop = stop_of(m, s->at);
  const int64_t count = stf_passes(&block->box);
  const bool each = !stop && s->indices && count <= NAMED_PASSES;
  const char *name = NULL;
  for (int64_t k = 0; k < count; k++) {
    const int64_t which = stf_at_pass(&block->box, k, s->a, s->stride) - m->discretes;
    if (!name || each) {
      place_name(m, s->at, s->bare ? ":\n" : NULL, text);
      if (each) add_pass(m, &block->box, k, s, text);
      snprintf(text + strlen(text), sizeof text - strlen(text), ")");
      name = stop ? kept(m, stf_source_at(&m->syntax.sources, stop->string), stop->strlength)
                  : kept(m, text, strlen(text));
    }
    if (!name) return STEIF_NO_MEMORY;
    m->event_list[which].name = name;
    m->event_sort[which] = sort_of(m, s);
  }
  return STEIF_OK;
}

int stf_name_timer(stf_model *m, const stf_statement *s, int32_t which)
{
  char text[ROOM];
  size_t used =
    (size_t)snprintf(text, sizeof text, "%s", s->kind == STF_SAY_AT ? "at " : "every ");
  place_name(m, s->at, ":#\n", text + used);
  used = strlen(text);
  snprintf(text + used, sizeof text - used, ")");
  m->event_list[which].name = kept(m, text, strlen(text));
  m->event_sort[which] = STF_INSTANT;
  return m->event_list[which].name ? STEIF_OK : STEIF_NO_MEMORY;
}

const char *stf_event_turn(const stf_model *m, int32_t which, int direction)
{
  switch (m->event_sort[which]) {
  case STF_TRUE_FALLING: return direction < 0 ? "true" : "false";
  case STF_TRUE_RISING: return direction > 0 ? "true" : "false";
  case STF_TURN: return direction > 0 ? "rising" : "falling";
  case STF_TURN_BACK: return direction < 0 ? "rising" : "falling";
  case STF_INSTANT: return "time";
  default: return "changes";
  }
}
