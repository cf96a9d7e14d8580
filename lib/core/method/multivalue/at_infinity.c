/* at_infinity.c: what a general linear method makes of errors of algebraic unknowns: M(z), z -> infinity, in each step.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "glm_state.h"
#include <math.h>

static void square(int k, const sunrealtype *M, sunrealtype *out)
{
  for (int i = 0; i < k; i++)
    for (int j = 0; j < k; j++) {
      out[i * k + j] = 0;
      for (int l = 0; l < k; l++) out[i * k + j] += M[i * k + l] * M[l * k + j];
    }
}

/* Divide by the largest entry, which is returned. */
static sunrealtype normalise(int count, sunrealtype *M)
{
  sunrealtype most = 0;
  for (int i = 0; i < count; i++) most = fmax(most, fabs(M[i]));
  for (int i = 0; i < count && most > 0; i++) M[i] /= most;
  return most;
}

/* ||M^(2^j)||^(1/2^j) for j = 20: within 1e-4 of the spectral radius. */
int stf_glm_at_infinity(steif_context *ctx, const steif_glm *g, sunrealtype *radius)
{
  enum { SQUARINGS = 20 };
  const sunrealtype far[2] = {-INFINITY, 0};
  sunrealtype M[2 * STEIF_PAST * STEIF_PAST], next[STEIF_PAST * STEIF_PAST], power = 1;
  const int count = g->k * g->k;
  STEIF_TRY(steif_glm_propagator(ctx, g, far, M));
  for (int i = 0; i < count; i++) M[i] = M[2 * i];
  sunrealtype logarithm = log(normalise(count, M));
  for (int j = 0; j < SQUARINGS && isfinite(logarithm); j++) {
    square(g->k, M, next);
    for (int i = 0; i < count; i++) M[i] = next[i];
    power /= 2;
    logarithm += power * log(normalise(count, M));
  }
  *radius = exp(logarithm);
  return STEIF_OK;
}
