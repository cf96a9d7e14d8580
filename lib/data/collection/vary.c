/* vary.c: a problem with other values of its parameters.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "collection.h"
#include "model_file.h"
#include <math.h>
#include <steif/parameters.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The number of a name among the parameters; -1: it is none of them. */
static int place_of(const steif_problem *p, const char *name)
{
  const steif_parameters *q = p->parameters;
  char numbered[STEIF_SPEC_WORD];
  for (int k = 0; q && k < q->count; k++) {
    snprintf(numbered, sizeof numbered, "p%d", k + 1);
    if (!strcmp(q->name ? q->name[k] : numbered, name)) return k;
  }
  return -1;
}

/* A parameter of the spec: another value, or one more. */
static int set_word(steif_context *ctx, steif_spec *spec, const char *name, sunrealtype value)
{
  int k = 0;
  while (k < spec->count && strcmp(spec->param[k].key, name)) k++;
  STEIF_CHECK(k < STEIF_SPEC_PARAMS && strlen(name) < STEIF_SPEC_KEY, ctx, STEIF_UNKNOWN_NAME,
              "problem '%s' has no parameter '%.40s'", spec->name, name);
  snprintf(spec->param[k].key, sizeof spec->param[k].key, "%s", name);
  snprintf(spec->param[k].value, sizeof spec->param[k].value, "%.17g", value);
  spec->count += k == spec->count;
  return STEIF_OK;
}

static size_t written(const steif_spec *spec, char *text, size_t room)
{
  size_t used = (size_t)snprintf(text, room, "%s", spec->name);
  for (int k = 0; k < spec->count; k++) {
    const bool bare = !spec->param[k].key[0];
    const size_t left = used < room ? room - used : 0;
    used += (size_t)snprintf(left ? text + used : NULL, left, "%c%s%s%s", k ? ',' : ':',
                             spec->param[k].key, bare ? "" : "=", spec->param[k].value);
  }
  return used;
}

static int find_again(steif_context *ctx, const steif_spec *spec, steif_problem *out)
{
  const size_t length = written(spec, NULL, 0);
  char *text = stf_allocate(ctx, length + 1, 1);
  if (!text) return STEIF_NO_MEMORY;
  written(spec, text, length + 1);
  const int code = steif_problem_find(ctx, text, out);
  stf_release(ctx, text);
  return code;
}

/* The first of the names that are no parameters of `like` that its spec does not take: each of them alone. */
static int no_parameter(steif_context *ctx, const steif_problem *like, int count,
                        const char *const *name, const sunrealtype *value)
{
  int code = STEIF_OK;
  for (int i = 0; i < count && code != STEIF_UNKNOWN_NAME; i++) {
    steif_spec spec;
    steif_problem alone;
    if (place_of(like, name[i]) >= 0) continue;
    STEIF_TRY(steif_spec_parse(ctx, like->name, &spec));
    code = set_word(ctx, &spec, name[i], value[i]);
    if (!code) code = find_again(ctx, &spec, &alone);
    if (!code) steif_problem_clear(ctx, &alone);
    if (code == STEIF_UNKNOWN_NAME && like->parameters)
      steif_parameter_find(ctx, like, name[i]); /* these are meant: the nearest of them */
  }
  return code;
}

/* Are these words in the spec, with their values? */
static bool says(const steif_spec *spec, const char *name, sunrealtype value)
{
  const char *word = stf_spec_word(spec, name);
  return word && strtod(word, NULL) == value;
}

/* Names that *out has not are words of the spec, which takes them or says why not: a parameter that `like` has may
 * be missing where another word of the spec has changed the form. */
static int find_with_all(steif_context *ctx, steif_spec *spec, int count,
                         const char *const *name, const sunrealtype *value, steif_problem *out)
{
  for (bool more = true; more;) {
    more = false;
    STEIF_TRY(find_again(ctx, spec, out));
    for (int i = 0; i < count; i++) {
      if (place_of(out, name[i]) >= 0 || says(spec, name[i], value[i])) continue;
      const int code = set_word(ctx, spec, name[i], value[i]);
      if (code) steif_problem_clear(ctx, out);
      STEIF_TRY(code);
      more = true;
    }
    if (more) steif_problem_clear(ctx, out);
  }
  return STEIF_OK;
}

/* What was published belongs to the values that the problem comes with. */
static int set_values(steif_context *ctx, steif_problem *p, int count, const char *const *name,
                      const sunrealtype *value)
{
  for (int i = 0; i < count; i++) {
    const int k = place_of(p, name[i]);
    if (k < 0 || p->parameters->value[k] == value[i]) continue;
    STEIF_TRY(steif_parameter_set(ctx, p, k, value[i]));
    p->reference = NULL;
    p->exact = NULL;
  }
  return STEIF_OK;
}

static int vary_spec(steif_context *ctx, const steif_problem *like, int count,
                     const char *const *name, const sunrealtype *value, steif_problem *out)
{
  steif_spec spec;
  STEIF_TRY(steif_spec_parse(ctx, like->name, &spec));
  for (int i = 0; i < count; i++)
    if (place_of(like, name[i]) < 0) {
      STEIF_CHECK(like->build, ctx, STEIF_UNKNOWN_NAME, "problem '%s' has no parameter '%.40s'",
                  like->name, name[i]);
      STEIF_TRY(set_word(ctx, &spec, name[i], value[i]));
    }
  int code = find_with_all(ctx, &spec, count, name, value, out);
  if (code == STEIF_UNKNOWN_NAME) {
    const int why = no_parameter(ctx, like, count, name, value);
    return why ? why : find_with_all(ctx, &spec, count, name, value, out);
  }
  if (!code) code = set_values(ctx, out, count, name, value);
  if (code) steif_problem_clear(ctx, out);
  return code;
}

int steif_problem_vary(steif_context *ctx, const steif_problem *like, int count,
                       const char *const *name, const sunrealtype *value, steif_problem *out)
{
  STEIF_CHECK(like && like->name && out && out != like && count >= 0 &&
                (count == 0 || (name && value)),
              ctx, STEIF_BAD_INPUT,
              "a problem, names and values of its parameters and another place are needed");
  *out = (steif_problem){0};
  for (int i = 0; i < count; i++)
    STEIF_CHECK(isfinite(value[i]), ctx, STEIF_BAD_INPUT, "parameter %s=%g must be finite",
                name[i], value[i]);
  return stf_model_is(like) ? stf_model_vary(ctx, like, count, name, value, out)
                            : vary_spec(ctx, like, count, name, value, out);
}
