/* supervise_answer.c: a supervised run beside error control alone, as a report and a picture.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "answers.h"
#include "members.h"
#include <stdlib.h>

bool supervise_open(struct supervise_run *run, size_t room)
{
  *run = (struct supervise_run){.room = room};
  run->window = calloc(room, sizeof *run->window);
  run->t = calloc(2 * (room + 1), sizeof *run->t);
  run->log = run->t ? run->t + room + 1 : NULL;
  return run->window && run->t;
}

void supervise_close(struct supervise_run *run)
{
  free(run->window);
  free(run->t);
}

static void cost(steif_report *r, const char *control, const struct supervise_run *j,
                 bool capped)
{
  static const struct member costs[] = {MEMBER(steif_stats, steps, A_LONG),
                                        MEMBER(steif_stats, rejected, A_LONG),
                                        MEMBER(steif_stats, nsolve, A_LONG), MEMBERS_END};
  static const struct member facts[] = {MEMBER(steif_supervised, mu, A_REAL),
                                        MEMBER(steif_supervised, peak, A_REAL),
                                        MEMBER(steif_supervised, triggers, A_LONG),
                                        MEMBER(steif_supervised, redone, A_LONG), MEMBERS_END};
  const double unlimited = 1e300;
  const steif_supervised *f = &j->facts;
  steif_report_row(r, "runs");
  steif_report_text(r, "runs.control", control);
  report_members(r, "runs.", costs, &f->cost);
  report_members(r, "runs.", facts, f);
  report_maybe(r, "runs.", "cap", capped && f->cap < unlimited, f->cap);
}

static void window(steif_report *r, const struct supervise_answer *a, size_t i)
{
  const bool kept = i < a->kept.count, beside = i < a->alone.count;
  const steif_supervised_window *w = kept ? &a->kept.window[i] : &a->alone.window[i];
  steif_report_row(r, "rows");
  steif_report_real(r, "rows.t", w->t);
  report_maybe(r, "rows.", "mu", kept, w->mu);
  report_maybe(r, "rows.", "mu_errors", beside, beside ? a->alone.window[i].mu : 0);
  steif_report_real(r, "rows.h", w->h);
  steif_report_whole(r, "rows.redone", w->redone);
  steif_report_truth(r, "rows.real", w->real);
}

int supervise_keep(const steif_supervised_window *w, void *user)
{
  struct supervise_run *run = user;
  if (run->count >= run->room) return 1;
  run->window[run->count++] = *w;
  run->t[run->count] = w->t;
  run->log[run->count] = w->log;
  if (!run->rows) return 0;
  window(run->rows->report, run->rows, run->count - 1);
  rows_come(run->rows->call, run->rows->report);
  return 0;
}

void supervise_begin(struct supervise_answer *a)
{
  const struct call *call = a->call;
  steif_report *r = a->report;
  steif_report_text(r, "problem", call->word[0]);
  steif_report_text(r, "method", call->word[1]);
  steif_report_real(r, "rate", real_of(call, "--rate"));
  steif_report_real(r, "window", real_of(call, "--window"));
}

/* A signal may have come in the run by error control alone: then the other one is not there. */
static void finish(struct supervise_answer *a)
{
  steif_report *r = a->report;
  const bool stopped = a->alone.code == STEIF_STOPPED;
  for (size_t i = 0; stopped && i < a->alone.count; i++) window(r, a, i);
  if (stopped || a->alone.code == STEIF_OK) cost(r, "errors", &a->alone, false);
  if (!stopped) cost(r, word_of(a->call, "--watch"), &a->kept, true);
  steif_report_list(r, "y", a->n, a->y);
}

int supervise_present(struct supervise_answer *a)
{
  const struct call *call = a->call;
  const struct supervise_run *alone = &a->alone, *kept = &a->kept;
  char title[160];
  finish(a);
  const int code = present(call, a->report);
  snprintf(title, sizeof title, "Growth of the linearised solution: %s, %s", call->word[0],
           call->word[1]);
  const steif_curve curve[] = {
    {"supervised", kept->count + 1, kept->t, kept->log, 0},
    {"error control alone", alone->count + 1, alone->t, alone->log, 0}};
  const steif_plot plot = {
    .title = title, .x_label = "t", .y_label = "ln |w|", .count = 2, .curve = curve};
  return code ? code : save_plot(call, &plot, call->plot);
}
