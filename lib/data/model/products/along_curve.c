/* along_curve.c: Taylor coefficients of the residual along a curve.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "model_file.h"
#include "products.h"
#include "series.h"
#include <steif/model.h>

/* All passes of one equation. */
static int of_equation(stf_model *m, stf_block *block, const stf_equation *e,
                       const stf_feed *feed, const stf_curve *curve, int order, double *F,
                       const char **why)
{
  static const int32_t unit[STF_LOOPS][STF_LOOPS] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const int32_t root = stf_residual_node(m, block, e);
  const int64_t count = stf_passes(&block->box);
  double c[STF_ORDER + 1];
  int32_t counter[STF_LOOPS];
  if (root < 0) return STEIF_NO_MEMORY;
  for (int64_t k = 0; k < count; k++) {
    const int32_t row = e->slot ? e->slot[k] : stf_at_pass(&block->box, k, e->row, e->stride);
    for (int d = 0; d < STF_LOOPS; d++) counter[d] = stf_at_pass(&block->box, k, 0, unit[d]);
    STEIF_TRY(stf_taylor(&block->graph, root, feed, curve, counter, order, &m->sweep, c, why));
    for (int j = 0; j <= order; j++) F[j * (int64_t)m->n + row] = c[j];
  }
  return STEIF_OK;
}

int steif_model_taylor(steif_context *ctx, const steif_problem *p, sunrealtype t, int order,
                       const sunrealtype *y, sunrealtype *F)
{
  STEIF_CHECK(
    p && p->destroy == stf_model_close && y && F, ctx, STEIF_BAD_INPUT,
    "a problem made from a text, coefficients of y and a place for those of F are needed");
  STEIF_CHECK(order >= 0 && order <= STF_ORDER, ctx, STEIF_BAD_INPUT,
              "the order %d must lie in 0 .. %d", order, STF_ORDER);
  stf_model *m = p->user;
  stf_feed feed = m->feed;
  feed.t = t;
  const stf_curve curve = {y, m->n};
  for (size_t i = 0; i < m->blocks.count; i++) {
    stf_block *block = *STF_AT(m->blocks, stf_block *, i);
    for (size_t k = 0; k < block->equations.count; k++) {
      const stf_equation *e = STF_AT(block->equations, stf_equation, k);
      const char *why = NULL;
      const int code = of_equation(m, block, e, &feed, &curve, order, F, &why);
      if (code > 0)
        return STEIF_RECOVER(ctx, STEIF_NOT_FINITE,
                             "an equation of '%s' has no Taylor series at t = %.12g: %s",
                             p->name, t, why ? why : "a coefficient is not finite");
      STEIF_TRY(code);
    }
  }
  return STEIF_OK;
}
