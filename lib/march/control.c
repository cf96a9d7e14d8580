/* control.c: one accepted step: given, or chosen by the error estimate.
 *
 * Chosen steps follow h_new = 0.9 h (tolerance / error)^(1/(q+1)), with Gustafsson's prediction
 * from two errors (Hairer and Wanner II, IV.8), factors within [1/8, 5], and no change for 1 ..
 * 1.2 so that factors are kept.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "march.h"
#include <math.h>

static const sunrealtype safety = 0.9, shrink_most = 0.125;
enum {
  REFUSALS = 40, /* refused attempts in one step before the run stops */
  HIGHEST = 3 /* index for which steps are chosen on nonlinear equations */
};

/* Of the caller, by rtol and atol, or, for given steps, of Newton's iteration alone. */
int stf_weigh(const steif_solver *s)
{
  const stf_step *step = &s->step;
  const steif_options *o = &s->options;
  const stf_space *space = &step->system.space;
  if (!step->adaptive)
    stf_weights(space, 1e-10, 1e-10 * step->system.scale, NULL, step->y, step->weights);
  else if (!o->ewt)
    stf_weights(space, o->rtol, o->atol, s->atols, step->y, step->weights);
  else {
    const int returned = o->ewt(step->y, step->weights, s->problem->user);
    STEIF_CHECK(returned == 0, s->ctx, STEIF_CALLBACK,
                "ewt of problem '%s' returned %d at t = %.12g", s->problem->name, returned,
                step->t);
    STEIF_CHECK(N_VMin(step->weights) > 0, s->ctx, STEIF_CALLBACK,
                "ewt of problem '%s' gave the weight %g at t = %.12g: weights are positive",
                s->problem->name, N_VMin(step->weights), step->t);
  }
  return STEIF_OK;
}

static int renew_weights(steif_solver *s, sunrealtype h)
{
  stf_step *step = &s->step;
  STEIF_TRY(stf_weigh(s));
  sunrealtype *w = s->problem->index ? N_VGetArrayPointer(step->weights) : NULL;
  for (sunindextype i = 0; w && i < s->problem->n; i++)
    for (int level = s->problem->index[i]; level > 1; level--) w[i] *= h;
  return STEIF_OK;
}

/* The trial becomes the solution. */
static void accept(steif_solver *s, sunrealtype h, sunrealtype t)
{
  stf_step *step = &s->step;
  step->h_try = h;
  step->method->commit(step);
  step->h = h, step->t = t, step->count++;
  step->newton.fresh = step->restart = step->ended = false;
}

/* What a refused attempt with a given step means for the run. */
static int give_up(steif_solver *s, int code) { return code > 0 ? steif_status(s->ctx) : code; }

static int given(steif_solver *s)
{
  stf_step *step = &s->step;
  const steif_options *o = &s->options;
  const bool mesh = o->mesh != NULL;
  const sunrealtype t = mesh ? o->mesh[s->mesh_at + 1]
                             : s->t1 - (sunrealtype)(s->total - s->mesh_at - 1) * step->h_equal;
  const sunrealtype h = mesh || step->restart ? t - step->t : step->h_equal;
  if (!(step->method->traits & STF_EXPLICIT)) STEIF_TRY(renew_weights(s, h));
  const int code = step->method->attempt(step, h);
  if (code) return give_up(s, code);
  if (s->problem->constraint) STEIF_TRY(stf_feasible_keep(s, h, 0));
  accept(s, h, t);
  s->mesh_at++;
  return STEIF_OK;
}

static sunrealtype clamp(sunrealtype x, sunrealtype low, sunrealtype high)
{
  return x < low ? low : x > high ? high : x;
}

/* Length of the next step after an accepted one with relative error e (1 is the limit). */
static sunrealtype grown(const steif_solver *s, sunrealtype h, sunrealtype e)
{
  const sunrealtype power = 1 / (s->step.error_order + 1.0);
  sunrealtype factor = s->step.safety * stf_power(fmax(e, 1e-10), -power);
  if (s->step.count > 1 && s->h_old > 0)
    factor = fmin(factor, s->step.safety * h / s->h_old *
                            stf_power(fmax(s->error_old, 1e-2) / (e * e + 1e-20), power));
  factor = clamp(factor, shrink_most, s->after_reject ? 1 : s->step.grow_most);
  return factor >= 1 && factor <= s->step.keep_up_to ? h : h * factor;
}

