/* pairing.h: the staircase and the generalised Schur form side by side on one dense pencil.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_PAIRING_H
#define STF_PAIRING_H

#include "structure.h"

/* E and F: dense or CSC, checked already. `both`: the second algorithm too, and a verdict. */
int stf_dense_structure(steif_context *ctx, SUNMatrix E, SUNMatrix F,
                        const steif_analysis *analysis, bool both, steif_structure *structure);
int stf_dense_impulse(steif_context *ctx, SUNMatrix E, SUNMatrix F,
                      const steif_analysis *analysis, const sunrealtype *x0,
                      const stf_sources *sources, steif_impulse *impulse);
/* STEIF_NOT_CERTIFIED where the index is undecided. */
int stf_dense_parts(steif_context *ctx, SUNMatrix E, SUNMatrix F,
                    const steif_analysis *analysis, const stf_pieces *parts);

/* s->message of a structure that is filled but for it. reason: why it is not certified, or NULL; by: the
 * algorithm that certifies it. */
void stf_announce(steif_structure *s, const char *reason, const char *by);

#endif
