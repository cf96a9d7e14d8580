/* control.c: one step: of a constant or prescribed length, or of a length that keeps the error estimate below
 * the tolerance.
 *
 * Adaptive lengths follow h_new = safety h (tolerance / error)^(1/(q+1)), with Gustafsson's prediction from
 * two errors (Hairer and Wanner II, IV.8), within the bounds of stf_control: no change for factors
 * from 1 to 1.2, so that factors are kept.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "integrator.h"
#include "carry.h"
#include <math.h>

enum { REJECTIONS = 40 }; /* of one step before the run stops */

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
    const int returned = o->ewt(step->y, step->weights, stf_ewt_user(s));
    STEIF_CHECK(returned == 0, s->ctx, STEIF_CALLBACK,
                "ewt of problem '%s' returned %d at t = %.12g", s->problem->name, returned,
                step->t);
    STEIF_CHECK(N_VMin(step->weights) > 0, s->ctx, STEIF_CALLBACK,
                "ewt of problem '%s' gave the weight %g at t = %.12g: weights are positive",
                s->problem->name, N_VMin(step->weights), step->t);
  }
  return STEIF_OK;
}

/* Weights of the norm in a step of length h: a component of index k counts h^(k-1) times less, unless stages over ranks
 * have it as it will be shown. */
static int weigh_levels(steif_solver *s, sunrealtype h)
{
  stf_step *step = &s->step;
  STEIF_TRY(stf_weigh(s));
  const bool shown = step->table && stf_spread(step->weights) && !s->settles;
  if (!s->problem->index || shown) return STEIF_OK;
  sunindextype rows;
  sunrealtype *w = stf_own_rows(step->weights, &rows);
  for (sunindextype i = 0; w && i < rows; i++)
    for (int level = s->problem->index[i]; level > 1; level--) w[i] *= h;
  return STEIF_OK;
}

/* The trial becomes the solution. */
static void accept(steif_solver *s, sunrealtype h, sunrealtype t)
{
  stf_step *step = &s->step;
  step->h_try = h;
  step->method->commit(step);
  if (step->carry) stf_carry_commit(step->carry);
  step->h = h;
  step->t = t;
  step->count++;
  step->newton.jacobian_new = step->restart = step->crossed = step->end_slope_known = false;
}

/* STEIF_RETRY of an attempt that is not repeated: its cause. */
static int cause(steif_solver *s, int code) { return code > 0 ? steif_status(s->ctx) : code; }

/* -- constant and prescribed step sizes --------------------------------------------------- */

/* Time k of constant steps, counted from that end of the run which is on the grid. */
static sunrealtype grid(const steif_solver *s, long k)
{
  const stf_constant *c = &s->constant;
  if (!(c->rest > 0)) return s->t1 - (sunrealtype)(c->whole - k) * c->h;
  return k <= c->whole || s->final ? c->t0 + (sunrealtype)k * c->h : s->t1;
}

int stf_fixed_step(steif_solver *s)
{
  stf_step *step = &s->step;
  const steif_options *o = &s->options;
  const bool mesh = o->mesh != NULL;
  const sunrealtype t = mesh ? o->mesh[s->mesh_at + 1] : grid(s, s->mesh_at + 1);
  const bool own = mesh || step->restart || (s->mesh_at == s->constant.whole && !s->final);
  const sunrealtype h = own ? t - step->t : step->h_equal;
  if (!(step->method->traits & STF_EXPLICIT)) STEIF_TRY(weigh_levels(s, h));
  const int code = step->method->attempt(step, h);
  if (code) return cause(s, code);
  if (step->carry) {
    const int carried = stf_carry_carry(step->carry, h);
    if (carried) return cause(s, carried);
  }
  if (s->constrained) STEIF_TRY(stf_constraint_keep(s, h, 0));
  accept(s, h, t);
  s->mesh_at++;
  return STEIF_OK;
}

/* -- adaptive step sizes ------------------------------------------------------------------ */

static sunrealtype clamp(sunrealtype x, sunrealtype low, sunrealtype high)
{
  return x < low ? low : x > high ? high : x;
}

/* Estimates of unknowns of index 3 answer to a new length a step late, as their errors come from the end of
 * the step before: a controller without memory makes them swing, and one attempt in three fails. The digital
 * filter H211b with b = 4 of G. Soederlind, ACM Trans. Math. Softw. 29 (2003) 1-26, damps that. */
static sunrealtype filtered(const steif_solver *s, sunrealtype h, sunrealtype e)
{
  const sunrealtype b = 4, wanted = 0.3, least = 1e-6,
                    power = 1 / (s->step.control.order + 1.0);
  const sunrealtype now = wanted / fmax(e, least), before = wanted / fmax(s->error_old, least);
  return stf_power(now * before, power / b) * stf_power(h / s->h_old, -1 / b);
}

/* What several refusals have not cured is rounding, which a step of the old length leaves at once. */
static bool swings(const steif_solver *s)
{
  const stf_step *step = &s->step;
  const sunrealtype rounding = 1e-11;
  const int patient = 3;
  return s->problem->dae_index >= 3 && step->control.order > 2 && !step->system.linear &&
         step->tries < patient && s->options.rtol >= 100 * rounding;
}

