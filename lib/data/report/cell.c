/* cell.c: one value as a person reads it.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "report.h"
#include <locale.h>
#include <math.h>
#include <string.h>

/* How numbers of a given name are shown; others with six significant digits. */
static const struct {
  const char *key;
  char conversion;
  int precision;
} rules[] = {
  {"error", 'e', 4},
  {"residual", 'e', 3},
  {"drift", 'e', 4},
  {"rounding", 'e', 1},
  {"defect", 'e', 3},
  {"order", 'f', 2},
  {"scd", 'f', 2},
  {"mescd", 'f', 2},
  {"digits", 'f', 2},
  {"ratio", 'f', 2},
  {"geomean", 'f', 2},
  {"y", 'g', 12},
  {"t", 'g', 10},
  {"value", 'g', 15},
  {"exact", 'g', 15},
  {"x_plus", 'g', 12},
  {"reference", 'g', 15},
  {"cpu_s", 'g', 3},
  {"baseline_cpu_s", 'g', 3},
  {"alpha_deg", 'g', 10},
  {"auto_cpu_s", 'g', 3},
  {"auto_ratio", 'f', 2},
  {"peer_cpu_s", 'g', 3},
  {"auto_geomean", 'f', 2},
  {"peer_geomean", 'f', 2},
};

static void locate(const char *key, char *conversion, int *precision)
{
  *conversion = 'g';
  *precision = 6;
  for (size_t i = 0; i < sizeof rules / sizeof *rules; i++)
    if (key && !strcmp(key, rules[i].key)) {
      *conversion = rules[i].conversion;
      *precision = rules[i].precision;
    }
}

size_t stf_report_most(const char *key, const json_t *value)
{
  enum { WHOLE = 7, TEXT = 10, GIVEN = 5, NONE = 6, STATUS = 13 };
  char conversion;
  int precision;
  locate(key, &conversion, &precision);
  if (!strcmp(key, "rtol") || !strcmp(key, "atol")) return GIVEN; /* seldom with many digits */
  if (!strcmp(key, "status")) return STATUS;                      /* "not certified" */
  if (json_is_null(value)) return NONE;
  if (json_is_integer(value)) return WHOLE;
  if (json_is_array(value) || !stf_report_is_number(value)) return TEXT;
  return (size_t)(precision + (conversion == 'g'   ? 6
                               : conversion == 'e' ? 7
                                                   : 5)); /* -1.2e-05 */
}

void stf_report_number(char *out, size_t size, char conversion, int precision, double value)
{
  if (isnan(value))
    snprintf(out, size, "nan");
  else if (isinf(value))
    snprintf(out, size, value > 0 ? "inf" : "-inf");
  else if (conversion == 'e')
    snprintf(out, size, "%.*e", precision, value);
  else if (conversion == 'f')
    snprintf(out, size, "%.*f", precision, value);
  else
    snprintf(out, size, "%.*g", precision, value);
  const char point = *localeconv()->decimal_point;
  char *found = point == '.' ? NULL : strchr(out, point);
  if (found) *found = '.';
}

size_t stf_report_width(const char *text)
{
  size_t width = 0;
  for (; *text; text++) width += (*text & 0xC0) != 0x80;
  return width;
}

/* A huge number with a fixed number of decimals would fill the line. */
static void real(char *out, size_t size, const char *key, double value)
{
  char conversion;
  int precision;
  locate(key, &conversion, &precision);
  if (conversion == 'f' && fabs(value) >= 1e6) {
    conversion = 'g';
    precision = 6;
  }
  stf_report_number(out, size, conversion, precision, value);
}

enum { SHOWN = 12 };

static void list(char *out, size_t size, const char *key, const json_t *value)
{
  const size_t count = json_array_size(value);
  const char *rule = key && strcmp(key, "exact") ? key : NULL; /* beside computed values */
  const bool words =
    json_is_string(json_array_get(value, 0)) && !stf_report_is_number(json_array_get(value, 0));
  size_t used = 0;
  *out = 0;
  for (size_t i = 0; i < count && used < size; i++) {
    char entry[128];
    if (i == SHOWN && !words) {
      snprintf(out + used, size - used, " ... (%zu)", count);
      return;
    }
    stf_report_cell(entry, sizeof entry, rule, json_array_get(value, i));
    used += (size_t)snprintf(out + used, size - used, "%s%s",
                             i == 0  ? ""
                             : words ? ", "
                                     : " ",
                             entry);
  }
}

/* The first row of a sheet has no observed order. */
static void text(char *out, size_t size, const char *key, const char *value)
{
  const bool none = key && !strcmp(key, "order") && !strcmp(value, "nan");
  snprintf(out, size, "%s", none ? "-" : value);
}

void stf_report_cell(char *out, size_t size, const char *key, const json_t *value)
{
  *out = 0;
  if (json_is_null(value))
    snprintf(out, size, "-");
  else if (json_is_boolean(value))
    snprintf(out, size, json_is_true(value) ? "yes" : "no");
  else if (json_is_integer(value))
    snprintf(out, size, "%" JSON_INTEGER_FORMAT, json_integer_value(value));
  else if (json_is_real(value))
    real(out, size, key, json_real_value(value));
  else if (json_is_string(value))
    text(out, size, key, json_string_value(value));
  else if (json_is_array(value))
    list(out, size, key, value);
  else if (value)
    snprintf(out, size, "{...}");
}
