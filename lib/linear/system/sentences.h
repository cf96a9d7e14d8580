/* sentences.h: equations and unknowns in sentences.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_SENTENCES_H
#define STF_SENTENCES_H

#include "linear_system.h"

enum { STF_NAME = 96 };
/* "equation 3", or "equation 3 (current at b)" where it has a name; i counts from 0. */
const char *stf_name_equation(const steif_names *names, sunindextype i, char text[STF_NAME]);

/* A pencil whose pattern allows no more than this rank, which is below its order: lists and sentence.
 * Equations and unknowns without any entry are named before all others. */
int stf_say_singular_pattern(steif_context *ctx, SUNMatrix E, SUNMatrix F,
                             const steif_names *names, sunindextype rank,
                             steif_structure *structure);

#endif
