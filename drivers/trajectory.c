/* trajectory.c: what a run was: steps or times asked for, events; as rows, files, a picture.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "impulse.h"
#include <nvector/nvector_serial.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

enum { CURVES = 8 };

/* -- times asked for --------------------------------------------------------------------- */

static int ask(struct call *call, trajectory *tr)
{
  double at[REALS_MOST];
  const size_t given_times = reals_of(call, "--at", at);
  tr->asked = given_times ? given_times : (size_t)whole_of(call, "--points", 0);
  if (tr->asked == 0) return EXIT_OK;
  tr->at = malloc(tr->asked * sizeof *tr->at);
  tr->between = tr->at ? N_VNew_Serial(tr->problem->n, steif_sundials(call->ctx)) : NULL;
  if (!tr->between) {
    say(call, "no memory for %zu times; ask for fewer", tr->asked);
    return EXIT_FAILED;
  }
  const double width = tr->asked > 1 ? (tr->t1 - tr->t0) / (double)(tr->asked - 1) : 0;
  for (size_t i = 0; i < tr->asked; i++) {
    tr->at[i] = given_times ? at[i] : i + 1 < tr->asked ? tr->t0 + width * (double)i : tr->t1;
    if (tr->at[i] < tr->t0 || tr->at[i] > tr->t1 || (i && tr->at[i] <= tr->at[i - 1]))
      return refuse(call, "--at must be times that ascend within [%g, %g], %g is not one",
                    tr->t0, tr->t1, tr->at[i]);
  }
  return EXIT_OK;
}

/* -- rows ------------------------------------------------------------------------------------- */

static bool grow(trajectory *tr)
{
  const size_t room = tr->room ? 2 * tr->room : 256;
  double *t = realloc(tr->t, room * sizeof *t);
  if (t) tr->t = t;
  double *y = t ? realloc(tr->y, room * tr->n * sizeof *y) : NULL;
  if (y) tr->y = y, tr->room = room;
  return y;
}

