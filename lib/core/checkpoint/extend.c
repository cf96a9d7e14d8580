/* extend.c: another end of a run.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "checkpoint_file.h"
#include <math.h>

static int check(const steif_solver *s, sunrealtype t1)
{
  STEIF_CHECK(!s->failed, s->ctx, s->failure, "the run has failed (%s) and does not go on",
              s->why);
  STEIF_CHECK(!s->finished, s->ctx, STEIF_BAD_INPUT,
              "the run was ended at t = %.12g by the event %s: restart the solver", s->end,
              s->events->name);
  STEIF_CHECK(
    !s->options.mesh, s->ctx, STEIF_BAD_INPUT,
    "the steps are those of a mesh, which ends at %.12g: restart the solver with another",
    s->t1);
  STEIF_CHECK(isfinite(t1) && t1 > s->end, s->ctx, STEIF_BAD_INPUT,
              "the end t1 = %.12g must lie after the time reached, %.12g", t1, s->end);
  STEIF_CHECK(!s->inside, s->ctx, STEIF_BAD_INPUT,
              "a run is extended after a step, not while its events are handled");
  return STEIF_OK;
}

/* The grid of constant steps begins at the last step. */
static int set_grid(steif_solver *s, sunrealtype t1)
{
  stf_constant c;
  const sunrealtype from = s->engine ? s->run.t : s->step.t;
  if (!(s->options.h > 0) || (stf_beyond(s) && t1 <= from)) return STEIF_OK;
  STEIF_TRY(stf_constant_steps(s->ctx, s->options.h, from, t1, &c));
  if (!s->engine) STEIF_TRY(stf_rest_open(s, &c, t1));
  if (!s->engine && !(c.rest > 0)) s->final = NULL;
  s->constant = c;
  s->mesh_at = 0;
  return STEIF_OK;
}

/* A last step across the old end: more of it is the solution now. */
static int uncover(steif_solver *s, sunrealtype t1)
{
  if (t1 < s->step.t) {
    STEIF_TRY(stf_dense(s, t1, s->final));
    s->end = t1;
  } else
    s->end = s->step.t;
  return STEIF_OK;
}

int steif_solver_extend(steif_solver *s, sunrealtype t1)
{
  if (!s) return STEIF_BAD_INPUT;
  STEIF_TRY(stf_agreed_begin(s, check(s, t1), "steif_solver_extend", t1));
  const bool beyond = stf_beyond(s);
  STEIF_TRY(set_grid(s, t1));
  if (beyond) STEIF_TRY(uncover(s, t1));
  s->t1 = s->options.t1 = t1;
  if (beyond) {
    s->shown = stf_last(s);
    s->t_shown = s->end;
  }
  return STEIF_OK;
}
