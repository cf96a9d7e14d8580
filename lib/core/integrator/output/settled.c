/* settled.c: unknowns of vectors spread over ranks, put by the problem where its equations hold.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "integrator.h"
#include <math.h>

bool stf_settled_by(const steif_solver *s)
{
  return s->agreed && s->problem->project && !s->options.reinitialise;
}

int stf_settle(const steif_solver *s, sunrealtype t, N_Vector y)
{
  const steif_problem *p = s->problem;
  const long failures = stf_failures(s->ctx);
  const int returned = p->project(t, y, NULL, p->user);
  if (returned && stf_failures(s->ctx) > failures) return steif_status(s->ctx); /* told */
  STEIF_CHECK(returned == 0, s->ctx, STEIF_CALLBACK,
              "project of problem '%s' returned %d at t = %.12g", p->name, returned, t);
  return STEIF_OK;
}

/* At a break: shown where an unknown moves by more tolerances than errors do. */
int stf_settle_break(steif_solver *s)
{
  const sunrealtype most = 10;
  stf_step *step = &s->step;
  N_VScale(1, step->y, s->dense);
  STEIF_TRY(stf_settle(s, step->t, step->y));
  STEIF_TRY(stf_weigh(s));
  N_VLinearSum(1, step->y, -1, s->dense, s->dense);
  N_VProd(s->dense, step->weights, s->dense);
  if (N_VMaxNorm(s->dense) > most) stf_observe(s, s->end, step->y);
  return STEIF_OK;
}

/* After a break where the next step begins from what is shown at it. */
static bool shown_after(const steif_solver *s, sunrealtype t)
{
  if (s->end != t || s->end >= s->t1) return s->end > t;
  return s->shown == s->dense && s->t_shown == t && s->step.restart && !s->options.reinitialise;
}

sunrealtype stf_side(const steif_solver *s, sunrealtype t)
{
  const steif_problem *p = s->problem;
  for (int i = 0; i < p->break_count; i++)
    if (p->breaks[i] == t) return nextafter(t, shown_after(s, t) ? INFINITY : -INFINITY);
  return t;
}

int stf_settle_shown(steif_solver *s)
{
  if (!s->settles || s->step.count == 0) return STEIF_OK;
  if (s->shown != s->dense) N_VScale(1, s->shown, s->dense);
  STEIF_TRY(stf_settle(s, stf_side(s, s->t_shown), s->dense));
  s->shown = s->dense;
  return STEIF_OK;
}

int stf_settle_observed(steif_solver *s)
{
  s->shown = stf_last(s), s->t_shown = s->end;
  if (s->options.observe) STEIF_TRY(stf_settle_shown(s));
  stf_observe(s, s->end, s->shown);
  return STEIF_OK;
}
