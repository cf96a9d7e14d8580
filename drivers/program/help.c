/* help.c: what steif VERB --help says, made from the table of the verb.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "command_line.h"
#include <stdio.h>
#include <string.h>

static void line(const struct option *o)
{
  enum { WIDTH = 28 }; /* of the first column; longer ones have a line of their own */
  char left[96];
  const int length = snprintf(left, sizeof left, "%s%s%s", o->name, o->argument ? " " : "",
                              o->argument ? o->argument : "");
  if (length > WIDTH)
    printf("  %s\n  %-*s ", left, WIDTH, "");
  else
    printf("  %-*s ", WIDTH, left);
  printf("%s", o->about);
  if (o->fallback) printf(" (default %s)", o->fallback);
  putchar('\n');
}

static const char method_help[] =
  "\n"
  "METHOD: a name that 'steif list methods' shows, or glm:file=PATH, a tableau in a text "
  "file:\n"
  "words xi, C, D, U and V before the matrices G = U X + h C F, X <- V X + h D F row by row, "
  "or\n"
  "A, b and c of a Runge-Kutta method, or alpha and beta of a multistep method (steif/glm.h).\n"
  "File e.g.:\n"
  "  alpha 1 -4 3\n"
  "  beta  0 0 2\n";

static const char exit_help[] =
  "\n"
  "Exit codes: 0 ok, 1 the computation or the output failed, 2 usage, 3 bad input file,\n"
  "4 singular pencil, 5 not certified, 130 or 143 interrupted.\n";

/* Common options that the verb has no use for are left out. */
static bool shown(const struct verb *verb, size_t i, const struct option *o)
{
  size_t own = 0;
  while (verb->option && verb->option[own].name) own++;
  if (i < own) return true;
  if (!strcmp(o->name, "--plot")) return verb->picture;
  return verb->matrices ||
         (strcmp(o->name, "--npz") && strcmp(o->name, "--h5") && strcmp(o->name, "--mtx"));
}

void call_help(const struct verb *verb)
{
  const struct option *o;
  printf("steif %s %s\n\n%s.\n", verb->name, verb->usage, verb->about);
  if (verb->method) printf("Without METHOD: %s.\n", verb->method);
  putchar('\n');
  for (size_t i = 0; (o = option_at(verb, i)); i++)
    if (shown(verb, i, o)) line(o);
  if (strstr(verb->usage, "METHOD")) fputs(method_help, stdout);
  fputs(exit_help, stdout);
}
