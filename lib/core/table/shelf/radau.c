/* radau.c: Radau IIA, collocation at the right Radau nodes, order 2s - 1; s = 1 is
 * backward Euler.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "table.h"

static int build(steif_context *ctx, const steif_spec *spec, steif_table *self, sunrealtype *A,
                 sunrealtype *b, sunrealtype *c)
{
  STEIF_TRY(stf_family_stages(ctx, spec, 1, 3, &self->s));
  self->order = 2 * self->s - 1, self->stage_order = self->s;
  return stf_family_fill(ctx, STF_RADAU_RIGHT, NULL, self, A, b, c);
}

const steif_table steif_table_radau = {
  .name = "radau",
  .about = "Radau IIA, s stages, order 2s-1: B. L. Ehle, BIT 8 (1968) and Waterloo CSRR 2010 "
           "(1969); O. Axelsson, BIT 9 (1969)",
  .kind = STEIF_COLLOCATION,
  .claims = STEIF_A_STABLE | STEIF_L_STABLE | STEIF_STIFFLY_ACCURATE,
  .build = build,
};
