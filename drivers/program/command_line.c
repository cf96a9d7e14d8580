/* command_line.c: the command line of every verb against its table of options and its rules.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "command_line.h"
#include "message.h"
#include <stdlib.h>
#include <string.h>

const struct option common_options[] = {
  {"--json", FLAG, NULL, "one JSON object on stdout", NULL},
  {"--csv", OUTPUT, "FILE", "the rows as comma-separated values", NULL},
  {"--plot", OUTPUT, "FILE", "a picture, .svg or .png", NULL},
  {"--npz", OUTPUT, "FILE", "the matrices and lists as arrays for numpy.load", NULL},
  {"--h5", OUTPUT, "FILE", "the same as an HDF5 file, where libhdf5 is installed", NULL},
  {"--mtx", WORD, "PREFIX", "each of them as a Matrix Market file PREFIXname.mtx", NULL},
  {"--quiet", FLAG, NULL, "no progress line, which terminals get", NULL},
  {"--help", FLAG, NULL, "this text", NULL},
  OPTIONS_END,
};

const struct option *option_at(const struct verb *verb, size_t i)
{
  const struct option *own = verb->option;
  for (; own && own->name; own++)
    if (i-- == 0) return own;
  return i < sizeof common_options / sizeof *common_options - 1 ? common_options + i : NULL;
}

static const char *name_at(const void *verb, size_t i)
{
  const struct option *o = option_at(verb, i);
  return o ? o->name : NULL;
}

static const struct option *find(const struct verb *verb, const char *name, size_t length)
{
  const struct option *o;
  for (size_t i = 0; (o = option_at(verb, i)); i++)
    if (strlen(o->name) == length && !strncmp(o->name, name, length)) return o;
  return NULL;
}

/* ---- options ---- */

static void set_common(struct call *call, const char *name, const char *text)
{
  if (!strcmp(name, "--json"))
    call->json = true;
  else if (!strcmp(name, "--quiet"))
    call->quiet = true;
  else if (!strcmp(name, "--help"))
    call->help = true;
  else if (!strcmp(name, "--csv"))
    call->csv = text;
  else if (!strcmp(name, "--plot"))
    call->plot = text;
  else if (!strcmp(name, "--npz"))
    call->npz = text;
  else if (!strcmp(name, "--h5"))
    call->h5 = text;
  else if (!strcmp(name, "--mtx"))
    call->mtx = text;
}

static int keep(struct call *call, const struct option *o, const char *text)
{
  if (o->kind != REPEATED && given(call, o->name))
    return bad_usage(call, "%s is given twice; leave one of them out", o->name);
  if (call->options == GIVEN)
    return bad_usage(call, "more than %d options; leave some out", GIVEN);
  set_common(call, o->name, text);
  call->given[call->options].option = o;
  call->given[call->options].text = text;
  call->options++;
  return EXIT_OK;
}

/* The option of this verb that others call so. */
static const char *known_elsewhere(const struct verb *v, const char *name, size_t length)
{
  static const char *const words[][2] = {{"--tend", "--t1"},
                                         {"--t-end", "--t1"},
                                         {"--tf", "--t1"},
                                         {"--tmax", "--t1"},
                                         {"--tfinal", "--t1"},
                                         {"--tspan", "--t1"},
                                         {"--tol", "--rtol"},
                                         {"--reltol", "--rtol"},
                                         {"--abstol", "--atol"},
                                         {"--dt", "--h"},
                                         {"--step", "--h"},
                                         {"--stepsize", "--h"},
                                         {"--max-step", "--h-max"},
                                         {"--hmax", "--h-max"},
                                         {"--first-step", "--h0"},
                                         {"--t-eval", "--at"},
                                         {"--out", "--csv"},
                                         {"--output", "--csv"},
                                         {"--save", "--csv"},
                                         {"--param", "--parameters"},
                                         {"--params", "--parameters"},
                                         {"--param", "--set"},
                                         {"--params", "--set"},
                                         {"--sigma", "--sd"},
                                         {"--seconds", "--max-seconds"}};
  for (size_t i = 0; i < sizeof words / sizeof *words; i++)
    if (strlen(words[i][0]) == length && !strncmp(name, words[i][0], length) &&
        find(v, words[i][1], strlen(words[i][1])))
      return words[i][1];
  return NULL;
}

/* argv[*i] begins with "--"; the value may follow "=" or be the next word. */
static int one_option(struct call *call, int argc, char **argv, int *i)
{
  const char *name = argv[*i], *text = strchr(name, '=');
  const size_t length = text ? (size_t)(text - name) : strlen(name);
  char near[GUESS];
  const struct option *o = find(call->verb, name, length);
  const char *other = o ? NULL : known_elsewhere(call->verb, name, length);
  if (other)
    return bad_usage(call, "no option %.*s; here it is %s; 'steif %s --help' lists them all",
                     (int)length, name, other, call->verb->name);
  if (!o)
    return bad_usage(call, "no option %.*s%s 'steif %s --help' lists them all", (int)length,
                     name, guess(name, name_at, call->verb, near), call->verb->name);
  if (o->kind == FLAG)
    return text ? bad_usage(call, "%s takes no value; leave %s out", o->name, text)
                : keep(call, o, "");
  if (text)
    text++;
  else if (*i + 1 < argc && strncmp(argv[*i + 1], "--", 2))
    text = argv[++*i];
  if (!text) return bad_usage(call, "%s needs a value: %s %s", o->name, o->name, o->argument);
  const char *wanted = option_objection(o, text);
  if (wanted) return bad_usage(call, "%s is \"%s\" and must be %s", o->name, text, wanted);
  return keep(call, o, text);
}

