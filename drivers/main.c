/* main.c: the program steif: one verb per file.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "program.h"
#include "verbs.h"
#include <stdio.h>
#include <string.h>

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
  call->ctx = steif_context_new(NULL);
  if (!call->ctx) return no_memory(call, "a context", "give the process more");
  code = call->verb->run(call);
  steif_context_free(&call->ctx);
  return code;
}

int main(int argc, char **argv)
{
  struct call call = {0};
  if (argc < 2) {
    verbs_overview(stderr);
    return EXIT_USAGE;
  }
  const bool asked = !strcmp(argv[1], "help") || !strcmp(argv[1], "--help");
  const char *name = asked ? argv[2] : argv[1];
  if (!strcmp(argv[1], "--version")) return printf("steif %s\n", steif_version()) < 0;
  call.verb = name ? verb_find(name) : NULL;
  if (name && !call.verb)
    return unknown_name(&call,
                        "no verb \"%s\"; the nearest is %s, and 'steif --help' lists them",
                        name, verb_nearest(name));
  const int code = asked ? help(call.verb) : run(&call, argc - 2, argv + 2);
  if (fflush(stdout) == 0 && !ferror(stdout)) return code;
  say(&call, "standard output could not be written; is the disk full? [STEIF_IO]");
  return EXIT_FAILED;
}
