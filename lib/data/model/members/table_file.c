/* table_file.c: tables of functions, from pairs or from a column of a CSV file
 * beside the model. Sentences about a file show line numbers only, nothing of
 * what it contains. SPDX-License-Identifier: BSD-3-Clause */
#include "model.h"
#include "text.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { ROWS = 10000000, COLUMNS = 1000 };

typedef struct columns {
  stf_vector x, y;
} columns;

static int complain(stf_model *m, const stf_statement *s, const char *what, const char *name,
                    long line)
{
  return line
           ? stf_complain(&m->syntax.sources, s->at, STEIF_BAD_INPUT, "%.60s, line %ld: %s",
                          name, line, what)
           : stf_complain(&m->syntax.sources, s->at, STEIF_BAD_INPUT, "'%.60s' %s", name, what);
}

static int point(stf_model *m, columns *c, double x, double y)
{
  double *to = stf_vector_push(m->ctx, &c->x, sizeof *to);
  if (!to) return STEIF_NO_MEMORY;
  *to = x;
  to = stf_vector_push(m->ctx, &c->y, sizeof *to);
  if (!to) return STEIF_NO_MEMORY;
  *to = y;
  return STEIF_OK;
}

/* ---- files
 * -----------------------------------------------------------------------------------
 */

/* Cell k of a line, without blanks and quotes. */
static const char *cell(const char *line, long k, size_t *length)
{
  for (; k > 0 && line; k--) {
    line = strchr(line, ',');
    if (line) line++;
  }
  if (!line) return NULL;
  line += strspn(line, " \t\"");
  *length = strcspn(line, ",\r\n");
  while (*length && strchr(" \t\"", line[*length - 1])) --*length;
  return line;
}

/* The name of column k, without a unit in braces behind it, which may be empty. */
static const char *column_name(const char *line, long k, size_t *length, const char **unit,
                               size_t *unit_length)
{
  const char *at = cell(line, k, length), *brace = at ? memchr(at, '{', *length) : NULL;
  *unit_length = 0;
  if (!brace || at[*length - 1] != '}') return at;
  *unit = brace + 1;
  *unit_length = *length - (size_t)(brace - at) - 2;
  *length = (size_t)(brace - at);
  while (*length && strchr(" \t", at[*length - 1])) --*length;
  return at;
}

static bool is(const char *line, long k, const char *name, size_t length)
{
  size_t found, whole, unit_length;
  const char *unit, *at = cell(line, k, &whole);
  if (at && whole == length && !strncmp(at, name, length)) return true;
  at = column_name(line, k, &found, &unit, &unit_length);
  return at && found == length && !strncmp(at, name, length);
}

/* The column of times in another unit than `time`, where both have one. */
static int check_unit(stf_model *m, const stf_statement *table, const char *line, long x,
                      const char *file)
{
  size_t length, unit_length;
  const char *unit;
  char shown[STF_SHOWN], text[STF_SHOWN];
  const char *at = column_name(line, x, &length, &unit, &unit_length);
  if (!at || length != 1 || *at != 't' || !unit_length) return STEIF_OK;
  for (size_t i = 0; i < m->syntax.statements.count; i++) {
    const stf_statement *s = stf_statement_at(m, (int32_t)i);
    if (s->kind != STF_SAY_TIME || !s->strlength) continue;
    const char *own = stf_source_at(&m->syntax.sources, s->string);
    if (s->strlength == unit_length && !strncmp(own, unit, unit_length)) return STEIF_OK;
    snprintf(text, sizeof text, "%.*s", (int)unit_length, unit);
    stf_input_shown(text, shown);
    return stf_complain(&m->syntax.sources, table->at, STEIF_BAD_INPUT,
                        "time is in {%.*s} (line %d), the column 't {%s}' of %.60s in {%s}; "
                        "convert one",
                        (int)s->strlength, own, (int)s->line, shown, file, shown);
  }
  return STEIF_OK;
}

/* The columns of x and y by the header. */
static int header(stf_model *m, const stf_statement *table, const stf_statement *column,
                  const char *line, const char *file, long *x, long *y)
{
  const char *name = stf_source_at(&m->syntax.sources, column->string);
  double number = 0;
  *x = 0;
  *y = -1;
  for (long k = 0; k < COLUMNS; k++) {
    if (is(line, k, "t", 1)) *x = k;
    if (column->strlength && *y < 0 && is(line, k, name, column->strlength)) *y = k;
  }
  if (!column->strlength) {
    STEIF_TRY(stf_number_of(m, &column->value, &number));
    if (number >= 1 && number <= COLUMNS) *y = (long)number - 1;
  }
  if (strchr(line, ';') && !strchr(line, ','))
    return complain(m, table,
                    "columns are separated by ',', and numbers have a decimal point; "
                    "this line has ';'",
                    file, 1);
  return *y < 0
           ? complain(m, table, "has no such column; its first line gives the names", file, 0)
           : check_unit(m, table, line, *x, file);
}

static bool number(const char *line, long k, double *value)
{
  size_t length;
  char *end;
  const char *at = cell(line, k, &length);
  if (!at || !length) return false;
  *value = strtod(at, &end);
  return end == at + length && isfinite(*value);
}

static int cells(const char *line)
{
  int count = 1;
  for (; (line = strchr(line, ',')); line++) count++;
  return count;
}

