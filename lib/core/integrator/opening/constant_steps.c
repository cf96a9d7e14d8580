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

/* Where h does not divide the interval the last step is shorter, or goes beyond it. */
int stf_rest_open(steif_solver *s, const stf_constant *c, sunrealtype t1)
{
  if (!(c->rest > 0) || s->step.rest == STF_REST_SHORTER) return STEIF_OK;
  STEIF_CHECK(s->step.rest == STF_REST_ACROSS, s->ctx, STEIF_BAD_INPUT,
              "t1 = %.12g is not a whole number of steps of h = %.12g, and '%s' has neither a "
              "step of another length nor dense output of its order: end at %.12g, or take "
              "h = %.12g",
              t1, c->h, s->method, c->end, (t1 - c->t0) / (double)(c->whole + 1));
  if (!s->final) s->final = stf_pool_vector(s->pool, s->step.y);
  return s->final ? STEIF_OK : STEIF_NO_MEMORY;
}
