/* writer.c: a text that grows.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "native.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static void append(stf_writer *w, const char *text, size_t length)
{
  const size_t before = w->text.count;
  if (!w->code) w->code = stf_vector_resize(w->ctx, &w->text, before + length, 1);
  if (!w->code) memcpy((char *)w->text.data + before, text, length);
}

void stf_write(stf_writer *w, const char *format, ...)
{
  char line[1000];
  va_list values;
  va_start(values, format);
  const int length = vsnprintf(line, sizeof line, format, values);
  va_end(values);
  append(w, line, length < (int)sizeof line ? (size_t)length : sizeof line - 1);
}

void stf_write_text(stf_writer *w, const char *text) { append(w, text, strlen(text)); }

void stf_write_number(stf_writer *w, double value)
{
  if (isnan(value))
    stf_write(w, "NAN");
  else if (isinf(value))
    stf_write(w, value > 0 ? "INFINITY" : "-INFINITY");
  else if (value == floor(value) && fabs(value) < 1e15 && !(value == 0 && signbit(value)))
    stf_write(w, "%.1f", value);
  else
    stf_write(w, "%a", value);
}

void stf_write_plain(stf_writer *w, const char *text)
{
  for (; *text; text++) {
    const char c = *text;
    const bool plain = c >= ' ' && c < 127 && c != '*' && c != '\\' && c != '"' && c != '?' &&
                       c != '%' && c != '/';
    append(w, plain ? text : ".", 1);
  }
}

void stf_write_string(stf_writer *w, const char *text)
{
  append(w, "\"", 1);
  for (; *text; text++) {
    const unsigned char c = (unsigned char)*text;
    const bool plain = c >= ' ' && c < 127 && !strchr("\\\"?%", c);
    if (plain)
      append(w, text, 1);
    else
      stf_write(w, "\\%03o", c);
  }
  append(w, "\"", 1);
}

const char *stf_written(stf_writer *w)
{
  append(w, "", 1);
  return w->code ? NULL : w->text.data;
}
