/* sweep_lines.c: headings, and rows of a sweep as lines of comma-separated values, there and back.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "sweep.h"
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

static const char *const stats[] = {"steps", "rejected", "nfe", "nje", "nlu", "nsolve"};
enum { STATS = sizeof stats / sizeof *stats };

size_t sweep_columns(const struct sweep *s)
{
  return s->collect == COLLECT_Y ? s->n : s->collect == COLLECT_DIGITS ? 2 : STATS;
}

/* Headings that every sheet has, beside those of its columns. */
static bool is_fixed(const char *name)
{
  static const char *const fixed[] = {"member", "status", "t", "message"};
  for (size_t i = 0; i < sizeof fixed / sizeof *fixed; i++)
    if (!strcmp(fixed[i], name)) return true;
  return false;
}

const char *sweep_column(const struct sweep *s, size_t j, char room[COLUMN])
{
  static const char *const digits[] = {"scd", "mescd"};
  const steif_names *names = s->first.names;
  if (s->collect == COLLECT_DIGITS) return digits[j];
  if (s->collect == COLLECT_STATS) return stats[j];
  const char *name = names && names->unknown ? names->unknown[j] : NULL;
  if (name && !is_fixed(name)) return name;
  if (name)
    snprintf(room, COLUMN, "y:%s", name);
  else
    snprintf(room, COLUMN, "y%zu", j + 1);
  return room;
}

const char *sweep_parameter(const struct sweep *s, int k, char room[COLUMN])
{
  const char *name = s->axes.name[k];
  char other[COLUMN];
  bool taken = is_fixed(name);
  for (size_t j = 0; j < sweep_columns(s) && !taken; j++)
    taken = !strcmp(sweep_column(s, j, other), name);
  if (!taken) return name;
  snprintf(room, COLUMN, "p:%s", name);
  return room;
}

/* Row number `row` of a member: its code; t, y or whatever is collected. */
int sweep_code(const struct member_record *r, size_t row)
{
  return row + 1 < r->rows ? STEIF_OK : r->code;
}

const double *sweep_numbers(const struct sweep *s, const struct member_record *r, size_t row)
{
  return r->row + row * (s->n + 1);
}

const char *sweep_message(const struct member_record *r, size_t row)
{
  return row + 1 < r->rows ? "" : r->message;
}

double sweep_cell(const struct sweep *s, const struct member_record *r, size_t row, size_t j)
{
  const long count[STATS] = {r->stats.steps, r->stats.rejected, r->stats.nfe,
                             r->stats.nje,   r->stats.nlu,      r->stats.nsolve};
  if (s->collect == COLLECT_STATS) return (double)count[j];
  if (s->collect == COLLECT_DIGITS) return j ? r->mescd : r->scd;
  return sweep_numbers(s, r, row)[1 + j];
}

/* ---- as comma-separated values --------------------------------------------------------------- */

struct text {
  char *at;
  size_t room, used;
};

static void add(struct text *t, const char *format, ...) STEIF_PRINTF(2, 3);
static void add(struct text *t, const char *format, ...)
{
  va_list arguments;
  const size_t left = t->used < t->room ? t->room - t->used : 0;
  va_start(arguments, format);
  t->used += (size_t)vsnprintf(left ? t->at + t->used : NULL, left, format, arguments);
  va_end(arguments);
}

static void add_number(struct text *t, double x)
{
  if (isfinite(x))
    add(t, ",%.17g", x);
  else
    add(t, ",%s", isnan(x) ? "nan" : x > 0 ? "inf" : "-inf");
}

static void add_quoted(struct text *t, const char *words)
{
  if (!strpbrk(words, ",\"")) {
    add(t, ",%s", words);
    return;
  }
  add(t, ",\"");
  for (; *words; words++) add(t, *words == '"' ? "\"\"" : "%c", *words);
  add(t, "\"");
}

