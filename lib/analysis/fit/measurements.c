/* measurements.c: measurements from a file of comma-separated values: t and names of unknowns, a row for each time.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "descent.h"
#include "text.h"
#include "problem.h"
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <steif/fit.h>
#include <steif/model.h>
#include <stdlib.h>
#include <string.h>

enum { COLUMNS = 512 };

typedef struct table {
  steif_context *ctx;
  stf_pool *pool;
  const steif_problem *problem;
  const char *path;
  long line; /* being read, from 1 */
  int columns;
  sunindextype component[COLUMNS]; /* of a column; of t -1 */
  int sd_of
    [COLUMNS]; /* the column whose standard deviations stand here; -1: a column of values */
  int sd_at[COLUMNS];      /* where those of a column stand; -1: nowhere */
  sunrealtype sd[COLUMNS]; /* of a column as a whole; 0: none */
  sunrealtype t0, t1, last;
  long last_line;
  bool repeated, weighted;
  steif_model_data said; /* by a model */
  steif_measurements *data;
} table;

#define REFUSE(T, column, code, format, ...)                                                   \
  STEIF_FAIL((T)->ctx, code, "%s, line %ld, column %d: " format, (T)->path, (T)->line,         \
             (column) + 1, __VA_ARGS__)

/* ---- cells ----------------------------------------------------------------------------------- */

typedef struct cell {
  const char *text;
  size_t length; /* without blanks and quotes around it */
} cell;

/* The cell at `at`, which goes past it: to the next one, or NULL behind the last of the line. Commas within quotes
 * belong to it, "u[1,2]". */
static cell next_cell(const char **at)
{
  const char *from = *at + strspn(*at, " \t");
  const size_t quoted = *from == '"' ? strcspn(from + 1, "\"\n") : 0;
  const char *to = from + (quoted && from[quoted + 1] == '"' ? quoted + 2 : 0);
  to += strcspn(to, ",\n");
  *at = *to == ',' ? to + 1 : NULL;
  while (from < to && isspace((unsigned char)*from)) from++;
  while (to > from && isspace((unsigned char)to[-1])) to--;
  if (to - from >= 2 && *from == '"' && to[-1] == '"') from++, to--;
  return (cell){from, (size_t)(to - from)};
}

static bool is(cell c, const char *word)
{
  return c.length == strlen(word) && !strncmp(c.text, word, c.length);
}

static bool missing(cell c) { return c.length == 0 || is(c, "NA"); }

static int number(const table *T, int column, cell c, sunrealtype *value)
{
  char text[64], shown[STF_SHOWN], *end;
  snprintf(text, sizeof text, "%.*s", (int)c.length, c.text);
  *value = strtod(text, &end);
  if (end == text || *end || c.length >= sizeof text)
    return REFUSE(T, column, STEIF_BAD_INPUT,
                  "'%s' is not a number; leave the cell empty where nothing was measured",
                  stf_input_shown(text, shown));
  if (!isfinite(*value))
    return REFUSE(T, column, STEIF_NOT_FINITE,
                  "%s is not finite; leave the cell empty where nothing was measured", text);
  return STEIF_OK;
}

/* ---- the first line -------------------------------------------------------------------------- */

/* Of unknown i, or of output i - n; NULL past the last. */
static const char *measured_name(const steif_problem *p, sunindextype i, char *room)
{
  if (i >= p->n) return steif_model_output(p, (size_t)(i - p->n));
  if (p->names && p->names->unknown) return p->names->unknown[i];
  snprintf(room, STEIF_SPEC_WORD, "y%lld", (long long)i + 1);
  return room;
}

/* The unknown or output of a name, or the sentence with the nearest one. */
static int find_measured(const table *T, int column, const char *name, sunindextype *i)
{
  char room[STEIF_SPEC_WORD], near[STEIF_SPEC_WORD] = "";
  const char *known;
  int best = 1 << 20;
  for (*i = 0; (known = measured_name(T->problem, *i, room)); ++*i) {
    const int distance = stf_distance(name, known);
    if (!strcmp(name, known)) return STEIF_OK;
    if (distance < best) snprintf(near, sizeof near, "%s", known);
    if (distance < best) best = distance;
  }
  return REFUSE(
    T, column, STEIF_UNKNOWN_NAME,
    "problem '%s' has no unknown or output '%s'; the nearest is '%s'; rename the column, or "
    "leave it out",
    T->problem->name, name, near);
}