/* A column by its number needs no names: a first line of numbers is a row. */
static int rows(stf_model *m, const stf_statement *s, const stf_statement *column,
                stf_lines *lines, const char *file, columns *c)
{
  int more;
  long x, y;
  STEIF_TRY(stf_line_next(lines, &more));
  STEIF_TRY(header(m, s, column, lines->text, file, &x, &y));
  double a, b;
  const int columns_there = cells(lines->text);
  bool here = !column->strlength && number(lines->text, x, &a) && number(lines->text, y, &b);
  for (;; here = false) {
    if (!here) STEIF_TRY(stf_line_next(lines, &more));
    if (!more) return STEIF_OK;
    if (!lines->text[strspn(lines->text, " \t\r")]) continue;
    if (cells(lines->text) > columns_there)
      return complain(m, s, "more cells than the first line has, or a decimal comma", file,
                      lines->number);
    if (!number(lines->text, x, &a) || !number(lines->text, y, &b))
      return complain(m, s, "expected finite numbers with a decimal point", file,
                      lines->number);
    if (c->x.count && !(a > *STF_AT(c->x, double, c->x.count - 1)))
      return complain(m, s, "the first column must ascend", file, lines->number);
    if (c->x.count == ROWS) return complain(m, s, "more than 1e7 rows", file, lines->number);
    STEIF_TRY(point(m, c, a, b));
  }
}

static int from_file(stf_model *m, const stf_statement *s, const stf_statement *column,
                     columns *c)
{
  const char *path, *name;
  STEIF_TRY(stf_source_path(&m->syntax.sources, m->pool, s->string - 1,
                            stf_source_at(&m->syntax.sources, s->string), s->strlength, &path));
  name = strrchr(path, '/') ? strrchr(path, '/') + 1 : path;
  stf_lines *lines = stf_allocate(m->ctx, 1, sizeof *lines);
  if (!lines) return STEIF_NO_MEMORY;
  lines->ctx = m->ctx;
  lines->path = name;
  lines->file = stf_input_open(m->ctx, path);
  const int code = lines->file ? rows(m, s, column, lines, name, c) : steif_status(m->ctx);
  if (lines->file) fclose(lines->file);
  stf_release(m->ctx, lines);
  return code;
}

static int from_pairs(stf_model *m, int32_t statement, columns *c)
{
  for (size_t i = (size_t)statement + 1; i < m->syntax.statements.count; i++) {
    const stf_statement *s = stf_statement_at(m, (int32_t)i);
    double x, y;
    if (s->parent != statement) break;
    STEIF_TRY(stf_number_of(m, &s->value, &x));
    STEIF_TRY(stf_number_of(m, &s->other, &y));
    if (c->x.count && !(x > *STF_AT(c->x, double, c->x.count - 1)))
      return stf_complain(&m->syntax.sources, s->at, STEIF_BAD_INPUT,
                          "the first numbers of the pairs must ascend");
    STEIF_TRY(point(m, c, x, y));
  }
  return STEIF_OK;
}

/* ---- slopes
 * ----------------------------------------------------------------------------------
 */

/* Monotone where the data are: F. N. Fritsch, R. E. Carlson, SIAM J. Numer.
 * Anal. 17, 1980; the weighted harmonic mean of the neighbouring slopes, 0 at
 * extrema. */
static void slopes(size_t n, const double *x, const double *y, double *slope)
{
  for (size_t i = 0; i + 1 < n; i++) slope[i] = (y[i + 1] - y[i]) / (x[i + 1] - x[i]);
  const double last = slope[n - 2];
  double before = slope[0];
  for (size_t i = 1; i + 1 < n; i++) {
    const double left = before, right = slope[i];
    const double h = x[i] - x[i - 1], k = x[i + 1] - x[i], a = 2 * k + h, b = k + 2 * h;
    before = right;
    slope[i] = left * right <= 0 ? 0 : (a + b) / (a / left + b / right);
  }
  slope[n - 1] = last;
}

static int table(stf_model *m, int32_t statement, stf_lookup *l)
{
  const stf_statement *s = stf_statement_at(m, statement);
  columns c = {{0}, {0}};
  int code = s->strlength ? from_file(m, s, stf_statement_at(m, statement + 1), &c)
                          : from_pairs(m, statement, &c);
  const size_t n = c.x.count;
  if (!code && n < 2)
    code = stf_complain(&m->syntax.sources, s->at, STEIF_BAD_INPUT,
                        "a table needs at least two points");
  double *x = code ? NULL : stf_pool_array(m->pool, 3 * n, sizeof *x);
  if (!code && !x) code = STEIF_NO_MEMORY;
  if (!code) {
    memcpy(x, c.x.data, n * sizeof *x);
    memcpy(x + n, c.y.data, n * sizeof *x);
    slopes(n, x, x + n, x + 2 * n);
    *l = (stf_lookup){s->whole, s->error, n, x, x + n, x + 2 * n};
  }
  stf_vector_free(m->ctx, &c.x);
  stf_vector_free(m->ctx, &c.y);
  return code;
}

int stf_read_tables(stf_model *m)
{
  m->lookups = stf_pool_array(m->pool, 4 * (size_t)m->tables, sizeof *m->lookups);
  if (!m->lookups) return STEIF_NO_MEMORY;
  int code = STEIF_OK;
  for (size_t i = 0; !code && i < m->symbols.count; i++) {
    const stf_symbol *s = stf_symbol_at(m, (int32_t)i);
    if (s->kind == STF_IS_TABLE) code = table(m, s->statement, m->lookups + s->which);
  }
  m->feed.lookups = m->lookups;
  return m->syntax.sources.errors ? stf_complaints(&m->syntax.sources) : code;
}
