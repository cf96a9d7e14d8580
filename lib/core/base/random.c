/* random.c: seeded numbers by splitmix64.
 *
 * A counter in steps of 2^64/phi is scrambled by two rounds of xor-shift and multiplication;
 * D. Stafford's constants "Mix13". The uniform numbers are the upper 53 bits, moved by half a
 * unit so that neither end is met; the normal ones are those of Box and Muller.
 * G. L. Steele, D. Lea, C. H. Flood, OOPSLA 2014, pp. 453-472.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "random.h"
#include <math.h>

static uint64_t next(stf_random *r)
{
  uint64_t z = r->state += UINT64_C(0x9e3779b97f4a7c15);
  z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
  z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
  return z ^ (z >> 31);
}

static sunrealtype unit(stf_random *r)
{
  return ((sunrealtype)(next(r) >> 11) + 0.5) / 9007199254740992.0;
}

sunrealtype stf_random_in(stf_random *r, sunrealtype low, sunrealtype high)
{
  return low + (high - low) * unit(r);
}

sunrealtype stf_random_normal(stf_random *r)
{
  const sunrealtype radius = sqrt(-2 * log(unit(r)));
  return radius * cos(6.28318530717958647692 * unit(r));
}

sunindextype stf_random_below(stf_random *r, sunindextype n)
{
  return (sunindextype)(next(r) % (uint64_t)n);
}

int stf_random_seed(steif_context *ctx, const steif_spec *spec, stf_random *r)
{
  int seed;
  STEIF_TRY(stf_spec_int(ctx, spec, "seed", 1, 1000000000, 1, &seed));
  r->state = (uint64_t)seed;
  return STEIF_OK;
}
