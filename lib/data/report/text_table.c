/* text_table.c: a report for a terminal: "name  value" lines and sheets as aligned columns.
 * Sentences in a column "message" are listed under their sheet, where there is room for them.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "report.h"
#include <string.h>

enum { CELL = 1024, LINE = 96, NARROW = 32, LIST_SHOWN = 24, ROWS_SHOWN = 12 };

static void pad(FILE *stream, size_t used, size_t width)
{
  for (; used < width; used++) putc(' ', stream);
}

/* Text broken at spaces, further lines indented to where it began. */
static void wrapped(FILE *stream, const char *text, size_t indent)
{
  size_t at = indent;
  while (*text) {
    const size_t length = strcspn(text, " ");
    char word[CELL];
    snprintf(word, sizeof word, "%.*s", (int)length, text);
    const size_t width = stf_report_width(word);
    if (at > indent && at + 1 + width > LINE) {
      putc('\n', stream);
      pad(stream, 0, indent);
      at = indent;
    } else if (at > indent) {
      putc(' ', stream);
      at++;
    }
    fwrite(text, 1, length, stream);
    at += width;
    text += length;
    text += strspn(text, " ");
  }
  putc('\n', stream);
}

static bool is_matrix(const json_t *value) { return json_is_array(json_array_get(value, 0)); }

/* ---- fields ---- */

/* Texts of several words need a comma between them. */
static bool of_words(const json_t *list)
{
  for (size_t i = 0; i < json_array_size(list); i++) {
    const char *text = json_string_value(json_array_get(list, i));
    if (text && strchr(text, ' ')) return true;
  }
  return false;
}

/* A list of numbers over several lines; long ones are cut with their count. */
static void list(FILE *stream, const char *key, const json_t *value, size_t indent)
{
  const size_t count = json_array_size(value);
  const size_t shown = count > LIST_SHOWN && stf_report_is_number(json_array_get(value, 0))
                         ? LIST_SHOWN / 2
                         : count;
  const char *between = of_words(value) ? ", " : "  ";
  char text[CELL * 4], entry[CELL];
  size_t used = 0;
  *text = 0;
  for (size_t i = 0; i < shown && used < sizeof text; i++) {
    stf_report_cell(entry, sizeof entry, key, json_array_get(value, i));
    used += (size_t)snprintf(text + used, sizeof text - used, "%s%s", i ? between : "", entry);
  }
  if (shown < count && used < sizeof text)
    snprintf(text + used, sizeof text - used, "  ... (%zu in all)", count);
  wrapped(stream, count ? text : "none", indent);
}

static void matrix(FILE *stream, const char *key, const json_t *value, size_t indent)
{
  const size_t count = json_array_size(value),
               columns = json_array_size(json_array_get(value, 0));
  if (count > ROWS_SHOWN) {
    fprintf(stream, "%zu rows of %zu numbers\n", count, columns);
    return;
  }
  for (size_t i = 0; i < count; i++) {
    if (i) pad(stream, 0, indent);
    list(stream, key, json_array_get(value, i), indent);
  }
}

static void field(FILE *stream, const char *prefix, const char *key, const json_t *value,
                  size_t width)
{
  char text[CELL];
  const size_t used = stf_report_width(prefix) + stf_report_width(key);
  fprintf(stream, "%s%s", prefix, key);
  pad(stream, used, width + 2);
  if (is_matrix(value)) {
    matrix(stream, key, value, width + 2);
  } else if (json_is_array(value)) {
    list(stream, key, value, width + 2);
  } else {
    stf_report_cell(text, sizeof text, key, value);
    wrapped(stream, text, width + 2);
  }
}

/* The widest name of a field or of an object's member, as "object.member". */
static size_t widest(json_t *object, size_t prefix)
{
  const char *key;
  json_t *value;
  size_t width = 0;
  json_object_foreach(object, key, value)
  {
    const size_t own = prefix + stf_report_width(key);
    const size_t used = json_is_object(value)        ? widest(value, own + 1)
                        : stf_report_is_sheet(value) ? 0
                                                     : own;
    if (used > width) width = used;
  }
  return width;
}

/* ---- sheets ---- */

static bool is_note(const char *key) { return !strcmp(key, "message"); }

