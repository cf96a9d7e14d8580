/* trajectory_stream.c: rows of a run as they come, so that a run that is killed has written what it made.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "trajectory.h"
#include <stdlib.h>
#include <string.h>

/* -- --csv ----------------------------------------------------------------------------------- */

enum { NAME = 32 };

/* t, the unknowns by their names or y1, y2, ..., and the outputs. */
static const char **column_names(const trajectory *tr, char *own)
{
  const size_t count = 1 + tr->n + tr->outputs;
  const char **name = malloc(count * sizeof *name);
  const char *const *unknown = tr->problem->names ? tr->problem->names->unknown : NULL;
  if (!name) return NULL;
  name[0] = "t";
  for (size_t j = 0; j < tr->n; j++) {
    char *room = own + j * NAME;
    snprintf(room, NAME, "y%zu", j + 1);
    name[1 + j] = unknown ? unknown[j] : room;
  }
  for (size_t j = 0; j < tr->outputs; j++) {
    char *room = own + (tr->n + j) * NAME;
    snprintf(room, NAME, "outputs%zu", j + 1);
    name[1 + tr->n + j] = unknown ? steif_model_output(tr->problem, j) : room;
  }
  return name;
}

static void open_csv(trajectory *tr)
{
  const size_t count = 1 + tr->n + tr->outputs;
  char *own = malloc(count * NAME);
  const char **name = own ? column_names(tr, own) : NULL;
  tr->line = malloc(count * sizeof *tr->line);
  if (name && tr->line)
    tr->csv = steif_rows_new(tr->call->ctx, tr->call->csv, count, name);
  else
    tr->short_of_memory = true;
  free(own);
  free(name);
}

static void fail_csv(trajectory *tr)
{
  tr->csv_code = tr->short_of_memory ? STEIF_NO_MEMORY : steif_status(tr->call->ctx);
  if (!tr->short_of_memory) say(tr->call, "%s", steif_message(tr->call->ctx));
  steif_forget(tr->call->ctx);
}

static size_t ready(const trajectory *tr) { return tr->count - tr->waiting; }

static void to_csv(trajectory *tr)
{
  if (!tr->csv) open_csv(tr);
  for (; tr->csv && !tr->csv_code && tr->written < ready(tr); tr->written++) {
    const size_t i = tr->written;
    tr->line[0] = tr->t[i];
    memcpy(tr->line + 1, tr->y + i * tr->n, tr->n * sizeof *tr->line);
    if (tr->outputs)
      memcpy(tr->line + 1 + tr->n, tr->output + i * tr->outputs,
             tr->outputs * sizeof *tr->line);
    if (steif_rows_add(tr->csv, tr->line)) fail_csv(tr);
  }
  if (!tr->csv) fail_csv(tr);
}

/* -- times asked for, on the terminal ---------------------------------------------------------- */

static void list(const double *x, size_t count, int digits)
{
  enum { SHOWN = 12 };
  for (size_t j = 0; j < count && j < SHOWN; j++)
    printf("%s%.*g", j ? " " : "  ", digits, x[j]);
  if (count > SHOWN) printf(" ... (%zu)", count);
}

static int width_of(const trajectory *tr)
{
  int width = 1;
  for (size_t i = 0; i < tr->asked; i++) {
    const int own = snprintf(NULL, 0, "%.10g", tr->at[i]);
    if (own > width) width = own;
  }
  return width;
}

static void to_terminal(trajectory *tr)
{
  const int width = width_of(tr);
  progress(tr->call, NULL);
  if (!tr->shown_rows) printf("%*s  y%s\n", width, "t", tr->outputs ? "  outputs" : "");
  for (; tr->shown_rows < ready(tr); tr->shown_rows++) {
    const size_t i = tr->shown_rows;
    printf("%*.10g", width, tr->t[i]);
    list(tr->y + i * tr->n, tr->n, 12);
    if (tr->outputs) list(tr->output + i * tr->outputs, tr->outputs, 6);
    putchar('\n');
  }
  fflush(stdout);
}

void trajectory_stream(trajectory *tr)
{
  const struct call *c = tr->call;
  if (c->csv && !tr->csv_code && (tr->written < ready(tr) || !tr->csv)) to_csv(tr);
  if (tr->asked && !c->json && tr->shown_rows < ready(tr)) to_terminal(tr);
}
