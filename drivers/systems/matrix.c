/* matrix.c: dense matrices from files.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "matrix.h"
#include <stdlib.h>
#include <string.h>
#include <nvector/nvector_serial.h>
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

/* ---- models ---- */

/* E or A of a linear problem, dense by columns. */
static int fill_matrix(struct call *call, const steif_problem *p, bool of_E, struct matrix *M)
{
  SUNContext sun = steif_sundials(call->ctx);
  const bool sparse = p->storage == STEIF_SPARSE;
  N_Vector y = N_VNew_Serial(p->n, sun), yp = N_VNew_Serial(p->n, sun);
  SUNMatrix S = sparse ? SUNSparseMatrix(p->n, p->n, of_E ? p->nnz_E : p->nnz, CSC_MAT, sun)
                       : SUNDenseMatrix(p->n, p->n, sun);
  *M = (struct matrix){(long)p->n, (long)p->n,
                       calloc((size_t)p->n * (size_t)p->n, sizeof(double))};
  int code = y && yp && S && M->x ? 0 : -1;
  if (!code) N_VConst(0, y), N_VConst(0, yp);
  if (!code)
    code = of_E     ? p->E(p->t0, y, yp, S, p->user)
           : p->jac ? p->jac(p->t0, y, yp, S, p->user, yp, yp, yp)
                    : p->A(p->t0, y, yp, S, p->user);
  if (!code && sparse) spread(S, M);
  if (!code && !sparse)
    memcpy(M->x, SUNDenseMatrix_Data(S), (size_t)p->n * (size_t)p->n * sizeof *M->x);
  if (y) N_VDestroy(y);
  if (yp) N_VDestroy(yp);
  if (S) SUNMatDestroy(S);
  return code ? no_memory(call, "the matrices of the model", "take fewer states") : EXIT_OK;
}

static int of_model(struct call *call, const char *path, struct matrix *A, struct matrix *E)
{
  steif_problem p;
  if (steif_problem_find(call->ctx, path, &p)) return fail_file(call);
  int code = EXIT_OK;
  if (!p.linear || !(p.jac || p.A)) {
    say(call,
        "'%s' is not linear with constant coefficients: it has no matrix A [STEIF_BAD_INPUT]",
        path);
    code = EXIT_FILE;
  } else if (p.E && !E) {
    say(call,
        "'%s' is E x' = A x with E not the identity; solve its equations for the derivatives "
        "[STEIF_BAD_INPUT]",
        path);
    code = EXIT_FILE;
  }
  if (!code) code = fill_matrix(call, &p, false, A);
  if (!code && p.E) code = fill_matrix(call, &p, true, E);
  steif_problem_clear(call->ctx, &p);
  return code;
}

int matrix_system(struct call *call, const char *path, const char *what, struct matrix *A,
                  struct matrix *E)
{
  return strstr(path, ".steif") ? of_model(call, path, A, E)
                                : matrix_square(call, path, what, A);
}
