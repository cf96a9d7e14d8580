/* ab.c: Adams-Bashforth formulas of order p = 1 .. 6.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "general.h"

static int fill(steif_context *ctx, const steif_spec *spec, steif_table *self, steif_glm *glm)
{
  int p;
  (void)self;
  STEIF_TRY(stf_spec_only(ctx, spec, (const char *const[]){"", "p", NULL}));
  STEIF_TRY(stf_spec_int(ctx, spec, "p", 1, 6, 2, &p));
  stf_glm_adams(glm, p, false);
  return STEIF_OK;
}

const steif_table steif_table_ab = {
  .name = "ab",
  .about =
    "Adams-Bashforth, order p, explicit: F. Bashforth, J. C. Adams (1883); Hairer, Norsett, "
    "Wanner: Solving ODEs I, III.1",
  .kind = STEIF_GLM,
  .fill = fill,
};