/* Fill the way to t_stop without a sliver at its end. */
static sunrealtype fitted(sunrealtype h, sunrealtype left)
{
  return h >= left * (1 - 1e-12) ? left : h > left / 2 ? left / 2 : h;
}

/* An attempt whose refusal is part of normal work: no sentence is made. */
static int quietly(steif_solver *s, sunrealtype h)
{
  const bool hushed = stf_hush(s->ctx, true);
  const int code = s->step.method->attempt(&s->step, h);
  stf_hush(s->ctx, hushed);
  return code;
}

/* The last refusal once more, for its sentence. */
static int aloud(steif_solver *s, sunrealtype h)
{
  const int code = s->step.method->attempt(&s->step, h);
  STEIF_CHECK(code, s->ctx, STEIF_STEP_SIZE,
              "the step of problem '%s' from t = %.12g became %.3g before one succeeded",
              s->problem->name, s->step.t, h);
  return give_up(s, code);
}

static int refused(steif_solver *s, int code, sunrealtype *h, int tries)
{
  stf_step *step = &s->step;
  const sunrealtype least = 10 * STF_EPS * fmax(fabs(step->t), fabs(s->t1 - step->t0) * 1e-16);
  const sunrealtype shorter = *h * (step->shrink > 0 ? step->shrink : tries < 2 ? 0.5 : 0.25);
  s->rejected++;
  s->after_reject = true;
  step->shrink = 0;
  if (code < 0 && code != STEIF_SINGULAR) return code;
  if (tries >= REFUSALS || shorter <= least) return aloud(s, *h);
  *h = shorter;
  return STEIF_OK;
}

/* The longest step that does not go beyond t_stop, rounding included. */
static sunrealtype way(sunrealtype t, sunrealtype t_stop)
{
  sunrealtype left = t_stop - t;
  while (t + left > t_stop) left = nextafter(left, 0);
  return left;
}

static int chosen(steif_solver *s, sunrealtype t_stop)
{
  stf_step *step = &s->step;
  const sunrealtype left = way(step->t, t_stop);
  sunrealtype h = s->h_next;
  for (int tries = 0;; tries++) {
    if (s->options.h_max > 0) h = fmin(h, s->options.h_max);
    h = fitted(h, left);
    STEIF_CHECK(h > 4 * STF_EPS * fabs(step->t), s->ctx, STEIF_STEP_SIZE,
                "the step of problem '%s' became %.3g at t = %.12g, too small for the clock: "
                "loosen the tolerance or look for a singularity there",
                s->problem->name, h, step->t);
    STEIF_TRY(renew_weights(s, h));
    step->tries = tries, step->refused = tries > 0;
    s->h_tried = h;
    const int code = quietly(s, h);
    if (code) {
      STEIF_TRY(refused(s, code, &h, tries));
      continue;
    }
    const sunrealtype e =
      stf_norm(&step->system.space, step->error, step->weights) / step->error_tolerance;
    const int kept =
      e <= 1 && s->problem->constraint ? stf_feasible_keep(s, h, tries) : STEIF_OK;
    if (kept) {
      STEIF_TRY(refused(s, kept, &h, tries));
      continue;
    }
    if (e <= 1) {
      accept(s, h, h == left ? t_stop : step->t + h);
      s->h_next = step->factor > 0 ? h * step->factor : grown(s, h, e);
      s->h_old = h, s->error_old = e, s->after_reject = false;
      return STEIF_OK;
    }
    s->rejected++, s->after_reject = true;
    const sunrealtype power = 1 / (step->error_order + 1.0);
    const sunrealtype factor =
      step->bias > 1 ? pow(step->bias * e, -power) : safety * pow(e, -power);
    h *= isfinite(e) ? clamp(factor, shrink_most, 0.9) : shrink_most;
    STEIF_CHECK(
      tries < REFUSALS, s->ctx, STEIF_STEP_SIZE,
      "the error test of problem '%s' failed %d times at t = %.12g, last with h = %.3g and "
      "%.3g times the tolerance%s",
      s->problem->name, tries, step->t, h, e,
      step->count > 0 ? "" : ": are the start values consistent? steif_consistent finds such, "
                             "method descriptor makes the jumps of linear systems");
  }
}

/* -- breaks ---------------------------------------------------------------------------------- */

/* f may have its new value at a break already, or only behind it: a step towards it ends at the
 * last time before, the next one begins at the first time after, and the solution in between is
 * shown at the break. Breaks too close for a step of their own are passed over. */
