/* test_mat.c: systems from two Matrix Market files and from MATLAB files, written here by matio.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fixture.h"

static const char E_text[] = "%%MatrixMarket matrix coordinate real general\n2 2 1\n1 2 3.5\n",
                  F_text[] = "%%MatrixMarket matrix array real general\n2 2\n1.5\n0\n-2.5\n4\n";

static void two_matrix_market_files_are_a_system(void)
{
  steif_context *ctx = steif_context_new(NULL);
  SUNMatrix E, F;
  CHECK(!steif_system_read(ctx, put("E.mtx", E_text), put("F.mtx", F_text), 0, &E, &F));
  CU_ASSERT_FATAL(E && F);
  CHECK(at(E, 0, 1) == 3.5 && at(E, 0, 0) == 0 && at(F, 0, 1) == -2.5 && at(F, 1, 1) == 4);
  SUNMatDestroy(E), SUNMatDestroy(F);
  CHECK(!steif_system_read(ctx, in_folder("E.mtx"), in_folder("F.mtx"), 1, &E, &F));
  CHECK(E && F && at(E, 0, 1) == 3.5 && at(F, 0, 1) == 2.5 && at(F, 1, 1) == -4); /* F = -A */
  SUNMatDestroy(E), SUNMatDestroy(F);
  CHECK(steif_system_read(ctx, in_folder("E.mat"), NULL, 1, &E, &F) == STEIF_BAD_INPUT);
  SAYS(ctx, "by their names");

  put("F3.mtx", "%%MatrixMarket matrix coordinate real general\n3 2 0\n");
  CHECK(steif_system_read(ctx, in_folder("E.mtx"), in_folder("F3.mtx"), 0, &E, &F) ==
        STEIF_BAD_INPUT);
  SAYS(ctx, "F is 3 x 2 and should be 2 x 2, the size of E");
  CHECK(!E && !F);
  CHECK(steif_system_read(ctx, in_folder("F3.mtx"), in_folder("E.mtx"), 0, &E, &F) ==
        STEIF_BAD_INPUT);
  SAYS(ctx, "E is 3 x 2 and should be 3 x 3, that is, square");
  CHECK(steif_system_read(ctx, in_folder("E.mtx"), in_folder("F4.mtx"), 0, &E, &F) == STEIF_IO);
  SAYS(ctx, "F4.mtx");
  CHECK(!E && !F);
  put("E5.mtx", "%%MatrixMarket matrix coordinate real general\n200000 200000 1\n1 1 2\n");
  CHECK(steif_system_read(ctx, in_folder("E5.mtx"), in_folder("E5.mtx"), 0, &E, &F) ==
        STEIF_SINGULAR);
  SAYS(ctx, "have 2 entries for 200000 equations");
  put("E6.mtx", "%%MatrixMarket matrix coordinate real general\n1 100000000 1\n1 1 2\n");
  CHECK(!steif_matrix_read(ctx, in_folder("E6.mtx")) && steif_status(ctx) == STEIF_BAD_INPUT);
  SAYS(ctx, "1 x 100000000 with 1 entries in all");
  CHECK(steif_system_read(ctx, NULL, in_folder("E.mtx"), 0, &E, &F) == STEIF_BAD_INPUT);
  CHECK(steif_system_read(ctx, in_folder("E.mtx"), in_folder("F.mtx"), 0, NULL, &F) ==
        STEIF_BAD_INPUT);
  steif_context_free(&ctx);
}

#ifdef STEIF_HAVE_MATIO
#include <matio.h>

/* A variable: kind 'd' double, 'f' single, 'i' 16-bit integers, 's' sparse, 'c' complex, 't' text. */
typedef struct variable {
  const char *name;
  char kind;
  size_t rows, columns;
  double value[16]; /* by columns */
} variable;

static matvar_t *sparse_variable(const variable *v, size_t *dims)
{
  mat_uint32_t row[16], column[17] = {0}, used = 0;
  double value[16];
  for (size_t j = 0; j < v->columns; j++) {
    for (size_t i = 0; i < v->rows; i++)
      if (v->value[j * v->rows + i] != 0)
        row[used] = (mat_uint32_t)i, value[used++] = v->value[j * v->rows + i];
    column[j + 1] = used;
  }
  mat_sparse_t s = {.nzmax = used,
                    .ir = row,
                    .nir = used,
                    .jc = column,
                    .njc = (mat_uint32_t)v->columns + 1,
                    .ndata = used,
                    .data = value};
  return Mat_VarCreate(v->name, MAT_C_SPARSE, MAT_T_DOUBLE, 2, dims, &s, 0);
}