/* Column names with their widths, in order of first appearance; *right marks number columns. */
static int measure(json_t *sheet, json_t *columns)
{
  size_t i;
  json_t *row, *value;
  const char *key;
  char text[CELL];
  json_array_foreach(sheet, i, row) json_object_foreach(row, key, value)
  {
    if (is_note(key)) continue;
    const json_t *known = json_object_get(columns, key);
    stf_report_cell(text, sizeof text, key, value);
    const json_int_t name = (json_int_t)stf_report_width(key);
    json_int_t width = (json_int_t)stf_report_width(text);
    if (width < name) width = name;
    if (known && json_integer_value(known) >= width) continue;
    if (json_object_set_new(columns, key, json_integer(width))) return STEIF_NO_MEMORY;
  }
  return STEIF_OK;
}

/* Numbers stand to the right: a column whose first value that is there is a number. */
static bool rightward(json_t *sheet, const char *key)
{
  size_t i;
  json_t *row;
  json_array_foreach(sheet, i, row)
  {
    const json_t *value = json_object_get(row, key);
    if (value && !json_is_null(value)) return stf_report_is_number(value);
  }
  return false;
}

/* One line: the cells of `row`, or the column names when row is NULL. The last column, when it
 * holds texts, is broken over lines if there is room for that. */
static void line(FILE *stream, json_t *sheet, json_t *columns, const json_t *row)
{
  const char *key;
  const json_t *width;
  json_t *entry;
  size_t left = json_object_size(columns), at = 0;
  json_object_foreach(columns, key, entry)
  {
    width = entry;
    const size_t w = (size_t)json_integer_value(width);
    const bool right = rightward(sheet, key);
    char text[CELL];
    snprintf(text, sizeof text, "%s", key);
    if (row) stf_report_cell(text, sizeof text, key, json_object_get(row, key));
    const size_t own = stf_report_width(text);
    if (right) pad(stream, own, w);
    if (--left == 0 && !right && at + NARROW < LINE) {
      wrapped(stream, text, at);
      return;
    }
    fputs(text, stream);
    if (left) pad(stream, right ? w : own, w + 2);
    at += w + 2;
  }
  putc('\n', stream);
}

/* "  name: sentence" for every row that has one other than "ok". */
static void notes(FILE *stream, json_t *sheet)
{
  size_t i;
  json_t *row;
  json_array_foreach(sheet, i, row)
  {
    const char *note = json_string_value(json_object_get(row, "message"));
    if (!note || !*note || !strcmp(note, "ok")) continue;
    const char *key = json_object_iter_key(json_object_iter(row));
    char name[CELL];
    stf_report_cell(name, sizeof name, key, json_object_get(row, key));
    fprintf(stream, "  %s: ", name);
    wrapped(stream, note, 4 + stf_report_width(name));
  }
}

static int sheet_lines(FILE *stream, json_t *sheet)
{
  json_t *columns = json_object(), *row;
  size_t i;
  int code = columns ? measure(sheet, columns) : STEIF_NO_MEMORY;
  if (code == STEIF_OK) {
    line(stream, sheet, columns, NULL);
    json_array_foreach(sheet, i, row) line(stream, sheet, columns, row);
    notes(stream, sheet);
  }
  json_decref(columns);
  return code;
}

/* Several sheets are told apart by their names. */
static size_t sheets(json_t *root)
{
  size_t count = 0;
  const char *key;
  json_t *value;
  json_object_foreach(root, key, value) count += stf_report_is_sheet(value);
  return count;
}

static void object(FILE *stream, const char *name, json_t *members, size_t width)
{
  const char *key;
  json_t *value;
  char prefix[256];
  snprintf(prefix, sizeof prefix, "%s.", name);
  json_object_foreach(members, key, value) field(stream, prefix, key, value, width);
}

int stf_report_table(steif_report *r, FILE *stream)
{
  const size_t width = widest(r->root, 0), count = sheets(r->root);
  const char *key;
  json_t *value;
  bool first = true, after = false;
  int code = STEIF_OK;
  json_object_foreach(r->root, key, value)
  {
    const bool sheet = stf_report_is_sheet(value);
    if (!first && (sheet || after)) putc('\n', stream);
    if (sheet && count > 1) fprintf(stream, "%s\n", key);
    if (sheet)
      code = sheet_lines(stream, value);
    else if (json_is_object(value))
      object(stream, key, value, width);
    else
      field(stream, "", key, value, width);
    if (code != STEIF_OK)
      return STEIF_FAIL(r->ctx, code, "no memory for the columns of sheet \"%s\"; ask for CSV",
                        key);
    first = false, after = sheet;
  }
  return STEIF_OK;
}
