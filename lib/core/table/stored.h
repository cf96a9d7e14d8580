/* stored.h: tables and splits kept as data: opening a solver costs less than a step of it then.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_STORED_H
#define STF_STORED_H

#include "table.h"

typedef struct stf_stored {
  const char *family;
  int s;
  const sunrealtype *c, *b, *A, *A_low, *B, *T, *Tinv, *re, *im;
} stf_stored;
extern const stf_stored stf_stored_tables[];
extern const size_t stf_stored_count;

/* NULL when it is not kept. */
const stf_stored *stf_stored_find(const char *family, int s);
/* The split of a kept table, without a computation. */
void stf_stored_transform(const stf_stored *kept, stf_transform *transform);

#endif
