/* attributes.h: which start values may move, by name.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef ATTRIBUTES_H
#define ATTRIBUTES_H

#include "program.h"

/* clang-format off */
#define ATTRIBUTE_OPTIONS                                                                      \
  {"--guess", WORD, "NAME,...", "start values that may move (default: all)", NULL},            \
  {"--fixed", WORD, "NAME,...", "start values that must stay", NULL},                          \
  {"--free", WORD, "NAME,...", "start values that are computed, whatever they are", NULL}
/* clang-format on */

/* *attributes: n of enum steif_attribute, to be freed; NULL where none of these options is given. EXIT_OK
 * or an exit code after a sentence: unknown names, a name twice, a model, which has its own marks. */
int attributes_of(struct call *call, const steif_problem *p, int **attributes);

/* The unknown of a name, or of y1, x1, ...; -1: there is none. */
sunindextype unknown_of(const steif_problem *p, const char *name);
/* The parameter of a name that has derivatives; -1 after a sentence: *code is the exit code. */
int parameter_of(struct call *call, const steif_problem *p, const char *name, int *code);
/* Says that p has no parameters to differentiate by, and why. */
int no_parameters(struct call *call, const steif_problem *p);

#endif
