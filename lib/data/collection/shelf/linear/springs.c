/* springs.c: a chain of n=200 masses, springs and dampers under c=n/10 constraints, index 3: see
 * chain.c.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "generated.h"

static int build(steif_context *ctx, const steif_spec *spec, steif_problem *self)
{
  static const char *const keys[] = {"n", "c", "seed", "case", "storage", NULL};
  STEIF_TRY(stf_spec_only(ctx, spec, keys));
  return stf_chain_build(ctx, spec, self, 0);
}

const steif_problem steif_problem_springs = {
  .about =
    "n=200 masses joined by springs and dampers under c=20 position constraints, index 3, "
    "impulses in velocities and multipliers (case=inc); on the form: E. Eich-Soellner and "
    "C. Fuehrer, Numerical Methods in Multibody Dynamics, Teubner 1998",
  .t1 = 10,
  .storage = STEIF_SPARSE,
  .build = build,
  STF_LINEAR_CALLBACKS,
};
