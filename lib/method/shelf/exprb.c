/* exprb.c: exponential Rosenbrock methods: L = df/dy at the start of every step, so that no part
 * of the equation need be declared linear (exponential.h).
 * SPDX-License-Identifier: BSD-3-Clause */
#include "expo.h"

static const stf_exponential *find(const steif_spec *spec)
{
  return stf_exponential_find(stf_exponential_rb, stf_exponential_rb_count, spec->name);
}

static int open(stf_step *s, const steif_spec *spec, const steif_table *table)
{
  (void)table;
  return stf_expo_open(s, find(spec), true);
}

static int describe(steif_context *ctx, const steif_spec *spec, const steif_table *table,
                    steif_method_info *info)
{
  (void)table;
  return stf_expo_describe(ctx, spec, find(spec), "exprb", info);
}

const steif_method steif_method_exprb = {
  .about = "exponential Rosenbrock",
  .forms = STEIF_ODE,
  .traits = STF_ADAPTIVE | STF_UNCORRECTED,
  .size = sizeof(stf_expo),
  .open = open,
  .attempt = stf_expo_attempt,
  .commit = stf_expo_commit,
  .dense = stf_expo_dense,
  .propagator = stf_expo_propagator,
  .describe = describe,
};
