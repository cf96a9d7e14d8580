/* units.c: copies of a pencil for the sparse algorithms, scaled where that makes all entries near to
 * one size. These scale for each circle by the largest entries; where units are far apart, small
 * entries that carry the structure would vanish.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "units.h"
#include "scaling.h"
#include <math.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

static void destroy(void *M) { SUNMatDestroy(M); }

static int own(steif_context *ctx, stf_pool *pool, SUNMatrix M)
{
  STEIF_CHECK(M, ctx, STEIF_NO_MEMORY, "no memory for a sparse copy of a matrix");
  return stf_pool_adopt(pool, M, destroy);
}

/* M itself when sparse, else a sparse copy in the pool. */
static int sparse(steif_context *ctx, stf_pool *pool, SUNMatrix M, SUNMatrix *S)
{
  *S = M;
  if (SUNMatGetID(M) == SUNMATRIX_SPARSE) return STEIF_OK;
  *S = SUNSparseFromDenseMatrix(M, 0, CSC_MAT);
  return own(ctx, pool, *S);
}

static int scale(steif_context *ctx, stf_pool *pool, const int *exponent, SUNMatrix *M)
{
  SUNMatrix from = *M, S = SUNMatClone(from);
  const sunindextype n = SM_COLUMNS_S(from);
  STEIF_TRY(own(ctx, pool, S));
  STEIF_CHECK(!SUNMatCopy(from, S), ctx, STEIF_NO_MEMORY, "no memory for a copy of a matrix");
  for (sunindextype j = 0; j < n; j++)
    for (sunindextype k = SM_INDEXPTRS_S(S)[j]; k < SM_INDEXPTRS_S(S)[j + 1]; k++) SM_DATA_S(S)
  [k] = ldexp(SM_DATA_S(S)[k], exponent[SM_INDEXVALS_S(S)[k]] + exponent[n + j]);
  *M = S;
  return STEIF_OK;
}

int stf_units_open(steif_context *ctx, stf_pool *pool, SUNMatrix E, SUNMatrix F, stf_units *u)
{
  enum stf_evenness even;
  *u = (stf_units){NULL, NULL, NULL};
  STEIF_TRY(sparse(ctx, pool, E, &u->E));
  STEIF_TRY(sparse(ctx, pool, F, &u->F));
  if (!stf_scaling_needed(u->E, u->F)) return STEIF_OK;
  int *exponent = stf_pool_array(pool, 2 * (size_t)SM_COLUMNS_S(u->F), sizeof *exponent);
  if (!exponent) return STEIF_NO_MEMORY;
  STEIF_TRY(stf_scaling_logarithmic(ctx, u->E, u->F, exponent, &even));
  if (even != STF_EVEN) return STEIF_OK;
  u->exponent = exponent;
  STEIF_TRY(scale(ctx, pool, exponent, &u->E));
  return scale(ctx, pool, exponent, &u->F);
}

int stf_units_enter(stf_pool *pool, const stf_units *u, const sunrealtype **x0,
                    stf_sources *sources)
{
  if (!u->exponent) return STEIF_OK;
  const size_t n = (size_t)sources->n, rows = sources->f ? (size_t)sources->derivatives + 1 : 0;
  sunrealtype *all = stf_pool_array(pool, n * (rows + 2), sizeof *all);
  if (!all) return STEIF_NO_MEMORY;
  sunrealtype *Ex0 = all + n, *f = Ex0 + n;
  for (size_t i = 0; i < n; i++) {
    all[i] = ldexp((*x0)[i], -u->exponent[n + i]);
    Ex0[i] = ldexp(sources->Ex0[i], u->exponent[i]);
    for (size_t j = 0; j < rows; j++)
      f[j * n + i] = ldexp(sources->f[j * n + i], u->exponent[i]);
  }
  *x0 = all;
  sources->Ex0 = Ex0;
  if (rows) sources->f = f;
  return STEIF_OK;
}

void stf_units_leave(const stf_units *u, steif_impulse *impulse, sunrealtype *apart)
{
  const sunindextype n = impulse->n;
  for (sunindextype j = 0; u->exponent && j < n; j++) {
    impulse->x_plus[j] = ldexp(impulse->x_plus[j], u->exponent[n + j]);
    apart[j] = ldexp(apart[j], u->exponent[n + j]);
    for (int i = 0; i < impulse->count; i++)
      impulse->c[i * n + j] = ldexp(impulse->c[i * n + j], u->exponent[n + j]);
  }
}
