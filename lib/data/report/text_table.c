/* text_table.c: a report for a terminal: "name  value" lines and sheets as aligned columns. What has been shown as it
 * came is left out.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "report.h"
#include <string.h>

enum { CELL = STF_CELL, LIST_SHOWN = 24, ROWS_SHOWN = 12 };

void stf_table_pad(FILE *stream, size_t used, size_t width)
{
  for (; used < width; used++) putc(' ', stream);
}

void stf_table_wrapped(FILE *stream, const char *text, size_t indent)
{
  size_t at = indent;
  while (*text) {
    const size_t length = strcspn(text, " ");
    char word[CELL];
    snprintf(word, sizeof word, "%.*s", (int)length, text);
    const size_t width = stf_report_width(word);
    if (at > indent && at + 1 + width > STF_LINE) {
      putc('\n', stream);
      stf_table_pad(stream, 0, indent);
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

/* How many entries of a list are shown: long ones are cut, names later than numbers. */
static size_t shown_of(const json_t *list)
{
  const size_t count = json_array_size(list);
  const bool numbers = stf_report_is_number(json_array_get(list, 0));
  return count <= (numbers ? 1 : 2) * LIST_SHOWN ? count : LIST_SHOWN / 2;
}

/* A list over several lines, with its count where it is cut. */
static void list(FILE *stream, const char *key, const json_t *value, size_t indent)
{
  const size_t count = json_array_size(value), shown = shown_of(value);
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
  stf_table_wrapped(stream, count ? text : "none", indent);
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
    if (i) stf_table_pad(stream, 0, indent);
    list(stream, key, json_array_get(value, i), indent);
  }
}

static void field(FILE *stream, const char *prefix, const char *key, const json_t *value,
                  size_t width)
{
  char text[CELL];
  const size_t used = stf_report_width(prefix) + stf_report_width(key);
  fprintf(stream, "%s%s", prefix, key);
  stf_table_pad(stream, used, width + 2);
  if (is_matrix(value)) {
    matrix(stream, key, value, width + 2);
  } else if (json_is_array(value)) {
    list(stream, key, value, width + 2);
  } else {
    stf_report_cell(text, sizeof text, key, value);
    stf_table_wrapped(stream, text, width + 2);
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
  bool first = true, after = false, before = r->flow.shown > 0;
  int code = STEIF_OK;
  json_object_foreach(r->root, key, value)
  {
    const bool sheet = stf_report_is_sheet(value);
    if (before && !sheet) continue; /* shown when the first row came */
    if (!first && (sheet || after)) putc('\n', stream);
    if (sheet && count > 1 && !before) fprintf(stream, "%s\n", key);
    if (sheet)
      code = before ? stf_flow_rest(r, value, stream) : stf_table_sheet(value, stream);
    else if (json_is_object(value))
      object(stream, key, value, width);
    else
      field(stream, "", key, value, width);
    if (code != STEIF_OK)
      return STEIF_FAIL(r->ctx, code, "no memory for the columns of sheet \"%s\"; ask for CSV",
                        key);
    first = before = false, after = sheet;
  }
  return STEIF_OK;
}

void stf_table_fields(steif_report *r, FILE *stream)
{
  const size_t width = widest(r->root, 0);
  const char *key;
  json_t *value;
  bool any = false;
  json_object_foreach(r->root, key, value)
  {
    if (stf_report_is_sheet(value)) break;
    if (json_is_object(value))
      object(stream, key, value, width);
    else
      field(stream, "", key, value, width);
    any = true;
  }
  if (any) putc('\n', stream);
}
