/* request.c: the words of `solve` and `compare` over ranks.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "over_ranks.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int object(const request *r, const char *format, ...)
{
  va_list list;
  va_start(list, format);
  if (r->rank == 0) {
    fprintf(stderr, "steif %s --parallel: ", r->verb ? r->verb : "solve");
    vfprintf(stderr, format, list);
    fputc('\n', stderr);
  }
  va_end(list);
  return USAGE;
}

/* A positive number and what is after it; 0: there is none. */
static double positive(const char **text)
{
  char *end = NULL;
  const double x = strtod(*text, &end);
  const bool good = end > *text && x > 0 && isfinite(x);
  *text = end;
  return good ? x : 0;
}

/* One number, or up to TOLERANCES of them with commas between. */
static int read_numbers(request *r, const char *name, const char *text, double *value,
                        int *count)
{
  const char *at = text;
  const int most = *count;
  for (*count = 0; *count < most; at++) {
    value[*count] = positive(&at);
    if (!(value[*count] > 0)) break;
    ++*count;
    if (*at == 0) return FINE;
    if (*at != ',') break;
  }
  return object(r, "%s needs %s, not \"%s\" [STEIF_BAD_INPUT]", name,
                most > 1 ? "positive numbers, R,R,..., at most 16" : "a positive number", text);
}

static int read_option(request *r, int argc, char **argv, int *i)
{
  const bool comparing = !strcmp(r->verb, "compare");
  const struct {
    const char *name;
    double *value;
  } numbers[] = {{"--rtol", r->rtol}, {"--atol", &r->atol}, {"--h", &r->h}, {"--t1", &r->t1}};
  const char *word = argv[*i], *next = *i + 1 < argc ? argv[*i + 1] : "";
  if (!strcmp(word, "--parallel")) return FINE;
  if (!strcmp(word, "--json")) return r->json = true, FINE;
  if (comparing && !strcmp(word, "--rtols")) {
    ++*i;
    r->tolerances = TOLERANCES;
    return read_numbers(r, word, next, r->rtol, &r->tolerances);
  }
  for (int k = 0; k < 4; k++)
    if (!strcmp(word, numbers[k].name)) {
      int one = 1;
      ++*i;
      if (k == 0) r->tolerances = 1;
      return read_numbers(r, word, next, numbers[k].value, &one);
    }
  if (!strcmp(word, "--linear")) {
    if (!*next || *next == '-')
      return object(r, "--linear needs a solver: amg, mumps or krylov [STEIF_BAD_INPUT]");
    r->linear = argv[++*i];
    return FINE;
  }
  return object(r,
                "no option %s over ranks; there are --rtol%s, --atol, --h, --t1, "
                "--linear amg|mumps|krylov, --json [STEIF_UNKNOWN_NAME]",
                word, comparing ? "s" : "");
}

static int read_word(request *r, const char *word)
{
  const int most = strcmp(r->verb, "compare") ? 1 : METHODS;
  if (!r->problem) return r->problem = word, FINE;
  if (r->methods < most) return r->method[r->methods++] = word, FINE;
  if (most == 1 && strstr(r->method[0], ".mtx"))
    return object(
      r,
      "matrices of two files are not solved over ranks, \"%s\" and \"%s\": write a "
      "model of them (form descriptor), or leave --parallel out [STEIF_UNSUPPORTED]",
      r->problem, r->method[0]);
  return object(r, "\"%s\" is one word too many [STEIF_BAD_INPUT]", word);
}

int request_read(request *r, int argc, char **argv)
{
  r->verb = argc > 1 ? argv[1] : "";
  if (strcmp(r->verb, "solve") && strcmp(r->verb, "compare"))
    return object(
      r,
      "the verbs solve, compare, sweep, impulse and pencil run over ranks [STEIF_UNSUPPORTED]");
  for (int i = 2; i < argc; i++) {
    const int code = argv[i][0] == '-' ? read_option(r, argc, argv, &i) : read_word(r, argv[i]);
    if (code) return code;
  }
  if (r->problem && !r->methods && strcmp(r->verb, "compare")) r->method[r->methods++] = "auto";
  if (r->methods) return FINE;
  return object(r, "steif %s PROBLEM %s --parallel [STEIF_BAD_INPUT]", r->verb,
                strcmp(r->verb, "compare") ? "[METHOD]" : "METHOD ...");
}

int exit_of_code(int code)
{
  switch (code) {
  case STEIF_OK: return FINE;
  case STEIF_BAD_INPUT:
  case STEIF_UNKNOWN_NAME:
  case STEIF_UNSUPPORTED: return USAGE;
  case STEIF_IO: return FILES;
  case STEIF_SINGULAR: return UNSOLVABLE;
  default: return FAILED;
  }
}
