/* student.c: quantiles of Student's t: A(t|nu) = P(|T| <= t) is a finite sum in theta = atan(t/sqrt(nu)), formulas
 * 26.7.3 and 26.7.4 of M. Abramowitz and I. A. Stegun, Handbook of Mathematical Functions (1964). Near 1 its digits are
 * those of 1 - A = I_x(nu/2, 1/2), x = nu/(nu + t^2), by the series 26.5.4, whose terms are positive. For many degrees
 * of freedom the expansion 26.7.5 about the quantile of the normal distribution.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "base.h"
#include <math.h>
#include <steif/fit.h>

enum { SUMMED = 2000, HALVINGS = 200 };
#define PI 3.14159265358979323846

static sunrealtype inside(sunrealtype t, long nu)
{
  const sunrealtype theta = atan(t / sqrt((sunrealtype)nu)), c = cos(theta), s = sin(theta);
  const bool odd = nu % 2;
  sunrealtype term = odd ? c : 1, sum = nu == 1 ? 0 : term;
  for (long k = odd ? 3 : 2; k <= nu - 2; k += 2) {
    term *= c * c * (sunrealtype)(k - 1) / (sunrealtype)k;
    sum += term;
  }
  return odd ? 2 / PI * (theta + s * sum) : s * sum;
}

/* P(|T| > t): x^a sqrt(1 - x) / (a B(a, 1/2)) (1 + (a + 1/2)/(a + 1) x (1 + (a + 3/2)/(a + 2) x (...))), a = nu/2. */
static sunrealtype outside(sunrealtype t, long nu)
{
  const sunrealtype a = (sunrealtype)nu / 2, square = t * t / (sunrealtype)nu;
  const sunrealtype x = 1 / (1 + square);
  sunrealtype ratio = nu % 2 ? 1 / sqrt(PI) : sqrt(PI) / 2; /* Gamma(b + 1/2) / Gamma(b) */
  for (sunrealtype b = nu % 2 ? 0.5 : 1; b < a; b++) ratio *= (b + 0.5) / b;
  sunrealtype term = 1, sum = 1;
  for (sunrealtype n = 1; term > 1e-17 * sum; n++) sum += term *= (a + n - 0.5) / (a + n) * x;
  return exp(-a * log1p(square)) * sqrt(square * x) * ratio / (a * sqrt(PI)) * sum;
}

static sunrealtype normal(sunrealtype t, long nu)
{
  (void)nu;
  return erf(t / sqrt(2));
}

static sunrealtype beyond(sunrealtype t, long nu)
{
  (void)nu;
  return erfc(t / sqrt(2));
}

typedef sunrealtype (*stf_distribution)(sunrealtype t, long nu);

/* The root of inner(t) = probability; near 1, of outer(t) = 1 - probability. */
static sunrealtype invert(stf_distribution inner, stf_distribution outer, long nu,
                          sunrealtype probability)
{
  const bool tail = probability > 0.9;
  sunrealtype low = 0, high = 1, t = 1;
  bool bracketed = false;
  for (int i = 0; i < HALVINGS && (!bracketed || high - low > 1e-15 * high); i++) {
    const bool less = tail ? outer(t, nu) > 1 - probability : inner(t, nu) < probability;
    bracketed |= !less;
    if (less)
      low = t;
    else
      high = t;
    t = bracketed ? (low + high) / 2 : (high *= 2);
  }
  return t;
}

static sunrealtype expansion(sunrealtype x, sunrealtype nu)
{
  const sunrealtype x2 = x * x;
  const sunrealtype g1 = (x2 + 1) / 4, g2 = ((5 * x2 + 16) * x2 + 3) / 96,
                    g3 = (((3 * x2 + 19) * x2 + 17) * x2 - 15) / 384;
  return x * (1 + (g1 + (g2 + g3 / nu) / nu) / nu);
}

int steif_student(steif_context *ctx, sunrealtype probability, long dof, sunrealtype *t)
{
  STEIF_CHECK(t, ctx, STEIF_BAD_INPUT, "no place for the quantile: it is NULL");
  STEIF_CHECK(probability > 0 && probability < 1 && dof >= 1, ctx, STEIF_BAD_INPUT,
              "probability %.17g must lie in (0, 1), and dof = %ld be at least 1", probability,
              dof);
  *t = dof <= SUMMED ? invert(inside, outside, dof, probability)
                     : expansion(invert(normal, beyond, 0, probability), (sunrealtype)dof);
  return STEIF_OK;
}
