/* etd.c: exponential Runge-Kutta methods for y' = L y + N(t, y): L, declared by the problem or
 * df/dy at the start, is integrated exactly, N explicitly (exponential_data.h).
 * SPDX-License-Identifier: BSD-3-Clause */
#include "exponential_step.h"

static const stf_exponential *find(const steif_spec *spec)
{
  return stf_exponential_find(stf_exponential_rk, stf_exponential_rk_count, spec->name);
}

static int open(stf_step *s, const steif_spec *spec, const steif_table *table)
{
  (void)table;
  return stf_exponential_step_open(s, find(spec), false);
}

static int describe(steif_context *ctx, const steif_spec *spec, const steif_table *table,
                    steif_method_info *info)
{
  (void)table;
  return stf_exponential_step_describe(ctx, spec, find(spec), "etd", info);
}

static bool owns(const char *name)
{
  return stf_exponential_find(stf_exponential_rk, stf_exponential_rk_count, name);
}

static stf_example example(size_t i)
{
  return (stf_example){i < stf_exponential_rk_count ? stf_exponential_rk[i].name : NULL, 6};
}

const steif_method steif_method_etd = {
  .about = "exponential Runge-Kutta",
  .forms = STEIF_ODE,
  .traits = STF_SEMILINEAR,
  .owns = owns,
  .example = example,
  .size = sizeof(stf_exponential_step),
  .open = open,
  .attempt = stf_exponential_step_attempt,
  .commit = stf_exponential_step_commit,
  .dense_by_f = stf_exponential_step_dense,
  .keep = stf_exponential_step_keep,
  .propagator = stf_exponential_step_propagator,
  .describe = describe,
};
