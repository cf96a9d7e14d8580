/* trajectory.c: the accepted steps of a run, or its solution at times asked for, and its events.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "trajectory.h"
#include "saved_note.h"
#include "saved_run.h"
#include <float.h>
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

/* ---- times asked for ---- */

static int ask(struct call *call, trajectory *tr)
{
  double at[REALS_MOST];
  const size_t given_times = reals_of(call, "--at", at);
  tr->asked = given_times ? given_times : (size_t)whole_of(call, "--points");
  if (tr->asked == 0 && !call->plot) return EXIT_OK;
  tr->at = malloc((tr->asked + 1) * sizeof *tr->at);
  tr->between = tr->at ? N_VNew_Serial(tr->problem->n, steif_sundials(call->ctx)) : NULL;
  if (!tr->between) return no_memory(call, "the times asked for", "ask for fewer");
  const double width = tr->asked > 1 ? (tr->t1 - tr->t0) / (double)(tr->asked - 1) : 0;
  for (size_t i = 0; i < tr->asked; i++) {
    tr->at[i] = given_times ? at[i] : i + 1 < tr->asked ? tr->t0 + width * (double)i : tr->t1;
    if (tr->at[i] < tr->t0 || tr->at[i] > tr->t1 || (i && tr->at[i] <= tr->at[i - 1]))
      return bad_usage(
        call, "--at must be times that ascend within [%g, %g]; %g is out of order or outside",
        tr->t0, tr->t1, tr->at[i]);
  }
  return EXIT_OK;
}

/* ---- steps and events as they come ---- */

static bool grow(trajectory *tr)
{
  const size_t room = tr->room ? 2 * tr->room : 256;
  double *t = realloc(tr->t, room * sizeof *t);
  if (t) tr->t = t;
  double *y = t ? realloc(tr->y, room * tr->n * sizeof *y) : NULL;
  if (!y) return false;
  tr->y = y;
  double *output = realloc(tr->output, (room * tr->outputs + 1) * sizeof *output);
  if (!output) return false;
  tr->output = output;
  tr->room = room;
  return true;
}

int trajectory_keep(trajectory *tr, double t, N_Vector y)
{
  if (tr->count == tr->room && !grow(tr)) {
    tr->short_of_memory = true;
    return -1;
  }
  tr->t[tr->count] = t;
  memcpy(tr->y + tr->count * tr->n, N_VGetArrayPointer(y), tr->n * sizeof *tr->y);
  if (tr->outputs) steif_model_outputs(tr->problem, t, y, tr->output + tr->count * tr->outputs);
  tr->count++;
  return 0;
}

