/* test_write.c: what is written reads back to the last bit, and a file is complete or not there.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fixture.h"
#include <float.h>
#include <locale.h>
#include <sys/stat.h>
#include <unistd.h>

static const double hard[] = {1. / 3,    -DBL_MAX / 2, DBL_MIN,     DBL_TRUE_MIN,
                              0.1 + 0.2, -0.0,         DBL_EPSILON, 1e22,
                              123456.7,  -2. / 7,      0,           3.141592653589793};

static void dense_matrices_return_to_the_bit(void)
{
  steif_context *ctx = steif_context_new(NULL);
  SUNMatrix M = SUNDenseMatrix(3, 4, steif_sundials(ctx));
  for (int k = 0; k < 12; k++) SM_DATA_D(M)[k] = hard[k];
  CHECK(!steif_matrix_write(ctx, M, in_folder("dense.mtx")));
  SUNMatrix R = steif_matrix_read(ctx, in_folder("dense.mtx"));
  CU_ASSERT_FATAL(R != NULL);
  CHECK(SM_ROWS_D(R) == 3 && SM_COLUMNS_D(R) == 4);
  for (int k = 0; k < 12; k++) CHECK(!memcmp(SM_DATA_D(R) + k, hard + k, sizeof *hard));
  SUNMatDestroy(M), SUNMatDestroy(R);
  steif_context_free(&ctx);
}

static SUNMatrix sparse(steif_context *ctx)
{
  static const sunindextype column[] = {0, 2, 2, 5}, row[] = {0, 3, 1, 2, 4};
  SUNMatrix M = SUNSparseMatrix(5, 3, 9, CSC_MAT, steif_sundials(ctx));
  memcpy(SM_INDEXPTRS_S(M), column, sizeof column);
  memcpy(SM_INDEXVALS_S(M), row, sizeof row);
  memcpy(SM_DATA_S(M), hard, 5 * sizeof *hard);
  return M;
}

static void sparse_matrices_return_to_the_bit(void)
{
  steif_context *ctx = steif_context_new(NULL);
  SUNMatrix M = sparse(ctx);
  CHECK(!steif_matrix_write(ctx, M, in_folder("sparse.mtx")));
  SUNMatrix R = steif_matrix_read(ctx, in_folder("sparse.mtx"));
  CU_ASSERT_FATAL(R != NULL);
  CHECK(SM_ROWS_S(R) == 5 && SM_COLUMNS_S(R) == 3);
  CHECK(!memcmp(SM_INDEXPTRS_S(R), SM_INDEXPTRS_S(M), 4 * sizeof(sunindextype)));
  CHECK(!memcmp(SM_INDEXVALS_S(R), SM_INDEXVALS_S(M), 5 * sizeof(sunindextype)));
  CHECK(!memcmp(SM_DATA_S(R), hard, 5 * sizeof *hard));
  SUNMatDestroy(M), SUNMatDestroy(R);
  steif_context_free(&ctx);
}

static void files_are_replaced_whole(void)
{
  steif_context *ctx = steif_context_new(NULL);
  SUNMatrix M = sparse(ctx);
  char before[400];
  strcpy(before, put("old.mtx", "something else"));
  CHECK(!steif_matrix_write(ctx, M, before));
  SUNMatrix R = steif_matrix_read(ctx, before);
  CHECK(R && SM_INDEXPTRS_S(R)[3] == 5);
  if (R) SUNMatDestroy(R);

  SM_DATA_S(M)[2] = NAN;
  CHECK(steif_matrix_write(ctx, M, before) == STEIF_NOT_FINITE);
  SAYS(ctx, "entry (2, 3) is");
  R = steif_matrix_read(ctx, before);
  CHECK(R && at(R, 1, 2) == hard[2]);
  if (R) SUNMatDestroy(R);
  SUNMatDestroy(M);
  steif_context_free(&ctx);
}

static void what_cannot_be_written_is_rejected(void)
{
  steif_context *ctx = steif_context_new(NULL);
  SUNMatrix M = sparse(ctx), R = SUNSparseMatrix(2, 2, 2, CSR_MAT, steif_sundials(ctx));
  CHECK(steif_matrix_write(ctx, M, "/nowhere/m.mtx") == STEIF_IO);
  SAYS(ctx, "cannot write '/nowhere/m.mtx': No such file");
  CHECK(steif_matrix_write(ctx, M, "/tmp") == STEIF_IO);
  CHECK(steif_matrix_write(ctx, M, "/dev/full") == STEIF_IO);
  CHECK(steif_matrix_write(ctx, M, "") == STEIF_BAD_INPUT);
  CHECK(steif_matrix_write(ctx, NULL, in_folder("none.mtx")) == STEIF_BAD_INPUT);
  CHECK(steif_matrix_write(ctx, R, in_folder("rows.mtx")) == STEIF_UNSUPPORTED);
  SAYS(ctx, "compressed by columns");
  SM_INDEXVALS_S(M)[1] = 5;
  CHECK(steif_matrix_write(ctx, M, in_folder("row.mtx")) == STEIF_BAD_INPUT);
  SM_INDEXPTRS_S(M)[1] = 99;
  CHECK(steif_matrix_write(ctx, M, in_folder("pointer.mtx")) == STEIF_BAD_INPUT);
  CHECK(access(in_folder("row.mtx"), F_OK) && access(in_folder("pointer.mtx"), F_OK));
  SUNMatDestroy(M), SUNMatDestroy(R);
  steif_context_free(&ctx);
}

/* Any locale with a decimal comma that this machine has; there may be none. */
static void numbers_have_a_point_in_every_locale(void)
{
  static const char *const names[] = {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "de_DE"};
  steif_context *ctx = steif_context_new(NULL);
  for (int i = 0; i < 4 && !setlocale(LC_ALL, names[i]); i++)
    ;
  SUNMatrix M = sparse(ctx);
  CHECK(!steif_matrix_write(ctx, M, in_folder("comma.mtx")));
  SUNMatrix R = steif_matrix_read(ctx, in_folder("comma.mtx"));
  CHECK(R && at(R, 0, 0) == hard[0]);
  steif_function *f = steif_function_parse(ctx, "2.75*t", 1, NULL);
  CHECK(ask(ctx, f, 1, 0, 0.5, 0) == 1.375);
  setlocale(LC_ALL, "C");
  steif_function_free(&f);
  if (R) SUNMatDestroy(R);
  SUNMatDestroy(M);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_write[] = {
  {"dense matrices return to the last bit", dense_matrices_return_to_the_bit},
  {"sparse matrices return to the last bit", sparse_matrices_return_to_the_bit},
  {"a file is replaced whole or stays", files_are_replaced_whole},
  {"what cannot be written is rejected", what_cannot_be_written_is_rejected},
  {"numbers have a point in every locale", numbers_have_a_point_in_every_locale},
  CU_TEST_INFO_NULL};
