/* exprb.c: exponential Rosenbrock methods: L = df/dy at the start of every step, so that no part
 * of the equation need be declared linear (exponential_data.h).
 * SPDX-License-Identifier: BSD-3-Clause */
#include "exponential_step.h"

static const stf_exponential *find(const steif_spec *spec)
{
  return stf_exponential_find(stf_exponential_rb, stf_exponential_rb_count, spec->name);
}

static int open(stf_step *s, const steif_spec *spec, const steif_table *table)
{
  (void)table;
  return stf_exponential_step_open(s, find(spec), true);
}

static int describe(steif_context *ctx, const steif_spec *spec, const steif_table *table,
                    steif_method_info *info)
{
  (void)table;
  return stf_exponential_step_describe(ctx, spec, find(spec), "exprb", info);
}

static bool owns(const char *name)
{
  return stf_exponential_find(stf_exponential_rb, stf_exponential_rb_count, name);
}

static stf_example example(size_t i)
{
  return (stf_example){i < stf_exponential_rb_count ? stf_exponential_rb[i].name : NULL, 7};
}

const steif_method steif_method_exprb = {
  .about = "exponential Rosenbrock",
  .forms = STEIF_ODE,
  .traits = STF_ADAPTIVE | STF_UNCORRECTED,
  .owns = owns,
  .example = example,
  .size = sizeof(stf_exponential_step),
  .open = open,
  .attempt = stf_exponential_step_attempt,
  .commit = stf_exponential_step_commit,
  .dense_by_f = stf_exponential_step_again,
  .keep = stf_exponential_step_keep,
  .propagator = stf_exponential_step_propagator,
  .describe = describe,
};
