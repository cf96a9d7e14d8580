/* trajectory_dense.c: points of a picture from the dense output of every step.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "trajectory.h"
#include <stdlib.h>
#include <string.h>

enum { BETWEEN = 7, MOST = 40000 }; /* points inside a step; no more of them from so many on */

static bool add(struct drawn *d, double t, const double *y)
{
  if (d->count == d->room) {
    const size_t room = d->room ? 2 * d->room : 512;
    double *times = realloc(d->t, room * sizeof *times);
    if (times) d->t = times;
    double *values = times ? realloc(d->y, room * d->n * sizeof *values) : NULL;
    if (!values) return false;
    d->y = values;
    d->room = room;
  }
  d->t[d->count] = t;
  memcpy(d->y + d->count * d->n, y, d->n * sizeof *y);
  d->count++;
  return true;
}

int trajectory_draw(trajectory *tr, steif_solver *s, double t, N_Vector y)
{
  struct drawn *d = &tr->drawn;
  const double from = d->count ? d->t[d->count - 1] : t;
  bool good = true;
  if (!d->n) d->n = tr->n < DRAWN ? tr->n : DRAWN;
  for (int k = 1; k <= BETWEEN && t > from && d->count < MOST && good; k++) {
    const double at = from + (t - from) * k / (BETWEEN + 1);
    if (steif_dense(s, at, tr->between) != STEIF_OK) { /* a method without: the steps alone */
      steif_forget(tr->call->ctx);
      break;
    }
    good = add(d, at, N_VGetArrayPointer(tr->between));
  }
  if (good) good = add(d, t, N_VGetArrayPointer(y));
  if (!good) tr->short_of_memory = true;
  return good ? 0 : -1;
}
