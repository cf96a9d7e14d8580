/* system_file.c: E and F of a descriptor system from files: two Matrix Market files, or one MATLAB file
 * with E and F, with E and A = -F, with F or A alone (E = I), or with M, D, K and G of a mechanical system
 *   M q'' + D q' + K q + G^T l = f,   G q = g,
 * which becomes, for x = (q, v, l),
 *   q' - v = 0,   M v' + D v + K q + G^T l = f,   G q = g.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "input.h"
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

int stf_input_sized(steif_context *ctx, const char *path, const char *name, SUNMatrix M,
                    sunindextype rows, sunindextype columns, const char *why)
{
  STEIF_CHECK(stf_input_rows(M) == rows && stf_input_columns(M) == columns, ctx,
              STEIF_BAD_INPUT,
              "'%s': %s is %lld x %lld and should be %lld x %lld, %s; correct it", path, name,
              (long long)stf_input_rows(M), (long long)stf_input_columns(M), (long long)rows,
              (long long)columns, why);
  return STEIF_OK;
}

static int pair(steif_context *ctx, const char *path_E, const char *path_F, const char *name_F,
                SUNMatrix E, SUNMatrix F)
{
  const sunindextype n = stf_input_rows(E);
  STEIF_TRY(stf_input_sized(ctx, path_E, "E", E, n, n, "that is, square"));
  return stf_input_sized(ctx, path_F, name_F, F, n, n, "the size of E");
}

/* ---- second order ---------------------------------------------------------------------------- */

/* A sparse matrix built in two passes over the same blocks: the first counts, the second fills. */
typedef struct builder {
  sunindextype *next; /* place of the next entry of each column */
  SUNMatrix M;        /* NULL while counting */
} builder;

static void put(builder *b, sunindextype i, sunindextype j, sunrealtype x)
{
  if (b->M) {
    SM_INDEXVALS_S(b->M)[b->next[j]] = i;
    SM_DATA_S(b->M)[b->next[j]] = x;
  }
  b->next[j]++;
}

/* A block, or its transpose, with its first entry at (row, column); zeros are left out. */
static void block(builder *b, SUNMatrix M, sunindextype row, sunindextype column,
                  bool transposed)
{
  for (sunindextype j = 0; M && j < stf_input_columns(M); j++)
    for (sunindextype k = 0; k < stf_input_column(M, j); k++) {
      sunindextype i;
      sunrealtype x;
      stf_input_entry(M, j, k, &i, &x);
      if (x != 0) put(b, row + (transposed ? j : i), column + (transposed ? i : j), x);
    }
}

enum { MASS, DAMPING, STIFFNESS, CONSTRAINT, PARTS, INPUT = PARTS };
typedef void (*blocks)(builder *b, SUNMatrix *part, sunindextype n);

static void blocks_of_E(builder *b, SUNMatrix *part, sunindextype n)
{
  for (sunindextype j = 0; j < n; j++) put(b, j, j, 1);
  block(b, part[MASS], n, n, false);
}

static void blocks_of_F(builder *b, SUNMatrix *part, sunindextype n)
{
  for (sunindextype j = 0; j < n; j++) put(b, j, n + j, -1);
  block(b, part[STIFFNESS], n, 0, false);
  block(b, part[DAMPING], n, n, false);
  block(b, part[CONSTRAINT], 2 * n, 0, false);
  block(b, part[CONSTRAINT], n, 2 * n, true);
}

static void blocks_of_B(builder *b, SUNMatrix *part, sunindextype n)
{
  block(b, part[INPUT], n, 0, false);
}

static SUNMatrix build(steif_context *ctx, blocks fill, SUNMatrix *part, sunindextype rows,
                       sunindextype size)
{
  const sunindextype n = stf_input_rows(part[MASS]);
  builder b = {stf_allocate(ctx, (size_t)size + 1, sizeof *b.next), NULL};
  if (!b.next) return NULL;
  fill(&b, part, n);
  sunindextype count = 0;
  for (sunindextype j = 0; j <= size; j++) {
    const sunindextype of_column = b.next[j];
    b.next[j] = count;
    count += of_column;
  }
  b.M = SUNSparseMatrix(rows, size, count, CSC_MAT, steif_sundials(ctx));
  if (b.M) {
    memcpy(SM_INDEXPTRS_S(b.M), b.next, ((size_t)size + 1) * sizeof *b.next);
    fill(&b, part, n);
  } else {
    STEIF_FAIL(ctx, STEIF_NO_MEMORY,
               "no memory for a system of %lld unknowns; make the problem "
               "smaller",
               (long long)rows);
  }
  stf_release(ctx, b.next);
  return b.M;
}

