/* carry_glm.c: derivatives by parameters through general linear methods: each of the k external vectors has its own, and
 * so have the values of the starting procedure.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "carry.h"
#include "glm_state.h"

typedef stf_glm_state state;

/* Of a column, kept: X_n, X_{n-1}, F; trial: X_{n+1}, X_n, F. */
static stf_carrier_size sizes(const stf_step *s)
{
  const state *e = s->state;
  return (stf_carrier_size){e->r, e->chain.gamma > 0, e->data, e->data, 0};
}

static stf_glm_step step_of(const state *e, N_Vector *column, sunrealtype h)
{
  return (stf_glm_step){column, column + 2 * e->k, column + e->k, h};
}

static int open(stf_carry *T)
{
  state *e = T->step->state;
  return stf_begin_carry(T, &e->begin);
}

/* X_n of the trial. */
static void history(stf_carry *T, sunrealtype h, int k)
{
  stf_step *s = T->step;
  state *e = s->state;
  N_Vector *X = T->trial[k] + e->k;
  const stf_glm_step last = step_of(e, T->kept[k], e->scale);
  if (e->begun)
    stf_mix(&s->system.space, e->k, e->begin.count + 1, e->first, e->begin.part[1 + k].value,
            X);
  else if (e->x == e->from)
    stf_glm_rescale(s, h, &last, X);
  else
    for (int i = 0; i < e->k; i++) stf_copy(&s->system.space, last.X[i], X[i]);
}

/* T->next: the derivative of sum_j u_ij x_j + h sum_{l<i} a_il K_l. */
static void stage_base(stf_carry *T, sunrealtype h, int i, int k)
{
  const stf_step *s = T->step;
  const state *e = s->state;
  const stf_space *space = &s->system.space;
  N_Vector *X = T->trial[k] + e->k, *F = X + e->k;
  stf_combine(space, e->k, e->chain.U + i * e->k, X, T->next[k]);
  stf_combine(space, i, e->chain.A + i * e->r, F, T->work);
  stf_axpy(space, h, T->work, T->next[k]);
}

static int stage(stf_carry *T, sunrealtype h, int i)
{
  stf_step *s = T->step;
  const state *e = s->state;
  const stf_space *space = &s->system.space;
  const int F = 2 * e->k;
  const bool guess = !s->system.linear && (i > 0 || (T->history && !s->restart));
  const sunrealtype t = s->t + e->chain.c[i] * h, shift = 1 / (e->chain.gamma * h);
  STEIF_TRY(stf_carry_point(T, i, t, e->chain.X[i], e->chain.K[i]));
  for (int k = 0; k < T->count; k++) stage_base(T, h, i, k);
  if (e->chain.A[i * (e->r + 1)] == 0) {
    for (int k = 0; k < T->count; k++)
      STEIF_TRY(stf_carry_residual(T, i, k, T->next[k], NULL, T->trial[k][F + i]));
    return STEIF_OK;
  }
  for (int k = 0; guess && k < T->count; k++)
    stf_scale(space, 1 / shift, i > 0 ? T->trial[k][F + i - 1] : T->kept[k][F + e->r - 1],
              T->trial[k][F + i]);
  const stf_carry_stages g = {.first = i,
                              .m = 1,
                              .t = t,
                              .h = h,
                              .predicted = guess,
                              .Y = e->chain.X[i],
                              .Yp = e->chain.K[i],
                              .B_over_h = &shift,
                              .base = T->next,
                              .to = F + i};
  STEIF_TRY(stf_carry_solve(T, &g));
  for (int k = 0; k < T->count; k++)
    stf_scale(space, shift, T->trial[k][F + i], T->trial[k][F + i]);
  return STEIF_OK;
}

static int estimate(stf_carry *T, const stf_glm_step *now, int k)
{
  stf_step *s = T->step;
  const state *e = s->state;
  const stf_glm_step last = step_of(e, T->kept[k], e->scale);
  if (e->begun && !e->estimates)
    stf_sum(&s->system.space, 1, T->next[k], -1, e->begin.part[1 + k].value[e->begin.count],
            T->error[k]);
  else
    stf_glm_error(s, now, &last, T->work, T->error[k]);
  T->tolerance[k] = stf_carry_allowed(s, s->control.tolerance, s->control.order, e->p);
  if (!(e->chain.gamma > 0)) return STEIF_OK;
  stf_scale(&s->system.space, 1 / (e->chain.gamma * now->h), T->error[k], T->work);
  STEIF_TRY(steif_pencil_product(s->system.pencil, 'E', T->work, T->error[k]));
  return steif_pencil_solve(s->system.pencil, 0, 1, &T->error[k], NULL);
}

static int carry(stf_carry *T, sunrealtype h)
{
  stf_step *s = T->step;
  const state *e = s->state;
  for (int k = 0; k < T->count; k++) history(T, h, k);
  for (int i = 0; i < e->r; i++) STEIF_TRY(stage(T, h, i));
  for (int k = 0; k < T->count; k++) {
    const stf_glm_step now = step_of(e, T->trial[k], h);
    stf_glm_advance(s, &now, T->next[k]);
    if (s->adaptive) STEIF_TRY(estimate(T, &now, k));
  }
  return STEIF_OK;
}

static int carried_dense(stf_carry *T, int k, sunrealtype t, N_Vector S)
{
  const state *e = T->step->state;
  const stf_glm_step last = step_of(e, T->kept[k], e->scale);
  stf_glm_dense(T->step, t, &last, T->before[k], T->S[k], S);
  return STEIF_OK;
}

const stf_carrier stf_glm_carrier = {.open = open,
                                     .size = sizes,
                                     .carry = carry,
                                     .apply = stf_newton_carry_apply,
                                     .renew = stf_newton_carry_renew,
                                     .dense = carried_dense};