/* ---- rules ---- */

/* "--method or --vs" of "--method|--vs". */
static void alternatives(const char *options, char *text, size_t room)
{
  size_t used = 0;
  for (const char *at = options; *at && used < room;) {
    const size_t length = strcspn(at, "|");
    used +=
      (size_t)snprintf(text + used, room - used, "%s%.*s", used ? " or " : "", (int)length, at);
    at += length + (at[length] == '|');
  }
}

static bool any_given(const struct call *call, const char *options)
{
  for (const char *at = options; *at;) {
    char name[32];
    const size_t length = strcspn(at, "|");
    snprintf(name, sizeof name, "%.*s", (int)length, at);
    if (given(call, name)) return true;
    at += length + (at[length] == '|');
  }
  return false;
}

static int required(const struct call *call, const char *name)
{
  const struct option *o = find(call->verb, name, strlen(name));
  return bad_usage(call, "%s %s is needed: %s", name, o->argument, o->about);
}

static int check_rule(const struct call *call, const struct rule *rule)
{
  char others[128];
  const char *name = rule->option;
  if (rule->kind == REQUIRED) return given(call, name) ? EXIT_OK : required(call, name);
  if (!given(call, name)) return EXIT_OK;
  switch (rule->kind) {
  case NEEDS:
    if (any_given(call, rule->other)) return EXIT_OK;
    alternatives(rule->other, others, sizeof others);
    return bad_usage(call, "%s needs %s; add %s, or leave %s out", name, others, others, name);
  case EXCLUDES:
    return given(call, rule->other)
             ? bad_usage(call, "%s and %s contradict each other; give one of them", name,
                         rule->other)
             : EXIT_OK;
  default:
    return real_of(call, name) > strtod(rule->other, NULL)
             ? bad_usage(call, "%s is %s and must be at most %s", name, word_of(call, name),
                         rule->other)
             : EXIT_OK;
  }
}

/* Is it in the table of the verb itself? */
static bool own_option(const struct verb *verb, const char *name)
{
  for (const struct option *o = verb->option; o && o->name; o++)
    if (!strcmp(o->name, name)) return true;
  return false;
}

static int check_words(struct call *call)
{
  const struct verb *verb = call->verb;
  if (verb->method && call->words == verb->least) call->word[call->words++] = verb->method;
  if (call->words < verb->least)
    return bad_usage(call, "something is missing, %d of %d words given: steif %s %s",
                     call->words, verb->least, verb->name, verb->usage);
  if (call->words > verb->most)
    return bad_usage(call, "\"%s\" is one word too many: steif %s %s", call->word[verb->most],
                     verb->name, verb->usage);
  if (call->plot && !verb->picture)
    return bad_usage(call, "%s has no picture; leave --plot out", verb->name);
  const bool arrays = verb->matrices || own_option(verb, "--npz");
  if ((!verb->matrices && call->mtx) || (!arrays && (call->npz || call->h5)))
    return bad_usage(call, "%s makes no matrices; leave %s out", verb->name,
                     call->mtx   ? "--mtx"
                     : call->npz ? "--npz"
                                 : "--h5");
  return EXIT_OK;
}

static int check(struct call *call)
{
  int code = check_words(call);
  for (const struct rule *r = call->verb->rule; r && r->option && code == EXIT_OK; r++)
    code = check_rule(call, r);
  return code;
}

bool call_wants_json(int argc, char **argv)
{
  for (int i = 0; i < argc && strcmp(argv[i], "--"); i++)
    if (!strcmp(argv[i], "--json")) return true;
  return false;
}

int call_parse(struct call *call, int argc, char **argv)
{
  int code = EXIT_OK;
  bool only_words = false;
  for (int i = 0; i < argc && code == EXIT_OK; i++) {
    if (!only_words && !strcmp(argv[i], "--"))
      only_words = true;
    else if (!only_words && !strcmp(argv[i], "-h"))
      call->help = true;
    else if (!only_words && argv[i][0] == '-' && argv[i][1] == '-')
      code = one_option(call, argc, argv, &i);
    else if (!only_words && argv[i][0] == '-' && argv[i][1] && argv[i][1] != ':')
      code = bad_usage(call, "no option %s; options begin with two dashes", argv[i]);
    else if (call->words == WORDS)
      code = bad_usage(call, "more than %d words; leave some out", WORDS);
    else
      call->word[call->words++] = argv[i];
  }
  return code == EXIT_OK && !call->help ? check(call) : code;
}
