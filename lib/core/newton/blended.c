/* blended.c: stages of any collocation method by one real factorisation.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "blended.h"
#include <math.h>

/* The eigenvalue of A^{-1} of largest argument. */
static int widest(const stf_transform *transform)
{
  int at = 0;
  for (int k = 1; k < transform->shifts; k++)
    if (transform->im[k] * transform->re[at] > transform->im[at] * transform->re[k]) at = k;
  return at;
}

int stf_newton_blend(stf_pool *pool, const steif_table *table, stf_newton *newton)
{
  const int s = newton->transform.s, k = widest(&newton->transform);
  newton->mix = stf_pool_array(pool, (size_t)(s * s), sizeof *newton->mix);
  if (!newton->mix) return STEIF_NO_MEMORY;
  newton->A = table->A;
  newton->gamma = 1 / hypot(newton->transform.re[k], newton->transform.im[k]);
  return STEIF_OK;
}

int stf_blend_correction(stf_newton *newton)
{
  const stf_space *space = &newton->system->space;
  const sunrealtype sigma = newton->shift;
  steif_pencil *pencil = newton->system->pencil;
  const int s = newton->transform.s;
  for (int i = 0; i < s * s; i++)
    newton->mix[i] = sigma * newton->h * newton->A[i] - (i % (s + 1) == 0);
  stf_mix(space, s, s, newton->mix, newton->residual, newton->omega);
  STEIF_TRY(steif_pencil_solve(pencil, 0, s, newton->omega, NULL));
  for (int j = 0; j < s; j++) {
    N_Vector product = newton->omega[j];
    if (newton->system->form != STEIF_ODE) {
      product = newton->dZ[j];
      STEIF_TRY(steif_pencil_product(pencil, 'E', newton->omega[j], product));
    }
    stf_sum(space, 1, newton->residual[j], sigma, product, newton->dZ[j]);
  }
  return steif_pencil_solve(pencil, 0, s, newton->dZ, NULL);
}
