/* irk_error.c: the error of a step of collocation.
 *
 * Error estimate (c_1 > 0): the shifted solve of -F(t_n, y_n, u'(t_n)); order s (Hairer and Wanner II, IV.8).
 * Where the end is not a stage, of -F(t_n + h, y_{n+1}, u'(t_n + h)): stiff and algebraic components are off.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "irk_state.h"
#include <math.h>

typedef stf_irk_state state;

/* error = -(lambda/h E - A)^{-1} F(t, y, u') with the real lane; with a pair the quadratic filter -(re/im) Im of the
 * complex solve, or its real part, which keeps stiff components; with the one shift sigma of the blended iteration
 * -sigma h gamma_0 (sigma E - A)^{-1} F, gamma_0 = 1/lambda or re/|lambda|^2. */
static int solve_shift(stf_step *s, sunrealtype h, N_Vector v)
{
  state *e = s->state;
  const bool pair = s->newton.gamma <= 0 && s->newton.transform.im[0] != 0;
  (void)h;
  if (pair) stf_zero(&s->system.space, e->imaginary);
  return steif_pencil_solve(s->system.pencil, 0, 1, &v, pair ? &e->imaginary : NULL);
}

/* What the filter keeps of the deviation of an algebraic component. */
static sunrealtype kept(const stf_step *s, sunrealtype h)
{
  const state *e = s->state;
  return s->newton.gamma > 0 ? e->filter * s->newton.shift * h : 1;
}

int stf_irk_filter_all(stf_step *s, sunrealtype h, int count, N_Vector *v)
{
  const bool real = s->newton.gamma > 0 || s->newton.transform.im[0] == 0;
  for (int k = 0; !real && k < count; k++) STEIF_TRY(stf_irk_filter(s, h, v[k]));
  if (!real) return STEIF_OK;
  STEIF_TRY(steif_pencil_solve(s->system.pencil, 0, count, v, NULL));
  for (int k = 0; s->newton.gamma > 0 && k < count; k++)
    stf_scale(&s->system.space, kept(s, h), v[k], v[k]);
  return STEIF_OK;
}

int stf_irk_filter(stf_step *s, sunrealtype h, N_Vector v)
{
  STEIF_TRY(solve_shift(s, h, v));
  if (s->newton.gamma > 0) stf_scale(&s->system.space, kept(s, h), v, v);
  return STEIF_OK;
}

static int filtered(stf_step *s, sunrealtype h, sunrealtype t, N_Vector y)
{
  state *e = s->state;
  STEIF_TRY(stf_system_residual(&s->system, t, y, e->work, s->error));
  if (y == s->y) STEIF_TRY(stf_without_residuals(s, e->X[0], e->imaginary, s->error));
  stf_scale(&s->system.space, -1, s->error, s->error);
  return stf_irk_filter(s, h, s->error);
}

static int estimate_end(stf_step *s, sunrealtype h)
{
  state *e = s->state;
  const stf_space *space = &s->system.space;
  const sunrealtype whole = 1 / kept(s, h);
  N_Vector first = e->X[0];
  STEIF_TRY(filtered(s, h, s->t + h, s->next));
  const int rounds = stf_filter_rounds(s);
  N_VConst(0, first);
  for (int k = 0; k < rounds; k++) {
    stf_axpy(space, whole, s->error, first);
    stf_sum(space, 1, s->next, 1, first, s->newton.Y);
    STEIF_TRY(filtered(s, h, s->t + h, s->newton.Y));
  }
  return stf_test_undamped(s, first, rounds * whole, s->newton.fails > e->fails,
                           s->newton.gamma > 0);
}

/* Of the components of index 1: others begin at the error of the last step. */
static void difference(stf_step *s, const sunrealtype *weight, N_Vector d)
{
  const state *e = s->state;
  stf_combine(&s->system.space, e->s, weight, e->trial, d);
  stf_of_index_one(s, d);
}

/* Oscillations that a step does not resolve take from the higher order. */
static int set_tolerance(stf_step *s, sunrealtype h)
{
  state *e = s->state;
  if (s->system.nje != e->omega_of) {
    e->omega_of = s->system.nje;
    stf_sum(&s->system.space, 1, s->next, -1, s->y, e->work);
    STEIF_TRY(stf_oscillation(s, e->work, e->X[0], e->imaginary, &e->omega));
  }
  N_Vector d[] = {e->work, e->imaginary, e->X[0]};
  sunrealtype size[3];
  difference(s, e->higher_order.top, d[0]), difference(s, e->higher_order.below, d[1]);
  difference(s, e->higher_order.lower, d[2]);
  stf_norm_each(&s->system.space, 3, d, s->weights, size);
  stf_estimate_set(s, &e->higher_order, size[0], size[1]);
  stf_estimate_between(s, &e->higher_order, size[2], size[1], size[0]);
  if (e->omega * h > 1) stf_estimate_none(s, &e->higher_order);
  return STEIF_OK;
}

static int estimate(stf_step *s, sunrealtype h)
{
  state *e = s->state;
  const stf_space *space = &s->system.space;
  STEIF_TRY(set_tolerance(s, h));
  sunrealtype slope[STEIF_STAGES];
  for (int j = 0; j < e->s; j++) slope[j] = e->u.slope[j] / h;
  stf_combine(space, e->s, slope, e->trial, e->work);
  if (!e->u.accurate) return estimate_end(s, h);
  STEIF_TRY(filtered(s, h, s->t, s->y));
  if (stf_filters_twice(s) && stf_norm(space, s->error, s->weights) > s->control.tolerance) {
    stf_sum(space, 1, s->y, 1 / kept(s, h), s->error, s->newton.Y);
    STEIF_TRY(filtered(s, h, s->t, s->newton.Y));
  }
  return stf_estimate_stiff(s, &e->higher_order, h, NULL, stf_irk_filter, e->X[0], e->work);
}

static int inside(stf_step *s, sunrealtype x, N_Vector y)
{
  const state *e = s->state;
  return stf_stage_polynomial_at(&e->u, &s->system.space, x, s->y, e->trial, y);
}

static int look_between(stf_step *s, sunrealtype h)
{
  const state *e = s->state;
  sunrealtype x[STEIF_STAGES];
  const int points = stf_between_nodes(e->table, x);
  const stf_look look = {x, points, inside, NULL, solve_shift, s->newton.Y, e->X[0], e->work};
  return stf_look_between(s, h, &look);
}

int stf_irk_estimate(stf_step *s, sunrealtype h)
{
  STEIF_TRY(estimate(s, h));
  stf_estimate_levels(s);
  return look_between(s, h);
}
