/* exact_start.h: a consistent start of a problem whose derivatives along curves are known.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_EXACT_START_H
#define STF_EXACT_START_H

#include <steif/consistent.h>

/* steif_consistent with Taylor coefficients of F (stf_taylor_of) in the place of differences, where there are any. */
int stf_consistent_along(steif_context *ctx, const steif_problem *problem,
                         const steif_point *inquiry, const steif_request *request,
                         int (*taylor)(steif_context *ctx, const steif_problem *problem,
                                       sunrealtype t, int order, const sunrealtype *y,
                                       sunrealtype *F),
                         steif_start *start);

#endif
