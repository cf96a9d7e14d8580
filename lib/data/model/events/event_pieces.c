/* event_pieces.c: how soon functions of time alone may change again.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "reactions.h"
#include <math.h>

/* |dx/dt|, x of one slope between events; 0: not known. */
static double rate_of(stf_builder *b, int32_t x)
{
  stf_vector partials = {0};
  stf_sweep sweep = {{0}, {0}, {0}};
  double rate = 0;
  const uint32_t at = b->g->at;
  if (!stf_formulas_differentiate(b->g, x, STF_OP_TIME, &sweep, &partials) && partials.count) {
    const int32_t slope = STF_AT(partials, stf_partial, 0)->value;
    const int moves = STF_ON_TIME | STF_ON_STATE | STF_ON_SLOPE | STF_ON_MEMORY | STF_ON_PASS;
    if (!(stf_node_at(b->g, slope)->on & moves) && stf_fixed_value(b->m, b->g, slope, &rate))
      rate = 0;
  }
  b->g->at = at;
  stf_sweep_free(b->m->ctx, &sweep);
  stf_vector_free(b->m->ctx, &partials);
  return fabs(rate);
}

void stf_note_piece(stf_builder *b, int32_t x, double size)
{
  const int on = stf_node_at(b->g, x)->on;
  if (!(on & STF_ON_TIME) || (on & (STF_ON_STATE | STF_ON_SLOPE))) return;
  const double rate = rate_of(b, x), half = 0.5;
  if (rate > 0 && half * size / rate < b->m->piece) b->m->piece = half * size / rate;
}

double stf_lookup_spacing(const stf_lookup *l)
{
  double least = INFINITY;
  for (size_t k = 1; k < l->count; k++) least = fmin(least, l->x[k] - l->x[k - 1]);
  return least;
}
