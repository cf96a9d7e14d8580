/* matrix.c: dense matrices from files and into reports.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "matrix.h"
#include <stdlib.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

static void spread(SUNMatrix S, struct matrix *M)
{
  const sunindextype *start = SUNSparseMatrix_IndexPointers(S);
  const sunindextype *row = SUNSparseMatrix_IndexValues(S);
  const double *value = SUNSparseMatrix_Data(S);
  for (long j = 0; j < M->columns; j++)
    for (sunindextype k = start[j]; k < start[j + 1]; k++)
      M->x[row[k] + j * M->rows] += value[k];
}

int matrix_read(struct call *call, const char *path, long rows, long columns, struct matrix *M)
{
  SUNMatrix S = steif_matrix_read(call->ctx, path);
  if (!S) {
    const int code = fail(call);
    return code == EXIT_USAGE || code == EXIT_FAILED ? EXIT_FILE : code;
  }
  const bool sparse = SUNMatGetID(S) == SUNMATRIX_SPARSE;
  M->rows = (long)(sparse ? SUNSparseMatrix_Rows(S) : SUNDenseMatrix_Rows(S));
  M->columns = (long)(sparse ? SUNSparseMatrix_Columns(S) : SUNDenseMatrix_Columns(S));
  const bool fits = (!rows || rows == M->rows) && (!columns || columns == M->columns);
  const size_t count = (size_t)M->rows * (size_t)M->columns;
  if (fits && M->rows <= 10000 && M->columns <= 10000) M->x = calloc(count + 1, sizeof *M->x);
  if (M->x && sparse) spread(S, M);
  if (M->x && !sparse) memcpy(M->x, SUNDenseMatrix_Data(S), count * sizeof *M->x);
  SUNMatDestroy(S);
  if (M->x) return EXIT_OK;
  if (fits)
    say(call, "'%s' is %ld x %ld, too large for a dense matrix; take fewer states", path,
        M->rows, M->columns);
  else
    say(call, "'%s' is %ld x %ld and should have %ld %s; correct it", path, M->rows, M->columns,
        rows && rows != M->rows ? rows : columns, rows && rows != M->rows ? "rows" : "columns");
  return fits ? EXIT_FAILED : EXIT_FILE;
}

int matrix_square(struct call *call, const char *path, const char *what, struct matrix *M)
{
  const int code = matrix_read(call, path, 0, 0, M);
  if (code || M->rows == M->columns) return code;
  say(call, "'%s' is %ld x %ld; %s must be square", path, M->rows, M->columns, what);
  return EXIT_FILE;
}

void report_dense(steif_report *r, const char *name, int rows, int columns, const double *x)
{
  const size_t count = (size_t)rows * (size_t)columns;
  double *by_rows = malloc((count + 1) * sizeof *by_rows);
  for (int i = 0; by_rows && i < rows; i++)
    for (int j = 0; j < columns; j++) by_rows[i * columns + j] = x[i + rows * j];
  if (by_rows) steif_report_matrix(r, name, (size_t)rows, (size_t)columns, by_rows);
  free(by_rows);
}
