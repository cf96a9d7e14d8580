/* chi_square.c: the chi-square distribution by the incomplete gamma function, Q(chi2|dof) = Gamma(a, x)/Gamma(a) with
 * a = dof/2 and x = chi2/2: its series below x = a + 1, its continued fraction above, formulas 6.5.29 and 6.5.31 of M.
 * Abramowitz and I. A. Stegun, Handbook of Mathematical Functions (1964); log Gamma by Stirling's series, 6.1.41.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "base.h"
#include <math.h>
#include <steif/fit.h>

enum { TERMS = 1000000 };
static const sunrealtype enough = 1e-16;
#define PI 3.14159265358979323846

/* Stirling's series less its leading terms: log Gamma(a) - ((a - 1/2) log a - a + log(2 pi)/2), for a >= 10. */
static sunrealtype stirling(sunrealtype a)
{
  const sunrealtype b = 1 / (a * a);
  return (1.0 / 12 - b * (1.0 / 360 - b * (1.0 / 1260 - b * (1.0 / 1680 - b / 1188)))) / a;
}

/* x^a e^-x / Gamma(a); for large a it is sqrt(a/2pi) e^(-a (u - log(1 + u))), u = x/a - 1, but for Stirling's rest: no
 * digits are lost where x is near a. */
static sunrealtype density(sunrealtype a, sunrealtype x)
{
  if (a < 10) return pow(x, a) * exp(-x) / tgamma(a);
  const sunrealtype u = (x - a) / a;
  return sqrt(a / (2 * PI)) * exp(-a * (u - log1p(u)) - stirling(a));
}

/* P(a, x). */
static sunrealtype below(sunrealtype a, sunrealtype x)
{
  sunrealtype term = 1 / a, sum = term;
  for (int n = 1; n < TERMS && term > enough * sum; n++) sum += term *= x / (a + n);
  return sum * density(a, x);
}

/* Q(a, x), from the last level of the fraction that matters up, by W. J. Lentz' products. */
static sunrealtype above(sunrealtype a, sunrealtype x)
{
  sunrealtype b = x + 1 - a, c = INFINITY, d = 1 / b, product = d, change = 0;
  for (int n = 1; n < TERMS && fabs(change - 1) > enough; n++) {
    const sunrealtype top = -n * (n - a);
    b += 2;
    d = 1 / (b + top * d), c = b + top / c;
    change = c * d, product *= change;
  }
  return product * density(a, x);
}

int steif_chi_square(steif_context *ctx, sunrealtype chi2, long dof, sunrealtype *probability)
{
  STEIF_CHECK(chi2 >= 0 && dof >= 1 && probability, ctx, STEIF_BAD_INPUT,
              "chi2 = %g must not be negative, and dof = %ld be at least 1", chi2, dof);
  const sunrealtype a = (sunrealtype)dof / 2, x = chi2 / 2;
  *probability = x == 0 ? 1 : !(x < INFINITY) ? 0 : x < a + 1 ? 1 - below(a, x) : above(a, x);
  return STEIF_OK;
}
