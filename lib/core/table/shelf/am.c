/* am.c: Adams-Moulton formulas of order p = 1 .. 6; p = 1 is backward Euler, p = 2 the
 * trapezoidal rule.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "general.h"

static int fill(steif_context *ctx, const steif_spec *spec, steif_table *self, steif_glm *glm)
{
  int p;
  STEIF_TRY(stf_spec_only(ctx, spec, (const char *const[]){"", "p", NULL}));
  STEIF_TRY(stf_spec_int(ctx, spec, "p", 1, 6, 3, &p));
  stf_glm_adams(glm, p, true);
  if (p <= 2) self->claims = p == 1 ? STEIF_A_STABLE | STEIF_L_STABLE : STEIF_A_STABLE;
  return STEIF_OK;
}

const steif_table steif_table_am = {
  .name = "am",
  .about =
    "Adams-Moulton, order p: F. R. Moulton (1926); Hairer, Norsett, Wanner: Solving ODEs I, "
    "III.1",
  .kind = STEIF_GLM,
  .fill = fill,
};
