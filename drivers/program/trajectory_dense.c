/* trajectory_dense.c: points of a picture from the dense output of every step.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "trajectory.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { BETWEEN = 7, MOST = 40000 }; /* points inside a step; no more of them from so many on */

/* As many unknowns as there is room for beside the outputs, up to half of the curves. */
static bool open_row(trajectory *tr)
{
  struct drawn *d = &tr->drawn;
  const size_t outputs = tr->outputs < DRAWN / 2 ? tr->outputs : DRAWN / 2,
               most = DRAWN - outputs;
  d->unknowns = tr->n < most ? tr->n : most;
  d->n = d->unknowns + outputs;
  d->row = malloc((d->unknowns + tr->outputs) * sizeof *d->row);
  return d->row;
}

static bool add(trajectory *tr, double t, N_Vector y)
{
  struct drawn *d = &tr->drawn;
  if (!d->row && !open_row(tr)) return false;
  if (d->count == d->room) {
    const size_t room = d->room ? 2 * d->room : 512;
    double *times = realloc(d->t, room * sizeof *times);
    if (times) d->t = times;
    double *values = times ? realloc(d->y, room * d->n * sizeof *values) : NULL;
    if (!values) return false;
    d->y = values;
    d->room = room;
  }
  memcpy(d->row, N_VGetArrayPointer(y), d->unknowns * sizeof *d->row);
  if (tr->outputs && steif_model_outputs(tr->problem, t, y, d->row + d->unknowns))
    for (size_t i = d->unknowns; i < d->n; i++) d->row[i] = NAN;
  d->t[d->count] = t;
  memcpy(d->y + d->count * d->n, d->row, d->n * sizeof *d->row);
  d->count++;
  return true;
}

int trajectory_draw(trajectory *tr, steif_solver *s, double t, N_Vector y)
{
  const struct drawn *d = &tr->drawn;
  const double from = d->count ? d->t[d->count - 1] : t;
  bool good = true;
  for (int k = 1; k <= BETWEEN && t > from && d->count < MOST && good; k++) {
    const double at = from + (t - from) * k / (BETWEEN + 1);
    if (steif_dense(s, at, tr->between) != STEIF_OK) { /* a method without: the steps alone */
      steif_forget(tr->call->ctx);
      break;
    }
    good = add(tr, at, tr->between);
  }
  if (good) good = add(tr, t, y);
  if (!good) tr->short_of_memory = true;
  return good ? 0 : -1;
}
