/* test_market.c: Matrix Market files of every kind, against the entries written here.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fixture.h"
#include <time.h>

/* Read `text`, compare with `rows` x `columns` values by rows. */
static void reads(const char *text, int rows, int columns, const double *expected)
{
  steif_context *ctx = steif_context_new(NULL);
  SUNMatrix M = steif_matrix_read(ctx, put("kind.mtx", text));
  if (!M) printf("\n  %s", steif_message(ctx));
  CHECK(M != NULL);
  if (M) {
    const bool dense = strstr(text, "array") != NULL;
    CHECK(SUNMatGetID(M) == (dense ? SUNMATRIX_DENSE : SUNMATRIX_SPARSE));
    CHECK((dense ? SM_ROWS_D(M) : SM_ROWS_S(M)) == rows);
    CHECK((dense ? SM_COLUMNS_D(M) : SM_COLUMNS_S(M)) == columns);
    for (int i = 0; i < rows; i++)
      for (int j = 0; j < columns; j++) CHECK(at(M, i, j) == expected[i * columns + j]);
    SUNMatDestroy(M);
  }
  steif_context_free(&ctx);
}

static void coordinates(void)
{
  reads("%%MatrixMarket matrix coordinate real general\n% a comment\n%\n\n3 4 4\n"
        "1 1 2.718281828459045\n3 2 -1.5e-3\n\n2 4 +7.25\n1 4 .125\n",
        3, 4, (const double[]){2.718281828459045, 0, 0, .125, 0, 0, 0, 7.25, 0, -1.5e-3, 0, 0});
  reads("%%MatrixMarket matrix coordinate integer general\n2 2 2\n1 2 -17\n2 1 4096\n", 2, 2,
        (const double[]){0, -17, 4096, 0});
  reads("%%MatrixMarket matrix coordinate pattern general\n2 3 3\n1 2\n2 1\n2 3\n", 2, 3,
        (const double[]){0, 1, 0, 1, 0, 1});
}

static void symmetric_ones_become_full(void)
{
  const double full[] = {3.5, -2.25, 0, -2.25, 0, 6.125, 0, 6.125, 9};
  reads(
    "%%MatrixMarket matrix coordinate real symmetric\n3 3 4\n1 1 3.5\n2 1 -2.25\n3 2 6.125\n"
    "3 3 9\n",
    3, 3, full);
  reads(
    "%%MatrixMarket matrix coordinate real symmetric\n3 3 4\n1 1 3.5\n1 2 -2.25\n2 3 6.125\n"
    "3 3 9\n",
    3, 3, full);
  reads("%%MatrixMarket matrix coordinate integer symmetric\n2 2 2\n2 2 5\n2 1 -3\n", 2, 2,
        (const double[]){0, -3, -3, 5});
  reads("%%MatrixMarket matrix coordinate pattern symmetric\n3 3 3\n1 1\n3 1\n3 3\n", 3, 3,
        (const double[]){1, 0, 1, 0, 0, 0, 1, 0, 1});
  reads("%%MatrixMarket matrix coordinate real skew-symmetric\n3 3 2\n2 1 4.75\n3 1 -0.5\n", 3,
        3, (const double[]){0, -4.75, 0.5, 4.75, 0, 0, -0.5, 0, 0});
  reads("%%MatrixMarket matrix coordinate real skew-symmetric\n3 3 1\n1 3 2.5\n", 3, 3,
        (const double[]){0, 0, 2.5, 0, 0, 0, -2.5, 0, 0});
}

static void arrays_are_dense(void)
{
  reads("%%MatrixMarket matrix array real general\n2 3\n1.5\n2.5\n-3.5\n4.5\n5.5\n6.5\n", 2, 3,
        (const double[]){1.5, -3.5, 5.5, 2.5, 4.5, 6.5});
  reads("%%MatrixMarket matrix array integer general\n1 2\n-8\n19\n", 1, 2,
        (const double[]){-8, 19});
  reads("%%MatrixMarket matrix array real symmetric\n3 3\n1.25\n2\n3\n4\n5\n6\n", 3, 3,
        (const double[]){1.25, 2, 3, 2, 4, 5, 3, 5, 6});
  reads("%%MatrixMarket matrix array real skew-symmetric\n3 3\n2.5\n3.5\n4.5\n", 3, 3,
        (const double[]){0, -2.5, -3.5, 2.5, 0, -4.5, 3.5, 4.5, 0});
}

