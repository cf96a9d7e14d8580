/* test_names.c: names of equations and unknowns, from lines of a text and from MATLAB files.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fixture.h"

static void rejected(steif_context *ctx, const char *text, sunindextype n, const char *words)
{
  steif_names *names;
  CHECK(steif_names_read(ctx, put("names.txt", text), n, &names) == STEIF_BAD_INPUT && !names);
  SAYS(ctx, words);
}

static void lines_name_unknowns_and_equations(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_names *names;
  CHECK(!steif_names_read(
    ctx, put("names.txt", "# a circuit\n v1 , current at a\r\n\nv 2,loop #x"), 2, &names));
  CU_ASSERT_FATAL(names != NULL);
  CHECK(!strcmp(names->unknown[0], "v1") && !strcmp(names->unknown[1], "v 2"));
  CHECK(!strcmp(names->equation[0], "current at a") && !strcmp(names->equation[1], "loop"));
  steif_names_free(&names);
  CHECK(!names);
  CHECK(!steif_names_read(ctx, put("names.txt", "p\nq\nr\n"), 3, &names));
  CHECK(names && !names->equation && !strcmp(names->unknown[2], "r"));
  steif_names_free(&names);
  rejected(ctx, "p\nq\n", 3, "names.txt ends at line 2 after 2 of 3 names");
  rejected(ctx, "p\nq\nr\n", 2, "names.txt, line 3: more than 2 names");
  rejected(ctx, "p\n, q\n", 2, "names.txt, line 2: expected UNKNOWN or UNKNOWN, EQUATION");
  rejected(ctx, "p, a\nq\n", 2,
           "names.txt, line 2: no equation where the lines before have one");
  rejected(ctx, "p\nq\np\n", 3, "calls two unknowns 'p'");
  CHECK(steif_names_read(ctx, in_folder("absent.txt"), 2, &names) == STEIF_IO && !names);
  steif_context_free(&ctx);
}

static void memory_may_fail(void)
{
  const char *path = put("names.txt", "p, a\nq, b\nr, c\n");
  for (long k = 1;; k++) {
    failing c = {.refuse_at = k};
    const steif_setup setup = failing_setup(&c);
    steif_context *ctx = steif_context_new(&setup);
    steif_names *names = NULL;
    const int code = ctx ? steif_names_read(ctx, path, 3, &names) : STEIF_NO_MEMORY;
    CHECK(code ? code == STEIF_NO_MEMORY && !names : names != NULL);
    steif_names_free(&names);
    steif_context_free(&ctx);
    CHECK(c.alive == 0);
    if (!code) break;
  }
}

#ifdef STEIF_HAVE_MATIO
#include <matio.h>

static void add(mat_t *mat, matvar_t *v)
{
  CHECK(v && !Mat_VarWrite(mat, v, MAT_COMPRESSION_NONE));
  Mat_VarFree(v);
}

static matvar_t *text_of(const char *name, const char *given)
{
  char text[32];
  snprintf(text, sizeof text, "%s", given);
  size_t dims[2] = {1, strlen(text)};
  return Mat_VarCreate(name, MAT_C_CHAR, MAT_T_UINT8, 2, dims, text, 0);
}

static void add_matrix(mat_t *mat, const char *name, size_t rows, size_t columns)
{
  double x[9] = {1.5, 2.5, -3.5, 4.5, 5.5, 6.5, 7.5, 8.5, 9.5};
  size_t dims[2] = {rows, columns};
  add(mat, Mat_VarCreate(name, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, dims, x, 0));
}

static void add_cells(mat_t *mat, const char *name, size_t count, const char *const *text)
{
  matvar_t *cell[3] = {NULL};
  size_t dims[2] = {1, count};
  for (size_t i = 0; i < count; i++) cell[i] = text_of(NULL, text[i]);
  add(mat, Mat_VarCreate(name, MAT_C_CELL, MAT_T_CELL, 2, dims, cell, 0));
}

static mat_t *create(void)
{
  remove(in_folder("named.mat"));
  mat_t *mat = Mat_CreateVer(in_folder("named.mat"), NULL, MAT_FT_MAT5);
  CU_ASSERT_FATAL(mat != NULL);
  return mat;
}

static void cells_and_characters_are_names(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_names *names;
  size_t dims[2] = {2, 3};
  mat_t *mat = create();
  add_matrix(mat, "E", 2, 2);
  add_cells(mat, "equations", 2, (const char *const[]){"mass balance", "wall"});
  add(mat, Mat_VarCreate("unknowns", MAT_C_CHAR, MAT_T_UINT8, 2, dims, "phx y ", 0));
  Mat_Close(mat);
  CHECK(!steif_names_read(ctx, in_folder("named.mat"), 2, &names));
  CU_ASSERT_FATAL(names && names->equation && names->unknown);
  CHECK(!strcmp(names->unknown[0], "pxy") && !strcmp(names->unknown[1], "h"));
  CHECK(!strcmp(names->equation[0], "mass balance") && !strcmp(names->equation[1], "wall"));
  steif_names_free(&names);
  CHECK(steif_names_read(ctx, in_folder("named.mat"), 3, &names) == STEIF_BAD_INPUT);
  SAYS(ctx, "unknowns has 2 names for 3 unknowns");
  mat = create();
  add_matrix(mat, "E", 2, 2);
  Mat_Close(mat);
  CHECK(!steif_names_read(ctx, in_folder("named.mat"), 2, &names) && !names);
  mat = create();
  add_matrix(mat, "unknowns", 2, 2);
  Mat_Close(mat);
  CHECK(steif_names_read(ctx, in_folder("named.mat"), 2, &names) == STEIF_BAD_INPUT);
  SAYS(ctx, "unknowns is neither a cell array of texts nor a character array");
  steif_context_free(&ctx);
}

/* (q, v, l) of M q'' + K q + G^T l = f, G q = g is called after q. */
static void mechanical_systems_are_named_after_q(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_names *names;
  for (int named = 0; named < 2; named++) {
    mat_t *mat = create();
    add_matrix(mat, "M", 2, 2), add_matrix(mat, "K", 2, 2), add_matrix(mat, "G", 1, 2);
    if (named) add_cells(mat, "unknowns", 2, (const char *const[]){"crank", "rod"});
    Mat_Close(mat);
    CHECK(!steif_names_read(ctx, in_folder("named.mat"), 5, &names));
    CU_ASSERT_FATAL(names && names->equation && names->unknown);
    CHECK(!strcmp(names->unknown[1], named ? "rod" : "q2"));
    CHECK(!strcmp(names->unknown[3], named ? "rod'" : "v2"));
    CHECK(!strcmp(names->equation[2], named ? "motion of crank" : "motion 1"));
    CHECK(!strcmp(names->unknown[4], "l1") && !strcmp(names->equation[4], "constraint 1"));
    steif_names_free(&names);
  }
  steif_context_free(&ctx);
}
#endif

CU_TestInfo tests_of_names[] = {
  {"lines name unknowns and equations", lines_name_unknowns_and_equations},
  {"every allocation may fail", memory_may_fail},
#ifdef STEIF_HAVE_MATIO
  {"cell and character arrays are names", cells_and_characters_are_names},
  {"mechanical systems are named after q", mechanical_systems_are_named_after_q},
#endif
  CU_TEST_INFO_NULL};
