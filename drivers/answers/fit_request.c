/* fit_request.c: parameters with start values and bounds as a command line has them, and the measurements.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fitted.h"
#include "attributes.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

const char *fitted_name(const struct fitted *a, int i, char *room)
{
  const steif_parameters *q = a->problem->parameters;
  if (q->name) return q->name[a->parameter[i]];
  snprintf(room, STEIF_SPEC_WORD, "p%d", a->parameter[i] + 1);
  return room;
}

/* "NAME=TEXT" of a list at *at, which goes past it: EXIT_OK, with text "" where there is no "=". */
static int item(struct call *call, const char *option, const char **at, char *name, char *text)
{
  const size_t length = strcspn(*at, ",");
  const char *equals = memchr(*at, '=', length);
  const size_t head = equals ? (size_t)(equals - *at) : length;
  const size_t tail = equals ? length - head - 1 : 0;
  if (head == 0 || head >= STEIF_SPEC_KEY || tail >= STEIF_SPEC_KEY)
    return bad_usage(call, "%s: \"%.*s\" is not NAME=VALUE", option, (int)length, *at);
  snprintf(name, STEIF_SPEC_KEY, "%.*s", (int)head, *at);
  snprintf(text, STEIF_SPEC_KEY, "%.*s", (int)tail, equals ? equals + 1 : "");
  *at += length + ((*at)[length] == ',');
  return EXIT_OK;
}

static int number(struct call *call, const char *option, const char *text, double *value)
{
  char *end;
  *value = strtod(text, &end);
  return end > text && !*end && isfinite(*value)
           ? EXIT_OK
           : bad_usage(call, "%s: \"%s\" is not a number", option, text);
}

static void add(struct fitted *a, int k, double start)
{
  a->parameter[a->count] = k, a->start[a->count] = start;
  a->low[a->count] = -INFINITY, a->high[a->count] = INFINITY;
  a->count++;
}

static int named(struct call *call, struct fitted *a, const char *list)
{
  char name[STEIF_SPEC_KEY], text[STEIF_SPEC_KEY];
  for (const char *at = list; *at;) {
    int code = item(call, "--parameters", &at, name, text);
    if (code) return code;
    int wrong;
    const int k = parameter_of(call, a->problem, name, &wrong);
    if (k < 0) return wrong;
    double start = a->problem->parameters->value[k];
    if (*text && (code = number(call, "--parameters", text, &start))) return code;
    if (a->count == FITTED) return bad_usage(call, "--parameters names more than %d", FITTED);
    add(a, k, start);
  }
  return EXIT_OK;
}

/* Those that the model names. */
static int by_model(struct call *call, struct fitted *a)
{
  const char *name;
  for (size_t i = 0; (name = steif_model_fitted(a->problem, i)); i++) {
    int wrong;
    const int k = parameter_of(call, a->problem, name, &wrong);
    if (k < 0) return wrong;
    if (a->count == FITTED) return bad_usage(call, "the model names more than %d", FITTED);
    add(a, k, a->problem->parameters->value[k]);
  }
  return EXIT_OK;
}

static steif_model_data said(const struct call *call, const struct fitted *a)
{
  steif_model_data data = {0};
  steif_model_data_find(call->ctx, a->problem, &data);
  return data;
}

const char *fitted_data(const struct call *call, const struct fitted *a)
{
  const char *path = word_of(call, "--data");
  return path ? path : said(call, a).path;
}

static int file(struct call *call, struct fitted *a)
{
  if (!fitted_data(call, a))
    return bad_usage(
      call,
      "--data FILE.csv is needed: '%s' names no measurements, as a model does by "
      "data \"FILE.csv\"",
      call->word[0]);
  a->log = said(call, a).log && !given(call, "--linear");
  return EXIT_OK;
}

static int choose(struct call *call, struct fitted *a)
{
  const char *list = word_of(call, "--parameters");
  const steif_parameters *q = a->problem->parameters;
  if (!q || q->count < 1) return no_parameters(call, a->problem);
  if (!given(call, "--parameters") && steif_model_fitted(a->problem, 0))
    return by_model(call, a);
  if (strcmp(list, "all")) return named(call, a, list);
  if (q->count > FITTED)
    return bad_usage(call, "problem '%s' has %d parameters, more than %d: name some",
                     call->word[0], q->count, FITTED);
  for (int k = 0; k < q->count; k++) add(a, k, q->value[k]);
  return EXIT_OK;
}

/* "A:B", either of which may be missing. */
static int bound(struct call *call, struct fitted *a, int i, char *text)
{
  char *colon = strchr(text, ':');
  if (!colon) return bad_usage(call, "--bounds: \"%s\" is not A:B", text);
  *colon = 0;
  int code = *text ? number(call, "--bounds", text, &a->low[i]) : EXIT_OK;
  if (!code && colon[1]) code = number(call, "--bounds", colon + 1, &a->high[i]);
  return code;
}

static int bounds(struct call *call, struct fitted *a)
{
  char name[STEIF_SPEC_KEY], text[STEIF_SPEC_KEY];
  const char *list = word_of(call, "--bounds");
  for (const char *at = list ? list : ""; *at;) {
    int code = item(call, "--bounds", &at, name, text), i = 0;
    if (code) return code;
    int wrong;
    const int k = parameter_of(call, a->problem, name, &wrong);
    if (k < 0) return wrong;
    while (i < a->count && a->parameter[i] != k) i++;
    if (i == a->count) return bad_usage(call, "--bounds: %s is not fitted", name);
    if ((code = bound(call, a, i, text))) return code;
  }
  return EXIT_OK;
}

int fitted_ask(struct call *call, struct fitted *a)
{
  double sd[REALS_MOST];
  a->run = options_of(call);
  a->run.rtol = real_of(call, "--rtol");
  int code = file(call, a);
  if (!code) code = choose(call, a);
  if (!code) code = bounds(call, a);
  if (code) return code;
  const size_t count = given(call, "--sd") ? reals_of(call, "--sd", sd) : 0;
  return steif_measurements_read(call->ctx, a->problem, word_of(call, "--data"), a->run.t1,
                                 given(call, "--repeated"), (int)count, count ? sd : NULL,
                                 &a->data)
           ? fail_file(call)
           : EXIT_OK;
}
