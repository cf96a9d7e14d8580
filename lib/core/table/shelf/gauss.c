/* gauss.c: collocation at Gauss's nodes, order 2s; s = 1 is the implicit midpoint rule.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "table.h"

static int build(steif_context *ctx, const steif_spec *spec, steif_table *self, sunrealtype *A,
                 sunrealtype *b, sunrealtype *c)
{
  STEIF_TRY(stf_family_stages(ctx, spec, 1, 2, &self->s));
  self->order = 2 * self->s, self->stage_order = self->s;
  return stf_family_fill(ctx, STF_GAUSS, NULL, self, A, b, c);
}

const steif_table steif_table_gauss = {
  .name = "gauss",
  .about = "Gauss, s stages, order 2s, symplectic: J. C. Butcher, Math. Comp. 18 (1964); "
           "J. Kuntzmann (1961)",
  .kind = STEIF_COLLOCATION,
  .claims = STEIF_A_STABLE | STEIF_SYMPLECTIC | STEIF_SYMMETRIC,
  .build = build,
};