/* Takes "{unit}" from the end of a cell: its words, "" where there is none. */
static void take_unit(cell *c, size_t room, char *unit)
{
  const char *brace = c->length ? memchr(c->text, '{', c->length) : NULL;
  *unit = 0;
  if (!brace || c->text[c->length - 1] != '}') return;
  snprintf(unit, room, "%.*s", (int)(c->text + c->length - brace) - 2, brace + 1);
  c->length = (size_t)(brace - c->text);
  while (c->length && isspace((unsigned char)c->text[c->length - 1])) c->length--;
}

/* A unit that is not the one of the model, where both are told. */
static int check_unit(const table *T, int column, const char *name, const char *unit)
{
  char own[STEIF_SPEC_WORD], shown[STF_SHOWN];
  steif_model_unit(T->problem, name, sizeof own, own);
  if (!*own || !*unit || !strcmp(own, unit)) return STEIF_OK;
  return REFUSE(T, column, STEIF_BAD_INPUT,
                "'%s' is in {%s}, and problem '%s' has it in {%s}; convert one", name,
                stf_input_shown(unit, shown), T->problem->name, own);
}

static int one_name(table *T, int column, cell c)
{
  char name[STEIF_SPEC_WORD], unit[STEIF_SPEC_WORD];
  take_unit(&c, sizeof unit, unit);
  snprintf(name, sizeof name, "%.*s", (int)c.length, c.text);
  const bool sd = !strncmp(name, "sd_", 3);
  T->sd_of[column] = T->sd_at[column] = -1, T->sd[column] = 0, T->component[column] = -1;
  if (column == 0 && strchr(name, ';'))
    return REFUSE(T, column, STEIF_BAD_INPUT,
                  "columns are separated by ',' and numbers have a decimal point; '%s' has ';'",
                  name);
  if (column == 0 && !is(c, "t"))
    return REFUSE(
      T, column, STEIF_BAD_INPUT,
      "the first line is 't' and names of unknowns, not '%s'; rename the column of the times",
      name);
  if (column == 0) return check_unit(T, column, name, unit);
  STEIF_TRY(find_measured(T, column, sd ? name + 3 : name, &T->component[column]));
  STEIF_TRY(check_unit(T, column, sd ? name + 3 : name, unit));
  for (int k = 1; k < column; k++)
    if (T->component[k] == T->component[column] && (T->sd_of[k] >= 0) == sd)
      return REFUSE(T, column, STEIF_BAD_INPUT, "'%s' stands in column %d too", name, k + 1);
  if (sd) T->sd_of[column] = column; /* of the column found by connect */
  return STEIF_OK;
}

/* Columns of standard deviations and those they belong to. */
static int connect(table *T)
{
  for (int j = 1; j < T->columns; j++) {
    if (T->sd_of[j] < 0) continue;
    T->sd_of[j] = 0;
    for (int k = 1; k < T->columns; k++)
      if (T->component[k] == T->component[j] && T->sd_of[k] < 0)
        T->sd_of[j] = k, T->sd_at[k] = j;
    if (!T->sd_of[j])
      return REFUSE(T, j, STEIF_BAD_INPUT, "%s",
                    "standard deviations of a column that is not there");
  }
  return STEIF_OK;
}

static int header(table *T, const char *line)
{
  for (const char *at = line; at;) {
    if (T->columns == COLUMNS)
      return REFUSE(T, T->columns, STEIF_BAD_INPUT, "more than %d columns", COLUMNS);
    const cell c = next_cell(&at);
    STEIF_TRY(one_name(T, T->columns++, c));
  }
  if (T->columns < 2)
    return REFUSE(T, 0, STEIF_BAD_INPUT, "%s", "no columns but t: name what was measured");
  return connect(T);
}

