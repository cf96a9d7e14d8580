/* invariants.c: what has become of the invariants since the start.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "integrator.h"

static int invariants(steif_solver *s, sunrealtype *value)
{
  const steif_problem *p = s->problem;
  const long failures = stf_failures(s->ctx);
  const int returned = p->invariant(s->t_shown, s->shown, value, p->user);
  if (returned && stf_failures(s->ctx) > failures) return steif_status(s->ctx); /* told */
  STEIF_CHECK(returned == 0, s->ctx, STEIF_CALLBACK,
              "the invariants of problem '%s' returned %d at t = %.12g", p->name, returned,
              s->t_shown);
  return STEIF_OK;
}

int stf_drift_open(steif_solver *s)
{
  const int count = s->problem->invariants;
  if (count < 1 || !s->problem->invariant) return STEIF_OK;
  s->invariants = stf_pool_array(s->pool, 2 * (size_t)count, sizeof *s->invariants);
  return s->invariants ? invariants(s, s->invariants) : STEIF_NO_MEMORY;
}

int steif_drift_now(steif_solver *s, int *count, sunrealtype *drift)
{
  if (!count) return STEIF_BAD_INPUT;
  const int room = *count;
  *count = s && s->invariants ? s->problem->invariants : 0;
  if (!*count) return STEIF_OK;
  sunrealtype *now = s->invariants + *count;
  STEIF_TRY(invariants(s, now));
  for (int k = 0; k < *count && k < room; k++) drift[k] = now[k] - s->invariants[k];
  if (*count > room) *count = room;
  return STEIF_OK;
}
