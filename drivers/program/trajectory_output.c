/* trajectory_output.c: a run as rows of a report, as files and as a picture.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "members.h"
#include "trajectory.h"
#include <stdlib.h>
#include <string.h>

static void rows(steif_report *r, const trajectory *tr)
{
  for (size_t i = 0; i < tr->count; i++) {
    steif_report_row(r, "output");
    steif_report_real(r, "output.t", tr->t[i]);
    steif_report_list(r, "output.y", tr->n, tr->y + i * tr->n);
    if (tr->outputs)
      steif_report_list(r, "output.outputs", tr->outputs, tr->output + i * tr->outputs);
  }
}

static void event_row(steif_report *r, const trajectory *tr, size_t i)
{
  const steif_problem *p = tr->problem;
  const size_t which = (size_t)tr->event_which[i], number = tr->event_number[i];
  const bool known = number < (size_t)p->event_time_count;
  char own[32];
  snprintf(own, sizeof own, "g%zu", which + 1);
  const char *name = p->event_list ? p->event_list[which].name : NULL,
             *turn = steif_model_turn(p, (int)which, tr->event_direction[i] > 0 ? 1 : -1);
  if (!turn) turn = tr->event_direction[i] > 0 ? "rising" : "falling";
  steif_report_row(r, "events");
  steif_report_real(r, "events.t", tr->event_t[i]);
  steif_report_text(r, "events.event", name ? name : own);
  steif_report_text(r, "events.direction", turn);
  report_maybe(r, "events.", "reference", known, known ? p->event_times[number] : 0);
  report_maybe(r, "events.", "error", known,
               known ? tr->event_t[i] - p->event_times[number] : 0);
}

void trajectory_fill(steif_report *r, const trajectory *tr)
{
  if (tr->asked && tr->call->json) rows(r, tr);
  for (size_t i = 0; given(tr->call, "--events") && i < tr->events; i++) event_row(r, tr, i);
}

/* The names of the columns of y and outputs, and of the numbers in event_which; room for all of them. */
static size_t name_arrays(const trajectory *tr, const char **room, steif_array *to)
{
  size_t count = 0;
  const size_t events = (size_t)tr->problem->events;
  if (tr->names && tr->names->unknown)
    to[count++] = (steif_array){.name = "y_names", .rows = tr->n, .text = tr->names->unknown};
  if (tr->outputs) {
    to[count++] = (steif_array){.name = "output_names", .rows = tr->outputs, .text = room};
    for (size_t i = 0; i < tr->outputs; i++) *room++ = steif_model_output(tr->problem, i);
  }
  for (size_t i = 0; i < events && tr->problem->event_list; i++) {
    if (!tr->problem->event_list[i].name) return count;
    room[i] = tr->problem->event_list[i].name;
  }
  if (events && tr->problem->event_list)
    to[count++] = (steif_array){.name = "event_names", .rows = events, .text = room};
  return count;
}

static int all_arrays(const struct call *call, const trajectory *tr)
{
  enum { MOST = 9 };
  steif_array array[MOST] = {{.name = "t", .rows = tr->count, .value = tr->t},
                             {"y", tr->count, tr->n, tr->y, NULL}};
  size_t count = 2;
  if (!call->npz && !call->h5) return EXIT_OK;
  const char **room = calloc(tr->outputs + (size_t)tr->problem->events + 1, sizeof *room);
  if (!room) return no_memory(call, "names", "leave --npz and --h5 out");
  if (tr->outputs)
    array[count++] = (steif_array){"outputs", tr->count, tr->outputs, tr->output, NULL};
  if (tr->problem->events) {
    const double *column[] = {tr->event_t, tr->event_which, tr->event_direction};
    static const char *const name[] = {"event_t", "event_which", "event_direction"};
    for (int i = 0; i < 3; i++)
      array[count++] = (steif_array){.name = name[i], .rows = tr->events, .value = column[i]};
  }
  count += name_arrays(tr, room, array + count);
  const int code = save_arrays(call, count, array);
  free(room);
  return code;
}

int trajectory_save(const struct call *call, trajectory *tr)
{
  const int arrays = all_arrays(call, tr);
  trajectory_stream(tr);
  return tr->csv_code ? EXIT_FAILED : arrays;
}

/* A run that went on has no points between its steps: unknowns and outputs side by side, at the steps. */
static int steps_of(const trajectory *tr, struct drawn *d)
{
  const size_t columns = tr->n + tr->outputs;
  *d = (struct drawn){.n = columns, .count = tr->count, .unknowns = tr->n, .t = tr->t};
  d->y = malloc((tr->count * columns + 1) * sizeof *d->y);
  for (size_t i = 0; d->y && i < tr->count; i++) {
    memcpy(d->y + i * columns, tr->y + i * tr->n, tr->n * sizeof *d->y);
    memcpy(d->y + i * columns + tr->n, tr->output + i * tr->outputs,
           tr->outputs * sizeof *d->y);
  }
  return d->y ? STEIF_OK : STEIF_NO_MEMORY;
}

static int plot(const struct call *call, const trajectory *tr, const char *title)
{
  struct drawn steps = {0};
  const bool dense = tr->drawn.count;
  const struct drawn *d = dense ? &tr->drawn : &steps;
  int code = dense ? STEIF_OK : steps_of(tr, &steps);
  const char **names = code ? NULL : calloc(d->n + 1, sizeof *names);
  for (size_t i = 0; names && i < d->n; i++)
    names[i] = i < d->unknowns ? tr->names && tr->names->unknown ? tr->names->unknown[i] : NULL
                               : steif_model_output(tr->problem, i - d->unknowns);
  code = names ? steif_plot_components(call->ctx, title, d->count, d->n,
                                       names[0] ? names : NULL, d->t, d->y, call->plot)
               : no_memory(call, "the picture", "make fewer steps");
  free(steps.y);
  free(names);
  return code;
}

int trajectory_plot(const struct call *call, const trajectory *tr, const char *title)
{
  if (!call->plot || plot(call, tr, title) == STEIF_OK) return EXIT_OK;
  say(call, "%s", steif_message(call->ctx));
  return EXIT_FAILED;
}
