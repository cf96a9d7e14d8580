/* event_handler.c: what happens at an event, and how a run begins anew behind it.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "integrator.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { GATHER = 10 }; /* restarts within `close` of each other in a row before the run stops */
static const sunrealtype close = 1e-9;
/* Part of the interval in which an event against y' is one of a crowd, and no grazing. */
static const sunrealtype near = 1e-3;

/* The first of those that fire, "'ground'" or "'ground' and others". */
static void name_fired(steif_solver *s)
{
  stf_detector *w = s->events;
  const size_t most = sizeof w->name - sizeof " and others";
  int found = 0;
  for (int i = 0; i < w->count; i++)
    if (w->fired[i] && found++ == 0) stf_event_name(s->problem, i, most, w->name);
  if (found > 1) strcat(w->name, " and others");
}

/* Does function i jump where it fires at t? What it is on both sides differs by more than it can in so short a time, if
 * it is like it is elsewhere in the step. */
static bool jumps(const steif_solver *s, int i, sunrealtype t)
{
  const stf_detector *w = s->events;
  /* Both sides lie 33 resolutions of time apart: 3e-7 of the step or less, in which g moves by much less than 0.01 of its
   * range there unless it jumps. */
  static const sunrealtype apart = 1e8, part = 0.01;
  const sunrealtype h = s->engine ? s->run.stats.h_last : s->step.h;
  sunrealtype low = w->low[i], high = w->low[i];
  if (h < apart * stf_event_tolerance(s, t)) return false;
  for (int k = 0; k < STF_NODES; k++) {
    low = fmin(low, w->node[k * w->count + i]);
    high = fmax(high, w->node[k * w->count + i]);
  }
  return fabs(w->mid[i] - w->low[i]) > part * (high - low);
}

/* Who fires, at t or a little behind it: functions with one root in exact arithmetic do not agree
 * about the last digits. What is on its old side again by then has touched 0, as |t - 1| does. Sides and noise behind
 * the event. */
static int collect(steif_solver *s, sunrealtype t, sunrealtype to, bool *any)
{
  stf_detector *w = s->events;
  *any = false;
  STEIF_TRY(stf_event_value(s, fmin(t + 32 * stf_event_tolerance(s, t), to), w->mid));
  for (int i = 0; i < w->count; i++) {
    const bool now = stf_event_crosses(s, i, w->high[i]);
    const bool soon = stf_event_crosses(s, i, w->mid[i]);
    const sunrealtype after = soon || now ? w->mid[i] : w->high[i];
    const bool touched = now && (w->mid[i] > 0) - (w->mid[i] < 0) == w->sign[i];
    w->fired[i] = (now || soon) && !touched ? -w->sign[i] : 0;
    *any = *any || w->fired[i];
    const bool kept = !w->fired[i] && stf_event_kept(w, i, after);
    if (w->fired[i]) w->noise[i] = jumps(s, i, t) ? 0 : 8 * fabs(w->mid[i] - w->low[i]);
    if (w->fired[i]) w->coarse[i] = 0;
    if (w->fired[i] || (w->sign[i] != 0 && !kept)) w->sign[i] = (after > 0) - (after < 0);
  }
  name_fired(s);
  return STEIF_OK;
}

static bool terminal(const steif_solver *s)
{
  const steif_event *list = s->problem->event_list;
  for (int i = 0; list && i < s->events->count; i++)
    if (s->events->fired[i] && list[i].terminal) return true;
  return false;
}

/* Restarts that crowd together never end: a state that slides along the surface g = 0, or bounces
 * of which infinitely many fit into a finite time. */
static int check_gathering(steif_solver *s, sunrealtype t)
{
  stf_detector *w = s->events;
  const bool crowded = t - w->last <= close * (s->t1 - s->problem->t0);
  w->gathered = crowded ? w->gathered + 1 : 0;
  w->last = t;
  w->crowded = w->gathered >= GATHER;
  STEIF_CHECK(
    !w->crowded, s->ctx, STEIF_STEP_SIZE,
    "the last %d events (%s) of problem '%s' crowd together at t = %.12g: it slides "
    "along the surface of the event or bounces without end; give the model a rule for "
    "that (hysteresis, a sliding mode, rest below a small speed) or end the run there",
    GATHER, w->name, s->problem->name, t);
  return STEIF_OK;
}

bool stf_event_crowded(const steif_solver *s) { return s->events && s->events->crowded; }

/* The step ends at t. Rests too short for the clock are left out. */
static void cut(steif_solver *s, sunrealtype t)
{
  s->end = s->t1 - t <= 32 * STF_EPS * fabs(s->t1) ? s->t1 : t;
}

