/* heat.c: u_t = u_xx on (0, 1), u = 0 at both ends, by second differences on n inner points.
 *
 * The grid functions sin(k pi x_i), x_i = i h, h = 1/(n+1), are eigenvectors with eigenvalue
 * -4/h^2 sin^2(k pi h/2): from sin(pi x) + sin(3 pi x)/2 the system has a closed solution.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "collection.h"
#include <math.h>
#include <nvector/nvector_serial.h>

#define PI 3.14159265358979323846

typedef struct rod {
  sunindextype n;
  sunrealtype scale;   /* 1/h^2 */
  sunrealtype start[]; /* n */
} rod;

static int f(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const rod *r = user;
  const sunrealtype *u = N_VGetArrayPointer(y);
  sunrealtype *du = N_VGetArrayPointer(ydot);
  (void)t;
  for (sunindextype i = 0; i < r->n; i++) {
    const sunrealtype left = i > 0 ? u[i - 1] : 0, right = i < r->n - 1 ? u[i + 1] : 0;
    du[i] = r->scale * (left - 2 * u[i] + right);
  }
  return 0;
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
               N_Vector b, N_Vector c)
{
  const rod *r = user;
  const sunrealtype value[] = {r->scale, -2 * r->scale, r->scale};
  (void)t, (void)y, (void)fy, (void)a, (void)b, (void)c;
  return stf_collection_toeplitz(J, -1, 1, value);
}

static void superpose(const rod *r, sunrealtype t, sunrealtype *u)
{
  const sunrealtype h = 1 / ((sunrealtype)r->n + 1);
  const sunrealtype s1 = sin(0.5 * PI * h), s3 = sin(1.5 * PI * h);
  const sunrealtype first = exp(-4 * r->scale * s1 * s1 * t);
  const sunrealtype third = 0.5 * exp(-4 * r->scale * s3 * s3 * t);
  for (sunindextype i = 0; i < r->n; i++) {
    const sunrealtype x = (sunrealtype)(i + 1) * h;
    u[i] = first * sin(PI * x) + third * sin(3 * PI * x);
  }
}

static int exact(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  superpose(user, t, N_VGetArrayPointer(y));
  return yp ? f(t, y, yp, user) : 0;
}

static int build(steif_context *ctx, const steif_spec *spec, steif_problem *self)
{
  int n;
  STEIF_TRY(stf_spec_only(ctx, spec, (const char *const[]){"n", "storage", NULL}));
  STEIF_TRY(stf_spec_int(ctx, spec, "n", 1, 10000000, 400, &n));
  STEIF_TRY(stf_collection_storage(ctx, spec, self));
  rod *r = stf_collection_allocate(ctx, self, sizeof *r, (size_t)n);
  if (!r) return STEIF_NO_MEMORY;
  r->n = self->n = n;
  r->scale = ((sunrealtype)n + 1) * ((sunrealtype)n + 1);
  superpose(r, 0, r->start);
  self->y0 = r->start;
  self->lower = self->upper = n > 1;
  self->nnz = stf_collection_count(n, -1, 1);
  return STEIF_OK;
}

const steif_problem steif_problem_heat = {
  .about =
    "heat equation u_t = u_xx by second differences on n=400 points (storage=band), smooth "
    "start, exact in time; Hundsdorfer and Verwer, Numerical Solution of Time-Dependent "
    "Advection-Diffusion-Reaction Equations, Springer 2003, ch. I.3",
  .t1 = 0.1,
  .f = f,
  .jac = jac,
  .storage = STEIF_BAND,
  .autonomous = 1,
  .linear = 1,
  .exact = exact,
  .build = build,
  .destroy = stf_collection_release,
};
