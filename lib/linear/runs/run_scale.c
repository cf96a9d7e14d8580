/* run_scale.c: the size of the states of E x' + F x = f over an interval.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "run_scale.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

/* Times at which f is looked at. */
enum { SAMPLES = 8 };

/* row[i] += the largest |entry| of row i of M over `by`. */
static void add_rows(SUNMatrix M, sunrealtype by, sunrealtype *most, sunrealtype *row)
{
  const bool dense = SUNMatGetID(M) == SUNMATRIX_DENSE;
  const sunindextype n = dense ? SM_COLUMNS_D(M) : SM_COLUMNS_S(M);
  const sunindextype count = dense ? SM_LDATA_D(M) : SM_INDEXPTRS_S(M)[n];
  const sunrealtype *a = dense ? SM_DATA_D(M) : SM_DATA_S(M);
  for (sunindextype i = 0; i < n; i++) most[i] = 0;
  for (sunindextype k = 0; k < count; k++) {
    const sunindextype i = dense ? k % n : SM_INDEXVALS_S(M)[k];
    most[i] = fmax(most[i], fabs(a[k]));
  }
  for (sunindextype i = 0; i < n; i++) row[i] += most[i] / by;
}

static int sample(steif_context *ctx, const steif_linear *l, sunrealtype t0, sunrealtype t1,
                  N_Vector g, sunrealtype *scale)
{
  const sunindextype n = N_VGetLength(g);
  const sunrealtype *f = N_VGetArrayPointer(g);
  sunrealtype *row = stf_allocate(ctx, 2 * (size_t)n, sizeof *row);
  if (!row) return STEIF_NO_MEMORY;
  add_rows(l->F, 1, row + n, row);
  add_rows(l->E, t1 - t0, row + n, row);
  for (int k = 0; k < SAMPLES; k++) {
    /* what f has to say where it fails comes with the steps */
    if (l->f(t0 + (k + 0.5) / SAMPLES * (t1 - t0), 0, g, l->user)) break;
    for (sunindextype i = 0; i < n; i++)
      if (row[i] > 0 && isfinite(f[i])) *scale = fmax(*scale, fabs(f[i]) / row[i]);
  }
  stf_release(ctx, row);
  return STEIF_OK;
}

int stf_run_scale(steif_context *ctx, const steif_linear *l, const sunrealtype *x,
                  sunrealtype t0, sunrealtype t1, sunrealtype *scale)
{
  const bool dense = SUNMatGetID(l->E) == SUNMATRIX_DENSE;
  const sunindextype n = dense ? SM_COLUMNS_D(l->E) : SM_COLUMNS_S(l->E);
  int code = STEIF_OK;
  *scale = 0;
  for (sunindextype i = 0; i < n; i++) *scale = fmax(*scale, fabs(x[i]));
  if (l->f && t1 > t0) {
    N_Vector g = N_VNew_Serial(n, steif_sundials(ctx));
    STEIF_CHECK(g, ctx, STEIF_NO_MEMORY, "no memory for a vector of %lld values", (long long)n);
    code = sample(ctx, l, t0, t1, g, scale);
    N_VDestroy(g);
  }
  *scale = *scale > 0 && isfinite(*scale) ? fmin(*scale, 1) : 1;
  return code;
}