static int settle(steif_solver *s, sunrealtype t)
{
  stf_detector *w = s->events;
  if (!s->options.reinitialise) return stf_mode_begin(s, t, w->after, w->slope, &w->settled);
  N_VConst(0, w->slope);
  STEIF_TRY(
    s->options.reinitialise(s->ctx, s->problem, t, s->options.rtol, w->after, w->slope));
  w->settled = N_VMaxNorm(w->slope) > 0;
  return STEIF_OK;
}

/* To the handler: what it wishes. */
static int ask_handler(steif_solver *s, sunrealtype t, int *wish)
{
  const steif_problem *p = s->problem;
  const long failures = stf_failures(s->ctx);
  *wish = p->handle_event(t, s->events->after, s->events->fired, p->user);
  if (*wish < 0 && stf_failures(s->ctx) > failures) return steif_status(s->ctx); /* told */
  STEIF_CHECK(*wish >= STEIF_CONTINUE && *wish <= STEIF_FINISH, s->ctx, STEIF_CALLBACK,
              "handle_event of problem '%s' returned %d at the event %s, t = %.12g", p->name,
              *wish, s->events->name, t);
  return STEIF_OK;
}

/* Derivatives pass what handlers do at the event, and modes; y that moves again is a case of its own. */
static int check_left_alone(steif_solver *s, sunrealtype t)
{
  stf_detector *w = s->events;
  N_VLinearSum(1, w->after, -1, w->y, w->y);
  STEIF_CHECK(
    N_VMaxNorm(w->y) == 0, s->ctx, STEIF_UNSUPPORTED,
    "at t = %.12g a jump of problem '%s' makes other conditions true, and their handler "
    "moves y again: what comes after it has no derivatives here",
    t, s->problem->name);
  return STEIF_OK;
}

/* Where the state jumps to the equations that hold from now on, conditions that it makes true or false are events
 * of this instant. *more: the handler has changed the equations again. */
static int react_to_jump(steif_solver *s, sunrealtype t, bool *more)
{
  stf_detector *w = s->events;
  const steif_options *o = &s->options;
  int wish;
  *more = false;
  N_VLinearSum(1, w->after, -1, w->y, w->y);
  if (o->reinitialise || s->engine || !(N_VMaxNorm(w->y) > 0)) return STEIF_OK;
  STEIF_TRY(stf_event_find_jumped(s, t, more));
  if (!*more) return STEIF_OK;
  name_fired(s);
  if (o->on_event && o->on_event(s, t, w->after, w->fired, o->observer))
    s->observer_stopped = true;
  *more = !terminal(s);
  s->finished = !*more;
  if (s->finished) return STEIF_OK;
  if (s->saltation) N_VScale(1, w->after, w->y);
  STEIF_TRY(ask_handler(s, t, &wish));
  s->finished = wish == STEIF_FINISH; /* what is behind the jump has not been shown */
  *more = wish == STEIF_RESTART;
  return s->saltation ? check_left_alone(s, t) : STEIF_OK;
}

/* The state behind the event, with what its jump brings about. */
static int settle_all(steif_solver *s, sunrealtype t)
{
  enum { ROUNDS = 20 };
  stf_detector *w = s->events;
  const size_t bytes = (size_t)w->count * sizeof *w->fired;
  bool more = true;
  memcpy(w->first, w->fired, bytes);
  for (int round = 0; more && round < ROUNDS; round++) {
    N_VScale(1, w->after, w->y);
    STEIF_TRY(settle(s, t));
    STEIF_TRY(react_to_jump(s, t, &more));
  }
  memcpy(w->fired, w->first, bytes);
  STEIF_CHECK(
    !more, s->ctx, STEIF_STEP_SIZE,
    "events of problem '%s' at t = %.12g, last %s, and the jumps that they make follow "
    "each other without end",
    s->problem->name, t, w->name);
  return STEIF_OK;
}

/* Event functions that read what the handler has set are others behind it, clearly off what they were or put on
 * another side: no crossing. w->mid: before. */
static int look_again(steif_solver *s, sunrealtype t)
{
  static const sunrealtype clearly = 1e6; /* times the noise of an event */
  stf_detector *w = s->events;
  if (w->moved && !w->again) return STEIF_OK;
  STEIF_TRY(w->again ? stf_event_value(s, t, w->low) : stf_event_ask(s, t, w->after, w->low));
  for (int i = 0; i < w->count; i++) {
    const bool off = fabs(w->low[i] - w->mid[i]) > clearly * w->noise[i];
    const int side = (w->low[i] > 0) - (w->low[i] < 0);
    const bool put = w->low[i] != w->mid[i] && side != 0 && side != w->sign[i];
    if (!off && !put) continue;
    w->sign[i] = side;
    w->noise[i] = 0;
  }
  return STEIF_OK;
}

