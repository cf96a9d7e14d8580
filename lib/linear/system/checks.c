/* checks.c: matrices of a descriptor system as they are handed over.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "linear_system.h"
#include "pencil.h"
#include <math.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

static bool is_dense(SUNMatrix M) { return SUNMatGetID(M) == SUNMATRIX_DENSE; }
static sunindextype order(SUNMatrix M)
{
  return is_dense(M) ? SM_COLUMNS_D(M) : SM_COLUMNS_S(M);
}

static int check_finite(steif_context *ctx, const char *name, SUNMatrix M)
{
  const sunindextype n = order(M);
  const sunrealtype *a = is_dense(M) ? SM_DATA_D(M) : SM_DATA_S(M);
  const sunindextype count = is_dense(M) ? SM_LDATA_D(M) : SM_INDEXPTRS_S(M)[n];
  if (stf_all_finite(a, (size_t)count)) return STEIF_OK;
  sunindextype p = 0, j = 0;
  while (isfinite(a[p])) p++;
  while (!is_dense(M) && SM_INDEXPTRS_S(M)[j + 1] <= p) j++;
  return STEIF_FAIL(ctx, STEIF_NOT_FINITE, "entry (%lld, %lld) of %s is %g: all must be finite",
                    (long long)(is_dense(M) ? p % n : SM_INDEXVALS_S(M)[p]) + 1,
                    (long long)(is_dense(M) ? p / n : j) + 1, name, a[p]);
}

static int check_matrix(steif_context *ctx, const char *name, SUNMatrix M)
{
  STEIF_CHECK(M, ctx, STEIF_BAD_INPUT, "matrix %s is missing", name);
  const SUNMatrix_ID id = SUNMatGetID(M);
  STEIF_CHECK(
    id == SUNMATRIX_DENSE || id == SUNMATRIX_SPARSE, ctx, STEIF_UNSUPPORTED,
    "matrix %s is neither dense nor sparse (SUNMatrix kind %d): copy it to one of them", name,
    (int)id);
  STEIF_CHECK(is_dense(M) || SM_SPARSETYPE_S(M) == CSC_MAT, ctx, STEIF_UNSUPPORTED,
              "matrix %s is stored by rows: convert it with SUNSparseMatrix_ToCSC", name);
  const sunindextype rows = is_dense(M) ? SM_ROWS_D(M) : SM_ROWS_S(M), columns = order(M);
  STEIF_CHECK(rows == columns, ctx, STEIF_BAD_INPUT,
              "matrix %s is %lld x %lld: as many equations as unknowns are needed", name,
              (long long)rows, (long long)columns);
  return check_finite(ctx, name, M);
}

int stf_structure_check(steif_context *ctx, SUNMatrix E, SUNMatrix F)
{
  STEIF_TRY(check_matrix(ctx, "E", E));
  STEIF_TRY(check_matrix(ctx, "F", F));
  STEIF_CHECK(order(E) == order(F), ctx, STEIF_BAD_INPUT,
              "E is of order %lld, F of order %lld: they must be equal", (long long)order(E),
              (long long)order(F));
  return STEIF_OK;
}
