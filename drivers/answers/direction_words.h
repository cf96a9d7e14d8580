/* direction_words.h: directions of parameters as users write them: k1=1,k3=-2.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef DIRECTION_WORDS_H
#define DIRECTION_WORDS_H

#include "program.h"

/* v, zeroed, gets the numbers named; EXIT_OK, or an exit code after a sentence. */
int direction_read(struct call *call, const steif_problem *p, const char *option, double *v);

#endif
