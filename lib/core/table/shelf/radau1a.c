/* radau1a.c: Radau IA on the left Radau nodes, order 2s - 1. It is given by D(s),
 *   sum_i b_i c_i^{k-1} a_ij = b_j (1 - c_j^k)/k,  k = 1 .. s,
 * which a_ij = b_j - b_j ahat_ji/b_i solves when ahat is the collocation method (C(s)) there.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "table.h"

static void adjoin(int s, const long double *b, long double *A)
{
  for (int i = 0; i < s; i++)
    for (int j = 0; j <= i; j++) {
      const long double upper = A[i * s + j], lower = A[j * s + i];
      A[i * s + j] = b[j] - b[j] * lower / b[i];
      A[j * s + i] = b[i] - b[i] * upper / b[j];
    }
}

static int build(steif_context *ctx, const steif_spec *spec, steif_table *self, sunrealtype *A,
                 sunrealtype *b, sunrealtype *c)
{
  STEIF_TRY(stf_family_stages(ctx, spec, 1, 2, &self->s));
  self->order = 2 * self->s - 1, self->stage_order = self->s - 1;
  return stf_family_fill(ctx, STF_RADAU_LEFT, adjoin, self, A, b, c);
}

const steif_table steif_table_radau1a = {
  .name = "radau1a",
  .about =
    "Radau IA, s stages, order 2s-1: B. L. Ehle, Waterloo CSRR 2010 (1969); Hairer, Wanner: "
    "Solving ODEs II, IV.5",
  .kind = STEIF_COLLOCATION,
  .claims = STEIF_A_STABLE | STEIF_L_STABLE,
  .build = build,
};
