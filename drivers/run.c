/* run.c: one integration and its line in a report.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "run.h"
#include <signal.h>
#include <string.h>
#include <time.h>

static volatile int stop_flag;
static struct timespec asked; /* when the first SIGINT came */

static double seconds_since(const struct timespec *then)
{
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)(now.tv_sec - then->tv_sec) + 1e-9 * (double)(now.tv_nsec - then->tv_nsec);
}

/* The first SIGINT ends the run after a step, a later one the program. Half a second belongs to
 * the first: timeout(1) and other parents send it to the child and to its group. */
static void on_interrupt(int number)
{
  if (!stop_flag)
    clock_gettime(CLOCK_MONOTONIC, &asked);
  else if (seconds_since(&asked) > 0.5) {
    signal(number, SIG_DFL);
    raise(number);
  }
  stop_flag = 1;
}

bool interrupted(void) { return stop_flag; }

steif_options options_of(const struct call *call)
{
  static const char *const name[] = {"dense", "band", "sparse", "krylov"};
  static const enum steif_storage storage[] = {STEIF_DENSE, STEIF_BAND, STEIF_SPARSE,
                                               STEIF_KRYLOV};
  steif_options o = steif_defaults();
  o.rtol = real_of(call, "--rtol", o.rtol);
  o.atol = real_of(call, "--atol", o.atol);
  o.h = real_of(call, "--h", 0);
  o.t1 = real_of(call, "--t1", 0);
  o.h0 = real_of(call, "--h0", 0);
  o.h_max = real_of(call, "--h-max", 0);
  /* Whoever names a step has named the number of steps. */
  o.max_steps = whole_of(call, "--max-steps",
                         given(call, "--h") || given(call, "--hs") ? 1000000000 : o.max_steps);
  o.max_seconds = real_of(call, "--max-seconds", 0);
  o.stop = &stop_flag;
  o.start = word_of(call, "--start", NULL);
  for (int i = 0; i < 4; i++)
    if (!strcmp(word_of(call, "--storage", ""), name[i]))
      o.storage = storage[i], o.force_storage = 1;
  return o;
}

/* atol/rtol of the run: how much of the size of a component counts as nothing. */
static double tolerance_ratio(const steif_problem *problem, const steif_options *o)
{
  const double scale = problem->rtol_scale > 0 ? problem->rtol_scale : 1;
  return o->atol > 0 && o->rtol > 0 ? o->atol / o->rtol : scale;
}

/* What a run that stopped by itself stopped for. */
static void explain(steif_context *ctx, const steif_problem *problem, const char *method,
                    const steif_options *options, outcome *o)
{
  static const int codes[] = {STEIF_NOT_FINITE, STEIF_SINGULAR,  STEIF_NO_CONVERGENCE,
                              STEIF_CALLBACK,   STEIF_STEP_LIMIT, STEIF_STEP_SIZE,
                              STEIF_UNSUPPORTED};
  static steif_failure f;
  for (size_t i = 0; i < sizeof codes / sizeof *codes; i++)
    if (o->code == codes[i] && !steif_failure_find(ctx, problem, method, options, &f))
      snprintf(o->why, sizeof o->why, "%s", f.message);
}

outcome integrate(steif_context *ctx, const steif_problem *problem, const char *method,
                  const steif_options *options, steif_solver **solver)
{
  outcome o = {.t = problem->t0};
  const double t1 = options->t1 > 0 ? options->t1 : problem->t1;
  steif_forget(ctx);
  steif_solver *s = steif_solver_new(ctx, problem, method, options);
  const struct sigaction ours = {.sa_handler = on_interrupt};
  struct sigaction before;
  sigaction(SIGINT, NULL, &before);
  if (before.sa_handler != SIG_IGN) sigaction(SIGINT, &ours, NULL);
  if (s && options->observe) options->observe(s, o.t, steif_solution(s), options->observer);
  o.code = s ? steif_solve_to(s, t1) : steif_status(ctx);
  sigaction(SIGINT, &before, NULL);
  snprintf(o.message, sizeof o.message, "%s", o.code == STEIF_OK ? "ok" : steif_message(ctx));
  if (s) o.t = steif_time(s), o.stats = *steif_statistics(s);
  if (o.code == STEIF_OK && o.stats.rounding > 1)
    snprintf(o.message, sizeof o.message,
             "ok, but rounding errors are about %.2g tolerances: small components are what is left "
             "of large ones, and no step size gives more digits in double precision",
             o.stats.rounding);
  if (s && (o.code == STEIF_OK || o.code == STEIF_EVENT))
    o.known =
      steif_problem_digits(ctx, problem, o.t, steif_solution(s),
                           tolerance_ratio(problem, options), &o.scd, &o.mescd) == STEIF_OK;
  if (s && o.code < 0) explain(ctx, problem, method, options, &o);
  if (solver)
    *solver = s;
  else
    steif_solver_free(&s);
  steif_forget(ctx);
  return o;
}

static const char *join(char *name, size_t size, const char *prefix, const char *key)
{
  snprintf(name, size, "%s%s", prefix, key);
  return name;
}

void report_maybe(steif_report *r, const char *prefix, const char *key, bool there,
                  double value)
{
  char name[96];
  join(name, sizeof name, prefix, key);
  if (there)
    steif_report_real(r, name, value);
  else
    steif_report_text(r, name, NULL);
}

void report_digits(steif_report *r, const char *prefix, const outcome *o)
{
  report_maybe(r, prefix, "scd", o->known, o->scd);
  report_maybe(r, prefix, "mescd", o->known, o->mescd);
}

void report_status(steif_report *r, const char *prefix, const outcome *o)
{
  char name[96];
  steif_report_text(r, join(name, sizeof name, prefix, "status"), steif_code_name(o->code));
  steif_report_text(r, join(name, sizeof name, prefix, "message"), o->message);
}

void report_stats(steif_report *r, const char *prefix, const outcome *o)
{
  const struct {
    const char *key;
    long count;
  } counts[] = {{"steps", o->stats.steps}, {"rejected", o->stats.rejected},
                {"nfe", o->stats.nfe},     {"nje", o->stats.nje},
                {"nlu", o->stats.nlu},     {"nsolve", o->stats.nsolve}};
  char name[96];
  for (int i = 0; i < 6; i++)
    steif_report_whole(r, join(name, sizeof name, prefix, counts[i].key), counts[i].count);
  if (o->stats.nli > 0)
    steif_report_whole(r, join(name, sizeof name, prefix, "nli"), o->stats.nli);
  steif_report_real(r, join(name, sizeof name, prefix, "cpu_s"), o->stats.cpu_s);
}

void report_run(steif_report *r, const char *method, const steif_problem *problem,
                const steif_options *options, const outcome *o)
{
  const bool steps = options->h > 0;
  steif_report_row(r, "rows");
  steif_report_text(r, "rows.method", method);
  report_maybe(r, "rows.", "rtol", !steps, options->rtol);
  report_maybe(r, "rows.", "atol", !steps, options->rtol * tolerance_ratio(problem, options));
  report_maybe(r, "rows.", "h", steps, options->h);
  report_digits(r, "rows.", o);
  report_status(r, "rows.", o);
  report_stats(r, "rows.", o);
}