/* A line on a terminal, four times a second. */
static void tell(trajectory *tr, double t)
{
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  const double seconds = (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
  if (seconds < tr->shown + 0.25) return;
  tr->shown = seconds;
  progress(tr->call, "t = %.4g of %.4g, %.0f %%", t, tr->t1,
           100 * (t - tr->t0) / (tr->t1 - tr->t0));
}

/* The solution at the next time asked for; multipliers of large systems as the method has them. */
static int row_at(trajectory *tr, steif_solver *s, sunrealtype t, N_Vector y)
{
  enum { FEW = 64 };
  const double at = tr->at[tr->next];
  if (tr->n <= FEW) return steif_output(s, at, tr->between);
  if (at < t) return steif_dense(s, at, tr->between);
  N_VScale(1, y, tr->between);
  return STEIF_OK;
}

/* Is the last row of time t, up to the rounding with which events are located? */
static bool at_end(const trajectory *tr, double t)
{
  return fabs(tr->t[tr->count - 1] - t) <= 64 * DBL_EPSILON * fabs(t);
}

/* At the time of an event the solution is what holds after it, which is seen a moment later: the row at the end of
 * a step waits for that. Of events that leave y alone, outputs may have changed. */
static bool settled(trajectory *tr, double t, N_Vector y)
{
  if (!tr->waiting) return false;
  const size_t last = tr->count - 1;
  const bool same = at_end(tr, t);
  double *row = tr->y + last * tr->n;
  tr->waiting = false;
  if (same) memcpy(row, N_VGetArrayPointer(y), tr->n * sizeof *row);
  if (!tr->outputs) return same;
  memcpy(N_VGetArrayPointer(tr->between), row, tr->n * sizeof *row);
  steif_model_outputs(tr->problem, tr->t[last], tr->between, tr->output + last * tr->outputs);
  return same;
}

void trajectory_end(trajectory *tr, double t, N_Vector y)
{
  settled(tr, t, y);
  trajectory_stream(tr);
}

static int keep(trajectory *tr, steif_solver *s, sunrealtype t, N_Vector y)
{
  const struct call *c = tr->call;
  const bool saved = c->continues || given(c, "--checkpoint"); /* which holds the steps alone */
  if (c->plot && !saved && trajectory_draw(tr, s, t, y)) return -1;
  if (tr->asked == 0)
    return c->csv || c->npz || c->h5 || (c->plot && saved) ? trajectory_keep(tr, t, y) : 0;
  if (settled(tr, t, y)) return 0;
  for (; tr->next < tr->asked && tr->at[tr->next] <= t; tr->next++) {
    if (row_at(tr, s, t, y) != STEIF_OK) return -1;
    if (trajectory_keep(tr, tr->at[tr->next], tr->between)) return -1;
  }
  return 0;
}

static int observe(steif_solver *s, sunrealtype t, N_Vector y, void *user)
{
  trajectory *tr = user;
  if (tr->live) tell(tr, t);
  const int code = keep(tr, s, t, y);
  tr->waiting = tr->asked && tr->count && at_end(tr, t);
  trajectory_stream(tr);
  return code ? code : saved_run_tick(tr, s);
}

static bool more_events(trajectory *tr)
{
  const size_t room = tr->event_room ? 2 * tr->event_room : 64;
  double **const column[] = {&tr->event_t, &tr->event_which, &tr->event_direction};
  for (int i = 0; i < 3; i++) {
    double *longer = realloc(*column[i], room * sizeof *longer);
    if (!longer) return false;
    *column[i] = longer;
  }
  size_t *number = realloc(tr->event_number, room * sizeof *number);
  if (!number) return false;
  tr->event_number = number;
  tr->event_room = room;
  return true;
}

static int keep_event(steif_solver *s, sunrealtype t, N_Vector y, const int *fired, void *user)
{
  trajectory *tr = user;
  (void)s, (void)y;
  for (int i = 0; i < tr->problem->events; i++) {
    if (!fired[i]) continue;
    if (tr->events == tr->event_room && !more_events(tr)) {
      tr->short_of_memory = true;
      return -1;
    }
    const size_t k = tr->events++;
    tr->event_t[k] = t;
    tr->event_which[k] = i;
    tr->event_direction[k] = fired[i];
    tr->event_number[k] = tr->happened;
  }
  tr->happened++;
  return 0;
}

static int keep_jump(sunrealtype t, const sunrealtype *before, const steif_impulse *i,
                     void *user)
{
  const trajectory *tr = user;
  if (tr->report) report_jump(tr->report, "jumps", NULL, t, before, i);
  return 0;
}

int trajectory_room(trajectory *tr, size_t rows, size_t events)
{
  const size_t most = (size_t)1 << 40;
  if (rows > most || events > most) return -1;
  while (tr->room < rows)
    if (!grow(tr)) return -1;
  while (tr->event_room < events)
    if (!more_events(tr)) return -1;
  return 0;
}

int trajectory_open(struct call *call, const steif_problem *problem, steif_options *options,
                    trajectory *tr)
{
  *tr = (trajectory){.call = call,
                     .problem = problem,
                     .names = problem->names,
                     .n = (size_t)problem->n,
                     .h = options->mesh ? 0 : options->h,
                     .t0 = problem->t0,
                     .t1 = options->t1 > 0 ? options->t1 : problem->t1,
                     .live = !call->quiet && isatty(STDERR_FILENO)};
  if (given(call, "--checkpoint")) {
    tr->checkpoint = word_of(call, "--checkpoint");
    tr->every = real_of(call, "--every");
    tr->files = note_files(call);
  }
  while (steif_model_output(problem, tr->outputs)) tr->outputs++;
  options->observe = observe;
  options->on_event = keep_event;
  options->jump = keep_jump;
  options->observer = tr;
  const int code = attributes_of(call, problem, &tr->attributes);
  options->attributes = tr->attributes;
  return code ? code : ask(call, tr);
}

void trajectory_free(trajectory *tr)
{
  if (tr->between) N_VDestroy(tr->between);
  free(tr->t);
  free(tr->y);
  free(tr->output);
  free(tr->drawn.t);
  free(tr->drawn.y);
  free(tr->drawn.row);
  free(tr->at);
  free(tr->line);
  free(tr->attributes);
  (void)steif_rows_close(&tr->csv);
  free(tr->event_t);
  free(tr->event_which);
  free(tr->event_direction);
  free(tr->event_number);
}
