/* run.c: the run of a solver: steps, what is shown, limits, statistics.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "integrator.h"
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

/* Seconds by a clock. */
static sunrealtype now(clockid_t clock)
{
  struct timespec t;
  clock_gettime(clock, &t);
  return (sunrealtype)t.tv_sec + 1e-9 * (sunrealtype)t.tv_nsec;
}

sunrealtype steif_time(const steif_solver *s) { return s ? s->t_shown : NAN; }

const char *steif_method_used(const steif_solver *s) { return s ? s->method : NULL; }

N_Vector steif_solution(steif_solver *s) { return s ? s->shown : NULL; }

/* The end of the last step as the method made it; an event may lie before. */
static sunrealtype stepped(const steif_solver *s) { return s->engine ? s->run.t : s->step.t; }

void stf_observe(steif_solver *s, sunrealtype t, N_Vector y)
{
  const long failures = stf_failures(s->ctx);
  s->shown = y, s->t_shown = t;
  if (!s->options.observe || !s->options.observe(s, t, y, s->options.observer)) return;
  s->observer_stopped = true, s->observer_failed = stf_failures(s->ctx) > failures;
}

bool stf_beyond(const steif_solver *s) { return s->final && s->step.t > s->t1; }

N_Vector stf_last(const steif_solver *s)
{
  if (s->events && stf_event_holds(s)) return s->events->after;
  if (stf_beyond(s)) return s->final;
  return s->engine ? s->run.y : s->step.y;
}

static int failed(steif_solver *s, int code)
{
  s->failed = true, s->failure = code > 0 ? steif_status(s->ctx) : code;
  snprintf(s->why, sizeof s->why, "%s", steif_message(s->ctx));
  return s->failure;
}

static int advance(steif_solver *s)
{
  sunrealtype stop;
  int code = stf_event_horizon(s, &stop);
  if (!code)
    code = s->engine ? s->engine->step(&s->run, s->engine_state, stop) : stf_advance(s, stop);
  if (code) return failed(s, code);
  s->end = s->t_shown = stf_beyond(s) ? s->t1 : stepped(s);
  if (stf_beyond(s) && (code = stf_dense(s, s->t1, s->final))) return failed(s, code);
  s->shown = stf_beyond(s) ? s->final : s->engine ? s->run.y : s->step.y;
  return STEIF_OK;
}

static int watched(steif_solver *s)
{
  const sunrealtype from = s->end;
  int code = stf_event_begin(s);
  if (code) return failed(s, code);
  STEIF_TRY(advance(s));
  s->inside = true;
  code = stf_event_step(s, from);
  s->inside = false;
  return code ? failed(s, code) : STEIF_OK;
}

/* With its events and integrals. */
static int integrated(steif_solver *s)
{
  STEIF_TRY(s->events ? watched(s) : advance(s));
  int code = s->quadratures ? stf_quadrature_step(s) : STEIF_OK;
  if (!code) code = stf_probe_later(s);
  return code ? failed(s, code) : STEIF_OK;
}

static sunrealtype passed(const steif_solver *s, sunrealtype begun)
{
  return s->options.max_seconds > 0 ? now(CLOCK_MONOTONIC) - begun : 0;
}

static void look(const steif_solver *s, sunrealtype begun, bool *limit)
{
  const steif_options *o = &s->options;
  limit[0] = o->stop && *o->stop;
  limit[1] = o->max_seconds > 0 && !(passed(s, begun) < o->max_seconds);
}

/* Do other limits than steps allow one more? Ranks know from the end of the last step. */
static int within_limits(steif_solver *s, sunrealtype begun)
{
  const steif_options *o = &s->options;
  const sunrealtype seconds = passed(s, begun);
  bool *limit = s->limit;
  if (!s->limits_known) look(s, begun, limit);
  if (s->agreed && !s->limits_known) stf_agree_any(o->like, 2, limit), s->agreements++;
  s->limits_known = false;
  STEIF_CHECK(!limit[0], s->ctx, STEIF_STOPPED,
              "the run was stopped from outside at t = %.12g after %ld steps", s->end,
              steif_statistics(s)->steps);
  STEIF_CHECK(!limit[1], s->ctx, STEIF_TIME_LIMIT,
              "the run took %.3g seconds to t = %.12g (%ld steps), max_seconds is %.3g: raise "
              "it or loosen the tolerance",
              seconds, s->end, steif_statistics(s)->steps, o->max_seconds);
  return STEIF_OK;
}

bool stf_observed(const steif_solver *s)
{
  const steif_options *o = &s->options;
  return s->agreed || s->events || o->observe || o->stop || o->max_seconds > 0;
}

