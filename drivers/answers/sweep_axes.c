/* sweep_axes.c: ranges of parameters, and the parameters of a member.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "problem.h"
#include "sweep.h"
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char ranges[] = "NAME=FROM:TO:COUNT, NAME=FROM:TO:COUNT:log or NAME=V,V,...",
                  at_random[] = "NAME=FROM:TO, NAME=FROM:TO:log or NAME=V,V,...";

static int wrong(const struct call *call, const char *text, bool random)
{
  return bad_usage(call, "--p is \"%s\" and must be %s", text, random ? at_random : ranges);
}

/* Also with the digits that a double leaves out. */
static bool number(const char **at, double *value, long double *longer)
{
  char *end;
  *value = strtod(*at, &end);
  *longer = strtold(*at, NULL);
  const bool good = end != *at && isfinite(*value);
  *at = end;
  return good;
}

static int read_list(const struct call *call, const char *text, const char *at, bool random,
                     struct axis *a)
{
  long double longer;
  a->list = true;
  do {
    if (a->count == AXIS_VALUES)
      return bad_usage(call, "--p %s lists more than %d values; give a range", a->name,
                       AXIS_VALUES);
    if (!number(&at, &a->value[a->count++], &longer)) return wrong(call, text, random);
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
  if (!number(&at, &a->from, &a->decimal[0]) || *at++ != ':' ||
      !number(&at, &a->to, &a->decimal[1]))
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
    const char *other = value_given(call, call->word[0], own->name);
    if (other)
      return bad_usage(call, "%s is given twice, %s and by --p; leave one of them out",
                       own->name, other);
    a->name[a->count] = own->name;
  }
  return count_members(call, a);
}

/* Exponents of ten of points between the ends: exact where these are decades apart. Nothing overflows, whatever a long
 * double is. */
static double between_logs(const struct axis *a, double j, double m)
{
  const long double from = a->decimal[0], to = a->decimal[1];
  long double decades = log10l(to) - log10l(from);
  const long double nearest = roundl(decades);
  if (fabsl(decades - nearest) <= 4 * LDBL_EPSILON * (fabsl(log10l(to)) + fabsl(log10l(from))))
    decades = nearest;
  const long double exponent = decades * (long double)j / (long double)m;
  const long double ratio = powl(10, exponent), half = powl(10, exponent / 2);
  return (double)(ratio > LDBL_MIN && ratio < LDBL_MAX ? from * ratio : from * half * half);
}

/* Point j of 0 .. m. The ends are met exactly, and mean the decimals that were written: between them these are kept with
 * the digits of a long double, so that decimal fractions and decades come out as their nearest doubles. */
static double between(const struct axis *a, double j, double m)
{
  if (j == 0 || j == m) return j == 0 ? a->from : a->to;
  if (a->log) return between_logs(a, j, m);
  const bool huge = fmax(fabs(a->from), fabs(a->to)) > 1e280;
  const long double scale = huge ? 0x1p-64L : 1;
  return (double)(((m - j) * (scale * a->decimal[0]) + j * (scale * a->decimal[1])) / m /
                  scale);
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
