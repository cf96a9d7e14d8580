/* hidden.c: the chain of springs.c with one stiff mode of rate lambda=1e4 far beyond its other
 * eigenvalues, which looks algebraic to whoever looks no further: see chain.c.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "generated.h"

static int build(steif_context *ctx, const steif_spec *spec, steif_problem *self)
{
  static const char *const keys[] = {"lambda", "n", "c", "seed", "case", "storage", NULL};
  sunrealtype lambda;
  STEIF_TRY(stf_spec_only(ctx, spec, keys));
  STEIF_TRY(stf_spec_real(ctx, spec, "lambda", 1e-3, 1e12, 1e4, &lambda));
  return stf_chain_build(ctx, spec, self, lambda);
}

const steif_problem steif_problem_hidden = {
  .about =
    "n=200 masses under c=20 position constraints and one coupled mode of rate lambda=1e4, "
    "index 3 (case=inc); a test of certificates: for |s| below lambda the mode "
    "looks like an algebraic unknown",
  .t1 = 10,
  .storage = STEIF_SPARSE,
  .build = build,
  STF_LINEAR_CALLBACKS,
};
