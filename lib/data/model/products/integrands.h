/* integrands.h: expressions that a model integrates beside its unknowns.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_INTEGRANDS_H
#define STF_INTEGRANDS_H

#include "model.h"

typedef struct stf_integrands stf_integrands;

/* The last `count` outputs are integrands. */
int stf_integrands_mark(stf_model *m, int count);
/* Nodes and relations, before those of events; then tapes. */
int stf_integrands_build(stf_model *m);
int stf_integrands_compile(stf_model *m);
/* Parameters have moved. */
void stf_integrands_follow(const stf_model *m);
void stf_integrands_free(stf_model *m);

#endif
