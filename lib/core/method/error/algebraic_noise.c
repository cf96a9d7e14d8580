/* algebraic_noise.c: how well can algebraic unknowns be known?
 *
 * A differential unknown comes from the last step and changes by little; rounding leaves it eps |y|. An algebraic
 * one is solved for from its equation, 0 = g(y), whose terms round: z = 1 - x - y is known to eps, however small it
 * is and however fine its tolerance. With A = -F_y, of algebraic rows only,
 *   (sigma E - A) dz = A dy,   dy_i = +- eps y_i,
 * one product and one solve with the factors at hand; the signs, a fixed sequence, keep terms from cancelling.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "pencil.h"
#include "step_error.h"
#include <math.h>

/* dy, of signs that a probe gives. */
static void spread(const stf_step *s, N_Vector dy, N_Vector probe)
{
  const sunrealtype *y = STF_ARRAY(s->y), *p = STF_ARRAY(probe);
  sunrealtype *d = STF_ARRAY(dy);
  for (sunindextype i = 0; i < s->system.space.n; i++)
    d[i] = (p[i] >= 1.5 ? STF_EPS : -STF_EPS) * y[i];
}

int stf_algebraic_noise(stf_step *s, N_Vector work, N_Vector other, N_Vector third,
                        sunrealtype *noise)
{
  const stf_space *space = &s->system.space;
  *noise = 0;
  if (s->system.form == STEIF_ODE || s->system.krylov || !space->serial || !s->newton.factored)
    return STEIF_OK;
  stf_row_probe(space, third);
  spread(s, work, third);
  STEIF_TRY(steif_pencil_product(s->system.pencil, 'A', work, other));
  STEIF_TRY(steif_pencil_product(s->system.pencil, 'E', third, work));
  stf_keep_rows(space, work, true, other);
  STEIF_TRY(steif_pencil_solve(s->system.pencil, 0, 1, &other, NULL));
  const sunrealtype size = stf_norm(space, other, s->weights);
  if (isfinite(size)) *noise = size;
  return STEIF_OK;
}
