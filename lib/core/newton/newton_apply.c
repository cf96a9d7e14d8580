/* newton_apply.c: the matrix of Newton's iteration as a preconditioner for many right-hand sides.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "newton.h"

enum { TOGETHER = 8 }; /* right-hand sides of one solve */

static int by_columns(stf_newton *newton, int count, N_Vector *const *r)
{
  const stf_space *space = &newton->system->space;
  const int s = newton->transform.s;
  for (int k = 0; k < count; k++) {
    for (int j = 0; j < s; j++) stf_copy(space, r[k][j], newton->residual[j]);
    STEIF_TRY(stf_newton_correct(newton));
    for (int j = 0; j < s; j++) stf_scale(space, newton->relax, newton->dZ[j], r[k][j]);
  }
  return STEIF_OK;
}

/* Of shift i, right-hand sides first .. first + count - 1. */
static int solve(stf_newton *newton, int i, int first, int count, N_Vector *const *omega)
{
  const stf_transform *T = &newton->transform;
  N_Vector re[TOGETHER], im[TOGETHER];
  const bool pair = T->im[i] != 0;
  for (int k = 0; k < count; k++) {
    re[k] = omega[first + k][T->row[i]];
    im[k] = pair ? omega[first + k][T->row[i] + 1] : NULL;
  }
  return steif_pencil_solve(newton->system->pencil, i, count, re, pair ? im : NULL);
}

int stf_newton_apply(stf_newton *newton, int count, N_Vector *const *r, N_Vector *const *other)
{
  const stf_transform *T = &newton->transform;
  const stf_space *space = &newton->system->space;
  if (newton->gamma > 0 || T->coupling) return by_columns(newton, count, r);
  N_Vector *const *omega = T->s > 1 ? other : r;
  for (int k = 0; T->s > 1 && k < count; k++)
    stf_mix(space, T->s, T->s, T->Tinv, r[k], other[k]);
  for (int i = 0; i < T->shifts; i++)
    for (int k = 0; k < count; k += TOGETHER)
      STEIF_TRY(solve(newton, i, k, count - k < TOGETHER ? count - k : TOGETHER, omega));
  for (int k = 0; k < count; k++) {
    if (T->s > 1) stf_mix(space, T->s, T->s, T->T, other[k], r[k]);
    for (int j = 0; j < T->s && newton->relax != 1; j++)
      stf_scale(space, newton->relax, r[k][j], r[k][j]);
  }
  return STEIF_OK;
}
