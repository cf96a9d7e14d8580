/* carry_predict.c: where the sweeps over a step of collocation begin: the polynomial of the last step, ahead, and what
 * that has missed in the last step, which is D_i(ratio) h_before^(s+1) S^(s+1) at stage i when steps follow one
 * another at that ratio, D_i being what it misses of x^(s+1) behind a step of length 1.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "carry.h"
#include <math.h>

static bool predicts(const stf_carry *T)
{
  return !T->K && !T->step->system.linear && T->history > 0 && !T->step->restart;
}

/* Stages of x^(s+1) from 0 in a step from `from`, relative to its beginning. */
static void stages_of_power(const steif_table *table, sunrealtype from, sunrealtype h,
                            sunrealtype *Z)
{
  const int s = table->s;
  for (int i = 0; i < s; i++) {
    Z[i] = 0;
    for (int m = 0; m < s; m++)
      Z[i] += h * table->A[i * s + m] * (s + 1) * pow(from + table->c[m] * h, s);
  }
}

static void defects(const stf_collocation_stages *c, sunrealtype ratio, sunrealtype *D)
{
  const int s = c->u->s;
  const sunrealtype *P = stf_stage_polynomial_ahead(c->ahead, ratio);
  sunrealtype last[STEIF_STAGES];
  stages_of_power(c->u->table, -1, 1, last);
  stages_of_power(c->u->table, 0, ratio, D);
  for (int i = 0; i < s; i++)
    for (int j = 0; j < s; j++) D[i] -= P[i * s + j] * last[j];
}

/* Factors of what was missed in the last step; false: there is nothing to be told from. */
static bool factors(const stf_carry *T, sunrealtype h, const stf_collocation_stages *c,
                    sunrealtype *factor)
{
  const sunrealtype last = T->step->h, before = T->h_before, most = 10;
  const int s = c->u->s;
  sunrealtype D[STEIF_STAGES];
  if (T->history < 2) return false;
  defects(c, last / before, D);
  defects(c, h / last, factor);
  for (int i = 0; i < s; i++) {
    factor[i] *= pow(last / before, s + 1) / D[i];
    if (!(fabs(factor[i]) <= most)) return false;
  }
  return true;
}

bool stf_carry_predict(stf_carry *T, sunrealtype h, const stf_collocation_stages *c)
{
  const stf_step *step = T->step;
  const stf_space *space = &step->system.space;
  const int s = c->u->s;
  sunrealtype factor[STEIF_STAGES];
  if (!predicts(T)) return false;
  const bool more = T->steady && factors(T, h, c, factor);
  const sunrealtype *P = stf_stage_polynomial_ahead(c->ahead, h / step->h);
  for (int k = 0; k < T->count; k++) {
    stf_mix(space, s, s, P, T->kept[k], T->trial[k]);
    for (int i = 0; more && i < s; i++)
      stf_axpy(space, factor[i], T->missed[k][i], T->trial[k][i]);
  }
  return true;
}

void stf_carry_look_back(stf_carry *T, sunrealtype h, const stf_collocation_stages *c)
{
  const stf_step *step = T->step;
  const stf_space *space = &step->system.space;
  const int s = c->u->s, end = s - 1;
  sunrealtype factor[STEIF_STAGES], without = 0, with = 0;
  T->steady = false;
  if (!predicts(T)) return;
  const bool more = factors(T, h, c, factor);
  const sunrealtype *P = stf_stage_polynomial_ahead(c->ahead, h / step->h);
  for (int k = 0; k < T->count; k++) {
    N_Vector *miss = T->misses[k];
    stf_mix(space, s, s, P, T->kept[k], miss);
    for (int i = 0; i < s; i++) stf_sum(space, 1, T->trial[k][i], -1, miss[i], miss[i]);
    without = fmax(without, stf_norm(space, miss[end], T->weights[k]));
    if (!more) continue;
    stf_sum(space, 1, miss[end], -factor[end], T->missed[k][end], T->work);
    with = fmax(with, stf_norm(space, T->work, T->weights[k]));
  }
  T->steady = more && with < without;
}
