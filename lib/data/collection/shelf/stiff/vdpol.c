/* vdpol.c: van der Pol's relaxation oscillator,
 *
 *   scaled    y1' = y2, y2' = ((1 - y1^2) y2 - y1)/eps    vdpol, vdpol:eps=1e-3
 *   unscaled  q' = p,   p'  = mu (1 - q^2) p - q          vdpol:mu=10
 *
 * with the parameter eps = 1e-6 or mu.
 *
 * B. van der Pol, Phil. Mag. 2 (1926) 978-992. Time of the unscaled form is mu times that of
 * the scaled one with eps = 1/mu^2.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "published.h"
#include <steif/parameters.h>

/* y2' = damping (1 - y1^2) y2 - spring y1 */
struct oscillator {
  sunrealtype damping, spring;
  int unscaled;
  sunrealtype p[1];
  steif_parameters parameters;
};
static const struct oscillator stiff = {1 / 1e-6, 1 / 1e-6, 0, {1e-6}, {0}};
static const char *const eps_name[] = {"eps"}, *const mu_name[] = {"mu"};

static int f(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const struct oscillator *o = user ? (const struct oscillator *)user : &stiff;
  const sunrealtype *u = NV_DATA_S(y);
  (void)t;
  NV_Ith_S(ydot, 0) = u[1];
  NV_Ith_S(ydot, 1) = o->damping * (1 - u[0] * u[0]) * u[1] - o->spring * u[0];
  return 0;
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector tmp1,
               N_Vector tmp2, N_Vector tmp3)
{
  const struct oscillator *o = user ? (const struct oscillator *)user : &stiff;
  const sunrealtype *u = NV_DATA_S(y);
  (void)t, (void)fy, (void)tmp1, (void)tmp2, (void)tmp3;
  SM_ELEMENT_D(J, 0, 0) = 0;
  SM_ELEMENT_D(J, 1, 0) = -2 * o->damping * u[0] * u[1] - o->spring;
  SM_ELEMENT_D(J, 0, 1) = 1;
  SM_ELEMENT_D(J, 1, 1) = o->damping * (1 - u[0] * u[0]);
  return 0;
}

/* -df/dp. */
static int slope(sunrealtype t, N_Vector y, N_Vector yp, int k, N_Vector out, void *user)
{
  const struct oscillator *o = user;
  const sunrealtype *u = NV_DATA_S(y), damped = (1 - u[0] * u[0]) * u[1];
  (void)t, (void)yp, (void)k;
  NV_Ith_S(out, 0) = 0;
  NV_Ith_S(out, 1) = o->unscaled ? -damped : (damped - u[0]) / (o->p[0] * o->p[0]);
  return 0;
}

static int follow(void *user)
{
  struct oscillator *o = user;
  o->damping = o->unscaled ? o->p[0] : 1 / o->p[0];
  o->spring = o->unscaled ? 1 : 1 / o->p[0];
  return 0;
}

static const sunrealtype y0[] = {2, 0};
/* The test set also gives y2 in the time of the unscaled form, 1000 times smaller. */
static const sunrealtype end[] = {1.7061677321704689, -0.89280970102481247};
static const steif_reference reference = {
  .t = 2, .value = end, .digits = 13, .source = IVP_TEST_SET "vdpol"};

/* Two integrations by codes of different families agree to these digits. */
static const sunrealtype end10[] = {-1.837906517857, 0.077044081421};
static const sunrealtype end30[] = {-0.866930590440, 1.062084027105};
static const steif_reference reference10 = {
  .t = 50, .value = end10, .digits = 11, .source = "two codes, agreeing to 12 digits"};
static const steif_reference reference30 = {
  .t = 50, .value = end30, .digits = 12, .source = "two codes, agreeing to 12 digits"};

static int build(steif_context *ctx, const steif_spec *spec, steif_problem *self)
{
  static const char *const keys[] = {"eps", "mu", NULL};
  const int unscaled = stf_spec_word(spec, "mu") != NULL;
  sunrealtype eps = 0, mu = 0;
  STEIF_TRY(stf_spec_only(ctx, spec, keys));
  STEIF_CHECK(!unscaled || !stf_spec_word(spec, "eps"), ctx, STEIF_BAD_INPUT,
              "vdpol takes eps (scaled form) or mu (unscaled form), not both");
  STEIF_TRY(stf_spec_real(ctx, spec, "eps", 1e-12, 1e12, 1e-6, &eps));
  STEIF_TRY(stf_spec_real(ctx, spec, "mu", 0, 1e6, 1, &mu));
  struct oscillator *o = stf_collection_allocate(ctx, self, sizeof *o, 0);
  if (!o) return STEIF_NO_MEMORY;
  o->unscaled = unscaled, o->p[0] = unscaled ? mu : eps;
  follow(o);
  o->parameters = (steif_parameters){.count = 1,
                                     .value = o->p,
                                     .name = unscaled ? mu_name : eps_name,
                                     .dFdp = slope,
                                     .moved = follow};
  self->parameters = &o->parameters;
  if (!unscaled && eps == 1e-6) return STEIF_OK;
  self->t1 = unscaled ? 50 : 2;
  self->reference = !unscaled ? NULL : mu == 10 ? &reference10 : mu == 30 ? &reference30 : NULL;
  return STEIF_OK;
}

const steif_problem steif_problem_vdpol = {
  .name = "vdpol",
  .about = "Relaxation oscillator, eps = 1e-6; eps=... or mu=... (unscaled) for others. "
           "B. van der Pol (1926); IVP Test Set II-6; " HAIRER_WANNER " IV.10.",
  .n = 2,
  .t1 = 2,
  .y0 = y0,
  .f = f,
  .jac = jac,
  .autonomous = 1,
  .reference = &reference,
  .build = build,
  .destroy = stf_collection_release,
};
