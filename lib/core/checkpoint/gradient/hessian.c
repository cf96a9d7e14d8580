/* hessian.c: products of second derivatives with a direction.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "journey.h"
#include <steif/hessian.h>

int steif_hessian_product(steif_context *ctx, steif_direction *d, const char *method,
                          const steif_options *options, const steif_functional *functional,
                          steif_gradient *g, sunrealtype *Hp, sunrealtype *Hy0)
{
  if (!ctx) return STEIF_BAD_INPUT;
  steif_forget(ctx);
  STEIF_CHECK(d, ctx, STEIF_BAD_INPUT,
              "a product with second derivatives needs a direction: steif_direction_new");
  STEIF_CHECK(Hp || d->count == 0, ctx, STEIF_BAD_INPUT,
              "a product with second derivatives of problem '%s' needs room for %d parameters",
              d->given->name, d->count);
  stf_journey J = {.method = method, .back = {.ctx = ctx}, .line = d, .Hp = Hp, .Hy0 = Hy0};
  J.options = options ? *options : steif_defaults();
  return stf_journey_make(&J, d->given, functional, g);
}
