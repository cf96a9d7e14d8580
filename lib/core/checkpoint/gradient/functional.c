/* functional.c: what a gradient is asked of, and its slopes.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "backwards.h"
#include <math.h>

static void *user_of(const stf_backwards *B)
{
  return B->functional->user ? B->functional->user : B->problem->user;
}

static int values(stf_backwards *B, int at_end, sunrealtype t, N_Vector y, sunrealtype *out)
{
  const steif_values what = at_end ? B->functional->end : B->functional->integrand;
  const int code = what(t, y, out, user_of(B));
  STEIF_CHECK(!code, B->ctx, STEIF_CALLBACK,
              "a functional of problem '%s' returned %d at t = %.12g", B->problem->name, code,
              t);
  for (int i = 0; i < B->count; i++)
    STEIF_CHECK(isfinite(out[i]), B->ctx, STEIF_NOT_FINITE,
                "functional %d of problem '%s' is %g at t = %.12g", i + 1, B->problem->name,
                out[i], t);
  return STEIF_OK;
}

/* Central differences by *x, into column `at` of `to`, `step` apart by functionals. */
static int differ(stf_backwards *B, int at_end, sunrealtype t, N_Vector y, sunrealtype *x,
                  sunrealtype size)
{
  const sunrealtype here = *x, d = cbrt(STF_EPS) * size;
  volatile sunrealtype up = here + d, down = here - d;
  *x = up;
  int code = values(B, at_end, t, y, B->other);
  *x = down;
  if (!code) code = values(B, at_end, t, y, B->other + B->count);
  *x = here;
  for (int i = 0; !code && i < B->count; i++)
    B->other[i] = (B->other[i] - B->other[B->count + i]) / (up - down);
  return code;
}

static int by_differences(stf_backwards *B, int at_end, sunrealtype t, N_Vector y)
{
  const steif_parameters *q = B->problem->parameters;
  sunrealtype *v = STF_ARRAY(y), most = N_VMaxNorm(y);
  for (sunindextype j = 0; j < B->n; j++) {
    STEIF_TRY(differ(B, at_end, t, y, v + j, fmax(fabs(v[j]), most > 0 ? 1e-3 * most : 1)));
    for (int i = 0; i < B->count; i++) STF_ARRAY(B->gy[i])[j] = B->other[i];
  }
  for (int k = 0; k < B->P; k++) {
    const sunrealtype scale = q->scale ? q->scale[k] : fabs(q->value[k]);
    STEIF_TRY(differ(B, at_end, t, y, q->value + k, scale > 0 ? scale : 1));
    for (int i = 0; i < B->count; i++) B->gp[i * B->P + k] = B->other[i];
  }
  return STEIF_OK;
}

int stf_functional_at(stf_backwards *B, int at_end, sunrealtype t, N_Vector y)
{
  STEIF_TRY(values(B, at_end, t, y, B->g));
  if (!B->functional->slopes) return by_differences(B, at_end, t, y);
  for (int k = 0; k < B->count * B->P; k++) B->gp[k] = 0;
  for (int i = 0; i < B->count; i++) {
    stf_zero(&B->space, B->gy[i]);
    const int code = B->functional->slopes(t, y, i, at_end, B->gy[i],
                                           B->P ? B->gp + i * B->P : NULL, user_of(B));
    STEIF_CHECK(!code, B->ctx, STEIF_CALLBACK,
                "slopes of functional %d of problem '%s' returned %d at t = %.12g", i + 1,
                B->problem->name, code, t);
    for (int k = 0; k < B->P; k++)
      STEIF_CHECK(isfinite(B->gp[i * B->P + k]), B->ctx, STEIF_NOT_FINITE,
                  "the slope of functional %d of problem '%s' by parameter %d is %g at t = "
                  "%.12g",
                  i + 1, B->problem->name, k + 1, B->gp[i * B->P + k], t);
    STEIF_CHECK(stf_finite(&B->space, B->gy[i]), B->ctx, STEIF_NOT_FINITE,
                "the slope of functional %d of problem '%s' is not finite at t = %.12g", i + 1,
                B->problem->name, t);
  }
  return STEIF_OK;
}

int stf_functional_add(stf_backwards *B, sunrealtype c, sunrealtype t, N_Vector y,
                       sunrealtype *to)
{
  if (!B->functional->integrand) return STEIF_OK;
  STEIF_TRY(values(B, 0, t, y, B->g));
  for (int i = 0; i < B->count; i++) to[i] += c * B->g[i];
  return STEIF_OK;
}

int stf_functional_shifted(stf_backwards *B, const sunrealtype *c, sunrealtype t, N_Vector y,
                           sunrealtype *to)
{
  if (!B->shift) return STEIF_OK;
  stf_sum(&B->space, 1, y, 1, B->shift[0], B->shift[1]);
  const bool before = stf_silence(B->ctx, true);
  const int code = values(B, 0, t, B->shift[1], B->other);
  stf_silence(B->ctx, before);
  if (code) {
    steif_forget(B->ctx);
    B->shift = NULL;
    return STEIF_OK;
  }
  for (int i = 0; i < B->count; i++) to[i] += c[i] * B->other[i];
  return STEIF_OK;
}

/* By central differences of two lengths, extrapolated. */
int stf_functional_by_time(stf_backwards *B, sunrealtype t, N_Vector y)
{
  static const sunrealtype by[] = {1, -1, 2, -2}, weight[] = {8, -8, -1, 1};
  const sunrealtype d = (B->home->t1 - B->problem->t0) / 4096;
  for (int i = 0; i < B->count; i++) B->other[B->count + i] = 0;
  for (int j = 0; B->functional->end && j < 4; j++) {
    STEIF_TRY(values(B, 1, t + by[j] * d, y, B->other));
    for (int i = 0; i < B->count; i++)
      B->other[B->count + i] += weight[j] / (12 * d) * B->other[i];
  }
  for (int i = 0; i < B->count; i++) B->g[i] = B->other[B->count + i];
  return STEIF_OK;
}
