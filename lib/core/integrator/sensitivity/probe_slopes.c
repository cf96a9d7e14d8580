/* probe_slopes.c: dF/dp as it is given, against differences at the start and at a point near it, where entries are seen
 * that vanish with start values.
 *
 * Differences over [-d, d], [-2d, 2d] and [0, d], d about 6e-6 of p, agree to their errors where F is smooth in p. Rounding
 * of F is what changes of y and y' by some units of rounding make of it, which sees terms that cancel. An entry
 * is called wrong where it is off by ten times the sum of both and by 1e-3 of itself; where a function cannot be
 * evaluated, or is not smooth, nothing is said; nor where F does not move, but does with half of p.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "probe.h"
#include <math.h>

typedef stf_slope_probe probe;

static const sunrealtype relative = 1e-3, units = 8;

int stf_probe_rounding(stf_slope_probe *q)
{
  stf_system *system = q->at.system;
  const sunindextype n = q->s->problem->n;
  sunrealtype *y = stf_array(q->wide), *yp = stf_array(q->half);
  STEIF_TRY(stf_system_residual(system, q->t, q->y, q->yp, q->F));
  N_VConst(0, q->rounding);
  for (int round = 0; round < 2; round++) {
    N_VScale(1, q->y, q->wide), N_VScale(1, q->yp, q->half);
    for (sunindextype i = 0; i < n; i++) {
      const sunrealtype sign = (i >> round) & 1 ? -1 : 1;
      y[i] *= 1 + sign * units * STF_EPS;
      yp[i] *= 1 - sign * units * STF_EPS;
    }
    STEIF_TRY(stf_system_residual(system, q->t, q->wide, q->half, q->given));
    const sunrealtype *a = stf_array(q->given), *b = stf_array(q->F);
    sunrealtype *r = stf_array(q->rounding);
    for (sunindextype i = 0; i < n; i++)
      r[i] = fmax(r[i], fabs(a[i] - b[i]) + units * STF_EPS * fabs(b[i]));
  }
  return STEIF_OK;
}

/* F is y' - f or M y' - f, and so is its derivative: one of f has the other sign everywhere. */
static bool of_other_sign(probe *q, N_Vector found)
{
  const sunrealtype size = fmax(N_VMaxNorm(q->given), N_VMaxNorm(found));
  N_VLinearSum(1, q->given, 1, found, q->F);
  return size > 0 && N_VMaxNorm(q->F) <= relative * size;
}

static int say(probe *q, int k, sunindextype i, sunrealtype found, sunrealtype bar)
{
  const steif_problem *p = q->s->problem;
  const steif_parameters *all = p->parameters;
  char row[STEIF_SPEC_WORD];
  return STEIF_FAIL(
    q->s->ctx, STEIF_BAD_INPUT,
    "dF/dp of parameter %d%s%.40s%s of problem '%s' is wrong: it gives %.6g in equation %s at "
    "t "
    "= %.6g, "
    "where differences of F are %.6g, to about %.1g; F is y' - f or M y' - f: check this entry "
    "of parameters.dFdp, or leave it NULL",
    k + 1, all->name ? " (" : "", all->name ? all->name[k] : "", all->name ? ")" : "", p->name,
    stf_array(q->given)[i], stf_equation(p, i, row), q->t, found, bar);
}

/* No difference, and a derivative: the equation is without p_k, or p_k is lost in larger terms. */
static bool lost(const probe *q, const sunrealtype *c, sunindextype i)
{
  return stf_array(q->given)[i] != 0 && c[i] == 0 && stf_array(q->wide)[i] == 0 &&
         stf_array(q->half)[i] == 0;
}

/* F := the difference over half of p_k; false: it is not needed, or cannot be had. */
static bool far_off(probe *q, int k, bool *needed)
{
  const int half = (int)(0.5 / cbrt(STF_EPS));
  *needed = false;
  for (sunindextype i = 0; i < q->s->problem->n; i++)
    *needed = *needed || lost(q, stf_array(q->found), i);
  if (!*needed) return false;
  const bool before = stf_silence(q->s->ctx, true);
  const int code = stf_slopes_between(q->slopes, k, q->t, q->y, q->yp, -half, half, q->F);
  stf_silence(q->s->ctx, before);
  return !code;
}

sunindextype stf_probe_worst(const stf_slope_probe *q, sunrealtype d,
                             bool (*unknown)(const stf_slope_probe *q, sunindextype i),
                             sunrealtype *bar)
{
  const sunrealtype *c = stf_array(q->found), *w = stf_array(q->wide), *h = stf_array(q->half),
                    *g = stf_array(q->given), *r = stf_array(q->rounding);
  sunindextype worst = -1;
  sunrealtype most = 1, error;
  for (sunindextype i = 0; i < q->s->problem->n; i++) {
    const sunrealtype excess = stf_probe_excess(g[i], c[i], w[i], h[i], r[i] / d, &error);
    if (!(excess > most) || !isfinite(excess) || (unknown && unknown(q, i))) continue;
    worst = i, most = excess, *bar = error;
  }
  return worst;
}

/* What is lost moves with half of p_k, or that is not known. */
static bool lost_and_unknown(const probe *q, sunindextype i)
{
  return lost(q, stf_array(q->found), i) && (!q->far || stf_array(q->F)[i] != 0);
}

static int compare(probe *q, int k)
{
  sunrealtype bar = 0;
  bool needed;
  q->far = far_off(q, k, &needed);
  const sunindextype worst =
    stf_probe_worst(q, stf_slopes_increment(q->s->problem->parameters, k),
                    needed ? lost_and_unknown : NULL, &bar);
  if (worst < 0) return STEIF_OK;
  STEIF_CHECK(!of_other_sign(q, q->found), q->s->ctx, STEIF_BAD_INPUT,
              "dF/dp of parameter %d of problem '%s' has the wrong sign at t = %.6g: F is "
              "y' - f or M y' - f, and its derivative -df/dp",
              k + 1, q->s->problem->name, q->t);
  return say(q, k, worst, stf_array(q->found)[worst], bar);
}

/* Of column k; what cannot be evaluated is left to the first step. */
static int look(probe *q, int k)
{
  stf_slopes *slopes = q->slopes;
  const bool before = stf_silence(q->s->ctx, true);
  int code = stf_slopes_at(slopes, k, q->t, q->y, q->yp, q->given);
  if (!code) code = stf_slopes_between(slopes, k, q->t, q->y, q->yp, -2, 2, q->wide);
  if (!code) code = stf_slopes_between(slopes, k, q->t, q->y, q->yp, 0, 1, q->half);
  if (!code) code = stf_slopes_between(slopes, k, q->t, q->y, q->yp, -1, 1, q->found);
  stf_silence(q->s->ctx, before);
  return code ? STEIF_OK : compare(q, k);
}

int stf_probe_slopes(stf_slope_probe *q)
{
  const steif_parameters *p = q->s->problem->parameters;
  if (!p || !p->dFdp) return STEIF_OK;
  for (int k = 0; k < q->count; k++) STEIF_TRY(look(q, q->parameter ? q->parameter[k] : k));
  return STEIF_OK;
}
