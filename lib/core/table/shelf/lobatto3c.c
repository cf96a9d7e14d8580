/* lobatto3c.c: Lobatto IIIC, order 2s - 2, from a_i1 = b_1 and C(s-1).
 *
 * Rows that share C(s-1) differ by a multiple of the weights w of the highest divided
 * difference on the nodes, and the rows ahat of the collocation method have C(s-1); so
 *   a_ij = ahat_ij + (b_1 - ahat_i1) w_j/w_1,   w_j = 1/prod_{k != j} (c_j - c_k).
 * On Lobatto's nodes w_j^2 is proportional to b_j, with alternating signs.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "table.h"
#include <math.h>

static void fix_first_column(int s, const long double *b, long double *A)
{
  for (int i = 0; i < s; i++) {
    const long double missing = b[0] - A[i * s];
    for (int j = 1; j < s; j++) {
      const long double ratio = sqrtl(b[j] / b[0]);
      A[i * s + j] += missing * (j % 2 ? -ratio : ratio);
    }
    A[i * s] = b[0];
  }
}

static int build(steif_context *ctx, const steif_spec *spec, steif_table *self, sunrealtype *A,
                 sunrealtype *b, sunrealtype *c)
{
  STEIF_TRY(stf_family_stages(ctx, spec, 2, 3, &self->s));
  self->order = 2 * self->s - 2, self->stage_order = self->s - 1;
  return stf_family_fill(ctx, STF_LOBATTO, fix_first_column, self, A, b, c);
}

const steif_table steif_table_lobatto3c = {
  .name = "lobatto3c",
  .about = "Lobatto IIIC, s stages, order 2s-2: F. H. Chipman, BIT 11 (1971); Hairer, Wanner: "
           "Solving ODEs II, IV.5",
  .kind = STEIF_COLLOCATION,
  .claims = STEIF_A_STABLE | STEIF_L_STABLE | STEIF_STIFFLY_ACCURATE,
  .build = build,
};
