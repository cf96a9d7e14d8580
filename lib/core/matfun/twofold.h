/* twofold.h: numbers hi + lo of twice the working precision, |lo| <= ulp(hi)/2 (T. J. Dekker,
 * Numer. Math. 18, 1971), and a + b N with N^2 = q, the algebra of functions of one 2 x 2
 * matrix. An overflow leaves lo = 0 and 0 times infinity is 0, so that infinity does not become
 * NaN.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_TWOFOLD_H
#define STF_TWOFOLD_H

#include <math.h>

typedef struct stf_two {
  double hi, lo;
} stf_two;

static inline stf_two stf_two_of(double a) { return (stf_two){a, 0}; }

/* |a| >= |b| */
static inline stf_two stf_two_quick(double a, double b)
{
  const double s = a + b;
  return (stf_two){s, isfinite(s) ? b - (s - a) : 0};
}

static inline stf_two stf_two_sum(double a, double b)
{
  const double s = a + b, t = s - a;
  return (stf_two){s, isfinite(s) ? (a - (s - t)) + (b - t) : 0};
}

static inline stf_two stf_two_add(stf_two a, stf_two b)
{
  const stf_two s = stf_two_sum(a.hi, b.hi), t = stf_two_sum(a.lo, b.lo);
  const stf_two r = stf_two_quick(s.hi, s.lo + t.hi);
  return stf_two_quick(r.hi, r.lo + t.lo);
}

static inline stf_two stf_two_mul(stf_two a, stf_two b)
{
  if (a.hi == 0 || b.hi == 0) return stf_two_of(0);
  const double p = a.hi * b.hi;
  if (!isfinite(p)) return stf_two_of(p);
  return stf_two_quick(p, fma(a.hi, b.hi, -p) + (a.hi * b.lo + a.lo * b.hi));
}

static inline stf_two stf_two_div(stf_two a, stf_two b)
{
  const double q = a.hi / b.hi;
  if (!isfinite(q)) return stf_two_of(q);
  const stf_two rest = stf_two_add(a, stf_two_mul(stf_two_of(-q), b));
  return stf_two_quick(q, rest.hi / b.hi);
}

/* a times a power of two */
static inline stf_two stf_two_scale(stf_two a, double c)
{
  return (stf_two){a.hi * c, a.lo * c};
}

typedef struct stf_jet {
  stf_two a, b;
} stf_jet;

static inline stf_jet stf_jet_add(stf_jet x, stf_jet y)
{
  return (stf_jet){stf_two_add(x.a, y.a), stf_two_add(x.b, y.b)};
}

static inline stf_jet stf_jet_times(stf_two c, stf_jet x)
{
  return (stf_jet){stf_two_mul(c, x.a), stf_two_mul(c, x.b)};
}

static inline stf_jet stf_jet_scale(stf_jet x, double c)
{
  return (stf_jet){stf_two_scale(x.a, c), stf_two_scale(x.b, c)};
}

static inline stf_jet stf_jet_mul(stf_jet x, stf_jet y, stf_two q)
{
  const stf_two bb = stf_two_mul(q, stf_two_mul(x.b, y.b));
  return (stf_jet){stf_two_add(stf_two_mul(x.a, y.a), bb),
                   stf_two_add(stf_two_mul(x.a, y.b), stf_two_mul(x.b, y.a))};
}

#endif
