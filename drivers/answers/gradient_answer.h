/* gradient_answer.h: gradients of what --functional and --end say, by a run backwards.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef GRADIENT_ANSWER_H
#define GRADIENT_ANSWER_H

#include "problem.h"

/* An exit code, after the answer or a sentence. */
int gradient_answer(struct call *call, const steif_problem *p);

#endif
