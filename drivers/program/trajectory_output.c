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
  if (tr->asked && tr->call->json) rows(r, tr);
  for (size_t i = 0; given(tr->call, "--events") && i < tr->events; i++) event_row(r, tr, i);
}

static int all_arrays(const struct call *call, const trajectory *tr)
{
  steif_array array[6] = {{"t", tr->count, 0, tr->t}, {"y", tr->count, tr->n, tr->y}};
  size_t count = 2;
  if (tr->outputs)
    array[count++] = (steif_array){"outputs", tr->count, tr->outputs, tr->output};
  if (tr->problem->events) {
    array[count++] = (steif_array){"event_t", tr->events, 0, tr->event_t};
    array[count++] = (steif_array){"event_which", tr->events, 0, tr->event_which};
    array[count++] = (steif_array){"event_direction", tr->events, 0, tr->event_direction};
  }
  return save_arrays(call, count, array);
}

int trajectory_save(const struct call *call, trajectory *tr)
{
  const int arrays = all_arrays(call, tr);
  trajectory_stream(tr);
  return tr->csv_code ? EXIT_FAILED : arrays;
}

/* Unknowns and outputs side by side, at the steps. */
static int plot_outputs(const struct call *call, const trajectory *tr, const char *title)
{
  const size_t columns = tr->n + tr->outputs;
  const char **names = calloc(columns, sizeof *names);
  double *all = malloc((tr->count * columns + 1) * sizeof *all);
  for (size_t i = 0; names && i < columns; i++)
    names[i] = i < tr->n ? tr->names ? tr->names->unknown[i] : NULL
                         : steif_model_output(tr->problem, i - tr->n);
  for (size_t i = 0; all && i < tr->count; i++) {
    memcpy(all + i * columns, tr->y + i * tr->n, tr->n * sizeof *all);
    memcpy(all + i * columns + tr->n, tr->output + i * tr->outputs, tr->outputs * sizeof *all);
  }
  const int code = all && names
                     ? steif_plot_components(call->ctx, title, tr->count, columns,
                                             tr->names ? names : NULL, tr->t, all, call->plot)
                     : no_memory(call, "the picture", "make fewer steps");
  free(all);
  free(names);
  return code;
}

static int plot(const struct call *call, const trajectory *tr, const char *title)
{
  const struct drawn steps = {tr->n, tr->count, tr->count, tr->t, tr->y},
                     *d = tr->drawn.count ? &tr->drawn : &steps;
  const char *const *names = tr->names ? tr->names->unknown : NULL;
  if (tr->outputs) return plot_outputs(call, tr, title);
  return steif_plot_components(call->ctx, title, d->count, d->n, names, d->t, d->y, call->plot);
}

int trajectory_plot(const struct call *call, const trajectory *tr, const char *title)
{
  if (!call->plot || plot(call, tr, title) == STEIF_OK) return EXIT_OK;
  say(call, "%s", steif_message(call->ctx));
  return EXIT_FAILED;
}