static int react(steif_solver *s, sunrealtype t)
{
  stf_detector *w = s->events;
  const steif_problem *p = s->problem;
  stf_observe(s, t, w->after);
  if (s->saltation) STEIF_TRY(stf_saltation_before(s, t));
  if (s->quadratures) STEIF_TRY(stf_quadrature_to(s, t));
  STEIF_TRY(stf_event_find_noise(s, t));
  N_VScale(1, w->after, w->y);
  STEIF_TRY(stf_event_ask(s, t, w->after, w->mid));
  STEIF_TRY(stf_event_pass(s, t));
  int wish;
  STEIF_TRY(ask_handler(s, t, &wish));
  N_VLinearSum(1, w->after, -1, w->y, w->y);
  w->moved = !(N_VMaxNorm(w->y) <= 0);
  s->finished = wish == STEIF_FINISH, w->silent = s->finished;
  w->cut = wish == STEIF_RESTART;
  w->again = wish == STEIF_CONTINUE;
  w->passing = w->passed && !w->again && !s->engine && !s->step.method->dense;
  if (w->again) return look_again(s, t);
  cut(s, t);
  if (w->cut) STEIF_TRY(look_again(s, t));
  if (w->cut) STEIF_TRY(settle_all(s, t));
  stf_space space;
  stf_space_open(&space, w->after);
  STEIF_CHECK(stf_finite(&space, w->after), s->ctx, STEIF_NOT_FINITE,
              "handle_event of problem '%s' left a component that is not finite, at t = %.12g",
              p->name, t);
  if (w->cut && s->saltation) STEIF_TRY(stf_saltation_after(s, t));
  return w->cut ? check_gathering(s, t) : STEIF_OK;
}

/* y' at (t, y), where it is known, else false. */
static bool slopes(steif_solver *s, sunrealtype t, N_Vector y, N_Vector yp)
{
  const stf_run *run = &s->run;
  const bool ode = (s->engine ? run->form : s->step.system.form) == STEIF_ODE;
  if (ode && s->engine) return s->problem->f(t, y, yp, s->problem->user) == 0;
  if (ode) return stf_system_rhs(&s->step.system, t, y, yp) == 0;
  if (t != s->end || (!s->engine && !s->step.yp_known)) return false;
  N_VScale(1, s->engine ? run->yp : s->step.yp, yp);
  return true;
}

/* An event in the same step as the one before, or soon after it. Where y' takes a function that fires back to
 * the side it comes from, the step does not show the way of the solution. */
static int check_way(steif_solver *s, sunrealtype t)
{
  stf_detector *w = s->events;
  const sunrealtype ahead = close * (s->t1 - s->problem->t0);
  bool again = false;
  for (int i = 0; i < w->count; i++)
    again = again ||
            (w->fired[i] && (w->leaves[i] || t - w->last <= near * (s->t1 - s->problem->t0)));
  if (!again || !slopes(s, t, w->after, w->y)) return STEIF_OK;
  STEIF_TRY(stf_event_ask(s, t, w->after, w->low));
  N_VLinearSum(1, w->after, ahead, w->y, w->y);
  STEIF_TRY(stf_event_ask(s, t, w->y, w->mid));
  for (int i = 0; i < w->count; i++)
    if (w->fired[i] * (w->mid[i] - w->low[i]) < 0) return stf_event_below(s, i, t, t - w->last);
  return STEIF_OK;
}

/* To whom wants it: y' of the step at the event, from there on where the step goes on, else up to there. */
static int tell_slope(steif_solver *s, sunrealtype t)
{
  static const sunrealtype part = 1e-8; /* of the interval */
  const steif_problem *p = s->problem;
  stf_detector *w = s->events;
  if (!p->event_slope) return STEIF_OK;
  const sunrealtype h = s->engine ? s->run.stats.h_last : s->step.h;
  const sunrealtype d = fmin(part * (s->t1 - p->t0), h / 2);
  const sunrealtype at = t + d <= s->end ? t + d : t - d;
  STEIF_TRY(stf_dense(s, at, w->y));
  N_VLinearSum(1 / (at - t), w->y, -1 / (at - t), w->after, w->y);
  const int returned = p->event_slope(t, w->after, w->y, p->user);
  STEIF_CHECK(returned == 0, s->ctx, STEIF_CALLBACK,
              "event_slope of problem '%s' returned %d at t = %.12g", p->name, returned, t);
  return STEIF_OK;
}

