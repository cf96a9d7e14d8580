/* carry_predict.c: where the sweeps over a step of collocation begin: the polynomial of the last step, ahead, and what
 * that has missed in the last step, which is D_i(ratio) h_before^(s+1) S^(s+1) at stage i when steps follow one
 * another at that ratio, D_i being what it misses of x^(s+1) behind a step of length 1. As many misses are looked at as
 * would have served the last step best.
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
  sunrealtype power[STEIF_STAGES];
  for (int m = 0; m < s; m++) {
    power[m] = 1;
    for (int k = 0; k < s; k++) power[m] *= from + table->c[m] * h;
  }
  for (int i = 0; i < s; i++) {
    Z[i] = 0;
    for (int m = 0; m < s; m++) Z[i] += h * table->A[i * s + m] * (s + 1) * power[m];
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

/* Weights, by stages, of what was missed in the last step and in the one before, as S^(s+1) is taken for constant, degree
 * 1, or for a straight line through the beginnings of both, degree 2. False: there is nothing to be told from. */
static bool weigh(const stf_carry *T, sunrealtype h, const stf_collocation_stages *c,
                  int degree, sunrealtype (*weight)[STEIF_STAGES])
{
  const sunrealtype last = T->step->h, *before = T->h_before, most = 10;
  const sunrealtype slope = degree > 1 ? last / before[0] : 0;
  const int s = c->u->s;
  sunrealtype D[STEIF_STAGES], then[STEIF_STAGES];
  if (degree < 1 || T->history < degree + 1) return false;
  defects(c, h / last, D);
  for (int d = 0; d < degree; d++) {
    const sunrealtype after = d ? before[0] : last;
    defects(c, after / before[d], then);
    for (int i = 0; i < s; i++) {
      weight[d][i] = (d ? -slope : 1 + slope) * D[i] / then[i] * pow(last / before[d], s + 1);
      if (!(fabs(weight[d][i]) <= most)) return false;
    }
  }
  return true;
}

/* v += the weighted misses of column k at stage i. */
static void add_misses(const stf_carry *T, int degree, sunrealtype (*weight)[STEIF_STAGES],
                       sunrealtype sign, int k, int i, N_Vector v)
{
  for (int d = 0; d < degree; d++)
    stf_axpy(&T->step->system.space, sign * weight[d][i], T->missed[d][k][i], v);
}

bool stf_carry_predict(stf_carry *T, sunrealtype h, const stf_collocation_stages *c)
{
  const stf_step *step = T->step;
  const int s = c->u->s;
  sunrealtype weight[STF_CARRY_MISSES][STEIF_STAGES];
  if (!predicts(T)) return false;
  const bool more = weigh(T, h, c, T->degree, weight);
  const sunrealtype *P = stf_stage_polynomial_ahead(c->ahead, h / step->h);
  for (int k = 0; k < T->count; k++) {
    stf_mix(&step->system.space, s, s, P, T->kept[k], T->trial[k]);
    for (int i = 0; more && i < s; i++)
      add_misses(T, T->degree, weight, 1, k, i, T->trial[k][i]);
  }
  return true;
}

/* The largest weighted miss at the last stage, had the start been of this degree. */
static sunrealtype miss(stf_carry *T, int degree, sunrealtype (*weight)[STEIF_STAGES], int end)
{
  const stf_space *space = &T->step->system.space;
  sunrealtype most = 0;
  for (int k = 0; k < T->count; k++) {
    stf_copy(space, T->misses[k][end], T->work);
    add_misses(T, degree, weight, -1, k, end, T->work);
    const sunrealtype norm = stf_norm(space, T->work, T->weights[k]);
    if (!(norm <= most)) most = norm;
  }
  return most;
}

void stf_carry_look_back(stf_carry *T, sunrealtype h, const stf_collocation_stages *c)
{
  const stf_step *step = T->step;
  const stf_space *space = &step->system.space;
  const int s = c->u->s;
  sunrealtype weight[STF_CARRY_MISSES][STEIF_STAGES];
  T->degree = 0;
  if (!predicts(T)) return;
  const sunrealtype *P = stf_stage_polynomial_ahead(c->ahead, h / step->h);
  for (int k = 0; k < T->count; k++) {
    stf_mix(space, s, s, P, T->kept[k], T->misses[k]);
    for (int i = 0; i < s; i++)
      stf_sum(space, 1, T->trial[k][i], -1, T->misses[k][i], T->misses[k][i]);
  }
  sunrealtype least = miss(T, 0, weight, s - 1);
  for (int degree = 1; degree <= STF_CARRY_MISSES; degree++) {
    if (!weigh(T, h, c, degree, weight)) continue;
    const sunrealtype now = miss(T, degree, weight, s - 1);
    if (now < least) least = now, T->degree = degree;
  }
}
