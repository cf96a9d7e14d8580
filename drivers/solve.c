/* solve.c: one integration.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "run.h"
#include <string.h>

/* What the invariants of the problem have lost or gained. */
static void fill_drift(steif_report *r, steif_solver *s)
{
  enum { SHOWN = 16 };
  sunrealtype drift[SHOWN];
  int count = SHOWN;
  if (s && steif_drift_now(s, &count, drift) == STEIF_OK && count > 0)
    steif_report_list(r, "drift", (size_t)count, drift);
}

static void fill(steif_report *r, const char *const *word, const outcome *o, steif_solver *s,
                 const trajectory *tr)
{
  steif_report_text(r, "problem", word[0]);
  steif_report_text(r, "method", word[1]);
  if (s && strcmp(word[1], steif_method_used(s)))
    steif_report_text(r, "used", steif_method_used(s));
  report_status(r, "", o);
  if (o->why[0]) steif_report_text(r, "failure", o->why);
  steif_report_real(r, "t", o->t);
  steif_report_list(r, "y", s ? tr->n : 0, s ? N_VGetArrayPointer(steif_solution(s)) : NULL);
  report_digits(r, "", o);
  report_stats(r, "stats.", o);
  if (o->stats.rounding > 0) steif_report_real(r, "stats.rounding", o->stats.rounding);
  fill_drift(r, s);
  trajectory_fill(r, tr);
}

/* What there is to show; a failed run is shown up to where it came. */
static int finish(struct call *call, const outcome *o, steif_solver *s, const trajectory *tr)
{
  char title[128];
  snprintf(title, sizeof title, "%s by %s", call->word[0], call->word[1]);
  const bool rounded = o->code == STEIF_OK && o->stats.rounding > 1;
  int code = rounded ? EXIT_UNCERTIFIED : o->code == STEIF_OK ? EXIT_OK : exit_of(o->code);
  fill(tr->report, call->word, o, s, tr);
  const bool shown = call->json || s;
  int output = shown ? show(call, tr->report) : EXIT_OK;
  if (o->code != STEIF_OK || rounded)
    say(call, "%s",
        tr->short_of_memory ? "no memory for the trajectory; leave out --csv, --npz and "
                              "--plot, or ask for fewer --points"
                            : o->message);
  if (o->why[0]) say(call, "%s", o->why);
  if (s && output == EXIT_OK) output = trajectory_save(call, tr);
  if (s && output == EXIT_OK) output = trajectory_plot(call, tr, title);
  return code ? code : output;
}

static int run(struct call *call)
{
  steif_problem p;
  if (steif_problem_find(call->ctx, call->word[0], &p) != STEIF_OK) return fail(call);
  steif_options options = options_of(call);
  trajectory tr;
  int code = trajectory_open(call, &p, &options, &tr);
  steif_solver *s = NULL;
  if (code == EXIT_OK && !(tr.report = steif_report_new(call->ctx))) code = fail(call);
  if (code == EXIT_OK) {
    const outcome o = integrate(call->ctx, &p, call->word[1], &options, &s);
    code = finish(call, &o, s, &tr);
  }
  steif_solver_free(&s);
  steif_report_free(&tr.report);
  trajectory_free(&tr);
  steif_problem_clear(call->ctx, &p);
  return code;
}

static const struct option options[] = {
  {"--rtol", POSITIVE, "R", "relative tolerance (default 1e-6)"},
  {"--atol", POSITIVE, "A", "absolute tolerance (default: rtol times the problem's scale)"},
  {"--h", POSITIVE, "H", "equal steps instead of a tolerance"},
  RUN_OPTIONS,
  {"--at", TIMES, "T,T,...", "the solution at these ascending times instead of steps"},
  {"--points", COUNT, "N", "the same at N equal distances from the start to the end"},
  {"--events", FLAG, NULL, "a table of the events of the problem"},
  {"--npz", OUTPUT, "FILE", "t, y and events as arrays for numpy.load"},
  {NULL, FLAG, NULL, NULL},
};
static const char *const clash[][2] = {
  {"--h", "--rtol"}, {"--h", "--atol"}, {"--at", "--points"}, {NULL, NULL}};

const struct verb verb_solve = {
  "solve",
  "Integrate one problem with one method",
  "PROBLEM METHOD [--rtol R --atol A | --h H] [--t1 T] [--events]",
  2,
  2,
  options,
  clash,
  run};
