/* propagator.c: M(z) = V + z D (I - z C)^{-1} U of a general linear method.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "general.h"
#include <math.h>

/* V + D (w - C)^{-1} U, w = 1/z; false at a pole. */
static bool at(const steif_glm *g, stf_complex w, stf_complex *M)
{
  const int k = g->k, r = g->r;
  stf_complex K[STEIF_STAGES * STEIF_STAGES], X[STEIF_STAGES * STEIF_PAST];
  for (int i = 0; i < r; i++) {
    for (int j = 0; j < r; j++) K[i * r + j] = (i == j ? w : 0) - g->C[i * r + j];
    for (int j = 0; j < k; j++) X[i * k + j] = g->U[i * k + j];
  }
  if (!stf_solve(r, k, K, X, 0)) return false;
  for (int i = 0; i < k; i++)
    for (int j = 0; j < k; j++) {
      M[i * k + j] = g->V[i * k + j];
      for (int l = 0; l < r; l++)
        if (g->D[i * r + l] != 0) M[i * k + j] += g->D[i * r + l] * X[l * k + j];
    }
  return true;
}

/* Where C is singular, M(w) = M(0) + w M'(0) + O(w^2); it grows like 1/w where there is no
 * limit. */
static bool limit(const steif_glm *g, stf_complex *M)
{
  stf_complex half[STEIF_PAST * STEIF_PAST];
  const long double w = -1e-7L;
  if (at(g, 0, M)) return true;
  if (!at(g, w, M) || !at(g, w / 2, half)) return false;
  for (int i = 0; i < g->k * g->k; i++) {
    if (cabsl(half[i]) > 1e4L && cabsl(half[i]) > 1.5L * cabsl(M[i])) return false;
    M[i] = 2 * half[i] - M[i];
  }
  return true;
}

int steif_glm_propagator(steif_context *ctx, const steif_glm *g, const sunrealtype z[2],
                         sunrealtype *out)
{
  STEIF_CHECK(g && z && out && !isnan(z[0]) && !isnan(z[1]), ctx, STEIF_BAD_INPUT,
              "M(z) needs a method, a number z and a place for the result");
  stf_complex M[STEIF_PAST * STEIF_PAST];
  const long double re = z[0], im = z[1], size = re * re + im * im;
  bool finite = true;
  if (isinf(size))
    finite = limit(g, M);
  else if (size > 0)
    finite = at(g, re / size - im / size * I, M);
  for (int i = 0; i < g->k * g->k; i++) {
    const stf_complex value = !finite ? INFINITY : size > 0 ? M[i] : g->V[i];
    out[2 * i] = (sunrealtype)creall(value), out[2 * i + 1] = (sunrealtype)cimagl(value);
  }
  return STEIF_OK;
}
