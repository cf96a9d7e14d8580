/* adams.c: Adams formulas of any order as general linear methods, by exact integration of the
 * Lagrange basis on their nodes.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "general.h"

/* beta_i = int_0^1 of the basis polynomial of node first - i, i = 0 .. count - 1. */
static void weights(int count, int first, sunrealtype *beta)
{
  long double node[STEIF_PAST], c[STEIF_PAST], w[STEIF_PAST], value[STEIF_PAST],
    slope[STEIF_PAST], sum[STEIF_PAST] = {0};
  for (int i = 0; i < count; i++) node[i] = first - i;
  stf_gauss(count, c, w);
  for (int q = 0; q < count; q++) {
    stf_lagrange(count, node, c[q], value, slope);
    for (int i = 0; i < count; i++) sum[i] += w[q] * value[i];
  }
  for (int i = 0; i < count; i++) beta[i] = (sunrealtype)sum[i];
}

/* X = (x_n, h f_n, h f_{n-1}, ..); the new slope takes the place of the last. */
void stf_glm_adams(steif_glm *g, int p, bool implicit)
{
  const int past = implicit ? p - 1 : p, k = past + 1;
  sunrealtype beta[STEIF_PAST];
  weights(p, implicit ? 1 : 0, beta);
  g->k = k, g->r = 1, g->order = p, g->xi[0] = 1;
  g->C[0] = g->D[0] = implicit ? beta[0] : 0;
  g->U[0] = g->V[0] = 1;
  for (int j = 1; j < k; j++) g->U[j] = g->V[j] = beta[implicit ? j : j - 1];
  for (int i = 2; i < k; i++) g->V[i * k + i - 1] = 1;
  if (k > 1) g->D[1] = 1;
  g->W[0] = 1;
  for (int i = 1; i < k; i++) {
    sunrealtype term = 1;
    for (int j = 1; j <= p; j++, term *= -(i - 1.0) / (j - 1)) g->W[i * (p + 1) + j] = term;
  }
}
