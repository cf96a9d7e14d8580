/* student.c: quantiles of Student's t: A(t|nu) = P(|T| <= t) is a finite sum in theta = atan(t/sqrt(nu)), formulas
 * 26.7.3 and 26.7.4 of M. Abramowitz and I. A. Stegun, Handbook of Mathematical Functions (1964); for many degrees
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

static sunrealtype normal(sunrealtype t, long nu)
{
  (void)nu;
  return erf(t / sqrt(2));
}

/* The root of distribution(t) = probability. */
static sunrealtype invert(sunrealtype (*distribution)(sunrealtype t, long nu), long nu,
                          sunrealtype probability)
{
  sunrealtype low = 0, high = 1;
  while (distribution(high, nu) < probability && high < 1e30) high *= 2;
  for (int i = 0; i < HALVINGS && high - low > 1e-15 * high; i++) {
    const sunrealtype t = (low + high) / 2;
    if (distribution(t, nu) < probability)
      low = t;
    else
      high = t;
  }
  return (low + high) / 2;
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
  STEIF_CHECK(probability > 0 && probability < 1 - 1e-12 && dof >= 1 && t, ctx, STEIF_BAD_INPUT,
              "probability %g must lie in (0, 1), and dof = %ld be at least 1", probability,
              dof);
  *t = dof <= SUMMED ? invert(inside, dof, probability)
                     : expansion(invert(normal, 0, probability), (sunrealtype)dof);
  return STEIF_OK;
}
