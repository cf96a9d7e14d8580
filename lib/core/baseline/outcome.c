/* outcome.c: before and after a step: breaks, counters, and the sentence of what went wrong.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "baseline.h"
#include "problem.h"
#include <math.h>
#include <stdio.h>

/* --- before a step --- */

/* The last time before the next break: f may have its new value at the break already, or only
 * behind it. Infinite where there is none. Given steps do not look at breaks. */
static sunrealtype before_break(const stf_baseline *base)
{
  const steif_problem *p = base->run->problem;
  const bool none = base->next_break >= p->break_count || base->run->options->h > 0;
  return none ? INFINITY : nextafter(p->breaks[base->next_break], -INFINITY);
}

static void stop_at_break(stf_baseline *base, sunrealtype *t_stop)
{
  while (before_break(base) <= base->run->t) base->next_break++;
  *t_stop = fmin(*t_stop, before_break(base));
}

int stf_baseline_ready(stf_baseline *base, stf_run *run, sunrealtype *t_stop)
{
  STEIF_CHECK(*t_stop > run->t, run->ctx, STEIF_BAD_INPUT,
              "%s is at t = %.12g and cannot go back to %.12g", base->package, run->t, *t_stop);
  STEIF_CHECK(run->stats.steps < run->options->max_steps, run->ctx, STEIF_STEP_LIMIT,
              "%s made %ld steps and is at t = %.12g on the way to %.12g; raise max_steps or "
              "loosen the tolerances",
              base->package, run->stats.steps, run->t, *t_stop);
  base->before = run->t, base->made = run->stats.steps;
  stf_baseline_enter(base, run);
  stop_at_break(base, t_stop);
  return STEIF_OK;
}

sunrealtype stf_baseline_renew(stf_baseline *base)
{
  base->restart = false;
  base->past = base->run->stats;
  stf_coloured_forget(base);
  return nextafter(base->run->t, INFINITY);
}

int stf_baseline_renewed(stf_run *run, void *state)
{
  stf_baseline *base = state;
  (void)run;
  base->restart = true;
  return STEIF_OK;
}

void stf_baseline_count(stf_baseline *base, const steif_stats *now)
{
  stf_run *run = base->run;
  steif_stats *sum = &run->stats;
  const steif_stats *past = &base->past;
  *sum = (steif_stats){.steps = past->steps + now->steps,
                       .rejected = past->rejected + now->rejected,
                       .nfe = past->nfe + now->nfe + stf_coloured_count(base),
                       .nje = past->nje + now->nje,
                       .nlu = past->nlu + now->nlu,
                       .nsolve = past->newton + now->newton,
                       .newton = past->newton + now->newton,
                       .newton_fails = past->newton_fails + now->newton_fails,
                       .nli = past->nli + now->nli,
                       .h_last = now->h_last};
  base->restart = run->t >= before_break(base);
  if (base->restart) run->t = run->problem->breaks[base->next_break];
}

/* --- after it --- */

static const stf_flag *row(const stf_baseline *base, int flag)
{
  static const stf_flag other = {0, STEIF_BASELINE, "an unlisted flag", "see its own words",
                                 "try another method"};
  for (const stf_flag *f = base->flags; f->flag; f++)
    if (f->flag == flag) return f;
  return &other;
}

/* "; f returned -7 at t = 0.3", or nothing. */
static void describe_fault(const stf_baseline *base, size_t room, char *text)
{
  *text = 0;
  if (!base->fault.now) return;
  if (base->fault.verdict)
    snprintf(text, room, "; %s returned %d at t = %.12g", base->fault.who, base->fault.verdict,
             base->fault.t);
  else if (base->fault.at >= 0)
    snprintf(text, room, "; component %lld of %s was not finite at t = %.12g",
             (long long)base->fault.at + 1, base->fault.who, base->fault.t);
  else
    snprintf(text, room, "; %s was not finite at t = %.12g", base->fault.who, base->fault.t);
}

static int code_of(const stf_baseline *base, const stf_flag *f)
{
  if (!base->fault.now) return f->code;
  if (base->fault.verdict < 0) return STEIF_CALLBACK;
  return base->fault.verdict == 0 ? STEIF_NOT_FINITE : f->code;
}

