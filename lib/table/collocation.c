/* collocation.c: a_ij = int_0^{c_i} l_j and b_j = int_0^1 l_j on given nodes, in long double by
 * Gauss's rule, and what families of tables share (Hairer, Wanner: Solving ODEs II, IV.5).
 * SPDX-License-Identifier: BSD-3-Clause */
#include "table.h"

int stf_family_stages(steif_context *ctx, const steif_spec *spec, int lowest, int fallback,
                      int *s)
{
  STEIF_TRY(stf_spec_only(ctx, spec, (const char *const[]){"s", NULL}));
  return stf_spec_int(ctx, spec, "s", lowest, STEIF_STAGES, fallback, s);
}

/* row_j = int_0^x l_j: degree s - 1, so (s+1)/2 points are exact. */
static void integrate(int s, const long double *c, long double x, long double *row)
{
  long double g[STEIF_STAGES], w[STEIF_STAGES], value[STEIF_STAGES], slope[STEIF_STAGES];
  const int points = (s + 1) / 2;
  stf_gauss(points, g, w);
  for (int j = 0; j < s; j++) row[j] = 0;
  for (int q = 0; q < points; q++) {
    stf_lagrange(s, c, x * g[q], value, slope);
    for (int j = 0; j < s; j++) row[j] += x * w[q] * value[j];
  }
}

/* x = hi + lo. */
static void halve(long double x, sunrealtype *hi, sunrealtype *lo)
{
  *hi = (sunrealtype)x;
  *lo = (sunrealtype)(x - (long double)*hi);
}

int stf_family_fill(steif_context *ctx, enum stf_node_kind kind, stf_alter *alter,
                    steif_table *self, sunrealtype *A, sunrealtype *b, sunrealtype *c)
{
  const int s = self->s;
  long double nodes[STEIF_STAGES], weights[STEIF_STAGES], full[STEIF_STAGES * STEIF_STAGES];
  STEIF_TRY(stf_nodes(ctx, kind, s, nodes));
  integrate(s, nodes, 1, weights);
  for (int i = 0; i < s; i++) integrate(s, nodes, nodes[i], full + i * s);
  if (alter) alter(s, weights, full);
  for (int i = 0; i < s * s; i++) halve(full[i], A + i, A + s * s + i);
  for (int i = 0; i < s; i++) b[i] = (sunrealtype)weights[i], c[i] = (sunrealtype)nodes[i];
  self->A = A, self->A_low = A + s * s, self->b = b, self->c = c;
  return STEIF_OK;
}
