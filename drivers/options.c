/* options.c: the command line of every verb against its table of options.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "face.h"
#include <stdlib.h>
#include <string.h>

static const struct option common[] = {
  {"--json", FLAG, NULL, "one JSON object on stdout"},
  {"--csv", OUTPUT, "FILE", "the rows as comma-separated values"},
  {"--plot", OUTPUT, "FILE", "a picture, .svg or .png"},
  {"--quiet", FLAG, NULL, "no progress line"},
  {"--help", FLAG, NULL, "this text"},
  {NULL, FLAG, NULL, NULL},
};

static const char *option_at(const void *verb, size_t i)
{
  const struct option *own = ((const struct verb *)verb)->option;
  for (; own && own->name; own++)
    if (i-- == 0) return own->name;
  return i < sizeof common / sizeof *common ? common[i].name : NULL;
}

static const struct option *find(const struct verb *verb, const char *name, size_t length)
{
  const struct option *const table[] = {verb->option, common};
  for (int k = 0; k < 2; k++)
    for (const struct option *o = table[k]; o && o->name; o++)
      if (strlen(o->name) == length && !strncmp(o->name, name, length)) return o;
  return NULL;
}

/* ---- values ---- */

static bool is_real(const char *text, bool positive)
{
  char *end;
  const double value = strtod(text, &end);
  return end != text && !*end && value - value == 0 && (!positive || value > 0);
}

static bool is_whole(const char *text, long lowest)
{
  char *end;
  const long value = strtol(text, &end, 10);
  return end != text && !*end && value >= lowest && value <= 1000000000;
}

static bool are_reals(const char *text, bool positive)
{
  for (size_t count = 0; count < REALS_MOST; count++) {
    char one[64];
    const size_t length = strcspn(text, ",");
    if (length >= sizeof one) return false;
    memcpy(one, text, length);
    one[length] = 0;
    if (!is_real(one, positive)) return false;
    if (!text[length]) return true;
    text += length + 1;
  }
  return false;
}

static bool is_choice(const char *text, const char *choices)
{
  for (const char *at = choices; *at;) {
    const size_t length = strcspn(at, "|");
    if (strlen(text) == length && !strncmp(at, text, length)) return true;
    at += length + (at[length] == '|');
  }
  return false;
}

/* What is wrong with a value, or NULL. */
static const char *objection(const struct option *o, const char *text)
{
  switch (o->kind) {
  case REAL: return is_real(text, false) ? NULL : "a finite number";
  case POSITIVE: return is_real(text, true) ? NULL : "a finite number above 0";
  case NATURAL: return is_whole(text, 0) ? NULL : "a whole number from 0";
  case COUNT: return is_whole(text, 1) ? NULL : "a whole number from 1";
  case REALS:
    return are_reals(text, true) ? NULL : "numbers above 0 separated by commas, at most 32";
  case TIMES: return are_reals(text, false) ? NULL : "times separated by commas, at most 32";
  case CHOICE: return is_choice(text, o->argument) ? NULL : o->argument;
  case WORD: return *text ? NULL : "a word";
  case OUTPUT: return *text ? NULL : "a file name";
  default: return NULL;
  }
}

/* ---- parsing ---- */

static int keep(struct call *call, const struct option *o, const char *text)
{
  if (!strcmp(o->name, "--json"))
    call->json = true;
  else if (!strcmp(o->name, "--quiet"))
    call->quiet = true;
  else if (!strcmp(o->name, "--help"))
    call->help = true;
  else if (!strcmp(o->name, "--csv"))
    call->csv = text;
  else if (!strcmp(o->name, "--plot"))
    call->plot = text;
  else if (!strcmp(o->name, "--npz"))
    call->npz = text;
  if (given(call, o->name))
    return refuse(call, "%s is given twice; leave one of them out", o->name);
  call->given[call->options].option = o;
  call->given[call->options++].text = text;
  return EXIT_OK;
}

