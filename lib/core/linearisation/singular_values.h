/* singular_values.h: singular value decompositions and ranks of rectangular matrices.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_SINGULAR_VALUES_H
#define STF_SINGULAR_VALUES_H

#include "base.h"

/* A = U diag(s) VT, all of U (m x m) and VT (n x n); A is destroyed. Workspace from the
 * context. */
int stf_point_svd(steif_context *ctx, size_t m, size_t n, sunrealtype *A, sunrealtype *s,
                  sunrealtype *U, sunrealtype *VT);
/* Rank by the widest gap of s_0 >= s_1 >= ..., with `top` above and rounding of it below. */
size_t stf_point_rank(const sunrealtype *s, size_t count, sunrealtype top, sunrealtype *gap);

#endif
