/* option_values.c: values of options: what they must be, and what they are.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "command_line.h"
#include <stdlib.h>
#include <string.h>

static bool is_real(const char *text, bool positive)
{
  char *end;
  const double value = strtod(text, &end);
  return end != text && !*end && value - value == 0 && (!positive || value > 0);
}

static bool is_whole(const char *text, long lowest)
{
  char *end;
  const long value = strtol(text, &end, 10);
  return end != text && !*end && value >= lowest && value <= 1000000000;
}

static bool are_reals(const char *text, bool positive)
{
  for (size_t count = 0; count < REALS_MOST; count++) {
    char one[64];
    const size_t length = strcspn(text, ",");
    if (length >= sizeof one) return false;
    memcpy(one, text, length);
    one[length] = 0;
    if (!is_real(one, positive)) return false;
    if (!text[length]) return true;
    text += length + 1;
  }
  return false;
}

int word_place(const char *words, const char *text)
{
  int place = 0;
  for (const char *at = words; *at; place++) {
    const size_t length = strcspn(at, "|");
    if (strlen(text) == length && !strncmp(at, text, length)) return place;
    at += length + (at[length] == '|');
  }
  return -1;
}

const char *option_objection(const struct option *o, const char *text)
{
  switch (o->kind) {
  case REAL: return is_real(text, false) ? NULL : "a finite number";
  case POSITIVE: return is_real(text, true) ? NULL : "a finite number above 0";
  case NATURAL: return is_whole(text, 0) ? NULL : "a whole number from 0 to 1000000000";
  case COUNT: return is_whole(text, 1) ? NULL : "a whole number from 1 to 1000000000";
  case REALS:
    return are_reals(text, true) ? NULL : "numbers above 0 separated by commas, at most 32";
  case TIMES: return are_reals(text, false) ? NULL : "times separated by commas, at most 32";
  case CHOICE: return word_place(o->argument, text) >= 0 ? NULL : o->argument;
  case WORD:
  case REPEATED: return *text ? NULL : "a word";
  case OUTPUT: return *text ? NULL : "a file name";
  default: return NULL;
  }
}

/* ---- the values of a call ---- */

static const char *text_of(const struct call *call, const char *name)
{
  for (int i = 0; i < call->options; i++)
    if (!strcmp(call->given[i].option->name, name)) return call->given[i].text;
  return NULL;
}

const char *repeated_of(const struct call *call, const char *name, int i)
{
  for (int k = 0; k < call->options; k++)
    if (!strcmp(call->given[k].option->name, name) && !i--) return call->given[k].text;
  return NULL;
}

bool given(const struct call *call, const char *name) { return text_of(call, name); }

const char *word_of(const struct call *call, const char *name)
{
  const char *text = text_of(call, name);
  const struct option *o;
  for (size_t i = 0; !text && (o = option_at(call->verb, i)); i++)
    if (!strcmp(o->name, name)) return o->fallback;
  return text;
}

double real_of(const struct call *call, const char *name)
{
  const char *text = word_of(call, name);
  return text ? strtod(text, NULL) : 0;
}

long whole_of(const struct call *call, const char *name)
{
  const char *text = word_of(call, name);
  return text ? strtol(text, NULL, 10) : 0;
}

double real_or(const struct call *call, const char *name, double otherwise)
{
  return given(call, name) ? real_of(call, name) : otherwise;
}

long whole_or(const struct call *call, const char *name, long otherwise)
{
  return given(call, name) ? whole_of(call, name) : otherwise;
}

int choice_of(const struct call *call, const char *name)
{
  const char *text = word_of(call, name);
  const struct option *o;
  for (size_t i = 0; text && (o = option_at(call->verb, i)); i++)
    if (!strcmp(o->name, name)) return word_place(o->argument, text);
  return 0;
}

size_t reals_of(const struct call *call, const char *name, double *value)
{
  const char *text = word_of(call, name);
  size_t count = 0;
  while (text && *text && count < REALS_MOST) {
    char *end;
    value[count++] = strtod(text, &end);
    text = *end == ',' ? end + 1 : end;
  }
  return count;
}