/* A step and all that may hang on it. */
static int step_once(steif_solver *s, sunrealtype begun)
{
  if (!s->observed) return integrated(s);
  STEIF_TRY(within_limits(s, begun));
  STEIF_TRY(integrated(s));
  if (!(s->finished && s->events->silent)) STEIF_TRY(stf_settle_observed(s));
  const bool asked = s->observer_stopped, explained = s->observer_failed;
  s->observer_stopped = s->observer_failed = false;
  if (asked && !explained)
    STEIF_FAIL(s->ctx, STEIF_CALLBACK, "the observer stopped the run at t = %.12g", s->end);
  const int code = asked ? steif_status(s->ctx) : STEIF_OK;
  if (!s->agreed) return code;
  look(s, begun, s->limit);
  s->limits_known = true, s->agreements++;
  return stf_agree_flags(s->ctx, s->options.like, code, 2, s->limit);
}

/* Steps of an engine that nobody looks at, in one call: what lies between them costs nothing then. Where
 * somebody may stop the run, as many as last a few milliseconds. */
static int stretch(steif_solver *s, sunrealtype t, sunrealtype begun)
{
  const sunrealtype soon = 1e-3;
  const long most = 1024;
  const sunrealtype from = s->observed ? now(CLOCK_MONOTONIC) : 0;
  if (s->observed) STEIF_TRY(within_limits(s, begun));
  const int code = s->engine->advance(&s->run, s->engine_state, t, s->t1, s->stretch);
  s->end = s->t_shown = s->run.t;
  s->shown = s->run.y;
  if (code) return failed(s, code);
  if (s->agreed) return STEIF_OK; /* clocks differ */
  const sunrealtype took = s->observed ? now(CLOCK_MONOTONIC) - from : 0;
  if (took < soon && s->stretch < most) s->stretch *= 2;
  if (took > 10 * soon && s->stretch > 1) s->stretch /= 2;
  return STEIF_OK;
}

static int ready(steif_solver *s)
{
  if (!s) return STEIF_BAD_INPUT;
  STEIF_CHECK(!s->failed, s->ctx, s->failure,
              "the run had failed before, at t = %.12g (%s): make a new solver", s->end,
              s->why);
  return STEIF_OK;
}

/* STEIF_EVENT with its sentence. */
static int ended(steif_solver *s)
{
  return STEIF_FAIL(s->ctx, STEIF_EVENT, "the run ended at t = %.17g by the event %s", s->end,
                    s->events->name);
}

static sunrealtype begin(const steif_solver *s)
{
  return s->options.max_seconds > 0 ? now(CLOCK_MONOTONIC) : 0;
}

static int one_step(steif_solver *s)
{
  STEIF_TRY(ready(s));
  if (s->finished) return ended(s);
  STEIF_CHECK(s->end < s->t1, s->ctx, STEIF_BAD_INPUT,
              "the run is at its end t1 = %.12g: no step is left", s->t1);
  s->limits_known = false;
  STEIF_TRY(step_once(s, begin(s)));
  s->shown = stf_last(s), s->t_shown = s->end;
  STEIF_TRY(stf_settle_shown(s));
  steif_forget(s->ctx);
  return STEIF_OK;
}

int stf_step_untimed(steif_solver *s) { return stf_agreed_end(s, one_step(s)); }

/* Time is counted from here until the next call. */
static void start_clock(steif_solver *s)
{
  s->running = true;
  s->cpu_from = now(CLOCK_PROCESS_CPUTIME_ID);
}

static void stop_clock(steif_solver *s)
{
  s->cpu_s = stf_cpu_seconds(s);
  s->running = false;
}

sunrealtype stf_cpu_seconds(const steif_solver *s)
{
  return s->cpu_s + (s->running ? now(CLOCK_PROCESS_CPUTIME_ID) - s->cpu_from : 0);
}

int steif_solve_step(steif_solver *s)
{
  if (s) start_clock(s);
  const int code = stf_step_untimed(s);
  if (s) stop_clock(s);
  return code;
}

/* Show the solution at t inside the last step. */
static int show(steif_solver *s, sunrealtype t)
{
  STEIF_TRY(steif_dense(s, t, s->dense));
  s->shown = s->dense, s->t_shown = t;
  return STEIF_OK;
}

/* What holds after a break is shown at it, and settled. */
static bool begun_anew(const steif_solver *s)
{
  return s->shown == s->dense && s->t_shown == s->end && !s->engine && s->step.restart;
}

