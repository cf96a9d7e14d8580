/* verbs.c: the list of the verbs: drivers/NAME.c defines `const struct verb verb_NAME`.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "verbs.h"
#include "message.h"
#include <string.h>

/* clang-format off */
#define VERBS(X)                                                                               \
  X(list) X(model) X(solve) X(resume) X(compare) X(order) X(layer) X(weak) X(pencil) X(impulse) X(region) X(c2d)  \
  X(d2c) X(diagnose) X(energy) X(hamiltonian) X(lyapunov) X(sensitivity) X(sweep) X(fit) X(supervise) X(counterexample)       \
  X(experiment) X(demo) X(bench)
/* clang-format on */

#define DECLARE(name) extern const struct verb verb_##name;
#define ENTRY(name) &verb_##name,
VERBS(DECLARE)
static const struct verb *const verbs[] = {VERBS(ENTRY)};

const struct verb *verb_at(size_t i)
{
  return i < sizeof verbs / sizeof *verbs ? verbs[i] : NULL;
}

const struct verb *verb_find(const char *name)
{
  const struct verb *v;
  for (size_t i = 0; (v = verb_at(i)); i++)
    if (!strcmp(v->name, name)) return v;
  return NULL;
}

static const char *name_at(const void *list, size_t i)
{
  const struct verb *v = verb_at(i);
  (void)list;
  return v ? v->name : NULL;
}

const char *verb_guess(const char *name, char text[GUESS])
{
  return guess(name, name_at, NULL, text);
}

void verbs_overview(FILE *out)
{
  const struct verb *v;
  fputs("steif VERB ...: stiff ODEs, DAEs and descriptor systems\n\n", out);
  for (size_t i = 0; (v = verb_at(i)); i++) fprintf(out, "  %-14s %s\n", v->name, v->about);
  fputs(
    "\n'steif VERB --help' explains the words and options of a verb; 'steif list' shows the\n"
    "methods and problems, 'steif --version' the version.\n",
    out);
}
