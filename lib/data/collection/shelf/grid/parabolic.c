/* parabolic.c: u_t = u_xx + 1/(1 + u^2) + Phi(x, t) on (0, 1), u = 0 at both ends, with Phi such
 * that u = x (1 - x) e^t; second differences on n inner points, which are exact for this u.
 *
 * The order of exponential and implicit methods falls to their stiff order here.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "collection.h"
#include <math.h>
#include <nvector/nvector_serial.h>

typedef struct rod {
  sunindextype n;
  sunrealtype scale;     /* 1/h^2 */
  sunrealtype profile[]; /* n: x (1 - x) */
} rod;

static int f(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const rod *r = user;
  const sunrealtype *u = N_VGetArrayPointer(y), growth = exp(t);
  sunrealtype *du = N_VGetArrayPointer(ydot);
  for (sunindextype i = 0; i < r->n; i++) {
    const sunrealtype left = i > 0 ? u[i - 1] : 0, right = i < r->n - 1 ? u[i + 1] : 0;
    const sunrealtype exact = r->profile[i] * growth;
    du[i] = r->scale * (left - 2 * u[i] + right) + 1 / (1 + u[i] * u[i]) + exact + 2 * growth -
            1 / (1 + exact * exact);
  }
  return 0;
}

static int linear_part(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix L, void *user)
{
  const rod *r = user;
  const sunrealtype value[] = {r->scale, -2 * r->scale, r->scale};
  (void)t, (void)y, (void)yp;
  return stf_collection_toeplitz(L, -1, 1, value);
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
               N_Vector b, N_Vector c)
{
  const rod *r = user;
  const sunrealtype *u = N_VGetArrayPointer(y);
  (void)fy, (void)a, (void)b, (void)c;
  const int code = linear_part(t, y, NULL, J, user);
  for (sunindextype i = 0; code == 0 && i < r->n; i++) {
    const sunrealtype square = 1 + u[i] * u[i];
    *stf_collection_diagonal(J, i) -= 2 * u[i] / (square * square);
  }
  return code;
}

static int exact(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  const rod *r = user;
  sunrealtype *u = N_VGetArrayPointer(y);
  for (sunindextype i = 0; i < r->n; i++) u[i] = r->profile[i] * exp(t);
  if (yp) N_VScale(1, y, yp);
  return 0;
}

static int build(steif_context *ctx, const steif_spec *spec, steif_problem *self)
{
  int n;
  STEIF_TRY(stf_spec_only(ctx, spec, (const char *const[]){"n", "storage", NULL}));
  STEIF_TRY(stf_spec_int(ctx, spec, "n", 1, 10000000, 199, &n));
  STEIF_TRY(stf_collection_storage(ctx, spec, self));
  rod *r = stf_collection_allocate(ctx, self, sizeof *r, (size_t)n);
  if (!r) return STEIF_NO_MEMORY;
  const sunrealtype intervals = (sunrealtype)n + 1;
  r->n = self->n = n;
  r->scale = intervals * intervals;
  for (int i = 0; i < n; i++)
    r->profile[i] = (i + 1) / intervals * ((intervals - i - 1) / intervals);
  self->y0 = r->profile;
  self->lower = self->upper = n > 1;
  self->nnz = stf_collection_count(n, -1, 1);
  return STEIF_OK;
}

const steif_problem steif_problem_parabolic = {
  .about = "u_t = u_xx + 1/(1+u^2) + Phi, u = x(1-x) e^t, on n=199 points (storage=band): M. "
           "Hochbruck and A. Ostermann, SIAM J. Numer. Anal. 43 (2005), example 6.1",
  .t1 = 1,
  .f = f,
  .jac = jac,
  .L = linear_part,
  .storage = STEIF_BAND,
  .exact = exact,
  .build = build,
  .destroy = stf_collection_release,
};
