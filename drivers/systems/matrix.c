/* matrix.c: dense matrices from files.
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

/* Why the matrix cannot be taken. */
static int reject(const struct call *call, const char *path, long rows, long columns,
                  const struct matrix *M)
{
  const bool fits = (!rows || rows == M->rows) && (!columns || columns == M->columns);
  const bool by_rows = rows && rows != M->rows;
  if (fits)
    say(call,
        "'%s' is %ld x %ld, too large for a dense matrix; take fewer states [STEIF_NO_MEMORY]",
        path, M->rows, M->columns);
  else
    say(call, "'%s' is %ld x %ld and should have %ld %s; correct it [STEIF_BAD_INPUT]", path,
        M->rows, M->columns, by_rows ? rows : columns, by_rows ? "rows" : "columns");
  return fits ? EXIT_FAILED : EXIT_FILE;
}

int matrix_read(struct call *call, const char *path, long rows, long columns, struct matrix *M)
{
  const size_t largest = 100000000; /* entries: 800 MB */
  SUNMatrix S = steif_matrix_read(call->ctx, path);
  if (!S) return fail_file(call);
  const bool sparse = SUNMatGetID(S) == SUNMATRIX_SPARSE;
  M->rows = (long)(sparse ? SUNSparseMatrix_Rows(S) : SUNDenseMatrix_Rows(S));
  M->columns = (long)(sparse ? SUNSparseMatrix_Columns(S) : SUNDenseMatrix_Columns(S));
  const bool fits = (!rows || rows == M->rows) && (!columns || columns == M->columns);
  const size_t count = (size_t)M->rows * (size_t)M->columns;
  if (fits && count <= largest) M->x = calloc(count + 1, sizeof *M->x);
  if (M->x && sparse) spread(S, M);
  if (M->x && !sparse) memcpy(M->x, SUNDenseMatrix_Data(S), count * sizeof *M->x);
  SUNMatDestroy(S);
  return M->x ? EXIT_OK : reject(call, path, rows, columns, M);
}

int matrix_option(struct call *call, const char *option, long rows, long columns,
                  struct matrix *M)
{
  const char *path = word_of(call, option);
  return path ? matrix_read(call, path, rows, columns, M) : EXIT_OK;
}

int matrix_square(struct call *call, const char *path, const char *what, struct matrix *M)
{
  const int code = matrix_read(call, path, 0, 0, M);
  if (code || M->rows == M->columns) return code;
  say(call, "'%s' is %ld x %ld; %s must be square [STEIF_BAD_INPUT]", path, M->rows, M->columns,
      what);
  return EXIT_FILE;
}
