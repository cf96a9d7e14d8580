/* attributes.c: lists of names become attributes of start values.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "attributes.h"
#include <ctype.h>
#include <stdlib.h>
#include <string.h>

enum { NOT_NAMED = -1, OBSTACLE = 400 };

static const struct {
  const char *option;
  enum steif_attribute attribute;
} lists[] = {{"--guess", STEIF_GUESS}, {"--fixed", STEIF_FIXED}, {"--free", STEIF_FREE}};

enum { LISTS = sizeof lists / sizeof *lists };

sunindextype unknown_of(const steif_problem *p, const char *name)
{
  const char *const *names = p->names ? p->names->unknown : NULL;
  for (sunindextype i = 0; names && i < p->n; i++)
    if (!strcmp(names[i], name)) return i;
  char *end;
  const long k = (name[0] == 'y' || name[0] == 'x') && isdigit((unsigned char)name[1])
                   ? strtol(name + 1, &end, 10)
                   : 0;
  return k >= 1 && k <= p->n && !*end ? k - 1 : -1;
}

int parameter_of(struct call *call, const steif_problem *p, const char *name, int *code)
{
  char why[OBSTACLE] = "";
  const int k = steif_parameter_find(call->ctx, p, name);
  if (k < 0) steif_model_obstacle(p, name, sizeof why, why);
  if (*why) *code = bad_usage(call, "parameter '%s' of '%s' %s", name, p->name, why);
  if (k < 0 && !*why) *code = fail(call);
  return k;
}

int no_parameters(struct call *call, const steif_problem *p)
{
  const char *known = steif_model_parameter(p, 0, NULL);
  char why[OBSTACLE] = "";
  if (known) steif_model_obstacle(p, known, sizeof why, why);
  return *why ? bad_usage(call, "parameter '%s' of '%s' %s", known, p->name, why)
              : bad_usage(
                  call,
                  "problem '%s' has no parameters: rober and chemakzo have, and models as text",
                  call->word[0]);
}

static int set(struct call *call, const steif_problem *p, int list, const char *name,
               int *attribute)
{
  const sunindextype i = unknown_of(p, name);
  if (i < 0)
    return bad_usage(call, "%s %s: '%s' has no such unknown; 'steif list %s' shows them",
                     lists[list].option, name, p->name, call->word[0]);
  if (attribute[i] != NOT_NAMED) return bad_usage(call, "start value %s is named twice", name);
  attribute[i] = (int)lists[list].attribute;
  return EXIT_OK;
}

static int read(struct call *call, const steif_problem *p, int list, int *attribute)
{
  char name[STEIF_SPEC_WORD];
  const char *at = word_of(call, lists[list].option);
  int code = EXIT_OK;
  while (at && *at && !code) {
    const size_t length = strcspn(at, ",");
    if (!length || length >= sizeof name)
      return bad_usage(call, "%s wants names of unknowns with commas between them",
                       lists[list].option);
    memcpy(name, at, length);
    name[length] = 0, at += length + (at[length] == ',');
    code = set(call, p, list, name, attribute);
  }
  return code;
}

static bool is_model(const char *word)
{
  const char *colon = strstr(word, ".steif");
  return !strcmp(word, "-") || (colon && (!colon[6] || colon[6] == ':'));
}

int attributes_of(struct call *call, const steif_problem *p, int **attributes)
{
  bool any = false;
  *attributes = NULL;
  for (int k = 0; k < LISTS; k++) any = any || given(call, lists[k].option);
  if (!any) return EXIT_OK;
  if (is_model(call->word[0]))
    return bad_usage(call, "a model marks its start values: y = 1 is fixed, y ~ 1 a guess, "
                           "y alone is computed");
  int *a = malloc((size_t)p->n * sizeof *a), code = EXIT_OK;
  if (!a) return no_memory(call, "attributes of start values", "free memory");
  for (sunindextype i = 0; i < p->n; i++) a[i] = NOT_NAMED;
  for (int k = 0; k < LISTS && !code; k++) code = read(call, p, k, a);
  for (sunindextype i = 0; i < p->n; i++)
    if (a[i] == NOT_NAMED) a[i] = (int)STEIF_GUESS;
  *attributes = a;
  return code;
}
