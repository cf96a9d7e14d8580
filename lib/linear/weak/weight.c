/* weight.c: test functions: values, derivatives and integrals over steps.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "spline.h"
#include "table.h"
#include <math.h>

/* Steps beyond this number are short for any g; boxes are halved until they agree so far. */
enum { POWER = 8, PLACES = 400, LONG_STEPS = 256, MOST_PARTS = 64 };
#define BOX_AGREED 1e-18L

stf_weight stf_weight_of(steif_context *ctx, const steif_weight *given)
{
  stf_weight g = {
    .ctx = ctx, .given = given, .t1 = given ? (long double)given->t1 : 1, .parts = 1};
  stf_gauss(STF_BOX, g.node, g.weight);
  return g;
}

static long double power(long double t, int q)
{
  long double value = q % 2 ? -1 : 1;
  if (q > POWER) return 0;
  for (int i = 0; i < q; i++) value *= POWER - i;
  for (int i = q; i < POWER; i++) value *= 1 - t;
  return value;
}

sunrealtype steif_test_function(sunrealtype t, int q)
{
  if (q < 0) return NAN;
  return t >= 1 ? 0 : (sunrealtype)power(t, q);
}

static int evaluate(const stf_weight *g, long double t, int order, long double *derivative)
{
  long double factorial = 1;
  for (int q = 0; !g->given && q <= order; q++) derivative[q] = power(t, q);
  if (!g->given) return STEIF_OK;
  STEIF_CHECK(order < STF_DERIVATIVES, g->ctx, STEIF_UNSUPPORTED,
              "derivative %d of the test function was asked for; %d is the highest", order,
              STF_DERIVATIVES - 1);
  const int code = g->given->taylor(t, order, derivative, g->given->user);
  STEIF_CHECK(!code, g->ctx, STEIF_BAD_INPUT,
              "the test function has no derivatives up to order %d at t = %Lg: take a smooth "
              "one",
              order, t);
  for (int q = 0; q <= order; q++) {
    if (q > 1) factorial *= q;
    derivative[q] *= factorial;
    STEIF_CHECK(
      isfinite(derivative[q]), g->ctx, STEIF_BAD_INPUT,
      "derivative %d of the test function is not finite at t = %Lg: correct it, or end "
      "its interval before",
      q, t);
  }
  return STEIF_OK;
}

int stf_weight_at(const stf_weight *g, long double t, int order, long double *derivative)
{
  if (g->smooth && order == 0) {
    *derivative = stf_spline_value(g->smooth, t);
    return STEIF_OK;
  }
  for (int q = 0; q <= order; q++) derivative[q] = 0;
  return t < g->t1 ? evaluate(g, t, order, derivative) : STEIF_OK;
}

int stf_weight_end(const stf_weight *g, int order, long double *derivative)
{
  return evaluate(g, g->t1 * (1 - 4 * STF_EPS), order, derivative);
}

int stf_weight_box(const stf_weight *g, long double a, long double b, long double *value)
{
  *value = 0;
  if (b > g->t1) b = g->t1;
  if (a >= b) return STEIF_OK;
  const long double width = (b - a) / g->parts;
  for (int p = 0; p < g->parts; p++)
    for (int i = 0; i < STF_BOX; i++) {
      long double at;
      STEIF_TRY(stf_weight_at(g, a + width * (p + g->node[i]), 0, &at));
      *value += width * g->weight[i] * at;
    }
  return STEIF_OK;
}

/* The sum of |int g| over all steps, and of what twice as many parts change of it. */
static int compare(const stf_weight *g, long double h, int steps, long double *apart,
                   long double *size)
{
  stf_weight finer = *g;
  finer.parts = 2 * g->parts;
  *apart = *size = 0;
  for (int i = 0; i < steps; i++) {
    long double one, other;
    STEIF_TRY(stf_weight_box(g, i * h, (i + 1) * h, &one));
    STEIF_TRY(stf_weight_box(&finer, i * h, (i + 1) * h, &other));
    *apart += fabsl(other - one);
    *size += fabsl(other);
  }
  return STEIF_OK;
}

int stf_weight_resolve(stf_weight *g, long double h)
{
  const long double steps = ceill(g->t1 / h);
  long double apart, size;
  g->parts = 1;
  if (!g->given || steps > LONG_STEPS) return STEIF_OK;
  const long double wanted = fmaxl(BOX_AGREED, (long double)g->given->rounding);
  for (;;) {
    STEIF_TRY(compare(g, h, (int)steps, &apart, &size));
    if (apart <= wanted * size || g->parts >= MOST_PARTS) return STEIF_OK;
    g->parts *= 2;
  }
}

int stf_weight_scale(const stf_weight *g, long double *most, long double *rate)
{
  long double slope = 0, bend = 0, d[3];
  *most = 0;
  for (int i = 0; i < PLACES; i++) {
    STEIF_TRY(stf_weight_at(g, g->t1 * (i + 0.5L) / PLACES, 2, d));
    *most = fmaxl(*most, fabsl(d[0]));
    slope = fmaxl(slope, fabsl(d[1]));
    bend = fmaxl(bend, fabsl(d[2]));
  }
  STEIF_CHECK(*most > 0, g->ctx, STEIF_BAD_INPUT,
              "the test function is 0 on [0, %Lg]: give another one", g->t1);
  *rate = fmaxl(slope / *most, sqrtl(bend / *most));
  return STEIF_OK;
}
