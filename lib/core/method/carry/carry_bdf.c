/* carry_bdf.c: S through steps of BDF, by the recurrence of y with past values of S.
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
    stf_combine(space, order, a, T->kept[k], T->error[k]);
    T->trial[k][0] = T->next[k];
    if (predict) stf_combine(space, count, predict, T->kept[k], T->next[k]);
  }
  const stf_carry_stages g = {.first = point,
                              .m = 1,
                              .t = t + h,
                              .h = h,
                              .predicted = predict != NULL,
                              .Y = y,
                              .Yp = T->last_slope,
                              .B_over_h = &shift,
                              .offset = T->error};
  return stf_carry_solve(T, &g);
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
