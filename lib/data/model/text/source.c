/* source.c: places in texts, and the sentences about them.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "source.h"
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

const stf_text *stf_text_of(const stf_sources *s, uint32_t at)
{
  const stf_text *text = s->texts.data;
  for (size_t i = 1; i < s->texts.count; i++)
    if (at != STF_NOWHERE && STF_AT(s->texts, stf_text, i)->base <= at)
      text = STF_AT(s->texts, stf_text, i);
  return text;
}

const stf_text *stf_place(const stf_sources *s, uint32_t at, int *line, int *column)
{
  const stf_text *text = stf_text_of(s, at);
  *line = *column = 1;
  if (at == STF_NOWHERE || !text->text) return text;
  for (uint32_t i = 0; i < at - text->base && i < text->length; i++) {
    const unsigned char c = (unsigned char)text->text[i];
    if (c == '\n') {
      ++*line;
      *column = 1;
    } else {
      *column += (c & 0xC0) != 0x80;
    }
  }
  return text;
}

int stf_line_of(const stf_sources *s, uint32_t at)
{
  int line, column;
  stf_place(s, at, &line, &column);
  return line;
}

const char *stf_place_text(const stf_sources *s, uint32_t at, char *room, size_t size)
{
  int line, column;
  const stf_text *text = stf_place(s, at, &line, &column);
  if (s->pieces)
    snprintf(room, size, "expression %d, position %d", line, column);
  else if (at == STF_NOWHERE)
    snprintf(room, size, "%s", text->name);
  else
    snprintf(room, size, "%s:%d:%d", text->name, line, column);
  return room;
}

int stf_complain(stf_sources *s, uint32_t at, int code, const char *format, ...)
{
  char sentence[600], place[STF_TOLD];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(sentence, sizeof sentence, format, arguments);
  va_end(arguments);
  if (!s->errors++) s->code = code;
  if (s->errors > STF_ERRORS) return code;
  const size_t room = sizeof s->told - s->used;
  const int length = snprintf(s->told + s->used, room, "%s%s: %s", s->used ? "\n" : "",
                              stf_place_text(s, at, place, sizeof place), sentence);
  if (length >= 0 && (size_t)length < room)
    s->used += (size_t)length;
  else
    s->told[s->used ? s->used : sizeof s->told - 1] = 0;
  return code;
}

int stf_complaints(stf_sources *s)
{
  return s->errors ? STEIF_FAIL(s->ctx, s->code, "%s", s->told) : STEIF_OK;
}
