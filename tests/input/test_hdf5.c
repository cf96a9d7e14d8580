/* test_hdf5.c: matrices from HDF5 files: data sets that steif writes, and files of MATLAB's version 7.3, written here by
 * matio where it can. Where libhdf5 is not installed its absence is said.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fixture.h"
#include <steif/report.h>

static const double E_rows[] = {0, 3.5, 0, 0}, A_rows[] = {-1.5, 2.5, 0, -4},
                    line[] = {1, 2, 3};

/* E, A and a column in a new file; NULL: no libhdf5 here. */
static const char *written(steif_context *ctx)
{
  const steif_array list[] = {
    {"E", 2, 2, E_rows, NULL}, {"A", 2, 2, A_rows, NULL}, {"b", 3, 0, line, NULL}};
  const char *path = in_folder("system.h5");
  const int code = steif_h5_save(ctx, path, 3, list);
  CHECK(code == STEIF_OK || code == STEIF_UNSUPPORTED);
  if (code) SAYS(ctx, "libhdf5");
  return code ? NULL : path;
}

static void data_sets_are_matrices_by_rows(void)
{
  steif_context *ctx = steif_context_new(NULL);
  SUNMatrix E = NULL, F = NULL;
  int found = 1;
  const char *path = written(ctx);
  if (path) {
    CHECK(!steif_system_read(ctx, path, NULL, 0, &E, &F));
    CU_ASSERT_FATAL(E && F);
    CHECK(at(E, 0, 1) == 3.5 && at(E, 1, 0) == 0);
    CHECK(at(F, 0, 0) == 1.5 && at(F, 0, 1) == -2.5 && at(F, 1, 0) == 0 && at(F, 1, 1) == 4);
    SUNMatDestroy(E), SUNMatDestroy(F);
    SUNMatrix b = steif_matrix_read_mat(ctx, path, "b", &found);
    CU_ASSERT_FATAL(b && found);
    CHECK(SM_ROWS_D(b) == 3 && SM_COLUMNS_D(b) == 1 && at(b, 2, 0) == 3);
    SUNMatDestroy(b);
    steif_forget(ctx);
    CHECK(!steif_matrix_read_mat(ctx, path, "none", &found) && !found);
    CHECK(steif_status(ctx) == STEIF_OK);
  }
  steif_context_free(&ctx);
}

/* Cut off anywhere: a sentence, never a part of a matrix. */
static void cut_files_are_refused(void)
{
  static char bytes[65536];
  steif_context *ctx = steif_context_new(NULL);
  const char *path = written(ctx);
  FILE *file = path ? fopen(path, "rb") : NULL;
  const size_t length = file ? fread(bytes, 1, sizeof bytes, file) : 0;
  if (file) fclose(file);
  for (size_t k = 1; k < 8 && length; k++) {
    steif_forget(ctx);
    const size_t part = 8 + (length - 8) * k / 8;
    CHECK(!steif_matrix_read_mat(ctx, put_bytes("cut.h5", bytes, part), "E", NULL));
    SAYS(ctx, "cut off or damaged");
  }
  steif_context_free(&ctx);
}

/* The sizes 2 x 2 replaced by 40000 x 40000: refused by what is in the file, not for want of memory. */
static void claims_are_looked_at(void)
{
  static char bytes[65536];
  const unsigned long long was[] = {2, 2}, claim[] = {40000, 40000};
  steif_context *ctx = steif_context_new(NULL);
  const char *path = written(ctx);
  FILE *file = path ? fopen(path, "rb") : NULL;
  const size_t length = file ? fread(bytes, 1, sizeof bytes, file) : 0;
  int changed = 0;
  if (file) fclose(file);
  for (size_t k = 0; k + sizeof was <= length; k++)
    if (!memcmp(bytes + k, was, sizeof was)) {
      memcpy(bytes + k, claim, sizeof claim);
      changed++;
    }
  CHECK(!length || changed >= 2);
  steif_forget(ctx);
  if (length) {
    CHECK(!steif_matrix_read_mat(ctx, put_bytes("claim.h5", bytes, length), "E", NULL));
    CHECK(steif_status(ctx) == STEIF_BAD_INPUT);
  }
  steif_context_free(&ctx);
}

static void every_allocation_may_fail(void)
{
  failing c = {0};
  const steif_setup setup = failing_setup(&c);
  steif_context *ctx = steif_context_new(&setup);
  const char *path = written(ctx);
  const long owned = c.alive;
  for (long k = 1, more = path != NULL; more; k++) {
    SUNMatrix M;
    steif_forget(ctx);
    c.served = 0, c.refuse_at = k;
    M = steif_matrix_read_mat(ctx, path, "E", NULL);
    more = !M;
    if (M)
      SUNMatDestroy(M);
    else
      CHECK(steif_status(ctx) == STEIF_NO_MEMORY);
    CHECK(c.alive == owned && k < 1000);
  }
  c.refuse_at = 0;
  steif_context_free(&ctx);
  CHECK(c.alive == 0);
}

#ifdef STEIF_HAVE_MATIO
#include <matio.h>

/* [1 0 0; 2 0 -3], full by columns and sparse. */
static void files_of_version_7_3_are_read(void)
{
  double value[] = {1, 2, 0, 0, 0, -3}, entry[] = {1, 2, -3};
  mat_uint32_t row[] = {0, 1, 1}, column[] = {0, 2, 2, 3};
  size_t size[] = {2, 3};
  mat_sparse_t parts = {3, row, 3, column, 4, 3, entry};
  steif_context *ctx = steif_context_new(NULL);
  const char *path = in_folder("new73.mat");
  remove(path);
  mat_t *mat = Mat_CreateVer(path, NULL, MAT_FT_MAT73);
  matvar_t *full = Mat_VarCreate("full", MAT_C_DOUBLE, MAT_T_DOUBLE, 2, size, value, 0);
  matvar_t *few = Mat_VarCreate("few", MAT_C_SPARSE, MAT_T_DOUBLE, 2, size, &parts, 0);
  const bool wrote = mat && !Mat_VarWrite(mat, full, MAT_COMPRESSION_ZLIB) &&
                     !Mat_VarWrite(mat, few, MAT_COMPRESSION_NONE);
  Mat_VarFree(full), Mat_VarFree(few);
  if (mat) Mat_Close(mat);
  for (int k = 0; k < 2 && wrote; k++) {
    SUNMatrix M = steif_matrix_read_mat(ctx, path, k ? "few" : "full", NULL);
    if (!M) printf("\n  %s", steif_message(ctx));
    CU_ASSERT_FATAL(M != NULL);
    CHECK(SUNMatGetID(M) == (k ? SUNMATRIX_SPARSE : SUNMATRIX_DENSE));
    for (int i = 0; i < 2; i++)
      for (int j = 0; j < 3; j++) CHECK(at(M, i, j) == value[i + 2 * j]);
    SUNMatDestroy(M);
  }
  steif_context_free(&ctx);
}
#else
static void files_of_version_7_3_are_read(void) {} /* nothing writes one here */
#endif

CU_TestInfo tests_of_hdf5[] = {
  {"data sets are matrices by rows", data_sets_are_matrices_by_rows},
  {"files that are cut off are refused", cut_files_are_refused},
  {"claims are looked at", claims_are_looked_at},
  {"every allocation may fail", every_allocation_may_fail},
  {"files of MATLAB 7.3", files_of_version_7_3_are_read},
  CU_TEST_INFO_NULL};
