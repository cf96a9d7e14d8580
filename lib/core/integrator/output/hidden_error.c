/* hidden_error.c: how large the errors of components of index 2 and 3 are: the distance of the solution from
 * the nearest point that fulfils the equations and their hidden derivatives. Positions hardly move there;
 * velocities and multipliers go where these belong.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "integrator.h"
#include <math.h>
#include <steif/consistent.h>

/* Largest |x_i| w_i of index above 1. */
static sunrealtype largest(const steif_problem *p, const sunrealtype *x, const sunrealtype *w)
{
  sunrealtype most = 0;
  for (sunindextype i = 0; i < p->n; i++)
    if (p->index[i] > 1) most = fmax(most, fabs(x[i]) * w[i]);
  return most;
}

static int distance(steif_solver *s, sunrealtype *error)
{
  const stf_step *step = &s->step;
  const sunrealtype *weight = stf_array(step->weights);
  const steif_point at = {.t = step->t, .y = stf_array(step->y)};
  const steif_request request = {.weight = weight};
  steif_start start = {.y = NULL};
  const bool before = stf_silence(s->ctx, true);
  const int code = steif_consistent(s->ctx, s->problem, &at, &request, &start);
  stf_silence(s->ctx, before);
  if (code == STEIF_OK) *error = largest(s->problem, start.moved, weight);
  steif_start_clear(&start);
  return code == STEIF_NO_MEMORY ? STEIF_FAIL(s->ctx, code, "no memory for a consistent point")
                                 : STEIF_OK;
}

int steif_hidden_error(steif_solver *s, sunrealtype *error)
{
  *error = NAN;
  if (!s || s->engine || s->failed || !s->step.adaptive || !stf_array(s->step.y) ||
      s->step.count == 0)
    return STEIF_OK;
  const steif_problem *p = s->problem;
  const bool served = p->index && p->dae_index > 1 && p->n <= STEIF_DIAGNOSE_LARGEST &&
                      !s->step.system.linear && s->step.system.space.serial &&
                      s->step.system.storage != STEIF_KRYLOV;
  if (!served) return STEIF_OK;
  if (s->t_shown == s->step.t && !isnan(s->corrected)) {
    *error = s->corrected;
    return STEIF_OK;
  }
  STEIF_TRY(stf_weigh(s));
  STEIF_TRY(distance(s, error));
  steif_forget(s->ctx);
  return STEIF_OK;
}
