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

/* Of a run that a signal has stopped: what is known, and no verdict. */
static int present_part(struct call *call, struct lyapunov_answer *a)
{
  snprintf(a->decay.sentence, sizeof a->decay.sentence, "undecided: %s",
           steif_message(call->ctx));
  a->decided = true;
  a->t1 = a->facts.end;
  const int output = lyapunov_present(call, a);
  return output ? output : fail(call);
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
                              .stop = interruption_poll()};
  const char *method = call->word[1];
  const double steps = (a->t1 - p->t0) / o.h + 2;
  const int full = steps < 1e8 ? series_open(call, a, (size_t)steps) : EXIT_OK;
  if (full) return full;
  progress(call, "%s on %s", method, call->word[0]);
  const int code =
    steif_lyapunov(call->ctx, p, method, &o, a->exponent, a->interval, &a->facts);
  a->count = (size_t)a->facts.count;
  if (code == STEIF_STOPPED && a->facts.steps > 0) return present_part(call, a);
  if (code || steif_lyapunov_verify(call->ctx, p, method, &o, real_of(call, "--accuracy"),
                                    real_of(call, "--period"), a->exponent, &a->facts, a->check,
                                    &a->checks))
    return fail(call);
  decide(call, p, &o, a);
  /* One solution of a linear problem can be followed as long as it neither overflows nor is 0. */
  if (a->t) o.tell = series_tell, o.user = a;
  a->measured = a->facts.linear && !steif_growth_measure(call->ctx, p, method, &o, &a->growth);
  steif_forget(call->ctx);
  const int output = lyapunov_present(call, a), saved = series_save(call, a);
  return saved ? saved : output;
}
