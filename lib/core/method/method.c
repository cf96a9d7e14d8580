/* method.c: what the families share.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "method.h"
#include <math.h>

const stf_control stf_control_usual = {.safety = 0.9, .shrink = 0.125, .grow = 5, .keep = 1.2};

int stf_propagate(steif_context *ctx, const steif_method *method, const steif_spec *spec,
                  const steif_table *table, const sunrealtype z[2], int *r, sunrealtype *M)
{
  STEIF_CHECK(method->propagator, ctx, STEIF_UNSUPPORTED,
              "the step of '%s' on y' = lambda y is not known as a function of h lambda",
              spec->name);
  return method->propagator(ctx, spec, table, z, r, M);
}

void stf_propagate_scalar(const sunrealtype R[2], int *r, sunrealtype *M)
{
  *r = 1;
  if (M) M[0] = R[0], M[1] = R[1];
}

void stf_swap(stf_step *s)
{
  N_Vector y = s->y;
  s->y = s->next, s->next = y;
}

/* By f(t), f(t + d) and f(t + 2 d). */
int stf_slope_in_time(stf_step *s, sunrealtype h, N_Vector f, N_Vector slope, N_Vector work)
{
  const sunrealtype d = fmax(1e-4 * h, 64 * STF_EPS * fabs(s->t));
  const sunrealtype c[] = {2 / d, -1.5 / d, -0.5 / d};
  N_Vector all[] = {slope, f, work};
  if (s->problem->autonomous) return STEIF_OK;
  STEIF_TRY(stf_system_rhs(&s->system, s->t + d, s->y, slope));
  STEIF_TRY(stf_system_rhs(&s->system, s->t + 2 * d, s->y, work));
  stf_combine(&s->system.space, 3, c, all, slope);
  return STEIF_OK;
}

int stf_hermite(stf_step *s, sunrealtype t, N_Vector before, N_Vector slope, N_Vector end,
                N_Vector y)
{
  if (!s->end_slope_known) STEIF_TRY(stf_system_rhs(&s->system, s->t, s->y, end));
  s->end_slope_known = true;
  const sunrealtype x = (t - (s->t - s->h)) / s->h, u = 1 - x;
  const sunrealtype c[] = {u * u * (1 + 2 * x), x * x * (1 + 2 * u), s->h * x * u * u,
                           -s->h * x * x * u};
  N_Vector v[] = {before, s->y, slope, end};
  stf_combine(&s->system.space, 4, c, v, y);
  return STEIF_OK;
}

static void zero_stages(const stf_step *s, const stf_stages *g)
{
  for (int j = 0; j < s->newton.transform.s; j++) stf_zero(&s->system.space, g->Z[j]);
}

int stf_solve_stages(stf_step *s, const stf_stages *g)
{
  stf_newton *newton = &s->newton;
  const bool renew = !newton->jacobian_new && stf_newton_stale(newton);
  STEIF_TRY(stf_newton_prepare(newton, s->t, g->h, s->y, s->yp, renew));
  int code = stf_newton_solve(newton, g);
  if (code <= 0) return code;
  zero_stages(s, g);
  STEIF_TRY(stf_newton_prepare(newton, s->t, g->h, s->y, s->yp, !newton->jacobian_new));
  code = stf_newton_solve(newton, g);
  if (code <= 0 || s->adaptive || s->system.linear) return code;
  zero_stages(s, g);
  return stf_newton_full(newton, g);
}

int stf_newton_carry_apply(stf_step *s, sunrealtype h, int count, N_Vector *const *r,
                           N_Vector *const *other)
{
  (void)h;
  return stf_newton_apply(&s->newton, count, r, other);
}

/* The Jacobian is that of another point than the one the next attempt may want. */
int stf_newton_carry_renew(stf_step *s, sunrealtype t, sunrealtype h, N_Vector Y, N_Vector Yp)
{
  STEIF_TRY(stf_newton_prepare(&s->newton, t, h, Y, Yp, true));
  s->newton.jacobian_new = false;
  return STEIF_OK;
}

void stf_interpolate(int k, const sunrealtype *node, sunrealtype x, sunrealtype *value)
{
  for (int j = 0; j <= k; j++) {
    value[j] = 1;
    for (int m = 0; m <= k; m++)
      if (m != j) value[j] *= (x - node[m]) / (node[j] - node[m]);
  }
}

void stf_differentiate(int k, const sunrealtype *node, sunrealtype *a)
{
  a[0] = 0;
  for (int j = 1; j <= k; j++) {
    sunrealtype product = 1 / (node[j] - node[0]);
    for (int m = 1; m <= k; m++)
      if (m != j) product *= (node[0] - node[m]) / (node[j] - node[m]);
    a[j] = product;
    a[0] += 1 / (node[0] - node[j]);
  }
}
