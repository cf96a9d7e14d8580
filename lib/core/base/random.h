/* random.h: seeded numbers, the same on every machine.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_RANDOM_H
#define STF_RANDOM_H

#include "base.h"
#include <stdint.h>

/* splitmix64 (G. L. Steele, D. Lea, C. H. Flood, Fast splittable pseudorandom number generators,
 * OOPSLA 2014). */
typedef struct stf_random {
  uint64_t state;
} stf_random;
sunrealtype stf_random_in(stf_random *r, sunrealtype low, sunrealtype high);
sunrealtype stf_random_normal(stf_random *r);
sunindextype stf_random_below(stf_random *r, sunindextype n);
/* Parameter seed=1 .. 1e9, 1 when absent. */
int stf_random_seed(steif_context *ctx, const steif_spec *spec, stf_random *r);

#endif
