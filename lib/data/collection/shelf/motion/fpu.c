/* fpu.c: n equal masses between walls, joined by springs that are not quite linear, started
 * in the lowest mode, q_j = sin(pi j/(n + 1)):
 *   H = sum p_j^2/2 + sum V(q_{j+1} - q_j),   V(r) = r^2/2 + alpha r^3/3 + beta r^4/4.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "collection.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <sunmatrix/sunmatrix_sparse.h>

#define PI 3.14159265358979323846

typedef struct lattice {
  sunindextype n;
  sunrealtype alpha, beta;
  sunrealtype start[];
} lattice;

static sunrealtype pull(const lattice *L, sunrealtype r)
{
  return r * (1 + r * (L->alpha + r * L->beta));
}

static int kick(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const lattice *L = user;
  const sunindextype n = L->n;
  const sunrealtype *q = N_VGetArrayPointer(y);
  sunrealtype *force = N_VGetArrayPointer(ydot) + n;
  (void)t;
  force[0] = pull(L, n > 1 ? q[1] - q[0] : -q[0]) - pull(L, q[0]);
  for (sunindextype j = 1; j < n - 1; j++)
    force[j] = pull(L, q[j + 1] - q[j]) - pull(L, q[j] - q[j - 1]);
  if (n > 1) force[n - 1] = pull(L, -q[n - 1]) - pull(L, q[n - 1] - q[n - 2]);
  return 0;
}

static int f(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const lattice *L = user;
  const sunrealtype *x = N_VGetArrayPointer(y);
  sunrealtype *dx = N_VGetArrayPointer(ydot);
  for (sunindextype j = 0; j < L->n; j++) dx[j] = x[L->n + j];
  return kick(t, y, ydot, user);
}

/* V'' of the spring to the left of mass j; n: of the one at the right wall. */
static sunrealtype stiffness(const lattice *L, const sunrealtype *q, sunindextype j)
{
  const sunrealtype r = (j < L->n ? q[j] : 0) - (j > 0 ? q[j - 1] : 0);
  return 1 + r * (2 * L->alpha + r * 3 * L->beta);
}

static void put(SUNMatrix J, sunindextype *at, sunindextype row, sunrealtype value)
{
  SM_INDEXVALS_S(J)[*at] = row;
  SM_DATA_S(J)[(*at)++] = value;
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
               N_Vector b, N_Vector c)
{
  const lattice *L = user;
  const sunindextype n = L->n;
  const sunrealtype *q = N_VGetArrayPointer(y);
  sunindextype at = 0;
  (void)t, (void)fy, (void)a, (void)b, (void)c;
  if (SUNMatGetID(J) != SUNMATRIX_SPARSE) return -1;
  for (sunindextype j = 0; j < n; j++) {
    const sunrealtype left = stiffness(L, q, j), right = stiffness(L, q, j + 1);
    SM_INDEXPTRS_S(J)[j] = at;
    if (j > 0) put(J, &at, n + j - 1, left);
    put(J, &at, n + j, -left - right);
    if (j < n - 1) put(J, &at, n + j + 1, right);
  }
  for (sunindextype j = 0; j < n; j++) {
    SM_INDEXPTRS_S(J)[n + j] = at;
    put(J, &at, j, 1);
  }
  SM_INDEXPTRS_S(J)[2 * n] = at;
  return 0;
}

static int energy(sunrealtype t, N_Vector y, sunrealtype *value, void *user)
{
  const lattice *L = user;
  const sunrealtype *q = N_VGetArrayPointer(y), *p = q + L->n;
  sunrealtype sum = 0, last = 0;
  (void)t;
  for (sunindextype j = 0; j <= L->n; j++) {
    const sunrealtype here = j < L->n ? q[j] : 0, r = here - last;
    sum += r * r * (0.5 + r * (L->alpha / 3 + r * L->beta / 4));
    if (j < L->n) sum += 0.5 * p[j] * p[j];
    last = here;
  }
  *value = sum;
  return 0;
}

static int build(steif_context *ctx, const steif_spec *spec, steif_problem *self)
{
  int n;
  sunrealtype alpha, beta;
  STEIF_TRY(stf_spec_only(ctx, spec, (const char *const[]){"n", "alpha", "beta", NULL}));
  STEIF_TRY(stf_spec_int(ctx, spec, "n", 1, 100000000, 32, &n));
  STEIF_TRY(stf_spec_real(ctx, spec, "alpha", -10, 10, 0.25, &alpha));
  STEIF_TRY(stf_spec_real(ctx, spec, "beta", 0, 10, 0, &beta));
  lattice *L = stf_collection_allocate(ctx, self, sizeof *L, 2 * (size_t)n);
  if (!L) return STEIF_NO_MEMORY;
  L->n = n;
  L->alpha = alpha;
  L->beta = beta;
  for (int j = 0; j < n; j++) L->start[j] = sin(PI * (j + 1) / (n + 1));
  self->n = 2 * (sunindextype)n;
  self->y0 = L->start;
  self->positions = n;
  self->nnz = 4 * (sunindextype)n - 2;
  return STEIF_OK;
}

const steif_problem steif_problem_fpu = {
  .about =
    "n=32 masses joined by springs with alpha=0.25, beta=0, in the lowest mode; E. Fermi, "
    "J. Pasta and S. Ulam, Los Alamos report LA-1940 (1955)",
  .t1 = 100,
  .f = f,
  .jac = jac,
  .storage = STEIF_SPARSE,
  .autonomous = 1,
  .invariants = 1,
  .invariant = energy,
  .kick = kick,
  .unit_mass = 1,
  .build = build,
  .destroy = stf_collection_release,
};
