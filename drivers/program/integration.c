/* integration.c: one integration with the options of a call, and why it stopped.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "integration.h"

steif_options options_of(const struct call *call)
{
  static const enum steif_storage storage[] = {STEIF_DENSE, STEIF_BAND, STEIF_SPARSE,
                                               STEIF_KRYLOV}; /* the words of --storage */
  /* Who names a step size has named the number of steps. */
  const bool constant = given(call, "--h") || given(call, "--hs");
  steif_options o = steif_defaults();
  o.rtol = real_or(call, "--rtol", o.rtol);
  o.atol = real_or(call, "--atol", o.atol);
  o.h = real_of(call, "--h");
  o.t1 = real_of(call, "--t1");
  o.h0 = real_of(call, "--h0");
  o.h_max = real_of(call, "--h-max");
  o.max_steps = whole_or(call, "--max-steps", constant ? 1000000000 : o.max_steps);
  o.max_seconds = real_of(call, "--max-seconds");
  o.stop = interruption_poll();
  o.start = word_of(call, "--start");
  if (given(call, "--initial")) o.initial = (enum steif_initial)choice_of(call, "--initial");
  o.force_storage = given(call, "--storage");
  if (o.force_storage) o.storage = storage[choice_of(call, "--storage")];
  return o;
}

/* What a run that stopped by itself stopped for, if the run made again stops where it did: one that went on from a
 * checkpoint may have had other limits before. */
static void explain(steif_context *ctx, const steif_problem *problem, const char *method,
                    const steif_options *options, bool begins, outcome *o)
{
  static const int codes[] = {STEIF_NOT_FINITE, STEIF_SINGULAR,   STEIF_NO_CONVERGENCE,
                              STEIF_CALLBACK,   STEIF_STEP_LIMIT, STEIF_STEP_SIZE,
                              STEIF_UNSUPPORTED};
  static steif_failure f;
  for (size_t i = 0; i < sizeof codes / sizeof *codes; i++)
    if (o->code == codes[i] && !steif_failure_find(ctx, problem, method, options, &f) &&
        (begins || f.t == o->t))
      snprintf(o->why, sizeof o->why, "%s", f.message);
  speak(o->why, sizeof o->why);
}

/* The sentence of a run that has ended. */
static void describe(steif_context *ctx, outcome *o)
{
  const bool rounded = o->code == STEIF_OK && o->stats.rounding > 1;
  if (rounded)
    snprintf(o->message, sizeof o->message,
             "ok, but rounding errors are about %.2g tolerances: small components are what is "
             "left of large ones, and no step size gives more digits in double precision",
             o->stats.rounding);
  else
    snprintf(o->message, sizeof o->message, "%s",
             o->code == STEIF_OK ? "ok" : steif_message(ctx));
  speak(o->message, sizeof o->message);
}

outcome integrate_from(steif_context *ctx, const steif_problem *problem, const char *method,
                       const steif_options *options, steif_solver **solver,
                       void (*begun)(steif_solver *s, void *user), void *user)
{
  outcome o = {.t = problem->t0};
  const double t1 = options->t1 > 0 ? options->t1 : problem->t1;
  const bool begins = !*solver;
  steif_forget(ctx);
  if (begins) *solver = steif_solver_new(ctx, problem, method, options);
  steif_solver *s = *solver;
  if (s && begins && options->observe)
    options->observe(s, o.t, steif_solution(s), options->observer);
  if (s && begun) begun(s, user);
  o.code = s ? steif_solve_to(s, t1) : steif_status(ctx);
  if (s) {
    o.t = steif_time(s);
    o.stats = *steif_statistics(s);
  }
  describe(ctx, &o);
  if (s && (o.code == STEIF_OK || o.code == STEIF_EVENT))
    o.known =
      steif_problem_digits(ctx, problem, o.t, steif_solution(s),
                           tolerance_ratio(problem, options), &o.scd, &o.mescd) == STEIF_OK;
  steif_forget(ctx);
  return o;
}

outcome integrate(steif_context *ctx, const steif_problem *problem, const char *method,
                  const steif_options *options, steif_solver **solver)
{
  steif_solver *s = solver ? *solver : NULL;
  const bool begins = !s;
  outcome o = integrate_from(ctx, problem, method, options, &s, NULL, NULL);
  if (s && o.code < 0) explain(ctx, problem, method, options, begins, &o);
  if (solver)
    *solver = s;
  else
    steif_solver_free(&s);
  steif_forget(ctx);
  return o;
}
