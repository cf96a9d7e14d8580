/* exponent_laws.c: what the laws share.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "laws.h"
#include <sunmatrix/sunmatrix_dense.h>

const char *const law_methods[] = {
  "be",
  "bdf:p=2",
  "bdf:p=4",
  "dirk:alexander2",
  "dirk:alexander3",
  "dirk:hw43",
  "dirk:trbdf2",
  "dirk:crouzeix23",
  "dirk:cranknicolson",
  "dirk:esdirk43",
  "gauss:s=1",
  "gauss:s=2",
  "gauss:s=3",
  "radau:s=2",
  "radau:s=3",
  "radau:s=5",
  "radau1a:s=2",
  "lobatto3c:s=3",
  "gauss:s=12",
  "exp-euler",
  "etd2",
  "krogstad",
  "hochost4",
  "exprb32",
  "exprb43",
  "glm:am,p=3",
  "glm:bdf,p=3",
  "glm:dimsim2",
  "glm:nord22",
  "glm:nordsieck,of=bdf,p=3",
  "glm:irks,p=4",
  "glm:dimsim1",
  "glm:ab,p=3",
  "euler",
  "rk4",
};
const int law_method_count = sizeof law_methods / sizeof *law_methods;
const int law_implicit_count = sizeof law_methods / sizeof *law_methods - 4;

static int f(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  const sunrealtype *u = N_VGetArrayPointer(y);
  sunrealtype *v = N_VGetArrayPointer(r);
  (void)user;
  v[0] = -21.3 * u[0] + u[1] * u[1] + sin(t);
  v[1] = -0.83 * u[1] + 0.31 * u[0] * u[1];
  return 0;
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
               N_Vector b, N_Vector c)
{
  const sunrealtype *u = N_VGetArrayPointer(y);
  (void)t, (void)fy, (void)user, (void)a, (void)b, (void)c;
  SM_ELEMENT_D(J, 0, 0) = -21.3, SM_ELEMENT_D(J, 0, 1) = 2 * u[1];
  SM_ELEMENT_D(J, 1, 0) = 0.31 * u[1], SM_ELEMENT_D(J, 1, 1) = -0.83 + 0.31 * u[0];
  return 0;
}

static const sunrealtype y0[] = {0.37, 1.18};

const steif_problem law_problem = {
  .name = "law",
  .n = 2,
  .t1 = 1.7,
  .y0 = y0,
  .f = f,
  .jac = jac,
};

N_Vector law_run(steif_context *ctx, const steif_problem *problem, const char *method,
                 const steif_options *options)
{
  steif_solver *s = steif_solver_new(ctx, problem, method, options);
  N_Vector out = NULL;
  if (s && steif_solve_to(s, options->t1 > 0 ? options->t1 : problem->t1) == STEIF_OK) {
    out = N_VClone(steif_solution(s));
    N_VScale(1, steif_solution(s), out);
  }
  steif_solver_free(&s);
  return out;
}

int law_exponential(const steif_method_info *info)
{
  return !strcmp(info->family, "etd") || !strcmp(info->family, "exprb");
}

double law_distance(N_Vector a, N_Vector b)
{
  const sunrealtype *x = N_VGetArrayPointer(a), *y = N_VGetArrayPointer(b);
  double size = 0, most = 0;
  for (sunindextype i = 0; i < N_VGetLength(a); i++) {
    size = fmax(size, fabs(x[i]));
    most = fmax(most, fabs(x[i] - y[i]));
  }
  return most / size;
}
