/* modular.h: numbers modulo an odd prime p < 2^62, kept as x 2^64 mod p. P. L. Montgomery, Modular
 * multiplication without trial division, Math. Comp. 44 (1985).
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_MODULAR_H
#define STF_MODULAR_H

#include "base.h"
#include <stdint.h>

__extension__ typedef unsigned __int128 stf_wide;

/* Doubles are m 2^e with a whole m of 53 bits and e from here on. */
enum { STF_LEAST_EXPONENT = -1127, STF_EXPONENTS = 2200 };

typedef struct stf_modulus {
  uint64_t p, inverse;           /* p inverse = -1 mod 2^64 */
  uint64_t one, square;          /* 2^64 and 2^128 mod p */
  uint64_t power[STF_EXPONENTS]; /* 2^e, e = STF_LEAST_EXPONENT, ... */
} stf_modulus;

void stf_modulus_set(uint64_t p, stf_modulus *m);

static inline uint64_t stf_modular_product(const stf_modulus *m, uint64_t a, uint64_t b)
{
  const stf_wide t = (stf_wide)a * b;
  const uint64_t r = (uint64_t)((t + (stf_wide)((uint64_t)t * m->inverse) * m->p) >> 64);
  return r >= m->p ? r - m->p : r;
}

static inline uint64_t stf_modular_sum(const stf_modulus *m, uint64_t a, uint64_t b)
{
  const uint64_t r = a + b;
  return r >= m->p ? r - m->p : r;
}

static inline uint64_t stf_modular_negative(const stf_modulus *m, uint64_t a)
{
  return a ? m->p - a : 0;
}

uint64_t stf_modular_power(const stf_modulus *m, uint64_t base, uint64_t exponent);
uint64_t stf_modular_inverse(const stf_modulus *m, uint64_t a);
/* Of a whole number, and of a double as it is. */
uint64_t stf_modular_whole(const stf_modulus *m, uint64_t a);
uint64_t stf_modular_double(const stf_modulus *m, sunrealtype x);

/* The next of a sequence of random numbers of 64 bits. */
uint64_t stf_random_bits(uint64_t *state);
/* A prime in (2^61, 2^62), each with the same probability. */
uint64_t stf_random_prime(uint64_t *state);
/* There are at least so many of them. */
#define STF_PRIMES 5e16

#endif