static int mechanical(steif_context *ctx, const char *path, SUNMatrix *part, SUNMatrix *E,
                      SUNMatrix *F)
{
  STEIF_CHECK(part[STIFFNESS], ctx, STEIF_BAD_INPUT,
              "'%s' has M and no K; save M, D, K and G, of which D and G may be left out",
              path);
  const sunindextype n = stf_input_rows(part[MASS]);
  STEIF_TRY(stf_input_sized(ctx, path, "M", part[MASS], n, n, "that is, square"));
  STEIF_TRY(stf_input_sized(ctx, path, "K", part[STIFFNESS], n, n, "the size of M"));
  if (part[DAMPING])
    STEIF_TRY(stf_input_sized(ctx, path, "D", part[DAMPING], n, n, "the size of M"));
  const sunindextype m = part[CONSTRAINT] ? stf_input_rows(part[CONSTRAINT]) : 0;
  if (m)
    STEIF_TRY(
      stf_input_sized(ctx, path, "G", part[CONSTRAINT], m, n, "a column for each of M"));
  const sunindextype all = 2 * n + m;
  *E = build(ctx, blocks_of_E, part, all, all);
  *F = *E ? build(ctx, blocks_of_F, part, all, all) : NULL;
  return *F ? STEIF_OK : STEIF_NO_MEMORY;
}

/* ---- files ----------------------------------------------------------------------------------- */

int stf_input_variable(steif_context *ctx, const char *path, const char *name, SUNMatrix *M)
{
  int found = 0;
  steif_forget(ctx);
  *M = steif_matrix_read_mat(ctx, path, name, &found);
  if (!*M && steif_status(ctx) != STEIF_OK) return steif_status(ctx);
  return STEIF_OK;
}

static void negate(SUNMatrix M)
{
  const bool dense = SUNMatGetID(M) == SUNMATRIX_DENSE;
  const sunindextype count = dense ? SM_LDATA_D(M) : SM_INDEXPTRS_S(M)[SM_COLUMNS_S(M)];
  sunrealtype *x = dense ? SM_DATA_D(M) : SM_DATA_S(M);
  for (sunindextype k = 0; k < count; k++) x[k] = -x[k];
}

/* E is there: F, or A with F = -A. */
static int first_order(steif_context *ctx, const char *path, SUNMatrix E, SUNMatrix *F)
{
  SUNMatrix A = NULL;
  STEIF_TRY(stf_input_variable(ctx, path, "F", F));
  const int code = stf_input_variable(ctx, path, "A", &A);
  const bool both = A && *F, negated = A && !*F;
  if (negated) {
    *F = A;
    A = NULL;
  }
  if (A) SUNMatDestroy(A);
  STEIF_TRY(code);
  STEIF_CHECK(!both, ctx, STEIF_BAD_INPUT,
              "'%s' has F and A; leave one out: F of E x' + F x = f, or A of E x' = A x + g",
              path);
  STEIF_CHECK(*F, ctx, STEIF_BAD_INPUT,
              "'%s' has E and neither F nor A; save F of E x' + F x = f beside it", path);
  if (negated) negate(*F);
  return pair(ctx, path, path, negated ? "A" : "F", E, *F);
}

static SUNMatrix identity(steif_context *ctx, sunindextype n, bool dense)
{
  const SUNContext sun = steif_sundials(ctx);
  SUNMatrix one = dense ? SUNDenseMatrix(n, n, sun) : SUNSparseMatrix(n, n, n, CSC_MAT, sun);
  if (!one)
    STEIF_FAIL(ctx, STEIF_NO_MEMORY, "no memory for E = I of %lld unknowns", (long long)n);
  if (one && dense) SUNMatZero(one);
  for (sunindextype j = 0; one && !dense && j <= n; j++) SM_INDEXPTRS_S(one)[j] = j;
  for (sunindextype j = 0; one && j < n; j++) {
    if (!dense) SM_INDEXVALS_S(one)[j] = j;
    *(dense ? &SM_ELEMENT_D(one, j, j) : SM_DATA_S(one) + j) = 1;
  }
  return one;
}

/* x' + F x = f, or x' = A x + f. */
static int without_E(steif_context *ctx, const char *path, SUNMatrix *E, SUNMatrix *F)
{
  SUNMatrix any = NULL;
  STEIF_TRY(stf_input_variable(ctx, path, "A", &any));
  if (!any) STEIF_TRY(stf_input_variable(ctx, path, "F", &any));
  STEIF_CHECK(
    any, ctx, STEIF_BAD_INPUT,
    "'%s' has neither E nor M, A or F; save E and F, E and A, A alone, or M, D, K and G", path);
  *E = identity(ctx, stf_input_rows(any), SUNMatGetID(any) == SUNMATRIX_DENSE);
  SUNMatDestroy(any);
  return *E ? first_order(ctx, path, *E, F) : STEIF_NO_MEMORY;
}

