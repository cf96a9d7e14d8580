/* algebraic_noise.c: how well can algebraic unknowns be known?
 *
 * A differential unknown comes from the last step and changes by little; rounding leaves it eps |y|. An algebraic
 * one is solved for from its equation, 0 = g(y), whose terms round: z = 1 - x - y is known to eps, however small it
 * is and however fine its tolerance. With A = -F_y, of algebraic rows only,
 *   (sigma E - A) dz = A dy,   dy_i = +- eps y_i,
 * one product and one solve with the factors at hand; the signs, a fixed sequence, keep terms from cancelling.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "method.h"
#include "pencil.h"
#include <math.h>
#include <stdint.h>

/* dy, and a probe of no particular direction. */
static void spread(const stf_step *s, N_Vector dy, N_Vector probe)
{
  const sunrealtype *y = STF_ARRAY(s->y);
  sunrealtype *d = STF_ARRAY(dy), *p = STF_ARRAY(probe);
  uint32_t bits = 1;
  for (sunindextype i = 0; i < s->system.space.n; i++) {
    bits = bits * 1664525u + 1013904223u; /* Knuth, TAOCP 2, 3.3.4 */
    d[i] = (bits >> 31 ? STF_EPS : -STF_EPS) * y[i];
    p[i] = 1 + (sunrealtype)bits / UINT32_MAX;
  }
}

int stf_algebraic_noise(stf_step *s, N_Vector work, N_Vector other, N_Vector third,
                        sunrealtype *noise)
{
  const stf_space *space = &s->system.space;
  *noise = 0;
  if (s->system.form == STEIF_ODE || s->system.krylov || !space->serial || !s->newton.factored)
    return STEIF_OK;
  spread(s, work, third);
  STEIF_TRY(steif_pencil_product(s->system.pencil, 'A', work, other));
  STEIF_TRY(steif_pencil_product(s->system.pencil, 'E', third, work));
  const sunrealtype *Ep = STF_ARRAY(work);
  sunrealtype *r = STF_ARRAY(other);
  for (sunindextype i = 0; i < space->n; i++)
    if (Ep[i] != 0) r[i] = 0;
  STEIF_TRY(steif_pencil_solve(s->system.pencil, 0, 1, &other, NULL));
  const sunrealtype size = stf_norm(space, other, s->weights);
  if (isfinite(size)) *noise = size;
  return STEIF_OK;
}

/* So many rejected steps have not cured what is no error of theirs. */
enum { STUBBORN = 2 };

int stf_without_residuals(stf_step *s, N_Vector probe, N_Vector Ep, N_Vector residual)
{
  const stf_space *space = &s->system.space;
  if (s->tries < STUBBORN || s->count == 0 || s->system.form == STEIF_ODE || s->system.krylov ||
      !space->serial || s->problem->dae_index > 1)
    return STEIF_OK;
  spread(s, Ep, probe);
  STEIF_TRY(steif_pencil_product(s->system.pencil, 'E', probe, Ep));
  const sunrealtype *rows = STF_ARRAY(Ep);
  sunrealtype *r = STF_ARRAY(residual);
  for (sunindextype i = 0; i < space->n; i++)
    if (rows[i] == 0) r[i] = 0;
  return STEIF_OK;
}