/* ---- standard deviations of columns ---------------------------------------------------------- */

/* What a model says of column k, unless the file has standard deviations of its values. */
static sunrealtype told(const table *T, int k)
{
  char room[STEIF_SPEC_WORD];
  const char *name = measured_name(T->problem, T->component[k], room);
  for (int i = 0; i < T->said.columns && T->sd_at[k] < 0; i++)
    if (!strcmp(T->said.column[i], name)) return T->said.sd[i];
  return 0;
}

static int spread(table *T, int count, const sunrealtype *sd)
{
  int values = 0;
  for (int k = 1; k < T->columns; k++) values += T->sd_of[k] < 0;
  STEIF_CHECK(count == 0 || count == 1 || count == values, T->ctx, STEIF_BAD_INPUT,
              "%d standard deviations for %d columns of '%s': give one, or one for each", count,
              values, T->path);
  for (int k = 1, i = 0; k < T->columns; k++) {
    if (T->sd_of[k] >= 0) continue;
    const sunrealtype s = count ? sd[count == 1 ? 0 : i] : told(T, k);
    STEIF_CHECK(!count || (s > 0 && isfinite(s)), T->ctx, STEIF_BAD_INPUT,
                "the standard deviation %g of column %d of '%s' must be positive", s, k + 1,
                T->path);
    T->sd[k] = s, T->weighted |= s > 0 || T->sd_at[k] >= 0, i++;
  }
  for (int k = 1; k < T->columns && T->weighted && !count; k++)
    STEIF_CHECK(
      T->sd_of[k] >= 0 || T->sd_at[k] >= 0 || T->sd[k] > 0, T->ctx, STEIF_BAD_INPUT,
      "column %d of '%s' has no standard deviations, and others have: give all, or none", k + 1,
      T->path);
  return STEIF_OK;
}

/* ---- rows ------------------------------------------------------------------------------------ */

static int check_time(table *T, sunrealtype t)
{
  if (T->last_line && t < T->last)
    return REFUSE(T, 0, STEIF_BAD_INPUT,
                  "t = %.9g comes after %.9g in line %ld; sort the rows by t", t, T->last,
                  T->last_line);
  if (T->last_line && t == T->last && !T->repeated)
    return REFUSE(T, 0, STEIF_BAD_INPUT,
                  "t = %.9g stands in line %ld too; say that measurements are repeated, or "
                  "take one out",
                  t, T->last_line);
  if (t < T->t0 || t > T->t1)
    return REFUSE(T, 0, STEIF_BAD_INPUT,
                  "t = %.9g lies outside the interval [%.9g, %.9g] of problem '%s'", t, T->t0,
                  T->t1, T->problem->name);
  T->last = t, T->last_line = T->line;
  return STEIF_OK;
}

/* The values of a row; `deviation` of those columns that have some in the file. */
static int keep(table *T, const cell *c)
{
  steif_measurements *m = T->data;
  for (int k = 1; k < T->columns; k++) {
    if (T->sd_of[k] >= 0 || missing(c[k])) continue;
    STEIF_TRY(number(T, k, c[k], &m->value[m->count]));
    m->t[m->count] = T->last, m->component[m->count] = T->component[k];
    const int at = T->sd_at[k];
    sunrealtype sd = T->sd[k];
    if (at >= 0 && sd == 0) STEIF_TRY(number(T, at, c[at], &sd));
    if (T->weighted && !(sd > 0))
      return REFUSE(T, at, STEIF_BAD_INPUT, "the standard deviation %g must be positive", sd);
    if (T->weighted) m->sd[m->count] = sd;
    m->count++;
  }
  return STEIF_OK;
}

static int row(table *T, const char *line)
{
  cell c[COLUMNS];
  sunrealtype t;
  int columns = 0;
  for (const char *at = line; at; columns++) {
    const cell one = next_cell(&at);
    if (columns >= T->columns)
      return REFUSE(T, columns, STEIF_BAD_INPUT, "the first line names %d columns", T->columns);
    c[columns] = one;
  }
  if (columns < T->columns)
    return REFUSE(T, columns, STEIF_BAD_INPUT,
                  "the row ends, and the first line names %d columns; write commas for cells "
                  "without a value",
                  T->columns);
  STEIF_TRY(number(T, 0, c[0], &t));
  STEIF_TRY(check_time(T, t));
  return keep(T, c);
}

