/* csv.c: the first sheet (or the fields as one row) as comma-separated values, RFC 4180 quoting.
 * A list of numbers takes one column per entry: x1, x2, ..., a matrix among the fields A1_1, A1_2, ...
 * SPDX-License-Identifier: BSD-3-Clause */
#include "report.h"
#include <string.h>

void stf_report_quoted(FILE *stream, const char *text)
{
  if (!strpbrk(text, ",\"\r\n")) {
    fputs(text, stream);
    return;
  }
  putc('"', stream);
  for (; *text; text++) {
    if (*text == '"') putc('"', stream);
    putc(*text, stream);
  }
  putc('"', stream);
}

static void scalar(FILE *stream, const json_t *value)
{
  char number[40];
  if (json_is_real(value)) {
    stf_report_number(number, sizeof number, 'g', 17, json_real_value(value));
    fputs(number, stream);
  } else if (json_is_integer(value)) {
    fprintf(stream, "%" JSON_INTEGER_FORMAT, json_integer_value(value));
  } else if (json_is_string(value)) {
    stf_report_quoted(stream, json_string_value(value));
  } else if (json_is_boolean(value)) {
    fputs(json_is_true(value) ? "true" : "false", stream);
  }
}

static bool spread(const json_t *value)
{
  return json_is_array(value) && stf_report_is_number(json_array_get(value, 0));
}

/* Texts in one cell, separated by spaces. */
static void joined(FILE *stream, const json_t *list)
{
  for (size_t i = 0; i < json_array_size(list); i++) {
    if (i) putc(' ', stream);
    scalar(stream, json_array_get(list, i));
  }
}

/* `width` cells of one member: 0 for a scalar column, else the entries of a list. */
static void cells(FILE *stream, const json_t *value, json_int_t width)
{
  if (width == 0) {
    if (json_is_array(value))
      joined(stream, value);
    else
      scalar(stream, value);
    return;
  }
  for (json_int_t i = 0; i < width; i++) {
    if (i) putc(',', stream);
    if (json_is_array(value))
      scalar(stream, json_array_get(value, (size_t)i));
    else if (i == 0)
      scalar(stream, value);
  }
}

/* Name to the longest list met (0: scalars only). */
int stf_csv_collect(json_t *columns, json_t *row)
{
  const char *key;
  json_t *value;
  json_object_foreach(row, key, value)
  {
    const json_t *known = json_object_get(columns, key);
    const json_int_t length = spread(value) ? (json_int_t)json_array_size(value) : 0;
    if (json_is_object(value) || stf_report_is_sheet(value)) continue;
    if (known && json_integer_value(known) >= length) continue;
    if (json_object_set_new(columns, key, json_integer(length))) return STEIF_NO_MEMORY;
  }
  return STEIF_OK;
}

static void header(FILE *stream, json_t *columns)
{
  const char *key, *comma = "";
  json_t *width;
  json_object_foreach(columns, key, width)
  {
    const json_int_t count = json_integer_value(width);
    if (count == 0) {
      fputs(comma, stream);
      stf_report_quoted(stream, key);
      comma = ",";
    }
    for (json_int_t i = 1; i <= count; i++) {
      fprintf(stream, "%s%s%" JSON_INTEGER_FORMAT, comma, key, i);
      comma = ",";
    }
  }
  putc('\n', stream);
}

void stf_csv_line(FILE *stream, json_t *columns, json_t *row)
{
  const char *key;
  json_t *width;
  bool first = true;
  json_object_foreach(columns, key, width)
  {
    if (!first) putc(',', stream);
    first = false;
    cells(stream, json_object_get(row, key), json_integer_value(width));
  }
  putc('\n', stream);
}

/* A field of the flat row; a matrix as its rows "A1_", "A2_", ... */
static bool field(json_t *row, const char *key, json_t *value)
{
  bool good = true;
  json_t *numbers;
  size_t i;
  if (!json_is_array(json_array_get(value, 0))) return !json_object_set(row, key, value);
  json_array_foreach(value, i, numbers)
  {
    char name[288];
    snprintf(name, sizeof name, "%s%zu_", key, i + 1);
    good = good && !json_object_set(row, name, numbers);
  }
  return good;
}

/* Fields and members of objects as one flat row; borrowed values. */
static json_t *flat(json_t *root)
{
  json_t *row = json_object(), *value, *member;
  const char *key, *inner;
  bool good = row;
  json_object_foreach(root, key, value)
  {
    if (!json_is_object(value))
      good = good && field(row, key, value);
    else
      json_object_foreach(value, inner, member)
      {
        char name[256];
        snprintf(name, sizeof name, "%s.%s", key, inner);
        good = good && field(row, name, member);
      }
  }
  if (good) return row;
  json_decref(row);
  return NULL;
}

json_t *stf_report_first_sheet(json_t *root)
{
  const char *key;
  json_t *value;
  json_object_foreach(root, key, value) if (stf_report_is_sheet(value)) return value;
  return NULL;
}

int stf_report_csv(steif_report *r, FILE *stream)
{
  json_t *columns = json_object(), *sheet = stf_report_first_sheet(r->root), *single = NULL,
         *row;
  size_t i;
  int code = columns ? STEIF_OK : STEIF_NO_MEMORY;
  if (code == STEIF_OK && !sheet) {
    single = flat(r->root);
    code = single ? stf_csv_collect(columns, single) : STEIF_NO_MEMORY;
  }
  json_array_foreach(sheet, i, row) if (code == STEIF_OK) code = stf_csv_collect(columns, row);
  if (code == STEIF_OK) {
    header(stream, columns);
    json_array_foreach(sheet, i, row) stf_csv_line(stream, columns, row);
    if (single) stf_csv_line(stream, columns, single);
  } else {
    STEIF_FAIL(r->ctx, code,
               "no memory for the columns of the CSV file; ask for fewer of them");
  }
  json_decref(single);
  json_decref(columns);
  return code;
}
