/* lyapunov_run.c: what `steif lyapunov` measures: exponents, the verdict on the step, one solution.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "answers.h"
#include "integration.h"

/* The step: its verdict, or why there is none. */
static void decide(struct call *call, const steif_problem *p, const steif_lyapunov_options *o,
                   struct lyapunov_answer *a)
{
  steif_decay *d = &a->decay;
  const int code = steif_decay_find(call->ctx, p, call->word[1], o, real_of(call, "--period"),
                                    given(call, "--search"), d);
  a->judged = code == STEIF_OK;
  a->decided = (a->judged && d->verdict != STEIF_DECAY_UNDECIDED) || code == STEIF_UNSUPPORTED;
  if (code)
    snprintf(d->sentence, sizeof d->sentence, "undecided: %s", steif_message(call->ctx));
  steif_forget(call->ctx);
}

/* --h, or the period by --steps. */
static double step_of(const struct call *call)
{
  return given(call, "--h") ? real_of(call, "--h")
                            : real_of(call, "--period") / (double)whole_of(call, "--steps");
}

/* Of a run that a signal has stopped: what is known, and no verdict that was not reached. */
static int present_part(struct call *call, struct lyapunov_answer *a)
{
  char sentence[500];
  snprintf(sentence, sizeof sentence, "%s",
           steif_status(call->ctx) ? steif_message(call->ctx)
                                   : "stopped by a signal: what was found until then is shown");
  if (!a->judged)
    snprintf(a->decay.sentence, sizeof a->decay.sentence, "undecided: %s", sentence);
  a->decided = true;
  a->t1 = a->facts.end;
  const int output = lyapunov_present(call, a), saved = series_save(call, a);
  if (output || saved) return output ? output : saved;
  say(call, "%s", sentence);
  return interruption_exit();
}

/* The laws, the verdict, and one solution of a linear problem, which can be followed as long as it does not
 * overflow. A signal leaves out what comes after it. */
static int judge(struct call *call, const steif_problem *p, steif_lyapunov_options *o,
                 struct lyapunov_answer *a)
{
  const char *method = call->word[1];
  const int code = steif_lyapunov_verify(call->ctx, p, method, o, real_of(call, "--accuracy"),
                                         real_of(call, "--period"), a->exponent, &a->facts,
                                         a->check, &a->checks);
  if (code && !interrupted()) return code;
  if (!interrupted()) decide(call, p, o, a);
  if (a->t) o->tell = series_tell;
  if (!interrupted() && a->facts.linear) {
    const int growth = steif_growth_measure(call->ctx, p, method, o, &a->growth);
    a->measured = !growth || (growth == STEIF_STOPPED && a->growth.steps > 0);
  }
  if (!interrupted()) steif_forget(call->ctx);
  return STEIF_OK;
}

int lyapunov_measure(struct call *call, const steif_problem *p, struct lyapunov_answer *a)
{
  steif_lyapunov_options o = {.h = step_of(call),
                              .t1 = real_of(call, "--t1"),
                              .transient = real_of(call, "--transient"),
                              .window = real_of(call, "--window"),
                              .count = (int)whole_or(call, "--count", 0),
                              .error = a->error,
                              .separation = a->separation,
                              .user = a,
                              .stop = interruption_poll()};
  const int full = series_open(call, a, (a->t1 - p->t0) / o.h + 2);
  if (full) return full;
  if (a->average) o.average = series_average;
  progress(call, "%s on %s", call->word[1], call->word[0]);
  int code =
    steif_lyapunov(call->ctx, p, call->word[1], &o, a->exponent, a->interval, &a->facts);
  a->count = (size_t)a->facts.count;
  if (code == STEIF_STOPPED && a->facts.steps > 0) return present_part(call, a);
  if (!code) code = judge(call, p, &o, a);
  if (code) return fail(call);
  if (interrupted()) return present_part(call, a);
  const int output = lyapunov_present(call, a), saved = series_save(call, a);
  return saved ? saved : output;
}
