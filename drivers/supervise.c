/* supervise.c: keep a decaying solution decaying, beside error control alone.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "run.h"
#include <stdlib.h>
#include <string.h>

/* The windows of one run, and ln |w| at their ends. */
typedef struct journal {
  size_t count, room;
  steif_supervised_window *window;
  double t0, begun, *t, *log; /* count + 1 points */
  steif_supervised facts;
  int code;
} journal;

static int note(const steif_supervised_window *window, void *user)
{
  journal *j = user;
  if (j->count >= j->room) return 1;
  const double before = j->t[j->count];
  j->t[j->count + 1] = window->t;
  j->log[j->count + 1] = j->log[j->count] + window->mu * (window->t - before);
  j->window[j->count++] = *window;
  return 0;
}

static void run_once(const struct call *call, const steif_problem *p, enum steif_watch watch,
                     double *y, journal *j)
{
  const steif_options o = options_of(call);
  const steif_supervision how = {.watch = watch,
                                 .rate = real_of(call, "--rate", 0),
                                 .window = real_of(call, "--window", 0),
                                 .swing = real_of(call, "--swing", 0),
                                 .tell = note,
                                 .user = j};
  progress(call, "%s on %s%s", call->word[1], call->word[0],
           watch == STEIF_WATCH_ONLY ? ", error control alone" : ", supervised");
  j->t[0] = p->t0;
  j->code = steif_supervise(call->ctx, p, call->word[1], &o, &how, y, &j->facts);
  progress(call, NULL);
}

static void cost(steif_report *r, const char *method, const journal *j, bool watched)
{
  const steif_supervised *f = &j->facts;
  steif_report_row(r, "runs");
  steif_report_text(r, "runs.control", method);
  steif_report_whole(r, "runs.steps", f->cost.steps);
  steif_report_whole(r, "runs.rejected", f->cost.rejected);
  steif_report_whole(r, "runs.nsolve", f->cost.nsolve);
  steif_report_real(r, "runs.mu", f->mu);
  steif_report_real(r, "runs.peak", f->peak);
  steif_report_whole(r, "runs.triggers", f->triggers);
  steif_report_whole(r, "runs.redone", f->redone);
  report_maybe(r, "runs.", "cap", watched && f->cap < 1e300, f->cap);
}

static int tell(const struct call *call, const steif_problem *p, const double *y,
                const journal *alone, const journal *kept)
{
  steif_report *r = steif_report_new(call->ctx);
  if (!r) return fail(call);
  steif_report_text(r, "problem", call->word[0]);
  steif_report_text(r, "method", call->word[1]);
  steif_report_real(r, "rate", real_of(call, "--rate", 0));
  steif_report_real(r, "window", real_of(call, "--window", 0));
  if (alone->code == STEIF_OK) cost(r, "errors", alone, false);
  cost(r, word_of(call, "--watch", "windows"), kept, true);
  for (size_t i = 0; i < kept->count; i++) {
    const steif_supervised_window *w = &kept->window[i];
    steif_report_row(r, "rows");
    steif_report_real(r, "rows.t", w->t);
    steif_report_real(r, "rows.mu", w->mu);
    report_maybe(r, "rows.", "mu_errors", i < alone->count,
                 i < alone->count ? alone->window[i].mu : 0);
    steif_report_real(r, "rows.h", w->h);
    steif_report_whole(r, "rows.redone", w->redone);
    steif_report_truth(r, "rows.real", w->real);
  }
  steif_report_list(r, "y", (size_t)p->n, y);
  const int code = present(call, r);
  steif_report_free(&r);
  return code;
}

static int draw(const struct call *call, const journal *alone, const journal *kept)
{
  char title[160];
  snprintf(title, sizeof title, "Growth of the linearised solution: %s, %s", call->word[0],
           call->word[1]);
  const steif_curve curve[] = {
    {"supervised", kept->count + 1, kept->t, kept->log, 0},
    {"error control alone", alone->count + 1, alone->t, alone->log, 0}};
  const steif_plot plot = {title, "t", "ln |w|", 0, 0, 0, 2, curve};
  return save_plot(call, &plot, call->plot);
}

static int both(struct call *call, const steif_problem *p, journal *alone, journal *kept,
                double *y)
{
  const bool sum = !strcmp(word_of(call, "--watch", "windows"), "sum");
  run_once(call, p, STEIF_WATCH_ONLY, y, alone); /* it may well overflow */
  run_once(call, p, sum ? STEIF_WATCH_SUM : STEIF_WATCH_WINDOWS, y, kept);
  if (kept->code != STEIF_OK) return fail(call);
  const int code = tell(call, p, y, alone, kept);
  return code == EXIT_OK ? draw(call, alone, kept) : code;
}

static int prepare(struct call *call, const steif_problem *p)
{
  const double t1 = real_of(call, "--t1", p->t1), window = real_of(call, "--window", 0);
  const double windows = (t1 - p->t0) / window;
  if (!(windows < 1e6))
    return refuse(call, "%g windows of %g: take a longer --window", windows, window);
  const size_t room = (size_t)(windows > 0 ? windows : 0) + 3, n = (size_t)p->n;
  journal alone = {.room = room}, kept = {.room = room};
  double *number = calloc(4 * (room + 1) + n, sizeof *number);
  steif_supervised_window *w = calloc(2 * room, sizeof *w);
  int code = EXIT_FAILED;
  if (number && w) {
    alone.window = w, kept.window = w + room;
    alone.t = number, alone.log = number + room + 1;
    kept.t = number + 2 * (room + 1), kept.log = number + 3 * (room + 1);
    code = both(call, p, &alone, &kept, number + 4 * (room + 1));
  } else
    say(call, "no memory for %zu windows; take a longer --window", room);
  free(w), free(number);
  return code;
}

static int run(struct call *call)
{
  steif_problem p;
  if (!given(call, "--rate") || !given(call, "--window"))
    return refuse(call, "give --rate, the decay per time that is certain, and --window, whole "
                        "periods of the coefficients");
  if (steif_problem_find(call->ctx, call->word[0], &p) != STEIF_OK) return fail(call);
  const int code = prepare(call, &p);
  steif_problem_clear(call->ctx, &p);
  return code;
}

static const struct option options[] = {
  {"--rate", POSITIVE, "G", "decay that is asserted: |w(t)| <= K exp(-G (t - s)) |w(s)|"},
  {"--window", POSITIVE, "H", "length of the windows, two periods of the coefficients or more"},
  {"--rtol", POSITIVE, "R", "relative tolerance"},
  {"--atol", POSITIVE, "A", "absolute tolerance (not used where w is y)"},
  {"--watch", CHOICE, "windows|sum", "undo windows that grow, or cap steps as growth adds up"},
  {"--swing", POSITIVE, "L", "ln K for --watch sum (default 7)"},
  RUN_OPTIONS,
  {NULL, FLAG, NULL, NULL},
};

const struct verb verb_supervise = {
  "supervise",
  "Choose steps that keep a decaying solution decaying",
  "PROBLEM METHOD --rate G --window H [--rtol R --t1 T] [--watch windows|sum]",
  2,
  2,
  options,
  NULL,
  run};
