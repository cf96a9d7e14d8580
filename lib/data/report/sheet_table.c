/* sheet_table.c: a sheet as aligned columns. Sentences in a column "message" are listed under it, where there is room
 * for them.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "report.h"
#include <string.h>

enum { NARROW = 32 };

static bool is_note(const char *key) { return !strcmp(key, "message"); }

/* What is known of a column: its width, and whether its first value is a number, which stands to the right. */
static int widen(json_t *columns, const char *key, const json_t *value, size_t width)
{
  json_t *known = json_object_get(columns, key);
  if (!known) {
    known = json_pack("{s:I}", "width", (json_int_t)0);
    if (!known || json_object_set_new(columns, key, known)) return STEIF_NO_MEMORY;
  }
  if (width > (size_t)json_integer_value(json_object_get(known, "width")) &&
      json_object_set_new(known, "width", json_integer((json_int_t)width)))
    return STEIF_NO_MEMORY;
  return !value || json_is_null(value) || json_object_get(known, "right") ||
             !json_object_set_new(known, "right", json_boolean(stf_report_is_number(value)))
           ? STEIF_OK
           : STEIF_NO_MEMORY;
}

int stf_table_measure(json_t *sheet, size_t from, bool more, json_t *columns)
{
  json_t *value;
  const char *key;
  char text[STF_CELL];
  for (size_t i = from; i < json_array_size(sheet); i++)
    json_object_foreach(json_array_get(sheet, i), key, value)
    {
      if (is_note(key)) continue;
      stf_report_cell(text, sizeof text, key, value);
      const size_t name = stf_report_width(key), most = more ? stf_report_most(key, value) : 0;
      size_t width = stf_report_width(text);
      if (width < name) width = name;
      if (width < most) width = most;
      if (widen(columns, key, value, width)) return STEIF_NO_MEMORY;
    }
  return STEIF_OK;
}

/* The last column, when it holds texts, is broken over lines if there is room for that. */
void stf_table_line(FILE *stream, json_t *columns, const json_t *row)
{
  const char *key;
  json_t *known;
  size_t left = json_object_size(columns), at = 0;
  json_object_foreach(columns, key, known)
  {
    const size_t w = (size_t)json_integer_value(json_object_get(known, "width"));
    const bool right = json_is_true(json_object_get(known, "right"));
    char text[STF_CELL];
    snprintf(text, sizeof text, "%s", key);
    if (row) stf_report_cell(text, sizeof text, key, json_object_get(row, key));
    const size_t own = stf_report_width(text);
    if (right) stf_table_pad(stream, own, w);
    if (--left == 0 && !right && at + NARROW < STF_LINE) {
      stf_table_wrapped(stream, text, at);
      return;
    }
    fputs(text, stream);
    if (left) stf_table_pad(stream, right && own < w ? w : own, w + 2);
    at += w + 2;
  }
  putc('\n', stream);
}

void stf_table_notes(FILE *stream, json_t *sheet)
{
  size_t i;
  json_t *row;
  char name[STF_CELL] = "", before[STF_CELL] = "";
  const char *last = "";
  json_array_foreach(sheet, i, row)
  {
    const char *note = json_string_value(json_object_get(row, "message"));
    if (!note || !*note || !strcmp(note, "ok")) continue;
    const char *key = json_object_iter_key(json_object_iter(row));
    stf_report_cell(name, sizeof name, key, json_object_get(row, key));
    if (!strcmp(note, last) && !strcmp(name, before)) continue; /* said of the row above */
    last = note;
    memcpy(before, name, sizeof before);
    fprintf(stream, "  %s: ", name);
    stf_table_wrapped(stream, note, 4 + stf_report_width(name));
  }
}

int stf_table_sheet(json_t *sheet, FILE *stream)
{
  json_t *columns = json_object(), *row;
  size_t i;
  int code = columns ? stf_table_measure(sheet, 0, false, columns) : STEIF_NO_MEMORY;
  if (code == STEIF_OK) {
    stf_table_line(stream, columns, NULL);
    json_array_foreach(sheet, i, row) stf_table_line(stream, columns, row);
    stf_table_notes(stream, sheet);
  }
  json_decref(columns);
  return code;
}
