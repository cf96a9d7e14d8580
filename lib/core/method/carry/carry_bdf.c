/* carry_bdf.c: S through steps of BDF, by the recurrence of y with past values of S.
 *
 * Solved for is Z = S - S_n: S' = (alpha_0 Z + sum_j alpha_j (S_{n+1-j} - S_n)) / h, as the alpha add up to 0. Of S alone
 * E S' would have the rounding of S / h, which algebraic equations see where E mixes them with others.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "carry.h"

int stf_carry_bdf(stf_carry *T, int point, sunrealtype t, sunrealtype h, int order,
                  const sunrealtype *alpha, N_Vector *past, N_Vector y, int count,
                  const sunrealtype *predict)
{
  stf_step *s = T->step;
  const stf_space *space = &s->system.space;
  const sunrealtype shift = alpha[0] / h;
  sunrealtype a[STF_CARRY_PAST];
  for (int j = 1; j <= order; j++) a[j - 1] = alpha[j] / h;
  stf_combine(space, order, a, past, T->last_slope);
  stf_axpy(space, shift, y, T->last_slope);
  STEIF_TRY(stf_carry_point(T, point, t + h, y, T->last_slope));
  for (int k = 0; k < T->count; k++) {
    N_Vector *S = T->kept[k];
    T->from[k] = S[0], T->trial[k][0] = T->next[k];
    stf_zero(space, T->error[k]);
    for (int j = 1; j < order; j++) {
      stf_sum(space, 1, S[j], -1, S[0], T->work);
      stf_axpy(space, a[j], T->work, T->error[k]);
    }
    if (!predict) continue;
    stf_combine(space, count, predict, S, T->next[k]);
    stf_axpy(space, -1, S[0], T->next[k]);
  }
  const stf_carry_stages g = {.first = point,
                              .m = 1,
                              .t = t + h,
                              .h = h,
                              .predicted = predict != NULL,
                              .Y = y,
                              .Yp = T->last_slope,
                              .B_over_h = &shift,
                              .base = T->from,
                              .offset = T->error};
  STEIF_TRY(stf_carry_solve(T, &g));
  for (int k = 0; k < T->count; k++) stf_axpy(space, 1, T->from[k], T->next[k]);
  return STEIF_OK;
}

void stf_carry_bdf_commit(stf_carry *T)
{
  const int last = T->size.kept - 1;
  for (int k = 0; k < T->count; k++) {
    N_Vector oldest = T->kept[k][last];
    for (int j = last; j > 0; j--) T->kept[k][j] = T->kept[k][j - 1];
    T->kept[k][0] = T->S[k] = T->next[k];
    T->next[k] = oldest;
  }
}