static sunrealtype before(sunrealtype at) { return nextafter(at, -INFINITY); }

static bool passed(const steif_solver *s, sunrealtype at)
{
  return before(at) - s->step.t <= 8 * STF_EPS * fabs(s->step.t);
}

static bool at_break(const steif_solver *s)
{
  const steif_problem *p = s->problem;
  return s->next_break < p->break_count && s->step.t == p->breaks[s->next_break];
}

/* The state behind a break, as behind an event. */
static int settle(steif_solver *s)
{
  stf_step *step = &s->step;
  N_VConst(0, step->yp);
  STEIF_TRY(s->options.settle(s->ctx, s->problem, step->t, s->options.rtol, step->y, step->yp));
  step->yp_known = N_VMaxNorm(step->yp) > 0;
  return STEIF_OK;
}

/* Slopes from before a break or an event are of no use; the ode form tells the new ones. */
static int begin_anew(steif_solver *s)
{
  stf_step *step = &s->step;
  const bool broken = at_break(s);
  step->t = nextafter(step->t, INFINITY);
  step->yp_known = s->watch && s->watch->settled;
  if (s->watch) s->watch->settled = false;
  if (broken && s->options.settle) STEIF_TRY(settle(s));
  if (!step->yp_known && step->system.form == STEIF_ODE) {
    const int code = stf_system_rhs(&step->system, step->t, step->y, step->yp);
    if (code < 0) return code;
    step->yp_known = code == STEIF_OK;
  }
  s->h_next = fmin(s->h_next, stf_first_step(s));
  s->h_old = 0;
  return STEIF_OK;
}

/* One chosen step, not beyond t_stop or the next break. */
static int free_step(steif_solver *s, sunrealtype t_stop)
{
  const steif_problem *p = s->problem;
  stf_step *step = &s->step;
  while (s->next_break < p->break_count && passed(s, p->breaks[s->next_break])) s->next_break++;
  const bool breaks = s->next_break < p->break_count && p->breaks[s->next_break] < t_stop;
  if (!breaks) return chosen(s, t_stop);
  const sunrealtype at = p->breaks[s->next_break];
  STEIF_TRY(chosen(s, before(at)));
  if (step->t < before(at)) return STEIF_OK;
  step->t = at, step->restart = true, step->newton.wanted = true;
  return STEIF_OK;
}

/* An unknown of index k carries errors tol / h^(k-1), which no weights make small from 4 on; linear
 * systems have `descriptor`. */
static int check_index(const steif_solver *s)
{
  const stf_step *step = &s->step;
  STEIF_CHECK(step->count > 0 || !step->adaptive || s->problem->dae_index <= HIGHEST ||
                step->system.linear,
              s->ctx, STEIF_UNSUPPORTED,
              "problem '%s' has index %d: steps for nonlinear equations are chosen up to index %d; "
              "differentiate the equations that steif_diagnose names, or give steps with h",
              s->problem->name, s->problem->dae_index, HIGHEST);
  return STEIF_OK;
}

int stf_advance(steif_solver *s, sunrealtype t_stop)
{
  const stf_step *step = &s->step;
  STEIF_TRY(check_index(s));
  STEIF_CHECK(
    step->count < s->options.max_steps, s->ctx, STEIF_STEP_LIMIT,
    "%ld steps made at t = %.12g of problem '%s', the limit: raise max_steps or loosen the "
    "tolerance",
    step->count, step->t, s->problem->name);
  if (step->restart) STEIF_TRY(begin_anew(s));
  if (s->rivals) STEIF_TRY(stf_rivals_look(s));
  const int code = step->adaptive ? free_step(s, t_stop) : given(s);
  if (code && s->rivals) stf_rivals_stay(s);
  return code || !s->rounding ? code : stf_rounding_step(s);
}

sunrealtype stf_first_step(const steif_solver *s)
{
  const stf_step *step = &s->step;
  const steif_options *o = &s->options;
  const sunrealtype span = s->t1 - step->t;
  if (o->h0 > 0) return fmin(o->h0, span);
  if (stf_weigh(s) != STEIF_OK) return 1e-6 * span; /* the first step will say so */
  const sunrealtype size = stf_norm(&step->system.space, step->y, step->weights);
  const sunrealtype slope = stf_norm(&step->system.space, step->yp, step->weights);
  const sunrealtype h = slope > 0 && step->yp_known ? 0.01 * size / slope : 1e-6 * span;
  return clamp(h, 1e-14 * span, 1e-3 * span);
}
