/* moments.c: impulse coefficients of one block from a homogeneous backward Euler run, exact for
 * every step: with M = (N + hI)^{-1} N, sum_i C(i-1, q) M^i = M^{q+1} (I - M)^{-(q+1)} and
 * I - M = h (N + hI)^{-1}, hence h^{q+1} sum_i C(i-1, q) x_i = N^{q+1} x_0.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "weak_inside.h"
#include <math.h>

int steif_binomial_moments(steif_context *ctx, int k, sunrealtype h, const sunrealtype *x,
                           sunrealtype *c)
{
  STEIF_CHECK(k >= 2, ctx, STEIF_BAD_INPUT,
              "k = %d: a block of index below 2 has no impulses to measure", k);
  STEIF_CHECK(h > 0 && isfinite(h), ctx, STEIF_BAD_INPUT, "the step h = %g must be positive",
              h);
  for (int q = 0; q + 1 < k; q++)
    for (int m = 0; m < k; m++) {
      long double sum = 0, binomial = 1; /* C(i-1, q), i = q+1, q+2, ... */
      for (int i = q + 1; i < k; i++) {
        sum += binomial * x[(i - 1) * k + m];
        binomial = binomial * i / (i - q);
      }
      c[q * k + m] = (sunrealtype)((q % 2 ? -1 : 1) * powl(h, q + 1) * sum);
    }
  return STEIF_OK;
}