static void words_in_any_case_and_foreign_line_ends(void)
{
  reads("%%MatrixMarket MATRIX Coordinate Real General\r\n%x\r\n2 2 2\r\n1 1 1.75\r\n 2\t2  "
        "8.5\r\n",
        2, 2, (const double[]){1.75, 0, 0, 8.5});
  reads("%%MatrixMarket matrix array real general\n1 1\n42.5", 1, 1, (const double[]){42.5});
}

static void duplicates_are_added(void)
{
  reads(
    "%%MatrixMarket matrix coordinate real general\n2 2 4\n2 1 1.5\n1 1 3\n2 1 2.25\n2 1 -8\n",
    2, 2, (const double[]){3, 0, -4.25, 0});
}

static void rows_of_a_column_ascend(void)
{
  steif_context *ctx = steif_context_new(NULL);
  SUNMatrix M = steif_matrix_read(
    ctx, put("order.mtx", "%%MatrixMarket matrix coordinate real general\n5 2 5\n"
                          "5 1 5.5\n1 1 1.5\n3 1 3.5\n4 2 4.5\n2 2 2.5\n"));
  CU_ASSERT_FATAL(M != NULL);
  static const sunindextype rows[] = {0, 2, 4, 1, 3};
  static const double values[] = {1.5, 3.5, 5.5, 2.5, 4.5};
  CHECK(SM_INDEXPTRS_S(M)[1] == 3 && SM_INDEXPTRS_S(M)[2] == 5);
  for (int k = 0; k < 5; k++)
    CHECK(SM_INDEXVALS_S(M)[k] == rows[k] && SM_DATA_S(M)[k] == values[k]);
  SUNMatDestroy(M);
  steif_context_free(&ctx);
}

static void a_matrix_may_be_empty_of_entries(void)
{
  reads("%%MatrixMarket matrix coordinate real general\n3 2 0\n", 3, 2, (const double[6]){0});
  reads("%%MatrixMarket matrix array real skew-symmetric\n1 1\n", 1, 1, (const double[1]){0});
}

/* The second difference of 300000 unknowns: 900000 lines. The limit is far above what is needed
 * (a second), so that it fails for quadratic work only. */
static void large_files_are_read_in_seconds(void)
{
  const long n = 300000;
  const char *path = in_folder("large.mtx");
  FILE *file = fopen(path, "w");
  CU_ASSERT_FATAL(file != NULL);
  fprintf(file, "%%%%MatrixMarket matrix coordinate real general\n%ld %ld %ld\n", n, n,
          3 * n - 2);
  for (long i = 1; i <= n; i++) {
    if (i > 1) fprintf(file, "%ld %ld -1.0625\n", i, i - 1);
    fprintf(file, "%ld %ld %.17g\n", i, i, 2 + 1e-7 * (double)i);
    if (i < n) fprintf(file, "%ld %ld -1.0625\n", i, i + 1);
  }
  fclose(file);
  steif_context *ctx = steif_context_new(NULL);
  const clock_t start = clock();
  SUNMatrix M = steif_matrix_read(ctx, path);
  const double seconds = (double)(clock() - start) / CLOCKS_PER_SEC;
  if (seconds > 20) printf("\n  %g s", seconds);
  CHECK(M && seconds < 20);
  CHECK(M && SM_INDEXPTRS_S(M)[n] == 3 * n - 2);
  CHECK(M && at(M, 123455, 123455) == 2 + 1e-7 * 123456. && at(M, 7, 8) == -1.0625);
  if (M) SUNMatDestroy(M);
  remove(path);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_market[] = {
  {"coordinate files: real, integer, pattern", coordinates},
  {"symmetric and skew-symmetric files become full matrices", symmetric_ones_become_full},
  {"array files become dense matrices", arrays_are_dense},
  {"words in any case, foreign line ends, no last line end",
   words_in_any_case_and_foreign_line_ends},
  {"entries given twice are added", duplicates_are_added},
  {"rows of a column ascend", rows_of_a_column_ascend},
  {"a matrix may be empty of entries", a_matrix_may_be_empty_of_entries},
  {"large files are read in seconds", large_files_are_read_in_seconds},
  CU_TEST_INFO_NULL};
