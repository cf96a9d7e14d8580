/* test_incomplete.c: ILU(0) is L U on the pattern, and whole where nothing fills in.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"
#include <nvector/nvector_serial.h>
#include <stdbool.h>
#include <steif/pencil.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

enum { SIDE = 4, N = SIDE * SIDE };
static const double s = 0.83;

/* Columns of a function of (row, column), zeros left out; rows descend, which is no order to rely on. */
static SUNMatrix sparse(SUNContext sun, int n, double (*entry)(int i, int j))
{
  SUNMatrix M = SUNSparseMatrix(n, n, n * n, CSC_MAT, sun);
  sunindextype used = 0;
  for (int j = 0; j < n; j++) {
    SM_INDEXPTRS_S(M)[j] = used;
    for (int i = n - 1; i >= 0; i--)
      if (entry(i, j) != 0) SM_INDEXVALS_S(M)[used] = i, SM_DATA_S(M)[used++] = entry(i, j);
  }
  SM_INDEXPTRS_S(M)[n] = used;
  return M;
}

static double star(int i, int j)
{
  const int across = abs(i % SIDE - j % SIDE), down = abs(i / SIDE - j / SIDE);
  return across + down == 0 ? -4 - 0.1 * i : across + down == 1 ? 1 + 0.03 * j : 0;
}

static double chain(int i, int j) { return abs(i - j) > 1 ? 0 : i == j ? -2.3 : 1 + 0.07 * i; }
static double swap(int i, int j) { return i + j == 1; }
static double first(int i, int j) { return i == 0 && j == 0; }
static double second(int i, int j) { return i == 1 && j == 1; }

/* Columns of (L U)^{-1}, then L U by a dense solve. */
static void product(steif_context *ctx, steif_pencil *p, double *LU)
{
  SUNContext sun = steif_sundials(ctx);
  SUNMatrix inverse = SUNDenseMatrix(N, N, sun);
  N_Vector x = N_VNew_Serial(N, sun);
  for (int j = 0; j < N; j++) {
    N_VConst(0, x), NV_Ith_S(x, j) = 1;
    CHECK(steif_pencil_solve(p, 0, 1, &x, NULL) == STEIF_OK);
    for (int i = 0; i < N; i++) SM_ELEMENT_D(inverse, i, j) = -NV_Ith_S(x, i);
  }
  steif_pencil *q = steif_pencil_new(ctx, NULL, inverse);
  CHECK(steif_pencil_factor(q, 1, &(steif_shift){0, 0}) == STEIF_OK);
  for (int j = 0; j < N; j++) {
    N_VConst(0, x), NV_Ith_S(x, j) = 1;
    CHECK(steif_pencil_solve(q, 0, 1, &x, NULL) == STEIF_OK);
    memcpy(LU + j * N, NV_DATA_S(x), N * sizeof *LU);
  }
  steif_pencil_free(&q);
  N_VDestroy(x), SUNMatDestroy(inverse);
}

static double matrix(double (*entry)(int i, int j), int i, int j)
{
  return (i == j ? s : 0) - entry(i, j);
}

static void agrees_on_the_pattern(void)
{
  double LU[N * N];
  steif_context *ctx = steif_context_new(NULL);
  SUNMatrix A = sparse(steif_sundials(ctx), N, star);
  steif_pencil *p = steif_pencil_new_incomplete(ctx, NULL, A);
  CHECK(steif_pencil_factor(p, 1, &(steif_shift){s, 0}) == STEIF_OK);
  product(ctx, p, LU);
  for (int j = 0; j < N; j++)
    for (int i = 0; i < N; i++)
      if (star(i, j) != 0) CLOSE(LU[j * N + i], matrix(star, i, j), 1e-13);
  /* The fill left out at (SIDE, 1) is l u of column 0. */
  const double fill = matrix(star, SIDE, 0) * matrix(star, 0, 1) / matrix(star, 0, 0);
  CLOSE(LU[N + SIDE], fill, 1e-12);
  CHECK(fabs(fill) > 0.2);
  CHECK(steif_pencil_statistics(p)->fill == 5 * N - 4 * SIDE);
  steif_pencil_free(&p), SUNMatDestroy(A);
  steif_context_free(&ctx);
}