/* ---- the file -------------------------------------------------------------------------------- */

static int room(table *T, const char *text)
{
  steif_measurements *m = T->data;
  size_t cells = 1; /* at most one value for each separator */
  for (const char *at = text; *at; at++) cells += *at == ',' || *at == '\n';
  m->t = stf_pool_array(T->pool, cells, sizeof *m->t);
  m->value = stf_pool_array(T->pool, cells, sizeof *m->value);
  m->component = stf_pool_array(T->pool, cells, sizeof *m->component);
  m->sd = T->weighted ? stf_pool_array(T->pool, cells, sizeof *m->sd) : NULL;
  return m->t && m->value && m->component && (m->sd || !T->weighted) ? STEIF_OK
                                                                     : STEIF_NO_MEMORY;
}

static int read(table *T, const char *text, int count, const sunrealtype *sd)
{
  for (const char *line = text; *line; line = stf_next_line(line)) {
    T->line++;
    if (!stf_has_data(line)) continue;
    if (T->columns) {
      STEIF_TRY(row(T, line));
      continue;
    }
    STEIF_TRY(header(T, line));
    STEIF_TRY(spread(T, count, sd));
    STEIF_TRY(room(T, text));
  }
  STEIF_CHECK(T->data->count > 0, T->ctx, STEIF_BAD_INPUT, "'%s' has no measurements", T->path);
  return STEIF_OK;
}

size_t stf_fit_outputs(const steif_problem *p)
{
  size_t count = 0;
  while (steif_model_output(p, count)) count++;
  return count;
}

sunrealtype stf_fit_end(const steif_problem *p, sunrealtype t1)
{
  return t1 != 0 ? t1 : p->t1 > p->t0 ? p->t1 : INFINITY;
}

int steif_measurements_read(steif_context *ctx, const steif_problem *problem, const char *path,
                            sunrealtype t1, int repeated, int sd_count, const sunrealtype *sd,
                            steif_measurements *data)
{
  STF_NAMED(problem);
  stf_plain plain;
  STEIF_CHECK(data, ctx, STEIF_BAD_INPUT, "no place for the measurements: it is NULL");
  *data = (steif_measurements){0};
  if (!ctx) return STEIF_BAD_INPUT;
  steif_model_data said = {0};
  STEIF_CHECK(problem, ctx, STEIF_BAD_INPUT, "a problem is needed, got NULL");
  STEIF_TRY(steif_model_data_find(ctx, problem, &said));
  if (!path) path = said.path;
  STEIF_CHECK(
    path, ctx, STEIF_BAD_INPUT,
    "the path of a file of measurements is needed: problem '%s' names none, as a model "
    "does by data \"FILE.csv\"",
    problem->name ? problem->name : "?");
  char *text = stf_input_text(ctx, path);
  if (!text) return steif_status(ctx);
  table *T = stf_allocate(ctx, 1, sizeof *T);
  int code = T ? stf_plain_begin(ctx, &plain) : STEIF_NO_MEMORY;
  if (!code) {
    *T = (table){.ctx = ctx, .problem = problem, .path = path, .data = data, .said = said};
    T->t0 = problem->t0, T->t1 = stf_fit_end(problem, t1), T->repeated = repeated;
    data->reserved[0] = T->pool = stf_pool_new(ctx);
    code = T->pool ? read(T, text, sd ? sd_count : 0, sd) : STEIF_NO_MEMORY;
    stf_plain_end(&plain);
  }
  if (T) stf_release(ctx, T);
  stf_release(ctx, text);
  if (code) steif_measurements_free(ctx, data);
  return code;
}

void steif_measurements_free(steif_context *ctx, steif_measurements *data)
{
  (void)ctx;
  if (!data) return;
  stf_pool *pool = data->reserved[0];
  stf_pool_free(&pool);
  *data = (steif_measurements){0};
}
