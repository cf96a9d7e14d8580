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

/* w = |a| + sign |b| B^-shift to limbs + 1 digits after one for the carry; for sign -1 shift > 0 or |a| >= |b|,
 * so that it is not negative. */
static void combine(int limbs, const stf_real *a, const stf_real *b, int shift, int sign,
                    uint32_t *w)
{
  int64_t carry = 0;
  for (int i = limbs; i >= shift; i--) {
    const int64_t low = i - shift < limbs ? b->limb[i - shift] : 0;
    carry += (int64_t)(i < limbs ? a->limb[i] : 0) + sign * low;
    w[i + 1] = (uint32_t)carry;
    carry >>= BITS;
  }
  for (int i = shift - 1; i >= 0; i--) {
    carry += a->limb[i];
    w[i + 1] = (uint32_t)carry;
    carry >>= BITS;
  }
  w[0] = (uint32_t)carry;
}

/* |a| < |b|, of the same exponent. */
static bool smaller(int limbs, const stf_real *a, const stf_real *b)
{
  int i = 0;
  while (i < limbs - 1 && a->limb[i] == b->limb[i]) i++;
  return a->limb[i] < b->limb[i];
}

void stf_real_add(int limbs, const stf_real *a, const stf_real *b, stf_real *sum)
{
  uint32_t w[WORK];
  const bool swap =
    !a->sign || (b->sign && (b->exponent > a->exponent ||
                             (b->exponent == a->exponent && smaller(limbs, a, b))));
  const stf_real *large = swap ? b : a, *small = swap ? a : b;
  const int shift = large->exponent - small->exponent;
  if (!small->sign || shift > limbs) {
    if (sum != large) *sum = *large;
    return;
  }
  combine(limbs, large, small, shift, large->sign * small->sign, w);
  normalise(limbs, large->sign, large->exponent + 1, limbs + 2, w, sum);
}

void stf_real_subtract(int limbs, const stf_real *a, const stf_real *b, stf_real *out)
{
  stf_real minus = *b;
  minus.sign = -b->sign;
  stf_real_add(limbs, a, &minus, out);
}

/* Limbs up to the last that is not 0. */
static int length(int limbs, const stf_real *x)
{
  while (limbs > 0 && !x->limb[limbs - 1]) limbs--;
  return limbs;
}

void stf_real_multiply(int limbs, const stf_real *a, const stf_real *b, stf_real *out)
{
  uint32_t w[WORK] = {0};
  if (!a->sign || !b->sign) {
    *out = (stf_real){0};
    return;
  }
  const int last = length(limbs, b) - 1;
  for (int i = length(limbs, a) - 1; i >= 0; i--) {
    const uint64_t factor = a->limb[i];
    const int most = i ? limbs - i : limbs - 1; /* what is beyond is chopped */
    uint64_t carry = 0;
    for (int j = last < most ? last : most; j >= 0; j--) {
      carry += factor * b->limb[j] + w[i + j + 1];
      w[i + j + 1] = (uint32_t)carry;
      carry >>= BITS;
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

/* The limbs beyond set to 0. */
static void chop(int limbs, int from, stf_real *x)
{
  for (int i = from; i < limbs; i++) x->limb[i] = 0;
}

/* Newton's iteration x += x (1 - b x) for 1/b doubles the right bits, so that early steps need few of them. */
void stf_real_divide(int limbs, const stf_real *a, const stf_real *b, stf_real *out)
{
  stf_real scaled = *b, inverse, rest;
  scaled.exponent = 0;
  inverse = stf_real_of(1 / stf_real_value(&scaled));
  for (int bits = 60; bits < 2 * BITS * limbs; bits *= 2) {
    const int enough = 2 * bits / BITS + 2, few = enough < limbs ? enough : limbs;
    rest = stf_real_of(1);
    stf_real_gather(few, -1, &scaled, &inverse, &rest);
    chop(limbs, few, &rest);
    stf_real_gather(few, 1, &rest, &inverse, &inverse);
    chop(limbs, few, &inverse);
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