static void whole_where_nothing_fills(void)
{
  double LU[N * N];
  steif_context *ctx = steif_context_new(NULL);
  SUNMatrix A = sparse(steif_sundials(ctx), N, star), B = sparse(steif_sundials(ctx), N, chain);
  steif_pencil *p = steif_pencil_new_incomplete(ctx, NULL, A);
  CHECK(steif_pencil_factor(p, 1, &(steif_shift){s, 0}) == STEIF_OK);
  /* Another pattern in the same matrix. */
  const size_t used = (size_t)SM_INDEXPTRS_S(B)[N];
  memcpy(SM_INDEXPTRS_S(A), SM_INDEXPTRS_S(B), (N + 1) * sizeof(sunindextype));
  memcpy(SM_INDEXVALS_S(A), SM_INDEXVALS_S(B), used * sizeof(sunindextype));
  memcpy(SM_DATA_S(A), SM_DATA_S(B), used * sizeof(double));
  CHECK(steif_pencil_update(p) == STEIF_OK);
  CHECK(steif_pencil_factor(p, 1, &(steif_shift){s, 0}) == STEIF_OK);
  product(ctx, p, LU);
  for (int j = 0; j < N; j++)
    for (int i = 0; i < N; i++) CLOSE_FLOOR(LU[j * N + i], matrix(chain, i, j), 1e-12, 1);
  CHECK(steif_pencil_statistics(p)->analyses == 2);
  steif_pencil_free(&p), SUNMatDestroy(A), SUNMatDestroy(B);
  steif_context_free(&ctx);
}

/* s E - A = [s -1; -1 0] with E = diag(1, 0): the second diagonal is in neither pattern. Where the
 * first is 0 there is no pivot. */
static void missing_diagonals(void)
{
  steif_context *ctx = steif_context_new(NULL);
  SUNContext sun = steif_sundials(ctx);
  SUNMatrix A = sparse(sun, 2, swap);
  for (int k = 0; k < 2; k++) {
    SUNMatrix E = sparse(sun, 2, k ? second : first);
    steif_pencil *p = steif_pencil_new_incomplete(ctx, E, A);
    const int code = steif_pencil_factor(p, 1, &(steif_shift){s, 0});
    CHECK(code == (k ? STEIF_SINGULAR : STEIF_OK));
    if (k) CHECK(strstr(steif_message(ctx), "the pivot of column 1 ") != NULL);
    N_Vector x = N_VNew_Serial(2, sun);
    NV_Ith_S(x, 0) = 1.7, NV_Ith_S(x, 1) = -0.6;
    CHECK(steif_pencil_solve(p, 0, 1, &x, NULL) == (k ? STEIF_BAD_INPUT : STEIF_OK));
    if (!k) CLOSE(NV_Ith_S(x, 0), 0.6, 1e-14);
    if (!k) CLOSE(NV_Ith_S(x, 1), 0.6 * s - 1.7, 1e-14);
    steif_pencil_free(&p), SUNMatDestroy(E), N_VDestroy(x);
  }
  SUNMatDestroy(A);
  steif_context_free(&ctx);
}

static void refusals(void)
{
  steif_context *ctx = steif_context_new(NULL);
  SUNMatrix A = sparse(steif_sundials(ctx), N, star);
  SUNMatrix D = SUNDenseMatrix(N, N, steif_sundials(ctx));
  CHECK(!steif_pencil_new_incomplete(ctx, NULL, D) && steif_status(ctx) == STEIF_UNSUPPORTED);
  CHECK(!steif_pencil_new_incomplete(ctx, NULL, NULL) && steif_status(ctx) == STEIF_BAD_INPUT);
  steif_pencil *p = steif_pencil_new_incomplete(ctx, NULL, A);
  CHECK(steif_pencil_factor(p, 1, &(steif_shift){s, 1}) == STEIF_UNSUPPORTED);
  SM_DATA_S(A)[7] = NAN;
  CHECK(steif_pencil_update(p) == STEIF_NOT_FINITE);
  CHECK(strstr(steif_message(ctx), " of A is ") != NULL);
  steif_pencil_free(&p), SUNMatDestroy(A), SUNMatDestroy(D);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_incomplete[] = {
  {"L U is the matrix on its pattern", agrees_on_the_pattern},
  {"whole where nothing fills, also for a new pattern", whole_where_nothing_fills},
  {"diagonals that are not stored, pivots that are not there", missing_diagonals},
  {"dense matrices, complex shifts and NaN are refused", refusals},
  CU_TEST_INFO_NULL,
};
