/* main.c: the program steif: one verb per file.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "blas_memory.h"
#include "parallel.h"
#include "program.h"
#include "verbs.h"
#include <stdio.h>
#include <string.h>

static bool is(const char *text, const char *name, const char *option, const char *letter)
{
  return !strcmp(text, name) || !strcmp(text, option) || !strcmp(text, letter);
}

static int help(const struct verb *verb)
{
  if (verb)
    call_help(verb);
  else
    verbs_overview(stdout);
  return EXIT_OK;
}

static int run(struct call *call, int argc, char **argv)
{
  int code = call_parse(call, argc, argv);
  if (code != EXIT_OK) return code;
  if (call->help) return help(call->verb);
  code = check_outputs(call);
  if (code != EXIT_OK) return code;
  interruption_open(call->verb->name);
  return call->verb->run(call);
}

/* The verb is named by argv[1], or after "help". */
static int dispatch(struct call *call, int argc, char **argv)
{
  const bool asked = is(argv[1], "help", "--help", "-h");
  const char *name = asked ? argv[2] : argv[1];
  char text[GUESS];
  if (is(argv[1], "version", "--version", "-V"))
    return printf("steif %s\n", steif_version()) < 0;
  call->verb = name ? verb_find(name) : NULL;
  call->json = call_wants_json(argc - 2, argv + 2);
  call->ctx = steif_context_new(NULL);
  if (!call->ctx) return no_memory(call, "a context", "give the process more");
  if (parallel_asked(argc, argv)) return parallel_become(call, argv);
  need_blas_memory(call);
  if (name && !call->verb)
    return unknown_name(call, "no verb \"%s\"%s 'steif --help' lists them", name,
                        verb_guess(name, text));
  return asked ? help(call->verb) : run(call, argc - 2, argv + 2);
}

int main(int argc, char **argv)
{
  struct call call = {0};
  if (argc < 2) {
    verbs_overview(stderr);
    return EXIT_USAGE;
  }
  interruption_open(NULL);
  const int code = dispatch(&call, argc, argv);
  steif_context_free(&call.ctx);
  if (fflush(stdout) == 0 && !ferror(stdout)) return code;
  say(&call, "standard output could not be written; is the disk full? [STEIF_IO]");
  return EXIT_FAILED;
}