static int second_order(steif_context *ctx, const char *path, SUNMatrix *E, SUNMatrix *F)
{
  static const char *const names[PARTS] = {"M", "D", "K", "G"};
  SUNMatrix part[PARTS] = {NULL};
  int code = STEIF_OK;
  for (int i = 0; i < PARTS && code == STEIF_OK; i++)
    code = stf_input_variable(ctx, path, names[i], part + i);
  if (code == STEIF_OK)
    code = part[MASS] ? mechanical(ctx, path, part, E, F) : without_E(ctx, path, E, F);
  for (int i = 0; i < PARTS; i++)
    if (part[i]) SUNMatDestroy(part[i]);
  return code;
}

static int of_mat(steif_context *ctx, const char *path, SUNMatrix *E, SUNMatrix *F)
{
  STEIF_TRY(stf_input_variable(ctx, path, "E", E));
  return *E ? first_order(ctx, path, *E, F) : second_order(ctx, path, E, F);
}

static int of_market(steif_context *ctx, const char *path_E, const char *path_F, bool negated,
                     SUNMatrix *E, SUNMatrix *F)
{
  *E = steif_matrix_read(ctx, path_E);
  *F = *E ? steif_matrix_read(ctx, path_F) : NULL;
  if (!*F) return steif_status(ctx);
  if (negated) negate(*F);
  return pair(ctx, path_E, path_F, negated ? "A" : "F", *E, *F);
}

/* n equations need n entries: with fewer a row is empty in both, and det(s E + F) = 0, whatever n is. */
static int populated(steif_context *ctx, const char *path, SUNMatrix E, SUNMatrix F)
{
  const sunindextype n = stf_input_columns(E);
  double entries = 0;
  for (sunindextype j = 0; j < n && entries < (double)n; j++)
    entries += (double)stf_input_column(E, j) + (double)stf_input_column(F, j);
  STEIF_CHECK(
    entries >= (double)n, ctx, STEIF_SINGULAR,
    "'%s': E and F have %.0f entries for %lld equations, so that one is empty and the "
    "pencil singular; check the sizes of the matrices",
    path, entries, (long long)n);
  return STEIF_OK;
}

int steif_system_read(steif_context *ctx, const char *path_E, const char *path_F,
                      int state_space, SUNMatrix *E, SUNMatrix *F)
{
  STEIF_CHECK(E && F, ctx, STEIF_BAD_INPUT, "room for E and F is needed, got NULL");
  STEIF_CHECK(path_F || !state_space, ctx, STEIF_BAD_INPUT,
              "'%s' holds both matrices and tells F from A by their names: leave state_space 0",
              path_E ? path_E : "");
  *E = *F = NULL;
  int code =
    path_F ? of_market(ctx, path_E, path_F, state_space, E, F) : of_mat(ctx, path_E, E, F);
  if (code == STEIF_OK) code = populated(ctx, path_E, *E, *F);
  if (code == STEIF_OK) return code;
  if (*E) SUNMatDestroy(*E);
  if (*F) SUNMatDestroy(*F);
  *E = *F = NULL;
  return code;
}

/* ---- inputs ---------------------------------------------------------------------------------- */

/* B in the rows of M q'' of the system in (q, v, l), where there is no E. */
static int lift(steif_context *ctx, const char *path, SUNMatrix *part, SUNMatrix *B)
{
  STEIF_TRY(stf_input_variable(ctx, path, "E", part + MASS));
  if (part[MASS]) return STEIF_OK;
  STEIF_TRY(stf_input_variable(ctx, path, "M", part + MASS));
  if (!part[MASS]) return STEIF_OK;
  STEIF_TRY(stf_input_variable(ctx, path, "G", part + CONSTRAINT));
  const sunindextype n = stf_input_rows(part[MASS]), columns = stf_input_columns(*B);
  STEIF_TRY(stf_input_sized(ctx, path, "B", *B, n, columns, "the rows of M"));
  const sunindextype m = part[CONSTRAINT] ? stf_input_rows(part[CONSTRAINT]) : 0;
  part[INPUT] = *B;
  *B = build(ctx, blocks_of_B, part, 2 * n + m, columns);
  return *B ? STEIF_OK : STEIF_NO_MEMORY;
}

int stf_input_read(steif_context *ctx, const char *path, SUNMatrix *B)
{
  SUNMatrix part[PARTS + 1] = {NULL};
  STEIF_TRY(stf_input_variable(ctx, path, "B", B));
  if (!*B) return STEIF_OK;
  const int code = lift(ctx, path, part, B);
  for (int i = 0; i <= PARTS; i++)
    if (part[i]) SUNMatDestroy(part[i]);
  if (code && *B) SUNMatDestroy(*B);
  if (code) *B = NULL;
  return code;
}