static int solve_to(steif_solver *s, sunrealtype t)
{
  STEIF_TRY(stf_agreed_begin(s, ready(s), "steif_solve_to", t));
  STEIF_CHECK(isfinite(t) && t >= s->problem->t0 &&
                t <= s->t1 * (1 + (s->t1 > 0 ? 1e-14 : -1e-14)),
              s->ctx, STEIF_BAD_INPUT,
              "t = %.17g lies outside the interval [%.17g, %.17g] of the "
              "run: set options.t1",
              t, s->problem->t0, s->t1);
  if (t > s->t1) t = s->t1;
  const sunrealtype begun = begin(s);
  s->limits_known = false;
  start_clock(s);
  int code = STEIF_OK;
  const bool alone = s->engine && s->engine->advance && !s->watched;
  while (!code && s->end < t && !s->finished)
    code = alone ? stretch(s, t, begun) : step_once(s, begun);
  if (!code && s->end > t)
    code = show(s, t);
  else if (!code)
    s->shown = stf_last(s), s->t_shown = s->end, code = stf_break_shown(s);
  if (!code && !begun_anew(s)) code = stf_settle_shown(s);
  stop_clock(s);
  if (!code && s->end < t) return ended(s);
  if (!code) code = stf_check_reached(s);
  if (!code) code = stf_recompute_shown(s);
  if (!code) steif_forget(s->ctx);
  return code;
}

/* No first step from a start that is not consistent: that is the reason, not what Newton's iteration met. */
static int first_step(steif_solver *s, int code)
{
  static const char begins[] = "start: not repaired; ";
  if (code != STEIF_NO_CONVERGENCE || !s || s->engine || s->step.count > 0 ||
      !s->repair.unsolved)
    return code;
  const char *why = s->repair.report.message;
  why += strncmp(why, begins, sizeof begins - 1) ? 0 : sizeof begins - 1;
  const char *symbol = strstr(why, " [STEIF");
  return STEIF_FAIL(s->ctx, code, "no step was made: %.*s",
                    symbol ? (int)(symbol - why) : (int)strlen(why), why);
}

int steif_solve_to(steif_solver *s, sunrealtype t)
{
  const int code = first_step(s, solve_to(s, t));
  return stf_agreed_end(s, code);
}

/* Steps are never evaluated anew at their end, which may be a break, where f is another function already. */
int stf_dense(steif_solver *s, sunrealtype t, N_Vector y)
{
  const steif_method *method = s->step.method;
  const stf_step *step = &s->step;
  if (s->engine) return s->engine->dense(&s->run, s->engine_state, t, y);
  if (stf_event_passed(s)) return stf_event_recall(s, -1, t, y);
  if (method->dense) return method->dense(step, t, y);
  if (fabs(t - step->t) > 2 * STF_EPS * fabs(t)) return method->dense_by_f(&s->step, t, y);
  stf_copy(&step->system.space, step->y, y);
  return STEIF_OK;
}

static int inside(const steif_solver *s, sunrealtype t)
{
  const sunrealtype h = s->engine ? s->run.stats.h_last : s->step.h, from = stepped(s) - h;
  const sunrealtype slack = 1e-12 * (fabs(s->end) + h);
  STEIF_CHECK(s->engine || s->step.count > 0, s->ctx, STEIF_BAD_INPUT,
              "no step has been made yet");
  STEIF_CHECK(t >= from - slack && t <= s->end + slack, s->ctx, STEIF_BAD_INPUT,
              "t = %.17g lies outside the last step [%.17g, %.17g]", t, from, s->end);
  return STEIF_OK;
}

/* All ranks must come where callbacks are called: those of ARKODE's interpolants are not known. */
static bool dense_calls(const steif_solver *s)
{
  return s->engine ? s->engine == stf_engine_find("arkode") : !s->step.method->dense;
}

int steif_dense(steif_solver *s, sunrealtype t, N_Vector y)
{
  if (!s) return STEIF_BAD_INPUT;
  int code = inside(s, t);
  if (dense_calls(s)) code = stf_agreed_begin(s, code, "steif_dense", t);
  return code ? code : stf_dense(s, t, y);
}

int steif_stages(steif_solver *s, int *count, const sunrealtype **c, const sunrealtype **b,
                 N_Vector **X)
{
  if (!count || !c || !b || !X) return STEIF_BAD_INPUT;
  *count = 0;
  if (!s || s->engine || !s->step.method->stages || s->step.count == 0) return STEIF_OK;
  return s->step.method->stages(&s->step, count, c, b, X);
}

const steif_stats *steif_statistics(steif_solver *s)
{
  static const steif_stats none = {0};
  if (!s) return &none;
  steif_stats *out = &s->stats;
  if (s->engine)
    *out = s->run.stats;
  else {
    const stf_step *step = &s->step;
    const steif_pencil_stats *pencil =
      step->system.pencil ? steif_pencil_statistics(step->system.pencil) : NULL;
    *out = (steif_stats){.steps = step->count,
                         .rejected = s->rejected,
                         .nfe = step->system.nfe,
                         .nje = step->system.nje,
                         .newton = step->newton.sweeps,
                         .newton_fails = step->newton.fails,
                         .h_last = step->h,
                         .rounding = s->rounded};
    if (pencil) out->nlu = pencil->factors + pencil->refactors, out->nsolve = pencil->solves;
    if (pencil) out->nli = pencil->iterations;
    out->nlu += step->factors, out->nsolve += step->solves;
    stf_rounding_count(s, out);
  }
  out->cpu_s = s->cpu_s;
  return out;
}
