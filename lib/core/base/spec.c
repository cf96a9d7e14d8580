/* spec.c: "radau:s=5,start=cq" into a name and parameters, and the nearest of some names.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "base.h"
#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool letter(char c)
{
  return isalnum((unsigned char)c) || c == '.' || c == '-' || c == '+' || c == '_';
}

enum { PLAIN, KEY, VALUE };

/* Keys are names, of a model in any script; values may be paths. */
static bool belongs(char c, int to)
{
  return letter(c) || (to == KEY && (unsigned char)c >= 0x80) || (to == VALUE && c == '/');
}

/* Copy a word from *at into out; false when it is empty or too long. */
static bool word(const char **at, char *out, size_t room, int kind)
{
  size_t used = 0;
  while (belongs(**at, kind) && used < room - 1) out[used++] = *(*at)++;
  out[used] = 0;
  return used > 0 && !belongs(**at, kind);
}

static bool parameter(const char **at, steif_spec *spec)
{
  if (spec->count == STEIF_SPEC_PARAMS) return false;
  char *key = spec->param[spec->count].key, *value = spec->param[spec->count].value;
  if (!word(at, key, STEIF_SPEC_KEY, KEY)) return false;
  if (**at == '=') {
    ++*at;
    if (!word(at, value, STEIF_SPEC_VALUE, VALUE)) return false;
  } else {
    strcpy(value, key);
    *key = 0;
  }
  for (int i = 0; i < spec->count; i++)
    if (!strcmp(spec->param[i].key, key)) return false;
  spec->count++;
  return true;
}

int steif_spec_parse(steif_context *ctx, const char *text, steif_spec *spec)
{
  STEIF_CHECK(spec && text, ctx, STEIF_BAD_INPUT, "a spec and a text are needed, got NULL");
  spec->count = 0;
  *spec->name = 0;
  const char *at = text;
  bool good = word(&at, spec->name, STEIF_SPEC_WORD, PLAIN);
  for (char mark = ':'; good && *at; mark = ',')
    good = *at == mark && (at++, parameter(&at, spec));
  STEIF_CHECK(
    good, ctx, STEIF_BAD_INPUT,
    "cannot read '%.60s' near position %d: write name:key=value,key=value with words of "
    "letters, digits and . - + _ (values also /), each key once, at most %d parameters",
    text, (int)(at - text), STEIF_SPEC_PARAMS);
  return STEIF_OK;
}

const char *stf_spec_word(const steif_spec *spec, const char *key)
{
  for (int i = 0; i < spec->count; i++)
    if (!strcmp(spec->param[i].key, key)) return spec->param[i].value;
  return NULL;
}

int stf_spec_real(steif_context *ctx, const steif_spec *spec, const char *key,
                  sunrealtype lowest, sunrealtype highest, sunrealtype fallback,
                  sunrealtype *value)
{
  const char *text = stf_spec_word(spec, key);
  *value = fallback;
  if (!text) return STEIF_OK;
  char *end;
  const double x = strtod(text, &end);
  STEIF_CHECK(!*end && isfinite(x) && x >= lowest && x <= highest, ctx, STEIF_BAD_INPUT,
              "parameter %s=%s of '%s' must be a number from %g to %g", key, text, spec->name,
              lowest, highest);
  *value = x;
  return STEIF_OK;
}

int stf_spec_int(steif_context *ctx, const steif_spec *spec, const char *key, int lowest,
                 int highest, int fallback, int *value)
{
  const char *text = stf_spec_word(spec, key);
  *value = fallback;
  if (!text) return STEIF_OK;
  char *end;
  const double x = strtod(text, &end);
  STEIF_CHECK(!*end && x >= lowest && x <= highest && x == floor(x), ctx, STEIF_BAD_INPUT,
              "parameter %s=%s of '%s' must be a whole number from %d to %d", key, text,
              spec->name, lowest, highest);
  *value = (int)x;
  return STEIF_OK;
}

static bool listed(const char *key, const char *const *keys)
{
  for (; *keys; keys++)
    if (!strcmp(*keys, key)) return true;
  return false;
}

int stf_spec_only(steif_context *ctx, const steif_spec *spec, const char *const *keys)
{
  for (int i = 0; i < spec->count; i++) {
    if (listed(spec->param[i].key, keys)) continue;
    char known[200] = "";
    for (const char *const *k = keys; *k; k++)
      if (**k && strlen(known) + strlen(*k) + 2 < sizeof known)
        strcat(strcat(known, *known ? ", " : ""), *k);
    return STEIF_FAIL(
      ctx, STEIF_UNKNOWN_NAME, "'%s' has no parameter '%s'; it takes %s", spec->name,
      *spec->param[i].key ? spec->param[i].key : spec->param[i].value, *known ? known : "none");
  }
  return STEIF_OK;
}

static bool same(char a, char b)
{
  return tolower((unsigned char)a) == tolower((unsigned char)b);
}

/* Letters left out, added, changed or swapped with their neighbours; words cut at the length of a spec word.
 * Capitals count once in all: 'BDF' is 1 away from 'bdf'. */
int stf_distance(const char *a, const char *b)
{
  int rows[3][STEIF_SPEC_WORD + 1], *before = rows[0], *above = rows[1], *row = rows[2];
  const int m = (int)strnlen(a, STEIF_SPEC_WORD), n = (int)strnlen(b, STEIF_SPEC_WORD);
  for (int j = 0; j <= n; j++) row[j] = j;
  for (int i = 1; i <= m; i++) {
    int *const oldest = before;
    before = above, above = row, row = oldest;
    row[0] = i;
    for (int j = 1; j <= n; j++) {
      const int change = above[j - 1] + !same(a[i - 1], b[j - 1]);
      int best = above[j] < row[j - 1] ? above[j] + 1 : row[j - 1] + 1;
      const bool swapped =
        i > 1 && j > 1 && same(a[i - 1], b[j - 2]) && same(a[i - 2], b[j - 1]);
      if (swapped && before[j - 2] + 1 < best) best = before[j - 2] + 1;
      row[j] = change < best ? change : best;
    }
  }
  return row[n] == 0 && strncmp(a, b, STEIF_SPEC_WORD) ? 1 : row[n];
}

const char *stf_nearest(const char *wrong, const void *list, size_t count, size_t stride)
{
  const char *best = NULL;
  int least = 0;
  for (size_t i = 0; i < count; i++) {
    const char *name;
    memcpy(&name, (const char *)list + i * stride, sizeof name);
    const int d = stf_distance(wrong, name);
    if (!best || d < least) best = name, least = d;
  }
  return best && stf_near(wrong, best) ? best : NULL;
}

bool stf_near(const char *wrong, const char *name)
{
  const int m = (int)strnlen(wrong, STEIF_SPEC_WORD), n = (int)strnlen(name, STEIF_SPEC_WORD);
  return stf_distance(wrong, name) <= ((m > n ? m : n) + 3) / 3;
}

const char *stf_guess(const char *wrong, const void *list, size_t count, size_t stride,
                      char text[STF_GUESS])
{
  const char *near = stf_nearest(wrong, list, count, stride);
  text[0] = 0;
  if (near) snprintf(text, STF_GUESS, "; did you mean '%.*s'?", STEIF_SPEC_WORD, near);
  return text;
}
