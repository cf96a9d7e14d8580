/* spectrum.c: does the fastest part of y' = f(t, y) oscillate?
 * SPDX-License-Identifier: BSD-3-Clause */
#include "method.h"
#include <math.h>

/* out = J (J x). */
static int twice(stf_step *s, N_Vector x, N_Vector between, N_Vector out)
{
  STEIF_TRY(steif_pencil_product(s->system.pencil, 'A', x, between));
  return steif_pencil_product(s->system.pencil, 'A', between, out);
}

int stf_oscillation(stf_step *s, N_Vector v, N_Vector w, N_Vector work, sunrealtype *omega)
{
  enum { ROUNDS = 6 };
  const stf_space *space = &s->system.space;
  sunrealtype size = stf_norm(space, v, s->weights), cosine = 0;
  *omega = 0;
  if (s->system.form != STEIF_ODE || !(size > 0)) return STEIF_OK;
  for (int k = 0; k < ROUNDS; k++) {
    stf_scale(space, 1 / size, v, v);
    STEIF_TRY(twice(s, v, work, w));
    size = stf_norm(space, w, s->weights);
    if (!(size > 0) || !isfinite(size)) return STEIF_OK;
    stf_scale(space, 1 / size, w, w);
    stf_sum(space, 1, v, 1, w, work);
    const sunrealtype sum = stf_norm(space, work, s->weights); /* both have norm 1 */
    cosine = sum * sum / 2 - 1;
    stf_copy(space, w, v);
    if (k + 1 < ROUNDS) *omega = sqrt(size), size = 1;
  }
  if (cosine > -0.5) *omega = 0;
  return STEIF_OK;
}
