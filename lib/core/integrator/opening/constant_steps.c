/* constant_steps.c: how many steps of one length an interval holds, and what is left of it.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "integrator.h"
#include <math.h>

enum { STEPS_MOST = 1000000000 };

int stf_constant_steps(steif_context *ctx, sunrealtype h, sunrealtype t0, sunrealtype t1,
                       stf_constant *c)
{
  const sunrealtype span = t1 - t0, clock = 4 * STF_EPS * fmax(fabs(t0), fabs(t1));
  STEIF_CHECK(span > 0 && isfinite(span), ctx, STEIF_BAD_INPUT,
              "the run from t = %.12g to %.12g is %g long: its end must lie after its start",
              t0, t1, span);
  STEIF_CHECK(h > 0 && isfinite(h), ctx, STEIF_BAD_INPUT,
              "the step h = %g must be positive and finite", h);
  STEIF_CHECK(
    h <= span + clock, ctx, STEIF_BAD_INPUT,
    "no step of h = %.12g fits between t = %.12g and %.12g: take h = %.12g or less, or "
    "end at %.12g or later",
    h, t0, t1, span, t0 + h);
  const sunrealtype count = floor((span + clock) / h * (1 + 4 * STF_EPS));
  STEIF_CHECK(
    count <= STEPS_MOST, ctx, STEIF_BAD_INPUT,
    "h = %g makes %.4g steps of the interval of length %g, more than %d: take a larger "
    "h or an earlier end",
    h, count, span, STEPS_MOST);
  c->whole = (long)count;
  c->t0 = t0;
  c->h = h;
  c->rest = span - count * h;
  if (!(c->rest > clock)) c->rest = 0;
  c->end = c->rest > 0 ? t0 + count * h : t1;
  return STEIF_OK;
}