/* A package may go on for ever with steps that vanish against t; a thousand in a row are a
 * failure. */
static int check_progress(stf_baseline *base)
{
  enum { PATIENCE = 1000 };
  const stf_run *run = base->run;
  const long steps = run->stats.steps > base->made ? run->stats.steps - base->made : 1;
  const bool moved = run->t - base->before > 4 * STF_EPS * (sunrealtype)steps * fabs(run->t);
  base->stalls = moved || !run->stats.steps ? 0 : base->stalls + steps;
  if (base->stalls < PATIENCE) return STEIF_OK;
  static const stf_flag stalled = {0, STEIF_STEP_SIZE, "", "", ""};
  char fault[120];
  /* The failure that made the steps small may lie some steps back. */
  base->fault.now = base->fault.who && fabs(base->fault.t - run->t) <= 1e-9 * fabs(run->t);
  describe_fault(base, sizeof fault, fault);
  const int code =
    base->fault.now && base->fault.verdict > 0 ? STEIF_CALLBACK : code_of(base, &stalled);
  return STEIF_FAIL(
    base->run->ctx, code,
    "%s stopped at t = %.12g after %ld steps: the last %d steps (h = %.3g) vanish against t%s. "
    "There may be a singularity or the end of the domain here, or an index above 1: look at y, "
    "declare breaks, or loosen the tolerances",
    base->package, run->t, run->stats.steps, PATIENCE, run->stats.h_last, fault);
}

static int check_solution(const stf_baseline *base)
{
  const stf_run *run = base->run;
  if (run->deferred && stf_deferred_gate(run->like, run->deferred))
    return STEIF_FAIL(run->ctx, STEIF_NO_MEMORY, "another rank could not make its solver");
  if (stf_baseline_finite(run->y)) return STEIF_OK;
  char room[STEIF_SPEC_WORD];
  return STEIF_FAIL(run->ctx, STEIF_NOT_FINITE,
                    "%s returned component %s of y that is not finite at t = %.12g after %ld "
                    "steps and called it success; look for overflow in f",
                    base->package, stf_number_not_finite(run->y, room), run->t,
                    run->stats.steps);
}

int stf_baseline_verdict(stf_baseline *base, int flag, sunrealtype h, int order)
{
  stf_run *run = base->run;
  if (flag >= 0) {
    STEIF_TRY(check_solution(base));
    return check_progress(base);
  }
  if (base->told && steif_status(run->ctx) < 0) return steif_status(run->ctx);
  const stf_flag *f = row(base, flag);
  char fault[120], at_order[24] = "";
  describe_fault(base, sizeof fault, fault);
  if (order > 0) snprintf(at_order, sizeof at_order, ", order %d", order);
  return STEIF_FAIL(
    run->ctx, code_of(base, f),
    "%s stopped at t = %.12g after %ld steps (h = %.3g%s): %s%s%s. %s. %s (%d)%s%s%s",
    base->package, run->t, run->stats.steps, h, at_order, f->what, fault, base->detail,
    f->remedy, f->name, flag, *base->said ? ": \"" : "", base->said, *base->said ? "\"" : "");
}

int stf_baseline_inside(const stf_baseline *base, sunrealtype *t)
{
  const stf_run *run = base->run;
  const sunrealtype h = run->stats.h_last, slack = 1e-12 * (fabs(run->t) + h);
  STEIF_CHECK(*t >= run->t - h - slack && *t <= run->t + slack, run->ctx, STEIF_BAD_INPUT,
              "%s has no solution at t = %.12g: its last step is [%.12g, %.12g]", base->package,
              *t, run->t - h, run->t);
  *t = fmin(fmax(*t, run->t - h), run->t);
  return STEIF_OK;
}

int stf_baseline_dense(stf_baseline *base, int flag, sunrealtype t)
{
  stf_baseline_leave(base);
  STEIF_CHECK(flag >= 0, base->run->ctx, STEIF_BASELINE,
              "%s could not interpolate at t = %.12g (flag %d): %s", base->package, t, flag,
              base->said);
  return STEIF_OK;
}