int stf_event_fire(steif_solver *s, sunrealtype t, sunrealtype to)
{
  stf_detector *w = s->events;
  const steif_options *o = &s->options;
  bool any;
  STEIF_TRY(collect(s, t, to, &any));
  if (!any) return STEIF_OK;
  STEIF_TRY(stf_dense(s, t, w->after));
  s->shown = w->after, s->t_shown = t;
  stf_saltation_forget(s, t);
  if (o->on_event && o->on_event(s, t, w->after, w->fired, o->observer))
    s->observer_stopped = true;
  if (terminal(s)) {
    s->finished = true;
    cut(s, t);
    return STEIF_OK;
  }
  if (!s->problem->handle_event) return STEIF_OK;
  STEIF_TRY(check_way(s, t));
  STEIF_TRY(tell_slope(s, t));
  return react(s, t);
}

bool stf_event_holds(const steif_solver *s) { return s->events->cut || s->finished; }

/* -- behind it ------------------------------------------------------------------------------------ */

static int renew_engine(steif_solver *s)
{
  stf_run *run = &s->run;
  stf_detector *w = s->events;
  N_VScale(1, w->after, run->y);
  w->settled ? N_VScale(1, w->slope, run->yp) : N_VConst(0, run->yp);
  w->settled = false;
  run->t = s->end;
  return s->engine->renew(run, s->engine_state);
}

static int renew_step(steif_solver *s)
{
  stf_step *step = &s->step;
  const bool inside = step->t - s->end > 8 * STF_EPS * fabs(step->t);
  if (inside && s->mesh_at > 0) s->mesh_at--; /* the rest of the given step */
  stf_copy(&step->system.space, s->events->after, step->y);
  step->yp_known = s->events->settled;
  if (step->yp_known) stf_copy(&step->system.space, s->events->slope, step->yp);
  if (s->saltation) stf_saltation_renew(s);
  step->t = s->end;
  step->restart = step->crossed = step->newton.jacobian_wanted = true;
  step->system.filled = false;
  return STEIF_OK;
}

/* A function at zero: its side a little later along y', or where it rests near zero. Dense output would not
 * do: errors within the tolerance may give the beginning of a step the wrong slope. */
static int look_ahead(steif_solver *s, N_Vector y)
{
  stf_detector *w = s->events;
  bool known = true;
  memset(w->leaves, 0, (size_t)w->count * sizeof *w->leaves);
  for (int i = 0; i < w->count; i++) known = known && w->sign[i] != 0;
  if (known || !slopes(s, s->end, y, w->y)) return STEIF_OK;
  const sunrealtype ahead = close * (s->t1 - s->problem->t0);
  N_VLinearSum(1, y, ahead, w->y, w->y);
  STEIF_TRY(stf_event_ask(s, s->end + ahead, w->y, w->mid));
  for (int i = 0; i < w->count; i++) {
    const int there = (w->mid[i] > 0) - (w->mid[i] < 0);
    if (w->sign[i] == 0 && w->low[i] == 0) w->leaves[i] = there;
    const bool rests = w->mid[i] == w->low[i];
    if (w->sign[i] == 0 && (rests || fabs(w->mid[i]) > w->noise[i])) w->sign[i] = there;
  }
  return STEIF_OK;
}

/* The sides behind the event. Where the reaction has left y alone, they are known: a new f that turns
 * the solution back makes it cross again. Else what fired is at zero until it is clearly off it. */
static int start_watch(steif_solver *s)
{
  stf_detector *w = s->events;
  N_Vector y = s->engine ? s->run.y : s->step.y;
  STEIF_TRY(stf_event_ask(s, s->end, y, w->low));
  if (w->started && !w->moved) return STEIF_OK;
  for (int i = 0; i < w->count; i++) {
    if (!w->fired[i]) w->noise[i] = 0, w->coarse[i] = 0;
    const bool off = fabs(w->low[i]) > w->noise[i];
    w->sign[i] = off ? (w->low[i] > 0) - (w->low[i] < 0) : w->coarse[i] ? w->fired[i] : 0;
  }
  w->started = true;
  return look_ahead(s, y);
}

int stf_event_begin(steif_solver *s)
{
  stf_detector *w = s->events;
  for (int i = 0; i < w->count; i++)
    if (w->sign[i] != 0) w->leaves[i] = 0;
  if (w->started && !w->cut) return STEIF_OK;
  if (w->cut) STEIF_TRY(s->engine ? renew_engine(s) : renew_step(s));
  w->cut = false;
  return start_watch(s);
}
