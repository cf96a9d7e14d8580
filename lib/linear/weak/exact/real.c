/* real.c: arithmetic of many digits: chopped sums and products limb by limb, quotients by Newton's iteration
 * for 1/b. D. E. Knuth, The Art of Computer Programming 2, 4.3.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "real.h"
#include <math.h>
#include <string.h>

enum { BITS = 32, WORK = STF_LIMBS + 2 };

/* The number sign (0.w_0 w_1 ..) B^exponent of `count` limbs, leading zeros and limbs beyond taken off. */
static void normalise(int limbs, int sign, int exponent, int count, const uint32_t *w,
                      stf_real *out)
{
  int zeros = 0;
  while (zeros < count && !w[zeros]) zeros++;
  out->sign = zeros < count ? sign : 0;
  out->exponent = exponent - zeros;
  for (int i = 0; i < limbs; i++) out->limb[i] = i + zeros < count ? w[i + zeros] : 0;
}

stf_real stf_real_of(long double v)
{
  stf_real x = {0};
  int e;
  if (v == 0 || !isfinite(v)) return x;
  long double m = frexpl(fabsl(v), &e); /* in [1/2, 1) */
  x.exponent = e > 0 ? (e + BITS - 1) / BITS : -(-e / BITS);
  m = ldexpl(m, e - BITS * x.exponent);
  x.sign = v < 0 ? -1 : 1;
  for (int i = 0; i < STF_LIMBS && m > 0; i++) {
    m = ldexpl(m, BITS);
    x.limb[i] = (uint32_t)m;
    m -= x.limb[i];
  }
  return x;
}

long double stf_real_value(const stf_real *x)
{
  long double v = 0;
  if (!x->sign) return 0;
  for (int i = 3; i >= 0; i--) v = (v + x->limb[i]) / 4294967296.0L;
  return x->sign * ldexpl(v, BITS * x->exponent);
}

/* w = |a| + sign |b| B^-shift to limbs + 1 digits after one for the carry, b the smaller; the sign of it. */
static int combine(int limbs, const stf_real *a, const stf_real *b, int shift, int sign,
                   uint32_t *w)
{
  int64_t carry = 0;
  for (int i = limbs; i >= 0; i--) {
    const int64_t top = i < limbs ? a->limb[i] : 0,
                  low = i >= shift && i - shift < limbs ? b->limb[i - shift] : 0,
                  sum = top + sign * low + carry;
    w[i + 1] = (uint32_t)(sum & 0xffffffff);
    carry = sum >> BITS;
  }
  w[0] = (uint32_t)(carry > 0 ? carry : 0);
  if (carry >= 0) return 1;
  uint64_t borrow = 1; /* the complement of a negative difference */
  for (int i = limbs + 1; i > 0; i--) {
    borrow += (uint32_t)~w[i];
    w[i] = (uint32_t)borrow;
    borrow >>= BITS;
  }
  return -1;
}

void stf_real_add(int limbs, const stf_real *a, const stf_real *b, stf_real *sum)
{
  uint32_t w[WORK];
  const bool swap = !a->sign || (b->sign && b->exponent > a->exponent);
  const stf_real *large = swap ? b : a, *small = swap ? a : b;
  const int shift = large->exponent - small->exponent;
  if (!small->sign || shift > limbs) {
    if (sum != large) *sum = *large;
    return;
  }
  const int sign = combine(limbs, large, small, shift, large->sign * small->sign, w);
  normalise(limbs, sign * large->sign, large->exponent + 1, limbs + 2, w, sum);
}

void stf_real_subtract(int limbs, const stf_real *a, const stf_real *b, stf_real *out)
{
  stf_real minus = *b;
  minus.sign = -b->sign;
  stf_real_add(limbs, a, &minus, out);
}

void stf_real_multiply(int limbs, const stf_real *a, const stf_real *b, stf_real *out)
{
  uint32_t w[WORK] = {0};
  if (!a->sign || !b->sign) {
    *out = (stf_real){0};
    return;
  }
  for (int i = limbs - 1; i >= 0; i--) {
    uint64_t carry = 0;
    if (!a->limb[i]) continue;
    for (int j = i ? limbs - i : limbs - 1; j >= 0; j--) {
      const uint64_t t = (uint64_t)a->limb[i] * b->limb[j] + w[i + j + 1] + carry;
      w[i + j + 1] = (uint32_t)t;
      carry = t >> BITS;
    }
    w[i] = (uint32_t)carry;
  }
  normalise(limbs, a->sign * b->sign, a->exponent + b->exponent, limbs + 1, w, out);
}

void stf_real_gather(int limbs, int sign, const stf_real *a, const stf_real *b, stf_real *sum)
{
  stf_real product;
  if (!a->sign || !b->sign) return;
  stf_real_multiply(limbs, a, b, &product);
  product.sign *= sign;
  stf_real_add(limbs, sum, &product, sum);
}

void stf_real_divide(int limbs, const stf_real *a, const stf_real *b, stf_real *out)
{
  stf_real scaled = *b, inverse, rest;
  const stf_real one = stf_real_of(1);
  scaled.exponent = 0;
  inverse = stf_real_of(1 / stf_real_value(&scaled));
  for (int bits = 60; bits < 2 * BITS * limbs; bits *= 2) {
    rest = one;
    stf_real_gather(limbs, -1, &scaled, &inverse, &rest);
    stf_real_gather(limbs, 1, &rest, &inverse, &inverse);
  }
  inverse.exponent -= b->exponent;
  stf_real_multiply(limbs, a, &inverse, out);
}

stf_real stf_real_ratio(int limbs, long a, long b)
{
  stf_real x = stf_real_of(a);
  const stf_real y = stf_real_of(b);
  if (b != 1) stf_real_divide(limbs, &x, &y, &x);
  return x;
}

int stf_real_compare(int limbs, const stf_real *a, const stf_real *b)
{
  stf_real d;
  stf_real_subtract(limbs, a, b, &d);
  return d.sign;
}
