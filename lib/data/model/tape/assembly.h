/* assembly.h: a tape in the making: an instruction a node, each with a register of its own; then fewer
 * instructions; then registers in the order in which they are filled.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_ASSEMBLY_H
#define STF_ASSEMBLY_H

#include "tape.h"

typedef struct stf_assembly {
  steif_context *ctx;
  stf_tape *tape;
  stf_vector code;      /* stf_step_code: scalar instructions */
  size_t fixed;         /* the first of them depend on parameters only */
  stf_vector negatives; /* stf_step_code: what comes after these */
  stf_vector factors;   /* int32_t: registers of sums of products */
  stf_vector number_at; /* int32_t: register of each number */
  stf_vector uses,
    maker; /* int32_t of each scalar register: how often it is read; 1 + its instruction */
} stf_assembly;

static inline int32_t *stf_uses_of(const stf_assembly *a, int32_t reg)
{
  return STF_AT(a->uses, int32_t, reg);
}
static inline int32_t *stf_maker_of(const stf_assembly *a, int32_t reg)
{
  return STF_AT(a->maker, int32_t, reg);
}

/* An instruction that another one does as well: it is left out in the end. */
static inline void stf_drop(stf_step_code *s) { s->kind = STF_OP_NUMBER; }

/* fuse.c: products and the sums that need them as one instruction; fills `uses` and `maker`. */
int stf_tape_fuse(stf_assembly *a);
/* sums.c: long sums as one instruction. */
int stf_tape_sum(stf_assembly *a);
/* arrange.c: the registers as tape.h has them. */
int stf_tape_arrange(stf_assembly *a);
/* encode.c: the instructions as words. */
int stf_tape_encode(stf_assembly *a);

#endif