/* Length of the next step after an accepted one with relative error e (1 is the limit). */
static sunrealtype next_length(const steif_solver *s, sunrealtype h, sunrealtype e)
{
  const stf_control *c = &s->step.control;
  const sunrealtype power = 1 / (c->order + 1.0);
  if (c->next > 0) return h * c->next;
  const bool before = s->step.count > 1 && s->h_old > 0;
  sunrealtype factor = c->safety * stf_power(fmax(e, 1e-10), -power);
  if (before && swings(s))
    factor = filtered(s, h, e);
  else if (before)
    factor = fmin(factor, c->safety * h / s->h_old *
                            stf_power(fmax(s->error_old, 1e-2) / (e * e + 1e-20), power));
  factor = clamp(factor, c->shrink, s->after_reject ? 1 : c->grow);
  return factor >= 1 && factor <= c->keep ? h : h * factor;
}

/* Fill the way to t_stop without a sliver at its end. */
static sunrealtype fitted(sunrealtype h, sunrealtype left)
{
  return h >= left * (1 - 1e-12) ? left : h > left / 2 ? left / 2 : h;
}

/* A length of few rounding errors of t, as the clock will show it: differences of times are exact. */
static sunrealtype on_the_clock(sunrealtype t, sunrealtype h)
{
  const sunrealtype few = 1e6;
  if (h >= few * STF_EPS * fabs(t)) return h;
  const volatile sunrealtype end = t + h;
  return end - t;
}

/* The length that is tried, in a way of length `left`, where h is wanted. */
static int trial_length(const steif_solver *s, sunrealtype left, sunrealtype *h)
{
  if (s->options.h_max > 0) *h = fmin(*h, s->options.h_max);
  *h = fitted(*h, left);
  if (*h < left) *h = on_the_clock(s->step.t, *h);
  STEIF_CHECK(*h > 4 * STF_EPS * fabs(s->step.t), s->ctx, STEIF_STEP_SIZE,
              "the step of problem '%s' became %.3g at t = %.12g, too small for the clock: "
              "loosen the tolerance or look for a singularity there",
              s->problem->name, *h, s->step.t);
  return STEIF_OK;
}

/* An attempt whose rejection is part of normal work: no sentence is made. */
static int attempt_silently(steif_solver *s, sunrealtype h)
{
  const bool before = stf_silence(s->ctx, true);
  const int code = s->step.method->attempt(&s->step, h);
  stf_silence(s->ctx, before);
  return code;
}

/* The last rejected attempt once more, for its sentence. */
static int explain(steif_solver *s, sunrealtype h)
{
  const int code = s->step.method->attempt(&s->step, h);
  STEIF_CHECK(code, s->ctx, STEIF_STEP_SIZE,
              "the step of problem '%s' from t = %.12g became %.3g before one succeeded",
              s->problem->name, s->step.t, h);
  return cause(s, code);
}

/* A shorter step after one of h. Beginnings judge by errors of stiff components and ask for far too short
 * ones: they try what the clock can tell apart before they give up. */
static sunrealtype shortened(const steif_solver *s, sunrealtype h, sunrealtype factor)
{
  const stf_step *step = &s->step;
  const sunrealtype least = 16 * STF_EPS * fabs(step->t);
  const bool begins = step->count == 0 || step->restart;
  return begins && h > least ? fmax(h * factor, least) : h * factor;
}

/* The attempt could not be completed, or a constraint was not kept: a shorter one. */
static int reject_attempt(steif_solver *s, int code, sunrealtype *h, int tries)
{
  stf_control *c = &s->step.control;
  const sunrealtype least =
    10 * STF_EPS * fmax(fabs(s->step.t), fabs(s->t1 - s->step.t0) * 1e-16);
  const sunrealtype shorter = shortened(s, *h,
                                        c->retry > 0 ? c->retry
                                        : tries < 2  ? 0.5
                                                     : 0.25);
  s->rejected++;
  s->after_reject = true;
  c->retry = 0;
  if (code < 0 && code != STEIF_SINGULAR) return code;
  if (tries >= REJECTIONS || shorter <= least) return explain(s, *h);
  *h = shorter;
  return STEIF_OK;
}

/* The error is e > 1 times what it may be, or not a number. */
static int reject_error(steif_solver *s, sunrealtype e, sunrealtype *h, int tries)
{
  const stf_control *c = &s->step.control;
  const sunrealtype power = 1 / (c->order + 1.0), safety = stf_control_usual.safety;
  const sunrealtype factor = c->bias > 1 ? pow(c->bias * e, -power) : safety * pow(e, -power);
  s->rejected++;
  s->after_reject = true;
  *h = shortened(s, *h, isfinite(e) ? clamp(factor, c->shrink, 0.9) : c->shrink);
  STEIF_CHECK(
    tries<REJECTIONS, s->ctx, STEIF_STEP_SIZE,
          "the error test of problem '%s' failed %d times at t = %.12g, last with h = %.3g and "
          "%.3g times the tolerance%s",
          s->problem->name, tries, s->step.t, *h, e, s->step.count> 0
      ? ""
      : ": are the start values consistent? steif_consistent finds such, "
        "method descriptor makes the jumps of linear systems");
  return STEIF_OK;
}

