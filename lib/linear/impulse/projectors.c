/* projectors.c: the slow spectral projector of a pencil.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "analysis_options.h"
#include "separated_parts.h"
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

/* Without forcing x(0+) = Pi_s x(0-). */
int steif_projector_apply(steif_context *ctx, SUNMatrix E, SUNMatrix F,
                          const steif_analysis *analysis, const steif_structure *structure,
                          const sunrealtype *x, sunrealtype *slow)
{
  steif_impulse i;
  STEIF_CHECK(slow, ctx, STEIF_BAD_INPUT, "no place for the projected vector: it is NULL");
  const int code = steif_impulse_find(ctx, E, F, x, 0, NULL, NULL, analysis, structure, &i);
  if (!code) memcpy(slow, i.x_plus, (size_t)i.n * sizeof *slow);
  if (!code) steif_impulse_clear(ctx, &i);
  return code;
}

int steif_projector_find(steif_context *ctx, SUNMatrix E, SUNMatrix F,
                         const steif_analysis *analysis, sunrealtype *P)
{
  STEIF_CHECK(P, ctx, STEIF_BAD_INPUT, "no place for the projector: it is NULL");
  const steif_analysis a = stf_analysis_resolved(E, F, analysis);
  STEIF_TRY(stf_analysis_check(ctx, E, F, &a));
  STEIF_CHECK(
    stf_analysis_dense(&a), ctx, STEIF_UNSUPPORTED,
    "the projector of order %lld is dense: choose the staircase to have it all the same",
    (long long)(SUNMatGetID(E) == SUNMATRIX_DENSE ? SM_COLUMNS_D(E) : SM_COLUMNS_S(E)));
  return stf_dense_parts(ctx, E, F, &a, &(stf_separated){.slow = P});
}
