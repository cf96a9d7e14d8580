/* blend.c: stages of any collocation method by one real factorisation.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "blend.h"
#include <math.h>

/* The lane of the eigenvalue of A^{-1} with the largest argument. */
static int widest(const stf_split *split)
{
  int at = 0;
  for (int k = 1; k < split->lanes; k++)
    if (split->im[k] * split->re[at] > split->im[at] * split->re[k]) at = k;
  return at;
}

int stf_newton_blend(stf_pool *pool, const steif_table *table, stf_newton *newton)
{
  const int s = newton->split.s, k = widest(&newton->split);
  newton->mix = stf_claim(pool, (size_t)(s * s), sizeof *newton->mix);
  if (!newton->mix) return STEIF_NO_MEMORY;
  newton->A = table->A;
  newton->gamma = 1 / hypot(newton->split.re[k], newton->split.im[k]);
  return STEIF_OK;
}

int stf_blend_correction(stf_newton *newton)
{
  const stf_space *space = &newton->system->space;
  const sunrealtype sigma = newton->shift;
  steif_pencil *pencil = newton->system->pencil;
  const int s = newton->split.s;
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