static matvar_t *create(const variable *v)
{
  size_t dims[2] = {v->rows, v->columns};
  double copy[16];
  float single[16];
  int16_t integer[16];
  for (int k = 0; k < 16; k++)
    copy[k] = v->value[k], single[k] = (float)v->value[k],
    integer[k] = (int16_t)(v->kind == 'i' ? v->value[k] : 0);
  mat_complex_split_t parts = {copy, copy};
  switch (v->kind) {
  case 's': return sparse_variable(v, dims);
  case 'f': return Mat_VarCreate(v->name, MAT_C_SINGLE, MAT_T_SINGLE, 2, dims, single, 0);
  case 'i': return Mat_VarCreate(v->name, MAT_C_INT16, MAT_T_INT16, 2, dims, integer, 0);
  case 'c':
    return Mat_VarCreate(v->name, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, dims, &parts, MAT_F_COMPLEX);
  case 't': return Mat_VarCreate(v->name, MAT_C_CHAR, MAT_T_UINT8, 2, dims, copy, 0);
  default: return Mat_VarCreate(v->name, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, dims, copy, 0);
  }
}

static const char *mat_file(int count, const variable *list)
{
  const char *path = in_folder("system.mat");
  remove(path);
  mat_t *mat = Mat_CreateVer(path, NULL, MAT_FT_MAT5);
  CU_ASSERT_FATAL(mat != NULL);
  for (int i = 0; i < count; i++) {
    matvar_t *v = create(list + i);
    CHECK(v && !Mat_VarWrite(mat, v, i % 2 ? MAT_COMPRESSION_ZLIB : MAT_COMPRESSION_NONE));
    Mat_VarFree(v);
  }
  Mat_Close(mat);
  return path;
}

static void variables_of_every_type_are_read(void)
{
  static const variable list[] = {{"full", 'd', 2, 3, {1.5, -2.25, 0, 4, 1e-300, 6.75}},
                                  {"thin", 's', 3, 2, {0, 2.5, -7, 1e10, 0, 0.1}},
                                  {"single", 'f', 1, 2, {0.5, -3.25}},
                                  {"whole", 'i', 2, 1, {-300, 17}}};
  steif_context *ctx = steif_context_new(NULL);
  const char *path = mat_file(4, list);
  for (int v = 0; v < 4; v++) {
    int found = -1;
    SUNMatrix M = steif_matrix_read_mat(ctx, path, list[v].name, &found);
    CHECK(M && found == 1);
    if (!M) printf("\n  %s", steif_message(ctx));
    if (!M) continue;
    CHECK(SUNMatGetID(M) == (v == 1 ? SUNMATRIX_SPARSE : SUNMATRIX_DENSE));
    for (size_t i = 0; i < list[v].rows; i++)
      for (size_t j = 0; j < list[v].columns; j++)
        CHECK(at(M, (sunindextype)i, (sunindextype)j) == list[v].value[j * list[v].rows + i]);
    SUNMatDestroy(M);
  }
  int found = -1;
  steif_forget(ctx);
  CHECK(!steif_matrix_read_mat(ctx, path, "absent", &found) && found == 0);
  CHECK(steif_status(ctx) == STEIF_OK);
  CHECK(!steif_matrix_read_mat(ctx, path, "", &found) && steif_status(ctx) == STEIF_BAD_INPUT);
  steif_context_free(&ctx);
}

static void what_is_no_real_matrix_is_rejected(void)
{
  static const variable list[] = {{"z", 'c', 2, 2, {1.5, 2, 3, 4}},
                                  {"word", 't', 1, 3, {0}},
                                  {"none", 'd', 0, 3, {0}},
                                  {"bad", 'd', 2, 1, {3.5, NAN}}};
  static const int codes[] = {STEIF_UNSUPPORTED, STEIF_BAD_INPUT, STEIF_BAD_INPUT,
                              STEIF_NOT_FINITE};
  static const char *const words[] = {"z is complex", "word is no matrix of numbers",
                                      "none is empty, 0 x 3", "variable bad: entry (2, 1) is"};
  steif_context *ctx = steif_context_new(NULL);
  const char *path = mat_file(4, list);
  for (int v = 0; v < 4; v++) {
    CHECK(!steif_matrix_read_mat(ctx, path, list[v].name, NULL));
    CHECK(steif_status(ctx) == codes[v]);
    SAYS(ctx, words[v]);
  }
  CHECK(!steif_matrix_read_mat(ctx, put("text.mat", "no MATLAB file"), "E", NULL));
  SAYS(ctx, "is no MATLAB file of version 5; save it");
  char head[512] = "MATLAB 7.3 MAT-file";
  memcpy(head + 124, "\0\2IM", 4);
  CHECK(!steif_matrix_read_mat(ctx, put_bytes("new.mat", head, sizeof head), "E", NULL));
  SAYS(ctx, "but of version 7.3; save it with '-v7'");
  CHECK(!steif_matrix_read_mat(ctx, in_folder("gone.mat"), "E", NULL));
  CHECK(steif_status(ctx) == STEIF_IO);
  steif_context_free(&ctx);
}