int trajectory_keep(trajectory *tr, double t, N_Vector y)
{
  if (tr->count == tr->room && !grow(tr)) {
    tr->short_of_memory = true;
    return -1;
  }
  tr->t[tr->count] = t;
  memcpy(tr->y + tr->count++ * tr->n, N_VGetArrayPointer(y), tr->n * sizeof *tr->y);
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

static int add(steif_solver *s, sunrealtype t, N_Vector y, void *user)
{
  trajectory *tr = user;
  if (tr->live) tell(tr, t);
  if (tr->asked == 0)
    return tr->call->csv || tr->call->plot || tr->call->npz ? trajectory_keep(tr, t, y) : 0;
  for (; tr->next < tr->asked && tr->at[tr->next] <= t; tr->next++) {
    const bool here = tr->at[tr->next] >= t;
    if (!here && steif_dense(s, tr->at[tr->next], tr->between) != STEIF_OK) return -1;
    if (trajectory_keep(tr, tr->at[tr->next], here ? y : tr->between)) return -1;
  }
  return 0;
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
  tr->event_number = number, tr->event_room = room;
  return true;
}

static int notice(steif_solver *s, sunrealtype t, N_Vector y, const int *fired, void *user)
{
  trajectory *tr = user;
  (void)s, (void)y;
  for (int i = 0; i < tr->problem->events; i++) {
    if (!fired[i]) continue;
    if (tr->events == tr->event_room && !more_events(tr)) {
      tr->short_of_memory = true;
      return -1;
    }
    tr->event_t[tr->events] = t, tr->event_which[tr->events] = i;
    tr->event_direction[tr->events] = fired[i];
    tr->event_number[tr->events++] = tr->happened;
  }
  tr->happened++;
  return 0;
}

static int jump(sunrealtype t, const sunrealtype *before, const steif_impulse *i, void *user)
{
  const trajectory *tr = user;
  if (tr->report) impulse_rows(tr->report, "jumps", NULL, t, before, i);
  return 0;
}

int trajectory_open(struct call *call, const steif_problem *problem, steif_options *options,
                    trajectory *tr)
{
  *tr = (trajectory){.call = call,
                     .problem = problem,
                     .n = (size_t)problem->n,
                     .t0 = problem->t0,
                     .t1 = options->t1 > 0 ? options->t1 : problem->t1,
                     .live = !call->quiet && isatty(STDERR_FILENO)};
  options->observe = add, options->notice = notice;
  options->jump = jump, options->observer = tr;
  if (given(call, "--events") && problem->events == 0)
    return refuse(call, "%s has no events; bounce, rectifier and swing have", call->word[0]);
  return ask(call, tr);
}

void trajectory_free(trajectory *tr)
{
  if (tr->between) N_VDestroy(tr->between);
  free(tr->t), free(tr->y), free(tr->at);
  free(tr->event_t), free(tr->event_which), free(tr->event_direction), free(tr->event_number);
}

/* -- what is shown and saved ---------------------------------------------------------------------- */

/* Columns have the names of the unknowns, if there are any; names NULL: one list y. */
static void rows(steif_report *r, const char *sheet, const trajectory *tr,
                 const char *const *names)
{
  char time[32], name[96];
  snprintf(time, sizeof time, "%s.t", sheet);
  for (size_t i = 0; i < tr->count; i++) {
    steif_report_row(r, sheet);
    steif_report_real(r, time, tr->t[i]);
    snprintf(name, sizeof name, "%s.y", sheet);
    if (!names) steif_report_list(r, name, tr->n, tr->y + i * tr->n);
    for (size_t j = 0; names && j < tr->n; j++) {
      snprintf(name, sizeof name, "%s.%s", sheet, names[j]);
      steif_report_real(r, name, tr->y[i * tr->n + j]);
    }
  }
}

static void event_row(steif_report *r, const trajectory *tr, size_t i)
{
  const steif_problem *p = tr->problem;
  const size_t which = (size_t)tr->event_which[i], number = tr->event_number[i];
  const bool known = number < (size_t)p->event_time_count;
  char own[32];
  snprintf(own, sizeof own, "g%zu", which + 1);
  const char *name = p->event_list ? p->event_list[which].name : NULL;
  steif_report_row(r, "events");
  steif_report_real(r, "events.t", tr->event_t[i]);
  steif_report_text(r, "events.event", name ? name : own);
  steif_report_text(r, "events.direction", tr->event_direction[i] > 0 ? "rising" : "falling");
  report_maybe(r, "events.", "reference", known, known ? p->event_times[number] : 0);
  report_maybe(r, "events.", "error", known,
               known ? tr->event_t[i] - p->event_times[number] : 0);
}

void trajectory_fill(steif_report *r, const trajectory *tr)
{
  if (tr->asked) rows(r, "output", tr, NULL);
  for (size_t i = 0; given(tr->call, "--events") && i < tr->events; i++) event_row(r, tr, i);
}

static int save_arrays(const struct call *call, const trajectory *tr)
{
  const steif_array array[] = {{"t", tr->count, 0, tr->t},
                               {"y", tr->count, tr->n, tr->y},
                               {"event_t", tr->events, 0, tr->event_t},
                               {"event_which", tr->events, 0, tr->event_which},
                               {"event_direction", tr->events, 0, tr->event_direction}};
  const size_t count = tr->problem->events ? 5 : 2;
  if (!call->npz || steif_npz_save(call->ctx, call->npz, count, array) == STEIF_OK)
    return EXIT_OK;
  say(call, "%s", steif_message(call->ctx));
  return EXIT_FAILED;
}

int trajectory_save(const struct call *call, const trajectory *tr)
{
  const int arrays = save_arrays(call, tr);
  if (!call->csv) return arrays;
  steif_report *r = steif_report_new(call->ctx);
  rows(r, "steps", tr, tr->problem->names ? tr->problem->names->unknown : NULL);
  const int code = r ? save_csv(call, r) : fail(call);
  steif_report_free(&r);
  return code ? code : arrays;
}

/* Component k by steps; the largest finite |y_k|. */
static double component(const trajectory *tr, size_t k, double *y)
{
  double most = 0;
  for (size_t i = 0; i < tr->count; i++) {
    y[i] = tr->y[i * tr->n + k];
    const double size = y[i] < 0 ? -y[i] : y[i];
    if (size > most && size - size == 0) most = size;
  }
  return most;
}

/* Components of very different size are drawn as parts of their largest value. */
static bool uneven(const double *most, size_t count)
{
  double low = 0, high = 0;
  for (size_t k = 0; k < count; k++) {
    if (most[k] > high) high = most[k];
    if (most[k] > 0 && (low <= 0 || most[k] < low)) low = most[k];
  }
  return high > 100 * low;
}

/* The first components over time; long intervals on a logarithmic axis. */
int trajectory_plot(const struct call *call, const trajectory *tr, const char *title)
{
  const size_t curves = tr->n < CURVES ? tr->n : CURVES;
  double *y = call->plot ? malloc((tr->count * curves + 1) * sizeof *y) : NULL, most[CURVES];
  char label[CURVES][32];
  steif_curve curve[CURVES];
  for (size_t k = 0; y && k < curves; k++) most[k] = component(tr, k, y + k * tr->count);
  const bool scaled = y && uneven(most, curves);
  for (size_t k = 0; y && k < curves; k++) {
    const bool divide = scaled && most[k] > 0;
    for (size_t i = 0; divide && i < tr->count; i++) y[k * tr->count + i] /= most[k];
    snprintf(label[k], sizeof label[k], divide ? "y%zu / %.3g" : "y%zu", k + 1, most[k]);
    curve[k] = (steif_curve){label[k], tr->count, tr->t, y + k * tr->count, 0};
  }
  const steif_plot plot = {.title = title,
                           .x_label = "t",
                           .y_label = curves < tr->n ? "the first components of y" : "y",
                           .log_x = tr->t1 >= 1e4,
                           .count = curves,
                           .curve = curve};
  if (!y && call->plot) say(call, "no memory for the picture; leave --plot out");
  const int code = !call->plot ? EXIT_OK : y ? save_plot(call, &plot, call->plot) : EXIT_FAILED;
  free(y);
  return code;
}
