/* newton_apply.c: the matrix of Newton's iteration as a preconditioner for many right-hand sides.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "newton.h"

enum { TOGETHER = 16 }; /* right-hand sides of one solve, at most */

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

/* Right-hand sides v_k, k < count, of s vectors each, with the one real shift. */
static int solve_all(stf_newton *newton, int count, N_Vector *const *v)
{
  const int s = newton->transform.s;
  N_Vector together[TOGETHER];
  int held = 0;
  for (int i = 0; i < count * s; i++) {
    together[held++] = v[i / s][i % s];
    if (held < TOGETHER && i + 1 < count * s) continue;
    STEIF_TRY(steif_pencil_solve(newton->system->pencil, 0, held, together, NULL));
    held = 0;
  }
  return STEIF_OK;
}

/* As stf_blend_correction; scratch: newton->residual. */
static int blended(stf_newton *newton, int count, N_Vector *const *r, N_Vector *const *other)
{
  const stf_space *space = &newton->system->space;
  const sunrealtype sigma = newton->shift;
  const int s = newton->transform.s;
  for (int i = 0; i < s * s; i++)
    newton->mix[i] = sigma * newton->h * newton->A[i] - (i % (s + 1) == 0);
  for (int k = 0; k < count; k++) stf_mix(space, s, s, newton->mix, r[k], other[k]);
  STEIF_TRY(solve_all(newton, count, other));
  for (int k = 0; k < count; k++)
    for (int j = 0; j < s; j++) {
      N_Vector product = other[k][j];
      if (newton->system->form != STEIF_ODE) {
        product = newton->residual[j];
        STEIF_TRY(steif_pencil_product(newton->system->pencil, 'E', other[k][j], product));
      }
      stf_axpy(space, sigma, product, r[k][j]);
    }
  STEIF_TRY(solve_all(newton, count, r));
  for (int k = 0; k < count && newton->relax != 1; k++)
    for (int j = 0; j < s; j++) stf_scale(space, newton->relax, r[k][j], r[k][j]);
  return STEIF_OK;
}

int stf_newton_apply(stf_newton *newton, int count, N_Vector *const *r, N_Vector *const *other)
{
  const stf_transform *T = &newton->transform;
  const stf_space *space = &newton->system->space;
  if (newton->gamma > 0) return blended(newton, count, r, other);
  if (T->coupling) return by_columns(newton, count, r);
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
