/* smooth.c: see smooth.h.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "smooth.h"
#include <sunmatrix/sunmatrix_dense.h>

static int f(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  (void)user;
  const double u = NV_Ith_S(y, 0), v = NV_Ith_S(y, 1), s = sin(t);
  NV_Ith_S(out, 0) = -2 * t * u * u, NV_Ith_S(out, 1) = cos(t) + s * s - v * v;
  return 0;
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
               N_Vector b, N_Vector c)
{
  (void)fy, (void)user, (void)a, (void)b, (void)c;
  SM_ELEMENT_D(J, 0, 0) = -4 * t * NV_Ith_S(y, 0), SM_ELEMENT_D(J, 0, 1) = 0;
  SM_ELEMENT_D(J, 1, 0) = 0, SM_ELEMENT_D(J, 1, 1) = -2 * NV_Ith_S(y, 1);
  return 0;
}

static int exact(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  (void)yp, (void)user;
  NV_Ith_S(y, 0) = 1 / (1 + t * t), NV_Ith_S(y, 1) = sin(t);
  return 0;
}

const steif_problem smooth = {.name = "smooth",
                              .n = 2,
                              .t0 = 0.25,
                              .t1 = 2,
                              .start = exact,
                              .f = f,
                              .jac = jac,
                              .exact = exact};

double smooth_error(double t, N_Vector y)
{
  return fmax(fabs(NV_Ith_S(y, 0) - 1 / (1 + t * t)), fabs(NV_Ith_S(y, 1) - sin(t)));
}

steif_solver *smooth_open(steif_context *ctx, const steif_problem *p, const char *method,
                          const steif_options *o)
{
  steif_solver *s = steif_solver_new(ctx, p, method, o);
  if (!s) printf("\n  %s %s: %s", p->name, method, steif_message(ctx));
  CU_ASSERT_FATAL(s != NULL);
  return s;
}

void smooth_refused(const steif_problem *p, const char *method, const steif_options *o,
                    int code, const char *words)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_solver *s = steif_solver_new(ctx, p, method, o);
  const int good = !s && steif_status(ctx) == code && strstr(steif_message(ctx), words);
  if (!good) printf("\n  code %d: %s", steif_status(ctx), steif_message(ctx));
  CHECK(good);
  steif_solver_free(&s);
  steif_context_free(&ctx);
}
