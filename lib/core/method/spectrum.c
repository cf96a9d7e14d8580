/* spectrum.c: how fast is the fastest part of y' = f(t, y), and does it oscillate?
 * SPDX-License-Identifier: BSD-3-Clause */
#include "method.h"
#include <math.h>

/* out = J (J x). */
static int twice(stf_step *s, N_Vector x, N_Vector between, N_Vector out)
{
  STEIF_TRY(steif_pencil_product(s->system.pencil, 'A', x, between));
  return steif_pencil_product(s->system.pencil, 'A', between, out);
}

static bool usable(sunrealtype norm, sunrealtype *size)
{
  *size = isfinite(norm) ? norm : INFINITY;
  return norm > 0 && isfinite(norm);
}

/* Rounds of v := J^2 v / ||J^2 v||: *size = ||J^2 v|| for ||v|| = 1 in the last, 0 or infinity where
 * a norm was that, and the cosine between v and J^2 v there. */
static int iterate(stf_step *s, N_Vector v, N_Vector w, N_Vector work, sunrealtype *size,
                   sunrealtype *cosine)
{
  enum { ROUNDS = 6 };
  const stf_space *space = &s->system.space;
  sunrealtype norm = stf_norm(space, v, s->weights);
  *cosine = 0;
  for (int k = 0; k < ROUNDS; k++) {
    if (!usable(norm, size)) return STEIF_OK;
    stf_scale(space, 1 / norm, v, v);
    STEIF_TRY(twice(s, v, work, w));
    norm = stf_norm(space, w, s->weights);
    if (k + 1 < ROUNDS) stf_copy(space, w, v);
  }
  if (!usable(norm, size)) return STEIF_OK;
  stf_sum(space, 1, v, 1 / norm, w, work);
  const sunrealtype sum = stf_norm(space, work, s->weights); /* both have norm 1 */
  *cosine = sum * sum / 2 - 1;
  return STEIF_OK;
}

/* The same; callbacks that fail on some ranks make the others wait for the end only. */
static int iterate_together(stf_step *s, N_Vector v, N_Vector w, N_Vector work,
                            sunrealtype *size, sunrealtype *cosine)
{
  stf_operator_hold(&s->system);
  const int code = iterate(s, v, w, work, size, cosine);
  const int others = stf_operator_release(&s->system);
  return code ? code : others;
}

int stf_oscillation(stf_step *s, N_Vector v, N_Vector w, N_Vector work, sunrealtype *omega)
{
  sunrealtype size, cosine;
  *omega = 0;
  if (s->system.form != STEIF_ODE) return STEIF_OK;
  STEIF_TRY(iterate_together(s, v, w, work, &size, &cosine));
  if (cosine <= -0.5) *omega = sqrt(size);
  return STEIF_OK;
}

int stf_spectral_radius(stf_step *s, N_Vector v, N_Vector w, N_Vector work, sunrealtype *radius,
                        bool *real)
{
  sunrealtype size, cosine;
  STEIF_TRY(iterate_together(s, v, w, work, &size, &cosine));
  *radius = sqrt(size);
  *real = cosine > 0.5;
  return STEIF_OK;
}
