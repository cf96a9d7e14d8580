/* matrix_file.c: matrices from Matrix Market files, read by CHOLMOD after a scan that names lines; and
 * what the room asks of a matrix.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "input.h"
#include <cholmod.h>
#include <math.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

static bool dense(SUNMatrix M) { return SUNMatGetID(M) == SUNMATRIX_DENSE; }

sunindextype stf_input_rows(SUNMatrix M) { return dense(M) ? SM_ROWS_D(M) : SM_ROWS_S(M); }

sunindextype stf_input_columns(SUNMatrix M)
{
  return dense(M) ? SM_COLUMNS_D(M) : SM_COLUMNS_S(M);
}

sunindextype stf_input_column(SUNMatrix M, sunindextype j)
{
  return dense(M) ? SM_ROWS_D(M) : SM_INDEXPTRS_S(M)[j + 1] - SM_INDEXPTRS_S(M)[j];
}

void stf_input_entry(SUNMatrix M, sunindextype j, sunindextype k, sunindextype *row,
                     sunrealtype *value)
{
  if (dense(M)) {
    *row = k;
    *value = SM_ELEMENT_D(M, k, j);
  } else {
    const sunindextype at = SM_INDEXPTRS_S(M)[j] + k;
    *row = SM_INDEXVALS_S(M)[at];
    *value = SM_DATA_S(M)[at];
  }
}

int stf_input_check(steif_context *ctx, SUNMatrix M, const char *name)
{
  STEIF_CHECK(M, ctx, STEIF_BAD_INPUT, "%s is NULL; give a matrix", name);
  const bool sparse = SUNMatGetID(M) == SUNMATRIX_SPARSE && SM_SPARSETYPE_S(M) == CSC_MAT;
  STEIF_CHECK(sparse || dense(M), ctx, STEIF_UNSUPPORTED,
              "%s is neither dense nor compressed by columns; convert it", name);
  for (sunindextype j = 0; sparse && j < SM_COLUMNS_S(M); j++)
    STEIF_CHECK(SM_INDEXPTRS_S(M)[j] >= 0 && SM_INDEXPTRS_S(M)[j] <= SM_INDEXPTRS_S(M)[j + 1] &&
                  SM_INDEXPTRS_S(M)[j + 1] <= SM_NNZ_S(M),
                ctx, STEIF_BAD_INPUT,
                "%s: column %lld ends before it begins or after its %lld "
                "entries; correct its pointers",
                name, (long long)j + 1, (long long)SM_NNZ_S(M));
  for (sunindextype j = 0; j < stf_input_columns(M); j++)
    for (sunindextype k = 0; k < stf_input_column(M, j); k++) {
      sunindextype i;
      sunrealtype x;
      stf_input_entry(M, j, k, &i, &x);
      STEIF_CHECK(i >= 0 && i < stf_input_rows(M), ctx, STEIF_BAD_INPUT,
                  "%s: entry %lld of column %lld names row %lld of %lld; correct its indices",
                  name, (long long)k + 1, (long long)j + 1, (long long)i + 1,
                  (long long)stf_input_rows(M));
      STEIF_CHECK(isfinite(x), ctx, STEIF_NOT_FINITE,
                  "%s: entry (%lld, %lld) is %g; every entry must be finite", name,
                  (long long)i + 1, (long long)j + 1, x);
    }
  return STEIF_OK;
}

static SUNMatrix no_memory(steif_context *ctx, const char *path)
{
  STEIF_FAIL(ctx, STEIF_NO_MEMORY, "no memory for the matrix of '%s'; make the problem smaller",
             path);
  return NULL;
}

static SUNMatrix from_dense(steif_context *ctx, const cholmod_dense *X)
{
  const sunindextype rows = (sunindextype)X->nrow, columns = (sunindextype)X->ncol;
  SUNMatrix M = SUNDenseMatrix(rows, columns, steif_sundials(ctx));
  for (sunindextype j = 0; M && j < columns; j++)
    memcpy(SM_COLUMN_D(M, j), (const double *)X->x + (size_t)j * X->d,
           X->nrow * sizeof(double));
  return M;
}

static SUNMatrix from_sparse(steif_context *ctx, const cholmod_sparse *A)
{
  const SuiteSparse_long *p = A->p, *i = A->i;
  const double *x = A->x;
  const sunindextype columns = (sunindextype)A->ncol, count = (sunindextype)p[A->ncol];
  SUNMatrix M = SUNSparseMatrix((sunindextype)A->nrow, columns, count ? count : 1, CSC_MAT,
                                steif_sundials(ctx));
  if (!M) return NULL;
  for (sunindextype j = 0; j <= columns; j++) SM_INDEXPTRS_S(M)[j] = (sunindextype)p[j];
  for (sunindextype k = 0; k < count; k++) {
    SM_INDEXVALS_S(M)[k] = (sunindextype)i[k];
    SM_DATA_S(M)[k] = x[k];
  }
  return M;
}

/* A matrix of no entries, which CHOLMOD does not read in every format. */
static SUNMatrix none(steif_context *ctx, const char *path, const stf_market *m)
{
  SUNContext sun = steif_sundials(ctx);
  SUNMatrix M = m->array ? SUNDenseMatrix(m->rows, m->columns, sun)
                         : SUNSparseMatrix(m->rows, m->columns, 1, CSC_MAT, sun);
  return M ? M : no_memory(ctx, path);
}

/* The file, which has passed the scan, through CHOLMOD: symmetric matrices become full, entries
 * given twice are added. */
static SUNMatrix convert(steif_context *ctx, const char *path, FILE *file,
                         cholmod_common *common)
{
  int type = 0;
  SUNMatrix M = NULL;
  void *read = cholmod_l_read_matrix(file, 1, &type, common);
  if (!read && common->status != CHOLMOD_OUT_OF_MEMORY && common->status != CHOLMOD_TOO_LARGE) {
    STEIF_FAIL(ctx, STEIF_BAD_INPUT,
               "CHOLMOD cannot read '%s', its status is %d; write the "
               "matrix again, one entry in each line",
               path, common->status);
    return NULL;
  }
  if (read && type == CHOLMOD_DENSE) {
    cholmod_dense *X = read;
    M = from_dense(ctx, X);
    cholmod_l_free_dense(&X, common);
  } else if (read) {
    cholmod_sparse *A = read;
    if (A->sorted || cholmod_l_sort(A, common)) M = from_sparse(ctx, A);
    cholmod_l_free_sparse(&A, common);
  }
  return M ? M : no_memory(ctx, path);
}

static SUNMatrix read(steif_context *ctx, const char *path, FILE *file)
{
  cholmod_common common;
  cholmod_l_start(&common);
  common.print = 0;
  common.error_handler = NULL;
  common.prefer_binary = 1; /* a pattern is a matrix of ones */
  SUNMatrix M = convert(ctx, path, file, &common);
  cholmod_l_finish(&common);
  if (M && stf_input_check(ctx, M, path)) {
    SUNMatDestroy(M);
    M = NULL;
  }
  return M;
}

SUNMatrix steif_matrix_read(steif_context *ctx, const char *path)
{
  stf_market market;
  stf_plain plain;
  SUNMatrix M = NULL;
  FILE *file = stf_input_open(ctx, path);
  if (!file) return NULL;
  if (!stf_plain_begin(ctx, &plain)) {
    if (!stf_market_scan(ctx, path, file, &market)) {
      rewind(file);
      M = market.entries ? read(ctx, path, file) : none(ctx, path, &market);
    }
    stf_plain_end(&plain);
  }
  fclose(file);
  return M;
}
