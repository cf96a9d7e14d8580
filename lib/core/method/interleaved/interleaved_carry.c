/* interleaved_carry.c: derivatives by parameters through steps of collocation with interleaved shifts: the lanes
 * solve for one column after another, from omega = 0.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "carry.h"
#include "irk_interleaved.h"
#include <string.h>

typedef stf_irk_interleaved state;

static stf_carrier_size sizes(const stf_step *s)
{
  const state *e = s->state;
  return (stf_carrier_size){e->s + 1, e->s, e->s, e->s, e->s};
}

int stf_irk_interleaved_damp(stf_step *s, sunrealtype h, N_Vector v)
{
  const state *e = s->state;
  (void)h;
  s->solves++;
  stf_interleaved_filter(e->L, STF_ARRAY(v));
  return STEIF_OK;
}

static int damp_all(stf_step *s, sunrealtype h, int count, N_Vector *v)
{
  for (int k = 0; k < count; k++) STEIF_TRY(stf_irk_interleaved_damp(s, h, v[k]));
  return STEIF_OK;
}

/* F as whole residuals in, the correction out of Z. */
static int apply(stf_step *s, sunrealtype h, int count, N_Vector *const *r,
                 N_Vector *const *other)
{
  state *e = s->state;
  const double none[STF_INTERLEAVED_STAGES] = {0};
  (void)other;
  e->L->residuals = true;
  for (int k = 0; k < count; k++) {
    stf_interleaved_begin(e->L, 0, e->a, none, STF_ARRAY(s->y));
    for (int j = 0; j < e->s; j++) stf_copy(&s->system.space, r[k][j], e->F[j]);
    stf_interleaved_sweep(e->L, STF_ARRAY(s->y), STF_ARRAY(s->weights), h);
    stf_interleaved_end(e->L);
    for (int j = 0; j < e->s; j++)
      for (int i = 0; i < e->n; i++) STF_ARRAY(r[k][j])[i] = e->L->Z[i * e->L->wide + j];
    s->solves += (e->s + 1) / 2;
  }
  return STEIF_OK;
}

static int renew(stf_step *s, sunrealtype t, sunrealtype h, N_Vector Y, N_Vector Yp)
{
  state *e = s->state;
  e->J_from_stage = e->J_ahead = true;
  STEIF_TRY(stf_system_matrices(&s->system, t, Y, Yp));
  return stf_irk_interleaved_factor(s, h);
}

/* The stages of y are set aside meanwhile. */
static int carry(stf_carry *T, sunrealtype h)
{
  stf_step *s = T->step;
  state *e = s->state;
  const size_t bytes = (size_t)e->n * (size_t)e->L->wide * sizeof *e->L->Z;
  sunrealtype B_over_h[STF_EIGEN_STAGES * STF_EIGEN_STAGES];
  for (int i = 0; i < e->s * e->s; i++) B_over_h[i] = e->B[i] / h;
  for (int j = 0; j < e->s; j++)
    for (int i = 0; i < e->n; i++) STF_ARRAY(e->stage[j])[i] = e->L->Z[i * e->L->wide + j];
  memcpy(e->aside, e->L->Z, bytes);
  const bool residuals = e->L->residuals;
  const stf_collocation_stages c = {.u = &e->u,
                                    .ahead = &e->u,
                                    .B_over_h = B_over_h,
                                    .estimate = &e->higher_order,
                                    .Z = e->stage,
                                    .filter = damp_all};
  const int code = stf_carry_collocation(T, h, &c);
  memcpy(e->L->Z, e->aside, bytes);
  e->L->residuals = residuals;
  return code;
}

static int dense(stf_carry *T, int k, sunrealtype t, N_Vector S)
{
  const stf_step *s = T->step;
  const state *e = s->state;
  return stf_stage_polynomial_at(&e->u, &s->system.space, (t - (s->t - s->h)) / s->h,
                                 T->before[k], T->kept[k], S);
}

const stf_carrier stf_irk_interleaved_carrier = {
  .size = sizes, .carry = carry, .apply = apply, .renew = renew, .dense = dense};
