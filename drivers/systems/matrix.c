/* matrix.c: dense matrices from files.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "matrix.h"
#include <math.h>
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

/* S, which is destroyed, as M. */
static int take(struct call *call, const char *path, long rows, long columns, SUNMatrix S,
                struct matrix *M)
{
  const size_t largest = 100000000; /* entries: 800 MB */
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

int matrix_read(struct call *call, const char *path, long rows, long columns, struct matrix *M)
{
  SUNMatrix S = steif_matrix_read(call->ctx, path);
  return S ? take(call, path, rows, columns, S, M) : fail_file(call);
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

/* Has the model terms free of x, which matrices leave out? Looked at in two times. */
static bool is_forced(struct call *call, const steif_problem *p)
{
  SUNContext sun = steif_sundials(call->ctx);
  N_Vector x = N_VNew_Serial(p->n, sun), f = N_VNew_Serial(p->n, sun);
  sunrealtype most = 0;
  for (int k = 0; x && f && k < 2; k++) {
    const sunrealtype t = p->t0 + 0.7 * k;
    N_VConst(0, x), N_VConst(0, f);
    const int failed = p->f ? p->f(t, x, f, p->user) : p->g ? p->g(t, 0, f, p->user) : -1;
    if (!failed) most = fmax(most, N_VMaxNorm(f));
  }
  if (x) N_VDestroy(x);
  if (f) N_VDestroy(f);
  return most > 0;
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
  if (!code && is_forced(call, &p))
    say(call, "the terms of '%s' that are free of x are left out: of x' = A x only A is taken",
        path);
  steif_problem_clear(call->ctx, &p);
  return code;
}

/* ---- .mat files ---- */

static bool is_mat(const char *path)
{
  const size_t length = strlen(path);
  return (length > 4 && !strcmp(path + length - 4, ".mat")) ||
         (length > 3 && !strcmp(path + length - 3, ".h5"));
}

static bool is_identity(const struct matrix *M)
{
  for (long i = 0; i < M->rows; i++)
    for (long j = 0; j < M->rows; j++)
      if (M->x[i + j * M->rows] != (i == j)) return false;
  return true;
}

/* A = -F. */
static int of_mat(struct call *call, const char *path, struct matrix *A, struct matrix *E)
{
  SUNMatrix read_E = NULL, F = NULL;
  struct matrix own = {0}, *to = E ? E : &own;
  if (steif_system_read(call->ctx, path, NULL, 0, &read_E, &F)) return fail_file(call);
  int code = take(call, path, 0, 0, F, A);
  for (long k = 0; !code && k < A->rows * A->columns; k++) A->x[k] = 0 - A->x[k];
  if (code)
    SUNMatDestroy(read_E);
  else
    code = take(call, path, 0, 0, read_E, to);
  const bool plain = !code && is_identity(to);
  if (!code && !plain && !E) {
    say(call, "'%s' has E, which is not the identity; give A = E^-1 A [STEIF_BAD_INPUT]", path);
    code = EXIT_FILE;
  }
  if (plain || !E) free(to->x), *to = (struct matrix){0};
  return code;
}

static int ports_of_mat(struct call *call, const char *path, struct matrix *B, struct matrix *C,
                        struct matrix *D)
{
  SUNMatrix S[3] = {NULL};
  if (call->words > 1 || given(call, "--C") || given(call, "--E"))
    return bad_usage(call, "%s holds B, C, D and E beside A; leave the others out", path);
  struct matrix *const to[3] = {B, C, D};
  if (steif_input_output_read(call->ctx, path, &S[0], &S[1], &S[2])) return fail_file(call);
  int code = EXIT_OK;
  for (int i = 0; i < 3; i++)
    if (S[i] && !code)
      code = take(call, path, 0, 0, S[i], to[i]);
    else if (S[i])
      SUNMatDestroy(S[i]);
  return code;
}

int matrix_ports(struct call *call, long n, struct matrix *B, struct matrix *C,
                 struct matrix *D)
{
  if (is_mat(call->word[0])) return ports_of_mat(call, call->word[0], B, C, D);
  return call->words > 1 ? matrix_read(call, call->word[1], n, 0, B) : EXIT_OK;
}

/* A model by its name, or on standard input, where a matrix would begin with %%MatrixMarket. */
static bool is_model(const char *path)
{
  if (strcmp(path, "-")) return strstr(path, ".steif");
  const int first = getc(stdin);
  if (first != EOF) ungetc(first, stdin);
  return first != '%';
}

int matrix_system(struct call *call, const char *path, const char *what, struct matrix *A,
                  struct matrix *E)
{
  return is_mat(path)     ? of_mat(call, path, A, E)
         : is_model(path) ? of_model(call, path, A, E)
                          : matrix_square(call, path, what, A);
}
