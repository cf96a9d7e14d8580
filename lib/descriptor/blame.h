/* blame.h: equations and unknowns in sentences.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_BLAME_H
#define STF_BLAME_H

#include "structure.h"

enum { STF_CALLED = 96 };
/* "equation 3", or "equation 3 (current at b)" where it has a name; i counts from 0. */
const char *stf_called_equation(const steif_names *names, sunindextype i,
                                char room[STF_CALLED]);
const char *stf_called_unknown(const steif_names *names, sunindextype j, char room[STF_CALLED]);

/* A pencil whose pattern allows no more than this rank, which is below its order: lists and sentence.
 * Equations and unknowns without any entry are named before all others. */
int stf_reject_pattern(steif_context *ctx, SUNMatrix E, SUNMatrix F, const steif_names *names,
                       sunindextype rank, steif_structure *structure);

#endif
