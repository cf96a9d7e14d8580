/* probe_slopes.c: dF/dp as it is given, against differences at the start and at a point near it, where entries are seen
 * that vanish with start values.
 *
 * Differences over [-d, d], [-2d, 2d] and [0, d], d about 6e-6 of p, agree to their errors where F is smooth in p. Rounding
 * of F is what changes of y and y' by some units of rounding make of it, which sees terms that cancel. An entry
 * is called wrong where it is off by ten times the sum of both and by 1e-3 of itself; where a function cannot be
 * evaluated, or is not smooth, nothing is said; nor where F does not move, but does with half of p.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "saltation.h"
#include <math.h>

typedef struct probe {
  steif_solver *s;
  stf_carry *T;
  sunrealtype t;
  N_Vector y, yp;           /* the point */
  N_Vector given, rounding; /* dF/dp_k, of F */
  N_Vector wide, half, F;   /* differences; F at the point */
} probe;

static const sunrealtype sure = 10, relative = 1e-3, units = 8;

/* rounding_i = how far F_i moves with y and y' by some units of rounding. */
static int find_rounding(probe *q)
{
  stf_system *system = &q->s->step.system;
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
static bool far_off(probe *q, int k, N_Vector found, bool *needed)
{
  const int half = (int)(0.5 / cbrt(STF_EPS));
  *needed = false;
  for (sunindextype i = 0; i < q->s->problem->n; i++)
    *needed = *needed || lost(q, stf_array(found), i);
  if (!*needed) return false;
  const bool before = stf_silence(q->s->ctx, true);
  const int code = stf_slopes_between(q->T->slopes, k, q->t, q->y, q->yp, -half, half, q->F);
  stf_silence(q->s->ctx, before);
  return !code;
}

/* The entry that is off the most, in what it may be off by; -1: none. */
static sunindextype find_worst(probe *q, int k, N_Vector found, sunrealtype *bar)
{
  const sunrealtype *c = stf_array(found), *w = stf_array(q->wide), *h = stf_array(q->half),
                    *g = stf_array(q->given), *r = stf_array(q->rounding),
                    *far = stf_array(q->F);
  const sunrealtype d = stf_slopes_increment(q->s->problem->parameters, k);
  bool needed;
  const bool known = far_off(q, k, found, &needed);
  sunindextype worst = -1;
  sunrealtype most = 1;
  for (sunindextype i = 0; i < q->s->problem->n; i++) {
    const sunrealtype spread = fmax(fabs(c[i] - w[i]), fabs(c[i] - h[i])),
                      error = sure * (spread + r[i] / d), off = fabs(g[i] - c[i]),
                      least = fmax(error, relative * fmax(fabs(g[i]), fabs(c[i])));
    if (!(off > most * least) || !isfinite(off)) continue;
    if (needed && lost(q, c, i) && (!known || far[i] != 0)) continue;
    worst = i, most = off / least, *bar = error;
  }
  return worst;
}

static int compare(probe *q, int k, N_Vector found)
{
  sunrealtype bar = 0;
  const sunindextype worst = find_worst(q, k, found, &bar);
  if (worst < 0) return STEIF_OK;
  STEIF_CHECK(!of_other_sign(q, found), q->s->ctx, STEIF_BAD_INPUT,
              "dF/dp of parameter %d of problem '%s' has the wrong sign at the start: F is "
              "y' - f or M y' - f, and its derivative -df/dp",
              k + 1, q->s->problem->name);
  return say(q, k, worst, stf_array(found)[worst], bar);
}

/* Of column k; what cannot be evaluated is left to the first step. */
static int look(probe *q, int k, N_Vector found)
{
  stf_slopes *slopes = q->T->slopes;
  const bool before = stf_silence(q->s->ctx, true);
  int code = stf_slopes_at(slopes, k, q->t, q->y, q->yp, q->given);
  if (!code) code = stf_slopes_between(slopes, k, q->t, q->y, q->yp, -2, 2, q->wide);
  if (!code) code = stf_slopes_between(slopes, k, q->t, q->y, q->yp, 0, 1, q->half);
  if (!code) code = stf_slopes_between(slopes, k, q->t, q->y, q->yp, -1, 1, found);
  stf_silence(q->s->ctx, before);
  return code ? STEIF_OK : compare(q, k, found);
}

static int look_at_all(probe *q, N_Vector found)
{
  const bool before = stf_silence(q->s->ctx, true);
  const int code = find_rounding(q);
  stf_silence(q->s->ctx, before);
  if (code) return STEIF_OK;
  for (int k = 0; k < q->T->count; k++) STEIF_TRY(look(q, q->T->parameter[k], found));
  return STEIF_OK;
}

/* Components above where they were, by amounts without a pattern. */
static void move(probe *q)
{
  const steif_solver *s = q->s;
  const sunrealtype part = 1e-3, golden = 0.6180339887498949;
  const sunrealtype *from = stf_array(s->step.y);
  sunrealtype *y = stf_array(q->y);
  for (sunindextype i = 0; i < s->problem->n; i++) {
    const sunrealtype share = fmod(golden * (sunrealtype)(i + 1), 1);
    y[i] = from[i] + part * (0.5 + share) * fmax(fabs(from[i]), stf_floor(&s->step.system, i));
  }
  q->t = s->step.t + part * (s->t1 - s->step.t);
}

int stf_probe_slopes(steif_solver *s, stf_carry *T)
{
  const stf_step *step = &s->step;
  if (!s->problem->parameters->dFdp) return STEIF_OK;
  probe q = {.s = s, .T = T, .t = step->t, .y = step->y, .yp = step->yp};
  q.given = T->error[0], q.rounding = T->weights[0], q.wide = T->last, q.half = T->last_slope;
  q.F = T->work;
  STEIF_TRY(look_at_all(&q, T->product));
  q.y = T->Y;
  move(&q);
  return look_at_all(&q, T->product);
}
