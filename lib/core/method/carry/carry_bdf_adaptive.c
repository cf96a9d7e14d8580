/* carry_bdf_adaptive.c: derivatives by parameters through BDF with variable steps and orders.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "bdf_adaptive.h"

typedef stf_bdf state;

static stf_carrier_size sizes(const stf_step *s)
{
  (void)s;
  return (stf_carrier_size){1, 1, STF_BDF_POINTS + 1, 1, 0};
}

/* T->before: the point between them. */
static int carry_halves(stf_carry *T, sunrealtype h)
{
  stf_step *s = T->step;
  state *e = s->state;
  const sunrealtype d = h / 2, c[] = {1, -2, 1};
  const sunrealtype same = 1;
  STEIF_TRY(stf_carry_bdf(T, 0, s->t, d, 1, e->alpha, &s->y, e->other, 1, &same));
  for (int k = 0; k < T->count; k++) {
    stf_copy(&s->system.space, T->next[k], T->before[k]);
    T->kept[k][0] = T->before[k];
  }
  const int code = stf_carry_bdf(T, 0, s->t + d, d, 1, e->alpha, &e->other, s->next, 1, &same);
  for (int k = 0; k < T->count; k++) {
    N_Vector v[] = {T->next[k], T->before[k], T->S[k]};
    T->kept[k][0] = T->S[k];
    if (!code) stf_combine(&s->system.space, 3, c, v, T->error[k]);
  }
  return code;
}

static int carry(stf_carry *T, sunrealtype h)
{
  stf_step *s = T->step;
  state *e = s->state;
  const stf_space *space = &s->system.space;
  const bool halved = stf_bdf_halves(s);
  sunrealtype weight[STF_BDF_POINTS];
  const int count = e->points < e->k + 1 ? e->points : e->k + 1;
  const sunrealtype span = e->points > e->k ? s->t + h - e->t[e->k] : 2 * h;
  if (!halved) stf_bdf_extrapolate(e, count, s->t + h, weight);
  STEIF_TRY(halved
              ? carry_halves(T, h)
              : stf_carry_bdf(T, 0, s->t, h, e->k, e->alpha, e->y, s->next, count, weight));
  for (int k = 0; k < T->count; k++) {
    T->tolerance[k] = stf_carry_allowed(s, s->control.tolerance, e->k, e->k);
    if (halved) continue;
    stf_combine(space, count, weight, T->kept[k], T->error[k]);
    stf_sum(space, h / span, T->next[k], -h / span, T->error[k], T->error[k]);
  }
  return STEIF_OK;
}

static int carried_dense(stf_carry *T, int k, sunrealtype t, N_Vector S)
{
  const state *e = T->step->state;
  sunrealtype weight[STF_BDF_POINTS];
  stf_bdf_extrapolate(e, e->last + 1, t, weight);
  stf_combine(&T->step->system.space, e->last + 1, weight, T->kept[k], S);
  return STEIF_OK;
}

const stf_carrier stf_bdf_carrier = {.size = sizes,
                                     .carry = carry,
                                     .apply = stf_newton_carry_apply,
                                     .renew = stf_newton_carry_renew,
                                     .commit = stf_carry_bdf_commit,
                                     .dense = carried_dense};
