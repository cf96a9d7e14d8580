/* integrals.c: z_1' = density, z_j' = z_{j-1}: from one time to another
 *   z_j(t + d) = sum_{i<j} d^i / i! z_{j-i}(t) + d^j / j! density.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "integrals.h"
#include <string.h>

int stf_integrals_open(steif_context *ctx, stf_integrals *s)
{
  const size_t row = (size_t)s->most + 1;
  s->z = stf_allocate(ctx, row * ((size_t)s->count + 2), sizeof *s->z);
  if (!s->z) return STEIF_NO_MEMORY;
  memset(s->z, 0, row * (size_t)s->count * sizeof *s->z);
  s->over = s->z + row * (size_t)s->count;
  s->power = s->over + row;
  s->at = (stf_real){0};
  for (int j = 1; j <= s->most; j++) s->over[j] = stf_real_ratio(s->limbs, 1, j);
  return STEIF_OK;
}

void stf_integrals_close(steif_context *ctx, stf_integrals *s) { stf_release(ctx, s->z); }

/* x NULL: no density. */
static void go(stf_integrals *s, const stf_real *t, const stf_real *x)
{
  stf_real d;
  stf_real_subtract(s->limbs, t, &s->at, &d);
  s->at = *t;
  s->power[0] = stf_real_of(1);
  for (int j = 1; j <= s->most; j++) {
    stf_real_multiply(s->limbs, s->power + j - 1, &d, s->power + j);
    stf_real_multiply(s->limbs, s->power + j, s->over + j, s->power + j);
  }
  for (int i = 0; i < s->count; i++) {
    stf_real *z = s->z + i * (s->most + 1);
    for (int j = s->most; j > 0; j--) {
      for (int q = 1; q < j; q++) stf_real_gather(s->limbs, 1, s->power + q, z + j - q, z + j);
      if (x) stf_real_gather(s->limbs, 1, s->power + j, x + s->first + i, z + j);
    }
  }
}

/* What has happened up to now: weight x, and z behind it. */
static void keep(stf_integrals *s, const stf_real *weight, const stf_real *x)
{
  stf_events *e = s->events;
  const size_t n = (size_t)s->n, most = (size_t)s->most;
  if (e->count == e->room) return;
  const size_t row = e->count++;
  e->at[row] = stf_real_value(&s->at) / s->unit;
  for (int i = 0; i < s->count; i++) {
    const size_t place = row * n + (size_t)(s->first + i);
    stf_real value;
    stf_real_multiply(s->limbs, weight, x + s->first + i, &value);
    e->value[place] = stf_real_value(&value);
    for (size_t j = 1; j <= most; j++)
      e->state[place * most + j - 1] = stf_real_value(s->z + (size_t)i * (most + 1) + j);
  }
}

void stf_integrals_density(stf_integrals *s, const stf_real *t, const stf_real *x)
{
  const stf_real one = stf_real_of(1);
  go(s, t, x);
  keep(s, &one, x);
}

void stf_integrals_mass(stf_integrals *s, const stf_real *t, const stf_real *weight,
                        const stf_real *x)
{
  go(s, t, NULL);
  for (int i = 0; i < s->count; i++)
    stf_real_gather(s->limbs, 1, weight, x + s->first + i, s->z + i * (s->most + 1) + 1);
  keep(s, weight, x);
}
