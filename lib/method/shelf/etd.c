/* etd.c: exponential Runge-Kutta methods for y' = L y + N(t, y): L, declared by the problem or
 * df/dy at the start, is integrated exactly, N explicitly (exponential.h).
 * SPDX-License-Identifier: BSD-3-Clause */
#include "expo.h"

static const stf_exponential *find(const steif_spec *spec)
{
  return stf_exponential_find(stf_exponential_rk, stf_exponential_rk_count, spec->name);
}

static int open(stf_step *s, const steif_spec *spec, const steif_table *table)
{
  (void)table;
  return stf_expo_open(s, find(spec), false);
}

static int describe(steif_context *ctx, const steif_spec *spec, const steif_table *table,
                    steif_method_info *info)
{
  (void)table;
  return stf_expo_describe(ctx, spec, find(spec), "etd", info);
}

const steif_method steif_method_etd = {
  .about = "exponential Runge-Kutta",
  .forms = STEIF_ODE,
  .traits = STF_SPLITS,
  .size = sizeof(stf_expo),
  .open = open,
  .attempt = stf_expo_attempt,
  .commit = stf_expo_commit,
  .dense = stf_expo_dense,
  .propagator = stf_expo_propagator,
  .describe = describe,
};