/* argv[*i] begins with "--"; the value may follow "=" or be the next word. */
static int one_option(struct call *call, int argc, char **argv, int *i)
{
  const char *name = argv[*i], *text = strchr(name, '=');
  const size_t length = text ? (size_t)(text - name) : strlen(name);
  const struct option *o = find(call->verb, name, length);
  if (!o)
    return refuse(call,
                  "no option %.*s; the nearest is %s, and 'steif %s --help' lists them all",
                  (int)length, name, nearest(name, option_at, call->verb), call->verb->name);
  if (o->kind == FLAG)
    return text ? refuse(call, "%s takes no value; leave %s out", o->name, text)
                : keep(call, o, "");
  if (text)
    text++;
  else if (*i + 1 < argc && strncmp(argv[*i + 1], "--", 2))
    text = argv[++*i];
  if (!text) return refuse(call, "%s needs a value: %s %s", o->name, o->name, o->argument);
  const char *wanted = objection(o, text);
  if (wanted) return refuse(call, "%s is \"%s\" and must be %s", o->name, text, wanted);
  return keep(call, o, text);
}

static int consistent(const struct call *call)
{
  const struct verb *verb = call->verb;
  for (int k = 0; verb->clash && verb->clash[k][0]; k++)
    if (given(call, verb->clash[k][0]) && given(call, verb->clash[k][1]))
      return refuse(call, "%s and %s contradict each other; give one of them",
                    verb->clash[k][0], verb->clash[k][1]);
  if (call->words < verb->least)
    return refuse(call, "something is missing: steif %s %s", verb->name, verb->usage);
  if (call->words > verb->most)
    return refuse(call, "\"%s\" is one word too many: steif %s %s", call->word[verb->most],
                  verb->name, verb->usage);
  return EXIT_OK;
}

int call_parse(struct call *call, int argc, char **argv)
{
  int code = EXIT_OK;
  bool only_words = false;
  for (int i = 0; i < argc && code == EXIT_OK; i++) {
    if (!only_words && !strcmp(argv[i], "--"))
      only_words = true;
    else if (!only_words && argv[i][0] == '-' && argv[i][1] == '-')
      code = one_option(call, argc, argv, &i);
    else if (!only_words && argv[i][0] == '-')
      code = refuse(call, "no option %s; options begin with two dashes", argv[i]);
    else if (call->words == WORDS)
      code = refuse(call, "more than %d words; leave some out", WORDS);
    else
      call->word[call->words++] = argv[i];
  }
  return code == EXIT_OK && !call->help ? consistent(call) : code;
}

static void lines(const struct option *o)
{
  for (; o && o->name; o++) {
    char left[64];
    snprintf(left, sizeof left, "%s %s", o->name, o->argument ? o->argument : "");
    printf("  %-32s %s\n", left, o->about);
  }
}

void call_help(const struct verb *verb)
{
  printf("steif %s %s\n\n%s.\n\n", verb->name, verb->usage, verb->about);
  lines(verb->option);
  lines(common);
  if (strstr(verb->usage, "METHOD"))
    puts("\nMETHOD: a name that 'steif list methods' shows, or glm:file=PATH, a tableau in a "
         "text file:\n"
         "words xi, C, D, U and V before the matrices G = U X + h C F, X <- V X + h D F row by "
         "row, or A, b\n"
         "and c of a Runge-Kutta method, or alpha and beta of a multistep method "
         "(steif/glm.h). File e.g.:\n"
         "  alpha 1 -4 3\n"
         "  beta  0 0 2");
  puts(
    "\nExit codes: 0 ok, 1 the computation or the output failed, 2 usage, 3 bad input file,\n"
    "4 singular pencil, 5 not certified, 130 interrupted.");
}

/* ---- what was given ---- */

const char *word_of(const struct call *call, const char *name, const char *fallback)
{
  for (int i = 0; i < call->options; i++)
    if (!strcmp(call->given[i].option->name, name)) return call->given[i].text;
  return fallback;
}

bool given(const struct call *call, const char *name) { return word_of(call, name, NULL); }

double real_of(const struct call *call, const char *name, double fallback)
{
  const char *text = word_of(call, name, NULL);
  return text ? strtod(text, NULL) : fallback;
}

long whole_of(const struct call *call, const char *name, long fallback)
{
  const char *text = word_of(call, name, NULL);
  return text ? strtol(text, NULL, 10) : fallback;
}

size_t reals_of(const struct call *call, const char *name, double *value)
{
  const char *text = word_of(call, name, NULL);
  size_t count = 0;
  while (text && *text && count < REALS_MOST) {
    char *end;
    value[count++] = strtod(text, &end);
    text = *end == ',' ? end + 1 : end;
  }
  return count;
}
