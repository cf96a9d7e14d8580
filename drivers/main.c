/* main.c: the program steif: one verb per file, listed here.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "face.h"
#include <string.h>

#define VERBS(X)                                                                               \
  X(list)                                                                                      \
  X(solve)                                                                                     \
  X(compare)                                                                                   \
  X(order)                                                                                     \
  X(layer) X(weak) X(pencil) X(impulse) X(region) X(c2d) X(d2c) X(diagnose) X(energy)          \
    X(hamiltonian) X(lyapunov) X(supervise) X(counterexample) X(experiment) X(demo) X(bench)

#define DECLARE(name) extern const struct verb verb_##name;
#define ENTRY(name) &verb_##name,
VERBS(DECLARE)
static const struct verb *const verbs[] = {VERBS(ENTRY) NULL};

static const char *verb_at(const void *list, size_t i)
{
  const struct verb *verb = ((const struct verb *const *)list)[i];
  return verb ? verb->name : NULL;
}

static int overview(FILE *out)
{
  fputs("steif VERB ...: stiff ODEs, DAEs and descriptor systems\n\n", out);
  for (const struct verb *const *v = verbs; *v; v++)
    fprintf(out, "  %-11s %s\n", (*v)->name, (*v)->about);
  fputs(
    "\n'steif VERB --help' tells the words and options of a verb, 'steif list' what methods\n"
    "and problems there are, 'steif --version' the version.\n",
    out);
  return out == stdout ? EXIT_OK : EXIT_USAGE;
}

static const struct verb *find(const char *name)
{
  for (const struct verb *const *v = verbs; *v; v++)
    if (!strcmp((*v)->name, name)) return *v;
  return NULL;
}

static int run(struct call *call, int argc, char **argv)
{
  int code = call_parse(call, argc, argv);
  if (code != EXIT_OK) return code;
  if (call->help) {
    call_help(call->verb);
    return EXIT_OK;
  }
  code = check_outputs(call);
  if (code != EXIT_OK) return code;
  call->ctx = steif_context_new(NULL);
  if (!call->ctx) {
    say(call, "no memory to begin with; give the process more");
    return EXIT_FAILED;
  }
  code = call->verb->run(call);
  steif_context_free(&call->ctx);
  return code;
}

int main(int argc, char **argv)
{
  struct call call = {0};
  if (argc < 2) return overview(stderr);
  const char *name = argv[1];
  const bool help = !strcmp(name, "help") || !strcmp(name, "--help");
  if (help && argc == 2) return overview(stdout);
  if (!strcmp(name, "--version")) return printf("steif %s\n", steif_version()) < 0;
  if (help) name = argv[2];
  call.verb = find(name);
  if (!call.verb)
    return refuse(&call, "no verb \"%s\"; the nearest is %s, and 'steif --help' lists them all",
                  name, nearest(name, verb_at, verbs));
  int code = EXIT_OK;
  if (help)
    call_help(call.verb);
  else
    code = run(&call, argc - 2, argv + 2);
  if (fflush(stdout) == 0 && !ferror(stdout)) return code;
  say(&call, "standard output could not be written; is the disk full or the reader gone?");
  return EXIT_FAILED;
}
