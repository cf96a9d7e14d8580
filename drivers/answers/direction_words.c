/* direction_words.c: directions of parameters, a number for each that is named.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "direction_words.h"
#include "attributes.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static int read_one(struct call *call, const steif_problem *p, const char *option,
                    const char *word, size_t length, double *v)
{
  char name[STEIF_SPEC_KEY], *end;
  const char *equals = memchr(word, '=', length);
  const size_t before = equals ? (size_t)(equals - word) : length;
  if (!equals || before == 0 || before >= sizeof name)
    return bad_usage(call, "%s: '%.*s' is not NAME=NUMBER", option, (int)length, word);
  memcpy(name, word, before);
  name[before] = 0;
  int wrong;
  const int k = parameter_of(call, p, name, &wrong);
  if (k < 0) return wrong;
  v[k] = strtod(equals + 1, &end);
  if (end != word + length || end == equals + 1 || !isfinite(v[k]))
    return bad_usage(call, "%s: '%.*s' is not NAME=NUMBER", option, (int)length, word);
  return EXIT_OK;
}

int direction_read(struct call *call, const steif_problem *p, const char *option, double *v)
{
  const char *word = word_of(call, option);
  int code = EXIT_OK;
  while (!code && word) {
    const size_t length = strcspn(word, ",");
    code = read_one(call, p, option, word, length, v);
    word = word[length] ? word + length + 1 : NULL;
  }
  return code;
}