/* The longest step that does not go beyond t_stop, rounding included. */
static sunrealtype way(sunrealtype t, sunrealtype t_stop)
{
  sunrealtype left = t_stop - t;
  while (t + left > t_stop) left = nextafter(left, 0);
  return left;
}

/* Derivatives through the attempt; the largest error of y and of them. */
static int carry(steif_solver *s, sunrealtype h, sunrealtype *e)
{
  stf_carry *T = s->step.carry;
  const bool before = stf_silence(s->ctx, true);
  const int code = stf_carry_carry(T, h);
  stf_silence(s->ctx, before);
  if (!code && !s->options.untested_sensitivities && !(T->relative <= *e)) *e = T->relative;
  return code;
}

/* One attempt: its relative error e, or why there is none. */
static int attempt(steif_solver *s, sunrealtype h, int tries, sunrealtype *e)
{
  stf_step *step = &s->step;
  step->error_norm = -1;
  STEIF_TRY(attempt_silently(s, h));
  if (!(step->error_norm >= 0))
    step->error_norm = stf_norm(&step->system.space, step->error, step->weights);
  *e = step->error_norm / step->control.tolerance;
  if (step->control.between > *e) *e = step->control.between;
  if (*e <= 1 && step->carry) STEIF_TRY(carry(s, h, e));
  if (*e <= 1 && s->options.test_quadratures) STEIF_TRY(stf_quadrature_test(s, h, e));
  if (!(*e <= 1) || !s->constrained) return STEIF_OK;
  const int code = stf_constraint_keep(s, h, tries);
  if (code == STEIF_RETRY) stf_switching_constrained(s);
  return code;
}

/* Estimate of the error of a run that is a success, in tolerances; and of errors that will not come back to
 * that, which end it early. */
static const sunrealtype most_errors = 7, hopeless = 40;
/* Of problems of index 3, whose velocities keep errors that positions add up, less is known. */
static const sunrealtype most_of_multipliers = 2;

/* Errors that add up, each as small as rounding or a million steps let it be, are no success; what has
 * grown since is not in the sum, and may shrink again. */
static int check_sum(const steif_solver *s)
{
  const sunrealtype sum = s->step.control.accumulated, rtol = s->options.rtol;
  STEIF_CHECK(
    !(sum > hopeless), s->ctx, STEIF_NOT_CERTIFIED,
    "the errors of %ld steps of '%s' add up to about %.2g times the tolerance at t = %.12g: "
    "about %.1f digits are right there, and its order does not allow smaller ones at "
    "rtol = %g; take radau:s=5 or auto, or a larger rtol",
    s->step.count, s->method, sum, s->step.t, -log10(sum * rtol), rtol);
  return STEIF_OK;
}

int stf_check_reached(const steif_solver *s)
{
  const sunrealtype error = s->step.control.reached, rtol = s->options.rtol;
  const sunrealtype most = s->problem->dae_index >= 3 ? most_of_multipliers : most_errors;
  STEIF_CHECK(
    !(error > most), s->ctx, STEIF_NOT_CERTIFIED,
    "the errors of %ld steps of '%s' have become about %.2g times the tolerance at "
    "t = %.12g: about %.1f digits are right there; take radau:s=5 or auto, or a smaller "
    "rtol",
    s->step.count, s->method, error, s->step.t, -log10(error * rtol));
  return STEIF_OK;
}

int stf_adaptive_step(steif_solver *s, sunrealtype t_stop)
{
  stf_step *step = &s->step;
  const sunrealtype left = way(step->t, t_stop);
  sunrealtype h = s->h_next, e;
  for (int tries = 0;; tries++) {
    STEIF_TRY(trial_length(s, left, &h));
    STEIF_TRY(weigh_levels(s, h));
    step->tries = tries;
    step->rejected = tries > 0;
    s->h_tried = h;
    const int code = attempt(s, h, tries, &e);
    if (!code && e <= 1) break;
    STEIF_TRY(code ? reject_attempt(s, code, &h, tries) : reject_error(s, e, &h, tries));
  }
  accept(s, h, h == left ? t_stop : step->t + h);
  s->h_next = next_length(s, h, e);
  s->h_old = h;
  s->error_old = e;
  s->after_reject = false;
  return check_sum(s);
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
  const sunrealtype clock =
    1e3 * STF_EPS * fabs(step->t); /* what t can tell apart, with room */
  const sunrealtype most = fmin(span, fmax(1e-3 * span, clock));
  if (s->settles) return most; /* of short steps unknowns of index 2 have noise / h */
  return clamp(h, fmin(fmax(1e-14 * span, clock), most), most);
}
