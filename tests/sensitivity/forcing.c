/* forcing.c: a linear problem with parameters, and runs of any.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "forcing.h"
#include <string.h>

static int f(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const sunrealtype *p = user;
  NV_Ith_S(ydot, 0) = -p[0] * NV_Ith_S(y, 0) + p[1] * sin(10 * t);
  return 0;
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
               N_Vector b, N_Vector c)
{
  const sunrealtype *p = user;
  (void)t, (void)y, (void)fy, (void)a, (void)b, (void)c;
  const sunrealtype d = -p[0];
  return steif_fill_diagonal(J, &d);
}

static int slope(sunrealtype t, N_Vector y, N_Vector yp, int k, N_Vector out, void *user)
{
  (void)yp, (void)user;
  NV_Ith_S(out, 0) = k == 0 ? NV_Ith_S(y, 0) : k == 1 ? -sin(10 * t) : 0;
  return 0;
}

static int start(int k, N_Vector S0, void *user)
{
  (void)user;
  NV_Ith_S(S0, 0) = k == 2;
  return 0;
}

void forcing_open(struct forcing *F, int differences)
{
  memset(F, 0, sizeof *F);
  F->p[0] = 1;
  F->parameters = (steif_parameters){
    .count = 3, .value = F->p, .dFdp = differences ? NULL : slope, .start = start};
  F->problem = (steif_problem){.name = "forcing",
                               .n = 1,
                               .t1 = 20,
                               .y0 = F->y0,
                               .f = f,
                               .jac = jac,
                               .linear = 1,
                               .user = F->p,
                               .parameters = &F->parameters};
}

void sensitivity_at(steif_context *ctx, const steif_problem *p, const char *method,
                    const steif_options *o, int k, sunrealtype t, sunrealtype *S,
                    steif_sensitivity_cost *cost)
{
  steif_solver *s = steif_solver_new(ctx, p, method, o);
  N_Vector d = N_VNew_Serial(p->n, steif_sundials(ctx));
  const int code = s ? steif_solve_to(s, t) : steif_status(ctx);
  if (code) printf("\n  %s: %s", method, steif_message(ctx));
  CU_ASSERT_FATAL(!code);
  CHECK(!steif_sensitivity(s, t, k, d));
  memcpy(S, NV_DATA_S(d), (size_t)p->n * sizeof *S);
  if (cost) CHECK(!steif_sensitivity_costs(s, cost));
  N_VDestroy(d);
  steif_solver_free(&s);
}

int constrained_f(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const sunrealtype *p = user, *u = NV_DATA_S(y);
  (void)t;
  NV_Ith_S(ydot, 0) = -u[1];
  NV_Ith_S(ydot, 1) = u[1] - p[0] * u[0];
  return 0;
}

int constrained_mass(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  static const sunrealtype d[] = {1, 0};
  (void)t, (void)y, (void)yp, (void)user;
  return steif_fill_diagonal(E, d);
}
