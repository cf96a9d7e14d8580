/* verbs.h: the verbs of the program by name.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef VERBS_H
#define VERBS_H

#include "command_line.h"
#include "message.h"
#include <stdio.h>

/* Verb i in the order of the overview; NULL past the end. */
const struct verb *verb_at(size_t i);
/* NULL: there is none of this name; then the nearest name. */
const struct verb *verb_find(const char *name);
const char *verb_guess(const char *name, char text[GUESS]);
/* What the verbs are, one line each. */
void verbs_overview(FILE *out);

#endif
