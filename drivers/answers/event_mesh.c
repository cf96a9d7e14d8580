/* event_mesh.c: the mesh of a run that an event ends, for runs in which it comes a little earlier or later; and what
 * takes the place of a mesh where steps have to meet breaks, which move with parameters.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "answers.h"
#include <math.h>
#include <stdlib.h>

enum { AHEAD = 64 };

int mesh_add(double **mesh, size_t *times, size_t *room, double t)
{
  if (*times == *room) {
    const size_t wanted = 2 * (*room + AHEAD);
    double *more = realloc(*mesh, wanted * sizeof *more);
    if (!more) return 1;
    *mesh = more, *room = wanted;
  }
  (*mesh)[(*times)++] = t;
  return 0;
}

int moved_problem(struct call *call, const steif_problem *problem, int k, const double *v,
                  double d, steif_problem *p)
{
  double old;
  const steif_parameters *q = problem->parameters;
  const int code = find_problem(call, call->word[0], p);
  if (code) return code;
  const bool model = steif_model_parameter(p, 0, &old) != NULL;
  for (int j = 0; j < q->count; j++) {
    const double by = v ? v[j] * d : j == k ? d : 0;
    if (by == 0) continue;
    if (!(model ? steif_model_set(call->ctx, p, p->parameters->name[j], q->value[j] + by)
                : steif_parameter_set(call->ctx, p, j, q->value[j] + by)))
      continue;
    steif_problem_clear(call->ctx, p);
    return fail(call);
  }
  return EXIT_OK;
}

double event_mesh(double **mesh, size_t *times, double t0, double event, double t1)
{
  double *more = realloc(*mesh, (*times + AHEAD) * sizeof *more);
  if (!more) return -1;
  size_t count = *times;
  *mesh = more;
  while (count > 1 && more[count - 1] >= event) count--;
  double t = more[count - 1], h = count > 1 ? t - more[count - 2] : t1 - t0;
  h = fmin(fmax(h, 2 * (event - t)), t1 - t);
  const double reach = fmin(event - t, t + h - event) / 2;
  for (int i = 0; t < t1 && i < AHEAD; i++, h *= 2)
    t = more[count++] = t + h < t1 && i < AHEAD - 1 ? t + h : t1;
  *times = count;
  return reach;
}

bool tighten(const steif_problem *p, steif_options *o)
{
  const double part = 1e-3, least = 1e-12;
  if (p->break_count == 0 || o->h > 0) return false;
  const double by = fmax(part, fmin(1, least / o->rtol));
  o->rtol *= by, o->atol *= by;
  return true;
}
