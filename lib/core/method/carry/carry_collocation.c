/* carry_collocation.c: S through a step of collocation, and its error estimate, that of y differentiated.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "carry.h"
#include "step_error.h"

/* Weighted size of sum_j weight_j dZ_j, of components of index 1. */
static sunrealtype size_of(stf_carry *T, const stf_collocation_stages *c, int k,
                           const sunrealtype *weight)
{
  const stf_step *s = T->step;
  const int *index = s->problem->index;
  stf_combine(&s->system.space, c->u->s, weight, T->trial[k], T->work);
  sunindextype rows = 0;
  sunrealtype *work = index ? stf_own_rows(T->work, &rows) : NULL;
  for (sunindextype i = 0; work && i < rows; i++)
    if (index[i] > 1) work[i] = 0;
  return stf_norm(&s->system.space, T->work, T->weights[k]);
}

/* What the error of column k may be; the control of y stays. */
static void set_tolerance(stf_carry *T, const stf_collocation_stages *c, int k)
{
  stf_step *s = T->step;
  const stf_control control = s->control;
  stf_estimate wider = *c->estimate;
  wider.loosest *= stf_carry_slack(s, wider.s, wider.s + wider.beyond);
  stf_estimate_set(s, &wider, size_of(T, c, k, c->estimate->top),
                   size_of(T, c, k, c->estimate->below));
  if (c->oscillates) stf_estimate_none(s, c->estimate);
  T->tolerance[k] = s->control.tolerance;
  s->control = control;
}

/* T->error[k] := F of column k with S = `at` and the slope of the stages. */
static int residual(stf_carry *T, const stf_collocation_stages *c, sunrealtype h, int k,
                    N_Vector at)
{
  sunrealtype slope[STEIF_STAGES];
  for (int j = 0; j < c->u->s; j++) slope[j] = c->u->slope[j] / h;
  stf_combine(&T->step->system.space, c->u->s, slope, T->trial[k], T->work);
  return stf_carry_residual(T, c->u->s, k, at, T->work, T->error[k]);
}

/* All columns with one call of the filter. Filtered again where that of y is: what stiff components add to the first
 * estimate at every length of the step is off. */
static int estimate(stf_carry *T, const stf_collocation_stages *c, sunrealtype h)
{
  stf_step *s = T->step;
  const stf_space *space = &s->system.space;
  N_Vector *const from = c->u->accurate ? T->S : T->next;
  int again = 0;
  for (int k = 0; k < T->count; k++) STEIF_TRY(residual(T, c, h, k, from[k]));
  STEIF_TRY(c->filter(s, h, T->count, T->error));
  for (int k = 0; k < T->count; k++) {
    const bool small = stf_norm(space, T->error[k], T->weights[k]) <= T->tolerance[k];
    if (c->u->accurate && (small || !stf_filters_twice(s))) continue;
    stf_sum(space, 1, from[k], 1, T->error[k], T->Y);
    STEIF_TRY(residual(T, c, h, k, T->Y));
    T->from[again++] = T->error[k];
  }
  return again ? c->filter(s, h, again, T->from) : STEIF_OK;
}

/* Matrices at the stages and, for the estimate, where that of y looks at F. */
static int points(stf_carry *T, sunrealtype h, const stf_collocation_stages *c)
{
  const stf_step *s = T->step;
  const stf_space *space = &s->system.space;
  const int count = c->u->s;
  sunrealtype slope[STEIF_STAGES];
  for (int j = 0; j < count; j++) {
    slope[j] = c->u->slope[j] / h;
    stf_sum(space, 1, s->y, 1, c->Z[j], T->last);
    stf_combine(space, count, c->B_over_h + j * count, c->Z, T->last_slope);
    STEIF_TRY(stf_carry_point(T, j, s->t + c->u->table->c[j] * h, T->last, T->last_slope));
  }
  if (!s->adaptive) return STEIF_OK;
  stf_combine(space, count, slope, c->Z, T->Yp);
  return c->u->accurate ? stf_carry_point(T, count, s->t, s->y, T->Yp)
                        : stf_carry_point(T, count, s->t + h, s->next, T->Yp);
}

int stf_carry_collocation(stf_carry *T, sunrealtype h, const stf_collocation_stages *c)
{
  stf_step *s = T->step;
  const stf_space *space = &s->system.space;
  const int count = c->u->s;
  STEIF_TRY(points(T, h, c));
  const stf_carry_stages g = {.m = count,
                              .t = s->t + c->u->table->c[count - 1] * h,
                              .h = h,
                              .predicted = stf_carry_predict(T, h, c),
                              .Y = T->last,
                              .Yp = T->last_slope,
                              .B_over_h = c->B_over_h,
                              .base = T->S};
  STEIF_TRY(stf_carry_solve(T, &g));
  stf_carry_look_back(T, h, c);
  for (int k = 0; k < T->count; k++) {
    stf_combine(space, count, c->u->end, T->trial[k], T->next[k]);
    stf_axpy(space, 1, T->S[k], T->next[k]);
    if (s->adaptive) set_tolerance(T, c, k);
  }
  return s->adaptive ? estimate(T, c, h) : STEIF_OK;
}