/* A file cut off anywhere is rejected, or its variable is not found: it is never read in part. */
static void cut_files_give_no_matrix(void)
{
  static const variable list[] = {{"E", 's', 2, 2, {0, 2.5, -7, 1e10}}};
  static char bytes[4096];
  steif_context *ctx = steif_context_new(NULL);
  FILE *file = fopen(mat_file(1, list), "r");
  const size_t size = fread(bytes, 1, sizeof bytes, file);
  fclose(file);
  CHECK(size > 200);
  for (size_t cut = 0; cut + 8 < size; cut += 4)
    CHECK(!steif_matrix_read_mat(ctx, put_bytes("cut.mat", bytes, cut), "E", NULL));
  steif_context_free(&ctx);
}

static void E_with_F_or_A_is_a_system(void)
{
  const variable E = {"E", 's', 2, 2, {1.5, 0, 0, 2.5}}, F = {"F", 'd', 2, 2, {1, 2, 3, 4.5}},
                 A = {"A", 's', 2, 2, {0, -2, 0, 4.5}}, small = {"F", 'd', 1, 1, {1}},
                 other = {"H", 'd', 1, 1, {1}};
  steif_context *ctx = steif_context_new(NULL);
  SUNMatrix e, f;
  CHECK(!steif_system_read(ctx, mat_file(2, (const variable[]){E, F}), NULL, 0, &e, &f));
  CU_ASSERT_FATAL(e && f);
  CHECK(at(e, 1, 1) == 2.5 && at(f, 1, 0) == 2 && at(f, 0, 1) == 3);
  SUNMatDestroy(e), SUNMatDestroy(f);
  CHECK(!steif_system_read(ctx, mat_file(2, (const variable[]){E, A}), NULL, 0, &e, &f));
  CU_ASSERT_FATAL(e && f);
  CHECK(at(f, 1, 0) == 2 && at(f, 1, 1) == -4.5 && at(f, 0, 1) == 0);
  SUNMatDestroy(e), SUNMatDestroy(f);
  const struct {
    variable list[3];
    int count;
    const char *words;
  } bad[] = {{{E, F, A}, 3, "has F and A; leave one out"},
             {{E}, 1, "has E and neither F nor A"},
             {{F, A}, 2, "has F and A; leave one out"},
             {{other}, 1, "has neither E nor M, A or F"},
             {{E, small}, 2, "F is 1 x 1 and should be 2 x 2"}};
  for (int i = 0; i < 5; i++) {
    CHECK(steif_system_read(ctx, mat_file(bad[i].count, bad[i].list), NULL, 0, &e, &f) ==
          STEIF_BAD_INPUT);
    SAYS(ctx, bad[i].words);
    CHECK(!e && !f);
  }
  steif_context_free(&ctx);
}

static void A_or_F_alone_has_the_identity_as_E(void)
{
  const variable F = {"F", 'd', 2, 2, {1, 2, 3, 4.5}}, A = {"A", 's', 2, 2, {0, -2, 0, 4.5}},
                 wide = {"A", 'd', 1, 2, {1, 2}};
  steif_context *ctx = steif_context_new(NULL);
  SUNMatrix e, f;
  for (int k = 0; k < 2; k++) {
    CHECK(!steif_system_read(ctx, mat_file(1, k ? &A : &F), NULL, 0, &e, &f));
    CU_ASSERT_FATAL(e && f);
    CHECK(at(e, 0, 0) == 1 && at(e, 1, 1) == 1 && at(e, 0, 1) == 0 && at(e, 1, 0) == 0);
    CHECK(at(f, 1, 0) == 2 && at(f, 1, 1) == (k ? -4.5 : 4.5));
    SUNMatDestroy(e), SUNMatDestroy(f);
  }
  CHECK(steif_system_read(ctx, mat_file(1, &wide), NULL, 0, &e, &f) == STEIF_BAD_INPUT);
  SAYS(ctx, "A is 1 x 2");
  CHECK(!e && !f);
  steif_context_free(&ctx);
}

