/* breaks.c: what comes before and after a step: declared discontinuities of f, reinitialisation, limits.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "integrator.h"
#include <math.h>

enum { HIGHEST_INDEX = 3 }; /* of nonlinear equations with adaptive step sizes */

/* f may have its new value at a break already, or only after it: a step towards it ends at the
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

/* The state after a break, as after an event; shown where it has jumped. */
static int reinitialise(steif_solver *s)
{
  stf_step *step = &s->step;
  const int jumps = s->repair.report.jumps;
  if (stf_settled_by(s)) return stf_settle_break(s);
  if (!s->options.reinitialise) {
    STEIF_TRY(stf_mode_place(s, step->t, step->y));
    if (s->repair.report.jumps > jumps) stf_observe(s, s->end, step->y);
    return STEIF_OK;
  }
  N_VConst(0, step->yp);
  STEIF_TRY(
    s->options.reinitialise(s->ctx, s->problem, step->t, s->options.rtol, step->y, step->yp));
  step->yp_known = N_VMaxNorm(step->yp) > 0;
  return STEIF_OK;
}

int stf_break_shown(steif_solver *s)
{
  const stf_step *step = &s->step;
  if (s->engine || !step->restart || !at_break(s) || s->end >= s->t1 || s->options.reinitialise)
    return STEIF_OK;
  const sunrealtype after = nextafter(step->t, INFINITY);
  N_VScale(1, step->y, s->dense);
  STEIF_TRY(stf_settled_by(s) ? stf_settle(s, after, s->dense)
                              : stf_mode_show(s, after, s->dense));
  s->shown = s->dense;
  return STEIF_OK;
}

/* Slopes from before a break or an event are of no use; the ode form tells the new ones. */
static int restart(steif_solver *s)
{
  stf_step *step = &s->step;
  const bool broken = at_break(s), carried = broken && s->saltation;
  if (carried) STEIF_TRY(stf_saltation_break(s, s->next_break));
  step->t = nextafter(step->t, INFINITY);
  step->yp_known = s->events && s->events->settled;
  if (s->events) s->events->settled = false;
  if (broken) STEIF_TRY(reinitialise(s));
  if (!step->yp_known && step->system.form == STEIF_ODE) {
    const int code = stf_system_rhs(&step->system, step->t, step->y, step->yp);
    if (code < 0) return code;
    step->yp_known = code == STEIF_OK;
  }
  if (carried) STEIF_TRY(stf_saltation_broken(s));
  s->h_next = fmin(s->h_next, stf_first_step(s));
  s->h_old = 0;
  return STEIF_OK;
}

/* One adaptive step, not beyond t_stop or the next break. */
static int step_to_break(steif_solver *s, sunrealtype t_stop)
{
  const steif_problem *p = s->problem;
  stf_step *step = &s->step;
  while (s->next_break < p->break_count && passed(s, p->breaks[s->next_break])) s->next_break++;
  const bool breaks = s->next_break < p->break_count && p->breaks[s->next_break] <= t_stop;
  if (!breaks) return stf_adaptive_step(s, t_stop);
  const sunrealtype at = p->breaks[s->next_break];
  STEIF_TRY(stf_adaptive_step(s, before(at)));
  if (step->t < before(at)) return STEIF_OK;
  step->t = at;
  step->restart = true;
  step->newton.jacobian_wanted = true;
  return STEIF_OK;
}

/* An unknown of index k carries errors tol / h^(k-1), which no weights make small from 4 on; linear
 * systems have `descriptor`. */
static int check_index(const steif_solver *s)
{
  const stf_step *step = &s->step;
  STEIF_CHECK(
    step->count > 0 || !step->adaptive || s->problem->dae_index <= HIGHEST_INDEX ||
      step->system.linear,
    s->ctx, STEIF_UNSUPPORTED,
    "problem '%s' has index %d: adaptive steps for nonlinear equations are made up to index "
    "%d; "
    "differentiate the equations that steif_diagnose names, or prescribe steps with h",
    s->problem->name, s->problem->dae_index, HIGHEST_INDEX);
  return STEIF_OK;
}

/* The order of the method where it is 1 or 2, else 0: of so low a one many steps are no trouble of the problem. */
static int low_order(const steif_solver *s)
{
  enum { MANY = 10000 };
  steif_method_info info = {0};
  if (!s->step.adaptive || s->step.count < MANY) return 0;
  const bool before = stf_silence(s->ctx, true);
  const int code = steif_method_find(s->ctx, steif_method_used(s), &info);
  stf_silence(s->ctx, before);
  return code || info.order > 2 ? 0 : info.order;
}

static int check_limit(const steif_solver *s)
{
  const stf_step *step = &s->step;
  if (step->count < s->options.max_steps) return STEIF_OK;
  const int order = low_order(s);
  STEIF_CHECK(
    !order, s->ctx, STEIF_STEP_LIMIT,
    "%ld steps made at t = %.12g of problem '%s', the limit: '%s' has order %d and takes "
    "%d times the steps for 100 times the accuracy: for rtol = %g take radau:s=5 or "
    "auto, or raise rtol or max_steps",
    step->count, step->t, s->problem->name, s->method, order, order > 1 ? 10 : 100,
    s->options.rtol);
  return STEIF_FAIL(
    s->ctx, STEIF_STEP_LIMIT,
    "%ld steps made at t = %.12g of problem '%s', the limit: raise max_steps or "
    "loosen the tolerance",
    step->count, step->t, s->problem->name);
}

int stf_advance(steif_solver *s, sunrealtype t_stop)
{
  const stf_step *step = &s->step;
  STEIF_TRY(check_index(s));
  STEIF_TRY(check_limit(s));
  if (step->restart) STEIF_TRY(restart(s));
  if (s->switching) STEIF_TRY(stf_switching_look(s));
  if (step->adaptive && step->count >= s->pace.steps) STEIF_TRY(stf_corner_check(s));
  const int code = step->adaptive ? step_to_break(s, t_stop) : stf_fixed_step(s);
  if (code && s->switching) stf_switching_stay(s);
  return code || !s->rounding ? code : stf_rounding_step(s);
}
