/* arrays.c: the lists and matrices of a report as numbers.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "report.h"
#include <math.h>
#include <string.h>

static double number(const json_t *value)
{
  const char *text = json_string_value(value);
  if (!text) return json_number_value(value);
  return !strcmp(text, "inf") ? INFINITY : !strcmp(text, "-inf") ? -INFINITY : NAN;
}

/* Lists and matrices of numbers; their sizes, columns 0 of a list. */
static bool is_array(const json_t *value, size_t *rows, size_t *columns)
{
  *rows = json_array_size(value); /* 0 of what is no array */
  const json_t *first = json_array_get(value, 0);
  *columns = json_array_size(first);
  return *rows && (*columns ? stf_report_is_number(json_array_get(first, 0))
                            : stf_report_is_number(first));
}

static void copy(const json_t *field, size_t rows, size_t columns, sunrealtype *value)
{
  for (size_t k = 0; k < rows; k++) {
    const json_t *row = json_array_get(field, k);
    if (!columns) value[k] = number(row);
    for (size_t j = 0; j < columns; j++)
      value[k * columns + j] = number(json_array_get(row, j));
  }
}

/* Array *i of an object and of the objects in it; *i counts down. */
static const char *find(json_t *object, size_t *i, size_t *rows, size_t *columns,
                        sunrealtype *value)
{
  const char *name, *inner;
  json_t *field;
  json_object_foreach(object, name, field)
  {
    if (json_is_object(field) && (inner = find(field, i, rows, columns, value))) return inner;
    if (!is_array(field, rows, columns) || (*i)--) continue;
    if (value) copy(field, *rows, *columns, value);
    return name;
  }
  return NULL;
}

const char *steif_report_array_at(const steif_report *r, size_t i, size_t *rows,
                                  size_t *columns, sunrealtype *value)
{
  return r && rows && columns ? find(r->root, &i, rows, columns, value) : NULL;
}
