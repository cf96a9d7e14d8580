/* saltation_breaks.c: S through breaks, which move with p where parameters.break_slope says so.
 *
 * Where an event has begun the run anew at the time of a break, its f+ is that behind both: the break adds nothing if it
 * moves with p as the event does, or if the slopes before and behind it are the same.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "transition.h"
#include <math.h>

/* What a model says of its failure is kept. */
int stf_break_slope(steif_solver *s, int i, int k, sunrealtype *slope)
{
  steif_forget(s->ctx);
  const int returned = s->problem->parameters->break_slope(i, k, slope, s->problem->user);
  if (returned && steif_status(s->ctx)) return steif_status(s->ctx);
  STEIF_CHECK(returned == 0 && isfinite(*slope), s->ctx, STEIF_CALLBACK,
              "parameters.break_slope of problem '%s' returned %d with %g for break %d",
              s->problem->name, returned, *slope, i + 1);
  return STEIF_OK;
}

int stf_breaks_check(steif_solver *s)
{
  const steif_problem *p = s->problem;
  const stf_carry *T = s->step.carry;
  if (s->step.adaptive || !p->parameters || !p->parameters->break_slope) return STEIF_OK;
  for (int i = 0; i < p->break_count; i++)
    for (int k = 0; k < (T ? T->count : p->parameters->count); k++) {
      const int number = T ? T->parameter[k] : k;
      sunrealtype slope;
      STEIF_TRY(stf_break_slope(s, i, number, &slope));
      STEIF_CHECK(slope == 0 || !(p->breaks[i] > p->t0 && p->breaks[i] < s->t1), s->ctx,
                  STEIF_UNSUPPORTED,
                  "the break of problem '%s' at t = %.12g moves with parameter %d, and given "
                  "steps do not end at breaks: their results do not show its derivative; let "
                  "steps be chosen",
                  p->name, p->breaks[i], number + 1);
    }
  return STEIF_OK;
}

/* Its time, where it depends on p. */
static int break_times(steif_solver *s, int i, sunrealtype *tau)
{
  const steif_parameters *q = s->problem->parameters;
  const stf_carry *T = s->step.carry;
  for (int k = 0; k < stf_columns(s); k++) {
    tau[k] = 0;
    if (q->break_slope) STEIF_TRY(stf_break_slope(s, i, T->parameter[k], tau + k));
  }
  return STEIF_OK;
}

/* Does break i move with p as the break or event that tau belongs to does? */
static bool together(const steif_solver *s)
{
  const stf_saltation *w = s->saltation;
  bool same = true;
  for (int k = 0; k < stf_columns(s); k++)
    same = same && fabs(w->tau[k] - w->other[k]) <=
                     1e-6 * fabs(w->tau[k]) + 1e-9 / s->step.carry->scale[k];
  return same;
}

/* Are the slopes of y before and behind t the same? */
static int continuous(steif_solver *s, sunrealtype t, bool *same)
{
  static const sunrealtype close = 1e-9;
  stf_saltation *w = s->saltation;
  STEIF_TRY(stf_saltation_slope(s, nextafter(t, -INFINITY), s->step.y, w->slope));
  STEIF_TRY(stf_saltation_behind(s, t, s->step.y, NULL));
  const sunrealtype size = N_VMaxNorm(w->slope) + N_VMaxNorm(w->after);
  N_VLinearSum(1, w->slope, -1, w->after, w->slope);
  *same = N_VMaxNorm(w->slope) <= close * size;
  return STEIF_OK;
}

/* Break i where an event has just begun the run anew (first < 0), or where break `first` lies. */
static int beside(steif_solver *s, int i, int first)
{
  stf_saltation *w = s->saltation;
  const sunrealtype t = s->step.t;
  bool same = together(s) && (!w->keeper || stf_transition_together(s, i, first));
  if (!same) STEIF_TRY(continuous(s, t, &same));
  STEIF_CHECK(same, s->ctx, STEIF_UNSUPPORTED,
              "a break and %s of problem '%s' at once at t = %.12g, whose times have other "
              "derivatives by parameters: what comes after them has none",
              first < 0 ? "an event" : "another", s->problem->name, t);
  return STEIF_OK;
}

/* Breaks at the same time. */
static int others(steif_solver *s, int i)
{
  const steif_problem *p = s->problem;
  for (int j = i + 1; j < p->break_count && p->breaks[j] == p->breaks[i]; j++) {
    STEIF_TRY(break_times(s, j, s->saltation->other));
    STEIF_TRY(beside(s, j, i));
  }
  return STEIF_OK;
}

int stf_saltation_break(steif_solver *s, int i)
{
  stf_saltation *w = s->saltation;
  const sunrealtype t = s->step.t;
  STEIF_TRY(break_times(s, i, w->other));
  if (w->renewed == t) {
    STEIF_TRY(beside(s, i, -1));
    for (int k = 0; k < stf_columns(s); k++) w->tau[k] = 0;
    return w->keeper ? stf_transition_break(s, -1) : STEIF_OK;
  }
  for (int k = 0; k < stf_columns(s); k++) w->tau[k] = w->other[k];
  STEIF_TRY(others(s, i));
  STEIF_TRY(stf_saltation_look(s, t));
  w->t = nextafter(t, INFINITY);
  for (int k = 0; k < stf_columns(s); k++)
    if (s->options.reinitialise)
      STEIF_TRY(stf_saltation_through(s, stf_saltation_projection, k, "options.reinitialise"));
    else
      N_VLinearSum(1, w->S[k], w->tau[k], w->slope, w->jump[k]);
  w->known = false, w->pending = true;
  if (w->keeper) STEIF_TRY(stf_transition_break(s, i));
  return stf_quadrature_before(s, t, w->y);
}

int stf_saltation_broken(steif_solver *s)
{
  const stf_step *step = &s->step;
  stf_saltation *w = s->saltation;
  bool moves = false;
  for (int k = 0; k < stf_columns(s); k++) moves = moves || w->tau[k] != 0;
  moves = moves || (w->open && w->open->rate != 0);
  const bool follow = w->found && w->pending; /* algebraic unknowns */
  if (moves || follow)
    STEIF_TRY(stf_saltation_behind(s, step->t, step->y, step->yp_known ? step->yp : NULL));
  for (int k = 0; moves && k < stf_columns(s); k++)
    stf_axpy(&step->system.space, -w->tau[k], w->after, w->jump[k]);
  if (follow) STEIF_TRY(stf_saltation_jumps(s, step->t, step->y));
  if (w->open) STEIF_TRY(stf_transition_broken(s));
  stf_saltation_renew(s);
  return moves ? stf_quadrature_after(s, step->t, step->y, w->tau) : STEIF_OK;
}