size_t sweep_header(const struct sweep *s, char *text, size_t room)
{
  struct text t = {text, room, 0};
  char name[COLUMN];
  add(&t, "member");
  for (int k = 0; k < s->axes.count; k++) add_quoted(&t, sweep_parameter(s, k, name));
  add(&t, ",status,t");
  for (size_t j = 0; j < sweep_columns(s); j++) add_quoted(&t, sweep_column(s, j, name));
  add(&t, ",message");
  return t.used;
}

size_t sweep_begin(const struct sweep *s, long long i, char *text, size_t room)
{
  struct text t = {text, room, 0};
  double value[AXES];
  axes_at(&s->axes, i, value);
  add(&t, "%lld", i);
  for (int k = 0; k < s->axes.count; k++) add_number(&t, value[k]);
  add(&t, ",");
  return t.used;
}

size_t sweep_line(const struct sweep *s, long long i, const struct member_record *r, size_t row)
{
  struct text t = {s->line, s->room, sweep_begin(s, i, s->line, s->room)};
  add(&t, "%s", steif_code_name(sweep_code(r, row)));
  add_number(&t, *sweep_numbers(s, r, row));
  for (size_t j = 0; j < sweep_columns(s); j++) add_number(&t, sweep_cell(s, r, row, j));
  add_quoted(&t, sweep_message(r, row));
  return t.used;
}

/* ---- and back --------------------------------------------------------------------------------- */

static bool read_code(const char **at, int *code)
{
  const size_t length = strcspn(*at, ",");
  for (*code = STEIF_EVENT; *code >= STEIF_INFEASIBLE; --*code) {
    const char *name = steif_code_name(*code);
    if (strlen(name) != length || strncmp(*at, name, length)) continue;
    *at += length;
    return true;
  }
  return false;
}

static bool read_number(const char **at, double *x)
{
  char *end;
  if (**at != ',') return false;
  *x = strtod(*at + 1, &end);
  const bool good = end != *at + 1;
  *at = end;
  return good;
}

static bool put_cell(const struct sweep *s, struct member_record *r, size_t row, size_t j,
                     double x)
{
  long *const count[STATS] = {&r->stats.steps, &r->stats.rejected, &r->stats.nfe,
                              &r->stats.nje,   &r->stats.nlu,      &r->stats.nsolve};
  if (s->collect == COLLECT_Y) {
    r->row[row * (s->n + 1) + 1 + j] = x;
  } else if (s->collect == COLLECT_DIGITS) {
    *(j ? &r->mescd : &r->scd) = x;
  } else {
    if (!(x >= 0 && x < 1e15)) return false;
    *count[j] = (long)x;
  }
  return true;
}

static bool read_message(const char *at, char *message, size_t room)
{
  size_t used = 0;
  if (*at++ != ',') return false;
  const bool quoted = *at == '"';
  for (at += quoted; *at && used + 1 < room; at++) {
    if (quoted && *at == '"' && *++at != '"') break;
    message[used++] = *at;
  }
  message[used] = 0;
  return true;
}

/* What was written in another way than here is no such line, whatever could be read of it. */
bool sweep_read(const struct sweep *s, long long i, const char *line, struct member_record *r)
{
  const size_t row = r->rows, begin = sweep_begin(s, i, s->line, s->room);
  const char *at = line + begin;
  if (begin >= s->room || strncmp(line, s->line, begin)) return false;
  if (row == s->points + s->on_the_way || (row && r->code)) return false;
  bool good = read_code(&at, &r->code) && read_number(&at, &r->row[row * (s->n + 1)]);
  for (size_t j = 0; good && j < sweep_columns(s); j++) {
    double x = 0;
    good = read_number(&at, &x) && put_cell(s, r, row, j, x);
  }
  if (!good || !read_message(at, r->message, sizeof r->message)) return false;
  r->rows++;
  if ((r->code < 0) != (r->message[0] != 0)) return false;
  if (r->code >= 0 && !isfinite(*sweep_numbers(s, r, row))) return false;
  return sweep_line(s, i, r, row) < s->room && !strcmp(line, s->line);
}
