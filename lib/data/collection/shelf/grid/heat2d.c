/* heat2d.c: u_t = u_xx + u_yy on the unit square, u = 0 on the boundary, by the five-point star on
 * n x n inner points, numbered by rows; sparse.
 *
 * Products sin(k pi x) sin(l pi y) are eigenvectors of the discrete Laplacian, so the start
 * sin(pi x) sin(pi y) + sin(3 pi x) sin(2 pi y)/2 has a closed solution.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "collection.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <sunmatrix/sunmatrix_sparse.h>

#define PI 3.14159265358979323846

typedef struct plate {
  sunindextype n;
  sunrealtype scale;   /* 1/h^2 */
  sunrealtype start[]; /* n^2 */
} plate;

static int f(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const plate *p = user;
  const sunindextype n = p->n;
  const sunrealtype *u = N_VGetArrayPointer(y);
  sunrealtype *du = N_VGetArrayPointer(ydot);
  (void)t;
  for (sunindextype j = 0; j < n; j++)
    for (sunindextype i = 0; i < n; i++) {
      const sunindextype k = j * n + i;
      sunrealtype sum = -4 * u[k];
      if (i > 0) sum += u[k - 1];
      if (i < n - 1) sum += u[k + 1];
      if (j > 0) sum += u[k - n];
      if (j < n - 1) sum += u[k + n];
      du[k] = p->scale * sum;
    }
  return 0;
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
               N_Vector b, N_Vector c)
{
  if (SUNMatGetID(J) != SUNMATRIX_SPARSE) return -1;
  const plate *p = user;
  const sunindextype n = p->n, step[] = {-n, -1, 0, 1, n};
  sunindextype *column = SUNSparseMatrix_IndexPointers(J),
               *row = SUNSparseMatrix_IndexValues(J);
  sunrealtype *value = SUNSparseMatrix_Data(J);
  sunindextype used = 0;
  (void)t, (void)y, (void)fy, (void)a, (void)b, (void)c;
  for (sunindextype k = 0; k < n * n; k++) {
    const bool inside[] = {k >= n, k % n > 0, true, k % n < n - 1, k < n * n - n};
    column[k] = used;
    for (int m = 0; m < 5; m++)
      if (inside[m]) {
        row[used] = k + step[m];
        value[used++] = (m == 2 ? -4 : 1) * p->scale;
      }
  }
  column[n * n] = used;
  return 0;
}

static sunrealtype eigenvalue(const plate *p, int k)
{
  const sunrealtype s = sin(0.5 * k * PI / ((sunrealtype)p->n + 1));
  return -4 * p->scale * s * s;
}

static void superpose(const plate *p, sunrealtype t, sunrealtype *u)
{
  const sunrealtype h = 1 / ((sunrealtype)p->n + 1);
  const sunrealtype first = exp(2 * eigenvalue(p, 1) * t);
  const sunrealtype second = 0.5 * exp((eigenvalue(p, 3) + eigenvalue(p, 2)) * t);
  for (sunindextype j = 0; j < p->n; j++)
    for (sunindextype i = 0; i < p->n; i++) {
      const sunrealtype x = (sunrealtype)(i + 1) * h, y = (sunrealtype)(j + 1) * h;
      u[j * p->n + i] =
        first * sin(PI * x) * sin(PI * y) + second * sin(3 * PI * x) * sin(2 * PI * y);
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
  STEIF_TRY(stf_spec_only(ctx, spec, (const char *const[]){"n", NULL}));
  STEIF_TRY(stf_spec_int(ctx, spec, "n", 2, 3000, 32, &n));
  self->n = (sunindextype)n * n;
  plate *p = stf_collection_allocate(ctx, self, sizeof *p, (size_t)self->n);
  if (!p) return STEIF_NO_MEMORY;
  p->n = n;
  p->scale = ((sunrealtype)n + 1) * ((sunrealtype)n + 1);
  superpose(p, 0, p->start);
  self->y0 = p->start;
  self->nnz = 5 * self->n - 4 * n;
  return STEIF_OK;
}

const steif_problem steif_problem_heat2d = {
  .about =
    "heat equation on the unit square by the five-point star on n=32 by n points, smooth "
    "start, exact in time; Hundsdorfer and Verwer, Numerical Solution of Time-Dependent "
    "Advection-Diffusion-Reaction Equations, Springer 2003",
  .t1 = 0.05,
  .f = f,
  .jac = jac,
  .storage = STEIF_SPARSE,
  .autonomous = 1,
  .linear = 1,
  .exact = exact,
  .build = build,
  .destroy = stf_collection_release,
};