/* M q'' + D q' + K q + G^T l = f, G q = g with two positions and one constraint, x = (q, v, l). */
static void second_order_systems_become_first_order(void)
{
  const variable M = {"M", 's', 2, 2, {3.5, 0, 0.25, 4.5}},
                 D = {"D", 'd', 2, 2, {0.5, 0, 0, 0.75}}, K = {"K", 'd', 2, 2, {7, -6, -5, 9}},
                 G = {"G", 's', 1, 2, {2.25, -8}}, wide = {"G", 'd', 1, 3, {1, 2, 3}};
  static const double E_expected[] = {1,   0, 0, 0, 0, 0,   1, 0, 0, 0, 0, 0, 3.5,
                                      .25, 0, 0, 0, 0, 4.5, 0, 0, 0, 0, 0, 0},
                      F_expected[] = {0, 0,    -1, 0, 0, 0,   0,  0,    -1, 0, 7, -5, .5,
                                      0, 2.25, -6, 9, 0, .75, -8, 2.25, -8, 0, 0, 0};
  steif_context *ctx = steif_context_new(NULL);
  SUNMatrix e, f;
  CHECK(!steif_system_read(ctx, mat_file(4, (const variable[]){M, D, K, G}), NULL, 0, &e, &f));
  CU_ASSERT_FATAL(e && f);
  CHECK(SM_ROWS_S(e) == 5 && SM_COLUMNS_S(f) == 5 && SM_INDEXPTRS_S(e)[5] == 5);
  for (int i = 0; i < 5; i++)
    for (int j = 0; j < 5; j++) {
      CHECK(at(e, i, j) == E_expected[5 * i + j]);
      CHECK(at(f, i, j) == F_expected[5 * i + j]);
    }
  for (int k = 0; k < SM_INDEXPTRS_S(f)[5] - 1; k++)
    for (int j = 0; j < 5; j++)
      if (k >= SM_INDEXPTRS_S(f)[j] && k + 1 < SM_INDEXPTRS_S(f)[j + 1])
        CHECK(SM_INDEXVALS_S(f)[k] < SM_INDEXVALS_S(f)[k + 1]);
  SUNMatDestroy(e), SUNMatDestroy(f);
  CHECK(!steif_system_read(ctx, mat_file(2, (const variable[]){M, K}), NULL, 0, &e, &f));
  CU_ASSERT_FATAL(e && f);
  CHECK(SM_ROWS_S(e) == 4 && at(f, 2, 2) == 0 && at(f, 2, 1) == -5);
  SUNMatDestroy(e), SUNMatDestroy(f);
  CHECK(steif_system_read(ctx, mat_file(2, (const variable[]){M, D}), NULL, 0, &e, &f));
  SAYS(ctx, "has M and no K");
  CHECK(steif_system_read(ctx, mat_file(3, (const variable[]){M, K, wide}), NULL, 0, &e, &f));
  SAYS(ctx, "G is 1 x 3 and should be 1 x 2");
  steif_context_free(&ctx);
}

/* B of E x' + F x = B u as it is, of M q'' + ... = B u in the rows of v. */
static void inputs_are_found_beside_systems(void)
{
  const variable E = {"E", 'd', 2, 2, {1, 0, 0, 1}}, M = {"M", 'd', 2, 2, {3.5, 0, 0, 4.5}},
                 G = {"G", 's', 1, 2, {2.25, -8}}, B = {"B", 'd', 2, 1, {-1.5, 6.25}},
                 tall = {"B", 's', 3, 1, {1, 0, 2}};
  steif_context *ctx = steif_context_new(NULL);
  SUNMatrix b;
  CHECK(
    !steif_input_output_read(ctx, mat_file(3, (const variable[]){E, B, M}), &b, NULL, NULL));
  CU_ASSERT_FATAL(b != NULL);
  CHECK(SM_ROWS_D(b) == 2 && at(b, 0, 0) == -1.5 && at(b, 1, 0) == 6.25);
  SUNMatDestroy(b);
  CHECK(
    !steif_input_output_read(ctx, mat_file(3, (const variable[]){M, G, B}), &b, NULL, NULL));
  CU_ASSERT_FATAL(b != NULL);
  CHECK(SM_ROWS_S(b) == 5 && SM_COLUMNS_S(b) == 1);
  for (int i = 0; i < 5; i++) CHECK(at(b, i, 0) == (i == 2 ? -1.5 : i == 3 ? 6.25 : 0));
  SUNMatDestroy(b);
  CHECK(!steif_input_output_read(ctx, mat_file(2, (const variable[]){M, G}), &b, NULL, NULL) &&
        !b);
  CHECK(steif_input_output_read(ctx, mat_file(2, (const variable[]){M, tall}), &b, NULL,
                                NULL) == STEIF_BAD_INPUT);
  SAYS(ctx, "B is 3 x 1 and should be 2 x 1, the rows of M");
  CHECK(!b && steif_input_output_read(ctx, in_folder("no.mat"), &b, NULL, NULL));
  steif_context_free(&ctx);
}

