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

int supervise_keep(const steif_supervised_window *window, void *user)
{
  struct supervise_run *run = user;
  if (run->count >= run->room) return 1;
  run->window[run->count++] = *window;
  run->t[run->count] = window->t;
  run->log[run->count] = window->log;
  return 0;
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

/* A signal may have come in the run by error control alone: then the other one is not there. */
static void fill(steif_report *r, const struct call *call, const void *result)
{
  const struct supervise_answer *a = result;
  const bool stopped = a->alone.code == STEIF_STOPPED;
  steif_report_text(r, "problem", call->word[0]);
  steif_report_text(r, "method", call->word[1]);
  steif_report_real(r, "rate", real_of(call, "--rate"));
  steif_report_real(r, "window", real_of(call, "--window"));
  if (stopped || a->alone.code == STEIF_OK) cost(r, "errors", &a->alone, false);
  if (!stopped) cost(r, word_of(call, "--watch"), &a->kept, true);
  for (size_t i = 0; i < (stopped ? a->alone.count : a->kept.count); i++) window(r, a, i);
  steif_report_list(r, "y", a->n, a->y);
}

int supervise_present(const struct call *call, const struct supervise_answer *a)
{
  const struct supervise_run *alone = &a->alone, *kept = &a->kept;
  char title[160];
  const int code = present_result(call, fill, a);
  snprintf(title, sizeof title, "Growth of the linearised solution: %s, %s", call->word[0],
           call->word[1]);
  const steif_curve curve[] = {
    {"supervised", kept->count + 1, kept->t, kept->log, 0},
    {"error control alone", alone->count + 1, alone->t, alone->log, 0}};
  const steif_plot plot = {
    .title = title, .x_label = "t", .y_label = "ln |w|", .count = 2, .curve = curve};
  return code ? code : save_plot(call, &plot, call->plot);
}
