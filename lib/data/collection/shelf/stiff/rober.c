/* rober.c: Robertson's autocatalytic reaction, as an ODE or with the conservation law
 * y1 + y2 + y3 = 1 in place of the third equation (M = diag(1, 1, 0), index 1).
 *
 *   y1' = -k1 y1 + k2 y2 y3
 *   y2' = k1 y1 - k2 y2 y3 - k3 y2^2
 *   y3' = k3 y2^2                          rober:form=mass: 0 = y1 + y2 + y3 - 1
 *
 * with parameters k1 = 0.04, k2 = 1e4, k3 = 3e7.
 *
 * H. H. Robertson, in J. Walsh (ed.), Numerical Analysis, an Introduction (1966) 178-182.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "published.h"
#include <steif/parameters.h>
#include <string.h>

static const sunrealtype rates[] = {0.04, 1e4, 3e7};
static const char *const names[] = {"k1", "k2", "k3"};

struct reaction {
  sunrealtype k[3];
  steif_parameters parameters;
};

static const sunrealtype *rates_of(const void *user)
{
  return user ? ((const struct reaction *)user)->k : rates;
}

static int f(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const sunrealtype *u = NV_DATA_S(y);
  const sunrealtype *k = rates_of(user);
  const sunrealtype slow = k[0] * u[0], back = k[1] * u[1] * u[2], fast = k[2] * u[1] * u[1];
  sunrealtype *d = NV_DATA_S(ydot);
  (void)t;
  d[0] = back - slow;
  d[1] = slow - back - fast;
  d[2] = fast;
  return 0;
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector tmp1,
               N_Vector tmp2, N_Vector tmp3)
{
  const sunrealtype *u = NV_DATA_S(y);
  const sunrealtype *k = rates_of(user);
  (void)t, (void)fy, (void)tmp1, (void)tmp2, (void)tmp3;
  SM_ELEMENT_D(J, 0, 0) = -k[0];
  SM_ELEMENT_D(J, 1, 0) = k[0];
  SM_ELEMENT_D(J, 2, 0) = 0;
  SM_ELEMENT_D(J, 0, 1) = k[1] * u[2];
  SM_ELEMENT_D(J, 1, 1) = -k[1] * u[2] - 2 * k[2] * u[1];
  SM_ELEMENT_D(J, 2, 1) = 2 * k[2] * u[1];
  SM_ELEMENT_D(J, 0, 2) = k[1] * u[1];
  SM_ELEMENT_D(J, 1, 2) = -k[1] * u[1];
  SM_ELEMENT_D(J, 2, 2) = 0;
  return 0;
}

/* -df/dk. */
static int slope(sunrealtype t, N_Vector y, N_Vector yp, int k, N_Vector out, void *user)
{
  const sunrealtype *u = NV_DATA_S(y);
  const sunrealtype slow = u[0], back = u[1] * u[2], fast = u[1] * u[1];
  sunrealtype *d = NV_DATA_S(out);
  (void)t, (void)yp, (void)user;
  d[0] = k == 0 ? slow : k == 1 ? -back : 0;
  d[1] = k == 0 ? -slow : k == 1 ? back : fast;
  d[2] = k == 2 ? -fast : 0;
  return 0;
}

static int slope_mass(sunrealtype t, N_Vector y, N_Vector yp, int k, N_Vector out, void *user)
{
  const int code = slope(t, y, yp, k, out, user);
  NV_Ith_S(out, 2) = 0;
  return code;
}

static int sum(sunrealtype t, N_Vector y, sunrealtype *value, void *user)
{
  const sunrealtype *u = NV_DATA_S(y);
  (void)t, (void)user;
  *value = u[0] + u[1] + u[2];
  return 0;
}

static int f_mass(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const sunrealtype *u = NV_DATA_S(y);
  const int code = f(t, y, ydot, user);
  NV_Ith_S(ydot, 2) = u[0] + u[1] + u[2] - 1;
  return code;
}

static int jac_mass(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user,
                    N_Vector tmp1, N_Vector tmp2, N_Vector tmp3)
{
  const int code = jac(t, y, fy, J, user, tmp1, tmp2, tmp3);
  for (sunindextype j = 0; j < 3; j++) SM_ELEMENT_D(J, 2, j) = 1;
  return code;
}

static int mass(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  SM_ELEMENT_D(E, 0, 0) = SM_ELEMENT_D(E, 1, 1) = 1;
  return 0;
}

static const sunrealtype y0[] = {1, 0, 0}, yp0[] = {-0.04, 0.04, 0};
static const int index_mass[] = {1, 1, 1};

static int open_parameters(steif_context *ctx, steif_problem *self)
{
  struct reaction *r = stf_collection_allocate(ctx, self, sizeof *r, 0);
  if (!r) return STEIF_NO_MEMORY;
  memcpy(r->k, rates, sizeof rates);
  r->parameters = (steif_parameters){
    .count = 3, .value = r->k, .name = names, .dFdp = self->E ? slope_mass : slope};
  self->parameters = &r->parameters;
  return STEIF_OK;
}

static void take_mass_form(steif_problem *self)
{
  self->f = f_mass;
  self->jac = jac_mass;
  self->E = mass;
  self->yp0 = yp0;
  self->index = index_mass;
  self->dae_index = 1;
}

/* rober:form=ode or rober:form=mass */
static int build(steif_context *ctx, const steif_spec *spec, steif_problem *self)
{
  static const char *const keys[] = {"form", NULL};
  const char *form = stf_spec_word(spec, "form");
  STEIF_TRY(stf_spec_only(ctx, spec, keys));
  const bool ode = !form || strcmp(form, "ode") == 0;
  STEIF_CHECK(ode || strcmp(form, "mass") == 0, ctx, STEIF_BAD_INPUT,
              "rober has form=ode or form=mass, not form=%s", form);
  if (!ode) take_mass_form(self);
  return open_parameters(ctx, self);
}

static const sunrealtype end[] = {2.083340149701255e-08, 8.3333607703347131e-14,
                                  0.99999997916650496};
static const steif_reference reference = {
  .t = 1e11, .value = end, .digits = 12, .source = IVP_TEST_SET "rober"};

const steif_problem steif_problem_rober = {
  .name = "rober",
  .about = "Autocatalytic reaction of three species over eleven decades of time. "
           "H. H. Robertson (1966); IVP Test Set II-10; " HAIRER_WANNER " IV.10.",
  .n = 3,
  .t1 = 1e11,
  .y0 = y0,
  .f = f,
  .jac = jac,
  .autonomous = 1,
  .reference = &reference,
  .invariants = 1,
  .invariant = sum,
  .rtol_scale = 1e-6,
  .build = build,
  .destroy = stf_collection_release,
};
