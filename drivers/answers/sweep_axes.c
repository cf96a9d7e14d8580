/* sweep_axes.c: ranges of parameters, and the parameters of a member.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "sweep.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char ranges[] = "NAME=FROM:TO:COUNT, NAME=FROM:TO:COUNT:log or NAME=V,V,...",
                  at_random[] = "NAME=FROM:TO, NAME=FROM:TO:log or NAME=V,V,...";

static int wrong(const struct call *call, const char *text, bool random)
{
  return bad_usage(call, "--p is \"%s\" and must be %s", text, random ? at_random : ranges);
}

static bool number(const char **at, double *value)
{
  char *end;
  *value = strtod(*at, &end);
  const bool good = end != *at && isfinite(*value);
  *at = end;
  return good;
}

static int read_list(const struct call *call, const char *text, const char *at, bool random,
                     struct axis *a)
{
  a->list = true;
  do {
    if (a->count == AXIS_VALUES)
      return bad_usage(call, "--p %s lists more than %d values; give a range", a->name,
                       AXIS_VALUES);
    if (!number(&at, &a->value[a->count++])) return wrong(call, text, random);
  } while (*at++ == ',');
  return at[-1] ? wrong(call, text, random) : EXIT_OK;
}

/* ":COUNT" unless random, then ":log" or nothing. */
static int read_rest(const struct call *call, const char *text, const char *at, bool random,
                     struct axis *a)
{
  if (!random) {
    char *end;
    if (*at != ':') return wrong(call, text, random);
    a->count = strtol(at + 1, &end, 10);
    if (end == at + 1) return wrong(call, text, random);
    if (a->count < 1)
      return bad_usage(call, "--p \"%s\" has no members; COUNT is 1 at least", text);
    at = end;
  }
  a->log = !strcmp(at, ":log");
  if (*at && !a->log) return wrong(call, text, random);
  if (a->log && (a->from <= 0 || a->to <= 0))
    return bad_usage(call, "--p \"%s\": the ends of a logarithmic range lie above 0", text);
  return EXIT_OK;
}

static int read_axis(const struct call *call, const char *text, bool random, struct axis *a)
{
  const size_t length = strcspn(text, "=");
  const char *at = text + length + 1;
  if (!length || !text[length] || length >= sizeof a->name) return wrong(call, text, random);
  memcpy(a->name, text, length);
  if (!strchr(at, ':')) return read_list(call, text, at, random, a);
  if (!number(&at, &a->from) || *at++ != ':' || !number(&at, &a->to))
    return wrong(call, text, random);
  return read_rest(call, text, at, random, a);
}

/* Chunks of 64, at most 2^31 of them. */
static const long long most = 64LL << 31;

static int count_members(const struct call *call, struct axes *a)
{
  a->members = a->random ? whole_of(call, "--random") : 1;
  for (int k = 0; k < a->count && !a->random; k++) {
    if (a->axis[k].count > most / a->members)
      return bad_usage(call,
                       "the product of the ranges has more than %lld members; take "
                       "smaller COUNTs or --random",
                       most);
    a->members *= a->axis[k].count;
  }
  return EXIT_OK;
}

int axes_read(const struct call *call, struct axes *a)
{
  a->random = given(call, "--random");
  a->seed = (unsigned long long)whole_of(call, "--seed");
  const char *text;
  for (; (text = repeated_of(call, "--p", a->count)); a->count++) {
    if (a->count == AXES)
      return bad_usage(call, "more than %d times --p; leave some out", AXES);
    struct axis *own = &a->axis[a->count];
    const int code = read_axis(call, text, a->random, own);
    if (code) return code;
    for (int k = 0; k < a->count; k++)
      if (!strcmp(own->name, a->name[k]))
        return bad_usage(call, "--p names %s twice; leave one of them out", own->name);
    a->name[a->count] = own->name;
  }
  return count_members(call, a);
}

/* Point j of 0 .. m; the ends are met exactly, and decimal fractions as far as doubles have them. */
static double between(const struct axis *a, double j, double m)
{
  if (j == 0 || j == m) return j == 0 ? a->from : a->to;
  return a->log ? a->from * pow(a->to / a->from, j / m) : ((m - j) * a->from + j * a->to) / m;
}

static double drawn(const struct axes *a, int k, long long i)
{
  const struct axis *axis = &a->axis[k];
  const unsigned long long counter =
    (unsigned long long)i * (unsigned long long)a->count + (unsigned long long)k;
  const double u = steif_ensemble_uniform(a->seed, counter);
  return axis->list ? axis->value[(long)(u * (double)axis->count)] : between(axis, u, 1);
}

void axes_at(const struct axes *a, long long i, double *value)
{
  for (int k = a->count; k-- > 0;) {
    const struct axis *axis = &a->axis[k];
    if (a->random) {
      value[k] = drawn(a, k, i);
      continue;
    }
    const long at = (long)(i % axis->count);
    i /= axis->count;
    value[k] = axis->list         ? axis->value[at]
               : axis->count == 1 ? axis->from
                                  : between(axis, (double)at, (double)(axis->count - 1));
  }
}
