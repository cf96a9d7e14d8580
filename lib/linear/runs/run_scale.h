/* run_scale.h: the size of the states of a run, which absolute tolerances are measured by where none is
 * given.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_RUN_SCALE_H
#define STF_RUN_SCALE_H

#include "base.h"
#include <steif/impulse.h>

/* max |x| of n values at t0, or what f up to t1 may make of x = 0, max_i |f_i| / (max_j |F_ij| + max_j
 * |E_ij| / (t1 - t0)), where it is larger; at most 1, and 1 where both are 0. */
int stf_run_scale(steif_context *ctx, const steif_linear *linear, const sunrealtype *x,
                  sunrealtype t0, sunrealtype t1, sunrealtype *scale);

#endif
