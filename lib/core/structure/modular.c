/* modular.c: arithmetic modulo a prime, and random primes.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "modular.h"
#include <math.h>

static void set_arithmetic(uint64_t p, stf_modulus *m)
{
  uint64_t x = 1; /* 1/p mod 2^64 by Newton's iteration: correct bits double */
  for (int k = 0; k < 6; k++) x *= 2 - p * x;
  m->p = p;
  m->inverse = 0 - x;
  m->one = (uint64_t)(((stf_wide)1 << 64) % p);
  m->square = (uint64_t)((stf_wide)m->one * m->one % p);
}

void stf_modulus_set(uint64_t p, stf_modulus *m)
{
  set_arithmetic(p, m);
  const int zero = -STF_LEAST_EXPONENT;
  m->power[zero] = m->one;
  for (int k = zero + 1; k < STF_EXPONENTS; k++)
    m->power[k] = stf_modular_sum(m, m->power[k - 1], m->power[k - 1]);
  for (int k = zero; k > 0; k--) {
    const uint64_t x = m->power[k];
    m->power[k - 1] = x % 2 ? (x + p) / 2 : x / 2;
  }
}

uint64_t stf_modular_power(const stf_modulus *m, uint64_t base, uint64_t exponent)
{
  uint64_t result = m->one;
  for (; exponent; exponent >>= 1, base = stf_modular_product(m, base, base))
    if (exponent & 1) result = stf_modular_product(m, result, base);
  return result;
}

uint64_t stf_modular_inverse(const stf_modulus *m, uint64_t a)
{
  return stf_modular_power(m, a, m->p - 2);
}

uint64_t stf_modular_whole(const stf_modulus *m, uint64_t a)
{
  return stf_modular_product(m, a % m->p, m->square);
}

uint64_t stf_modular_double(const stf_modulus *m, sunrealtype x)
{
  int e;
  const int64_t whole = (int64_t)ldexp(frexp(x, &e), 53);
  if (!whole) return 0;
  const uint64_t size = stf_modular_whole(m, (uint64_t)(whole < 0 ? -whole : whole));
  const uint64_t r = stf_modular_product(m, size, m->power[e - 53 - STF_LEAST_EXPONENT]);
  return whole < 0 ? stf_modular_negative(m, r) : r;
}

/* -- primes ----------------------------------------------------------------------------------- */

/* G. L. Steele, D. Lea, C. H. Flood, OOPSLA 2014: splitmix64. */
uint64_t stf_random_bits(uint64_t *state)
{
  uint64_t z = *state += 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

/* Could p be a prime, by Miller's test to one base? */
static bool passes(const stf_modulus *m, uint64_t base)
{
  uint64_t odd = m->p - 1;
  int twos = 0;
  while (odd % 2 == 0) odd /= 2, twos++;
  const uint64_t minus = stf_modular_negative(m, m->one);
  uint64_t x = stf_modular_power(m, stf_modular_whole(m, base), odd);
  if (x == m->one || x == minus) return true;
  while (--twos > 0) {
    x = stf_modular_product(m, x, x);
    if (x == minus) return true;
  }
  return false;
}

/* The first twelve primes as bases decide for all numbers of 64 bits: J. Sorenson, J. Webster, Math.
 * Comp. 86 (2017). */
static bool is_prime(uint64_t p)
{
  static const unsigned char base[] = {2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37};
  stf_modulus m;
  for (size_t k = 0; k < sizeof base; k++)
    if (p % base[k] == 0) return false;
  set_arithmetic(p, &m);
  for (size_t k = 0; k < sizeof base; k++)
    if (!passes(&m, base[k])) return false;
  return true;
}

uint64_t stf_random_prime(uint64_t *state)
{
  const uint64_t least = (uint64_t)1 << 61;
  uint64_t p;
  do p = least | (stf_random_bits(state) & (least - 1)) | 1;
  while (!is_prime(p));
  return p;
}
