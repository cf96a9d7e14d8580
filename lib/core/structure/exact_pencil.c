/* exact_pencil.c: what ranks modulo random primes tell of a pencil: is it singular, how many infinite
 * eigenvalues it has, in which chains, and how sure that is.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "prime_field.h"
#include "residues.h"
#include "weyr.h"
#include <math.h>
#include <string.h>
#include <time.h>

/* The entries and the clock, mixed: whoever wrote the entries did not know the primes. */
static uint64_t seed(const stf_columns *c, uint64_t state)
{
  for (sunindextype k = 0; k < c->count; k++) {
    uint64_t bits;
    memcpy(&bits, c->value + k, sizeof bits);
    state ^= bits;
    state = stf_random_bits(&state);
  }
  return state;
}

int stf_field_open(steif_context *ctx, SUNMatrix E, SUNMatrix F, bool snap, stf_field *field)
{
  const stf_columns e = stf_columns_of(E), f = stf_columns_of(F);
  struct timespec now;
  uint64_t state = timespec_get(&now, TIME_UTC) ? (uint64_t)now.tv_nsec : 1;
  state = seed(&f, seed(&e, state));
  *field = (stf_field){.E = E, .F = F, .snap = snap};
  for (int which = 0; which < STF_FIELD_PRIMES; which++) {
    field->prime[which] = stf_random_prime(&state);
    field->point[which] = stf_random_bits(&state) % field->prime[which];
  }
  return stf_residues_bits(ctx, E, F, &field->bits);
}

int stf_field_singular(steif_context *ctx, const stf_field *field, bool *singular)
{
  const sunindextype n = stf_columns_of(field->E).n;
  *singular = true;
  for (int which = 0; which < STF_FIELD_PRIMES && *singular; which++) {
    sunindextype rank;
    STEIF_TRY(stf_field_rank(ctx, field, 0, which, &rank));
    *singular = rank >= 0 && rank < n;
  }
  return STEIF_OK;
}

/* -- chains at infinity ------------------------------------------------------------------------ */

typedef struct chains {
  steif_context *ctx;
  const stf_field *field;
  sunindextype n;
  bool ended, lost; /* the last kernel grew no more; it was not computed */
  sunindextype before;
} chains;

/* The kernel over the rationals is the smallest one over a prime field. */
static int kernel(void *data, int level, sunindextype *dimension)
{
  chains *c = data;
  *dimension = level * c->n;
  for (int which = 0; which < STF_FIELD_PRIMES; which++) {
    sunindextype rank;
    STEIF_TRY(stf_field_rank(c->ctx, c->field, level, which, &rank));
    c->lost = c->lost || rank < 0;
    if (level * c->n - rank < *dimension) *dimension = level * c->n - rank;
  }
  if (c->lost) *dimension = -1;
  c->ended = *dimension == c->before;
  c->before = *dimension;
  return STEIF_OK;
}

int stf_field_chains(steif_context *ctx, const stf_field *field, int most, sunindextype *weyr,
                     int *count)
{
  chains c = {.ctx = ctx, .field = field, .n = stf_columns_of(field->E).n};
  bool complete;
  STEIF_TRY(stf_weyr_find(kernel, &c, c.n, most, weyr, count, &complete));
  if (!complete && !c.ended) *count = -1;
  return STEIF_OK;
}

sunrealtype stf_field_doubt(const stf_field *field, int blocks)
{
  const sunrealtype n = (sunrealtype)stf_columns_of(field->E).n;
  const sunrealtype times = blocks > 0 ? blocks * (blocks + 1) / 2. : 1; /* every level */
  sunrealtype doubt = 1;
  for (int which = 0; which < STF_FIELD_PRIMES; which++)
    doubt *= times * field->bits / 61 / STF_PRIMES + (blocks > 0 ? 0 : n / 0x1p61);
  return fmin(doubt, 1);
}