/* C and D of y = C x + D u, checked against E and B; beside M the name D is the damping's. */
static void outputs_are_found_beside_systems(void)
{
  const variable E = {"E", 'd', 2, 2, {1, 0, 0, 1}}, M = {"M", 'd', 2, 2, {3.5, 0, 0, 4.5}},
                 B = {"B", 'd', 2, 1, {-1.5, 6.25}}, C = {"C", 's', 1, 2, {2.5, -3}},
                 D = {"D", 'd', 1, 1, {0.75}}, wide = {"C", 'd', 1, 3, {1, 2, 3}},
                 square = {"D", 'd', 1, 2, {7, 8}};
  const double x[2] = {4, 5}, u[1] = {8};
  double y[1];
  steif_context *ctx = steif_context_new(NULL);
  SUNMatrix c, d;
  CHECK(
    !steif_input_output_read(ctx, mat_file(4, (const variable[]){E, B, C, D}), NULL, &c, &d));
  CU_ASSERT_FATAL(c && d);
  steif_output_value(c, d, x, u, y);
  CHECK(y[0] == 2.5 * 4 - 3 * 5 + 0.75 * 8);
  steif_output_value(c, NULL, x, NULL, y);
  CHECK(y[0] == -5);
  SUNMatDestroy(c), SUNMatDestroy(d);
  CHECK(!steif_input_output_read(ctx, mat_file(2, (const variable[]){M, C}), NULL, &c, &d) &&
        c && !d);
  SUNMatDestroy(c);
  CHECK(!steif_input_output_read(ctx, mat_file(2, (const variable[]){E, B}), NULL, &c, &d) &&
        !c && !d);
  CHECK(steif_input_output_read(ctx, mat_file(2, (const variable[]){E, wide}), NULL, &c, &d));
  SAYS(ctx, "C is 1 x 3 and should be 1 x 2, a column for each of E");
  CHECK(steif_input_output_read(ctx, mat_file(2, (const variable[]){M, wide}), NULL, &c, &d));
  SAYS(ctx, "should be 1 x 4, a column for each of q, or of q, v and the multipliers");
  CHECK(steif_input_output_read(ctx, mat_file(4, (const variable[]){E, B, C, square}), NULL, &c,
                                &d));
  SAYS(ctx, "D is 1 x 2 and should be 1 x 1, the rows of C and the columns of B");
  CHECK(!c && !d);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_mat[] = {
  {"two Matrix Market files are a system", two_matrix_market_files_are_a_system},
  {"B of an input is found beside its system", inputs_are_found_beside_systems},
  {"outputs are found beside systems", outputs_are_found_beside_systems},
  {"variables of every type are read", variables_of_every_type_are_read},
  {"what is no real matrix is rejected", what_is_no_real_matrix_is_rejected},
  {"files that are cut off give no matrix", cut_files_give_no_matrix},
  {"E with F, or with A = -F, is a system", E_with_F_or_A_is_a_system},
  {"A or F alone has E = I", A_or_F_alone_has_the_identity_as_E},
  {"second order systems become first order", second_order_systems_become_first_order},
  CU_TEST_INFO_NULL};

#else

static void without_matio_it_is_said(void)
{
  steif_context *ctx = steif_context_new(NULL);
  SUNMatrix E, F;
  int found = -1;
  CHECK(!steif_matrix_read_mat(ctx, "s.mat", "E", &found) && found == 0);
  CHECK(steif_status(ctx) == STEIF_UNSUPPORTED);
  SAYS(ctx, "libmatio-dev");
  CHECK(steif_system_read(ctx, "s.mat", NULL, 0, &E, &F) == STEIF_UNSUPPORTED);
  CHECK(!E && !F);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_mat[] = {
  {"two Matrix Market files are a system", two_matrix_market_files_are_a_system},
  {"without matio its absence is said", without_matio_it_is_said},
  CU_TEST_INFO_NULL};

#endif
