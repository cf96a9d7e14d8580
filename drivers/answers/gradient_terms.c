/* gradient_terms.c: sums of components and of their squares.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "gradient_terms.h"
#include "attributes.h"
#include <ctype.h>
#include <stdlib.h>
#include <string.h>

/* [+-][number*]name[^2], from *at on. */
static bool term(const steif_problem *p, const char **at, struct sum *sum)
{
  const char *s = *at;
  char name[STEIF_SPEC_WORD];
  double factor = 1;
  if (*s == '+' || *s == '-') factor = *s++ == '-' ? -1 : 1;
  if (isdigit((unsigned char)*s) || *s == '.') {
    char *end;
    factor *= strtod(s, &end);
    if (*end != '*') return false;
    s = end + 1;
  }
  const size_t length = strcspn(s, "+-^*");
  if (!length || length >= sizeof name) return false;
  memcpy(name, s, length);
  name[length] = 0, s += length;
  const bool square = !strncmp(s, "^2", 2);
  if (square) s += 2;
  const int i = sum->count++;
  sum->term[i].factor = factor, sum->term[i].power = square ? 2 : 1;
  sum->term[i].component = unknown_of(p, name);
  *at = s;
  return sum->term[i].component >= 0 && (!*s || *s == '+' || *s == '-');
}

bool sum_read(const steif_problem *p, const char *text, struct sum *sum)
{
  sum->count = 0;
  bool good = *text;
  while (good && *text) good = sum->count < TERMS && term(p, &text, sum);
  return good;
}

double sum_at(const struct sum *sum, const double *y)
{
  double value = 0;
  for (int i = 0; i < sum->count; i++) {
    const double x = y[sum->term[i].component];
    value += sum->term[i].factor * (sum->term[i].power == 2 ? x * x : x);
  }
  return value;
}

void sum_slope(const struct sum *sum, const double *y, double *slope)
{
  for (int i = 0; i < sum->count; i++) {
    const sunindextype j = sum->term[i].component;
    slope[j] += sum->term[i].factor * (sum->term[i].power == 2 ? 2 * y[j] : 1);
  }
}
