/* test_sparse.c: one analysis, refactorisation, the growth check, changing patterns.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "gear.h"
#include "pencil.h"
#include "suite.h"
#include <string.h>

enum { N = 40 };

static gear g;
static steif_context *ctx;
static SUNMatrix E, A;
static steif_pencil *p;
static const steif_pencil_stats *stats;

static void begin(bool identity)
{
  gear_fill(&g, N, identity, 60221u);
  ctx = steif_context_new(NULL);
  SUNContext sun = steif_sundials(ctx);
  E = identity ? NULL : gear_matrix(g.E, N, SUNMATRIX_SPARSE, sun);
  A = gear_matrix(g.A, N, SUNMATRIX_SPARSE, sun);
  p = steif_pencil_new(ctx, E, A);
  stats = steif_pencil_statistics(p);
}

static void end(void)
{
  steif_pencil_free(&p);
  if (E) SUNMatDestroy(E);
  SUNMatDestroy(A);
  steif_context_free(&ctx);
}

static bool says(const char *what)
{
  const bool found = strstr(steif_message(ctx), what) != NULL;
  if (!found) printf("\n  \"%s\" lacks \"%s\"", steif_message(ctx), what);
  return found;
}

/* The residual of a solve of q with slot k and shift s; the solution in x when not NULL. */
static double residual(steif_pencil *q, int k, steif_shift s, double *x)
{
  SUNContext sun = steif_sundials(ctx);
  N_Vector re = gear_vector(N, 41, sun), im = gear_vector(N, 42, sun);
  N_Vector br = gear_vector(N, 41, sun), bi = gear_vector(N, 42, sun);
  CHECK(steif_pencil_solve(q, k, 1, &re, &im) == STEIF_OK);
  const double r =
    gear_residual(&g, s, NV_DATA_S(re), NV_DATA_S(im), NV_DATA_S(br), NV_DATA_S(bi));
  for (int i = 0; x && i < N; i++) x[i] = NV_Ith_S(re, i), x[N + i] = NV_Ith_S(im, i);
  N_VDestroy(re), N_VDestroy(im), N_VDestroy(br), N_VDestroy(bi);
  return r;
}

static void one_analysis(void)
{
  begin(false);
  for (int round = 0; round < 9; round++) {
    steif_shift s[7];
    for (int k = 0; k < 7; k++)
      s[k] = (steif_shift){2.3 + 0.7 * k + 0.1 * round, k % 2 ? 0.6 * k : 0};
    CHECK(steif_pencil_update(p) == STEIF_OK);
    CHECK(steif_pencil_factor(p, 7, s) == STEIF_OK);
    for (int k = 0; k < 7; k++) CHECK(residual(p, k, s[k], NULL) < 1e-14);
  }
  CHECK(stats->analyses == 1);
  CHECK(stats->factors == 7 + stats->fallbacks);
  CHECK(stats->factors + stats->refactors == 63);
  CHECK(stats->refactors >= 50);
  CHECK(stats->fill >= 4 * N && stats->fill <= N * N);
  end();
}

static void refactor_is_factor(void)
{
  begin(false);
  const steif_shift before[2] = {{3.1, 0}, {2.2, 5.7}}, after[2] = {{3.7, 0}, {2.9, 4.1}};
  CHECK(steif_pencil_factor(p, 2, before) == STEIF_OK);
  CHECK(stats->factors == 2 && stats->refactors == 0);
  CHECK(steif_pencil_factor(p, 2, after) == STEIF_OK);
  CHECK(stats->factors == 2 && stats->refactors == 2 && stats->fallbacks == 0);
  steif_pencil *q = steif_pencil_new(ctx, E, A);
  CHECK(steif_pencil_factor(q, 2, after) == STEIF_OK);
  for (int k = 0; k < 2; k++) {
    double x[2 * N], y[2 * N];
    CHECK(residual(p, k, after[k], x) < 1e-14 && residual(q, k, after[k], y) < 1e-14);
    for (int i = 0; i < 2 * N; i++) CLOSE_FLOOR(x[i], y[i], 1e-13, 1);
  }
  steif_pencil_free(&q);
  end();
}

/* The diagonal of s I - A, of size 3 at the first factorisation, becomes 1e-12: with the old pivots
 * the growth is 1e12 and four digits would be left. */
static void growth(void)
{
  const steif_shift s[2] = {{1.5, 0}, {1.5, 1e-12}};
  begin(true);
  CHECK(steif_pencil_factor(p, 2, s) == STEIF_OK && stats->factors == 2);
  for (int i = 0; i < N; i++) g.A[i + N * i] = 1.5 - 1e-12;
  gear_copy(g.A, N, A);
  CHECK(steif_pencil_update(p) == STEIF_OK);
  CHECK(steif_pencil_factor(p, 2, s) == STEIF_OK);
  CHECK(stats->fallbacks == 2 && stats->factors == 4 && stats->refactors == 0);
  for (int k = 0; k < 2; k++) CHECK(residual(p, k, s[k], NULL) < 1e-14);
  end();
}

/* Exactly zero pivots on the diagonal, where nothing grows: KLU itself gives up. */
static void vanished_pivot(void)
{
  const steif_shift s = {0.5, 0};
  begin(true);
  CHECK(steif_pencil_factor(p, 1, &s) == STEIF_OK);
  for (int i = 0; i < N; i++) g.A[i + N * i] = 0.5;
  gear_copy(g.A, N, A);
  CHECK(steif_pencil_update(p) == STEIF_OK && steif_pencil_factor(p, 1, &s) == STEIF_OK);
  CHECK(stats->fallbacks == 1 && residual(p, 0, s, NULL) < 1e-14);
  end();
}

static void pattern_changes(void)
{
  const steif_shift s[2] = {{4.25, 0}, {1.5, 2.5}};
  begin(false);
  CHECK(steif_pencil_factor(p, 2, s) == STEIF_OK && stats->analyses == 1);
  /* An entry moves within its column: pointers stay, a row changes. */
  sunindextype *row = SM_INDEXVALS_S(A) + SM_INDEXPTRS_S(A)[11];
  g.A[29 + N * 11] = g.A[*row + N * 11], g.A[*row + N * 11] = 0;
  *row = 29;
  CHECK(steif_pencil_update(p) == STEIF_OK && stats->analyses == 2);
  CHECK(steif_pencil_factor(p, 2, s) == STEIF_OK);
  for (int k = 0; k < 2; k++) CHECK(residual(p, k, s[k], NULL) < 1e-14);
  /* A new entry in E. */
  g.E[36 + N * 2] = 0.77;
  SUNMatrix more = gear_matrix(g.E, N, SUNMATRIX_SPARSE, steif_sundials(ctx));
  SUNMatCopy(more, E);
  SUNMatDestroy(more);
  CHECK(steif_pencil_update(p) == STEIF_OK && stats->analyses == 3);
  CHECK(steif_pencil_factor(p, 2, s) == STEIF_OK && stats->refactors == 0);
  for (int k = 0; k < 2; k++) CHECK(residual(p, k, s[k], NULL) < 1e-14);
  end();
}

static void filled_later(void)
{
  const steif_shift s = {2.125, -1.5};
  begin(true);
  SUNMatrix late = SUNSparseMatrix(N, N, N * N, CSC_MAT, steif_sundials(ctx));
  steif_pencil *q = steif_pencil_new(ctx, NULL, late);
  CHECK(q != NULL);
  SUNMatCopy(A, late);
  CHECK(steif_pencil_update(q) == STEIF_OK && steif_pencil_factor(q, 1, &s) == STEIF_OK);
  CHECK(residual(q, 0, s, NULL) < 1e-14);
  steif_pencil_free(&q);
  SUNMatDestroy(late);
  end();
}

/* An entry given in two pieces counts as their sum. */
static void duplicates(void)
{
  const steif_shift s[2] = {{2.5, 0}, {0.75, 1.25}};
  begin(true);
  const sunindextype last = SM_INDEXPTRS_S(A)[N];
  SM_INDEXVALS_S(A)[last] = N - 1;
  SM_DATA_S(A)[last] = 0.625;
  SM_INDEXPTRS_S(A)[N] = last + 1;
  g.A[N - 1 + N * (N - 1)] += 0.625;
  CHECK(steif_pencil_update(p) == STEIF_OK && steif_pencil_factor(p, 2, s) == STEIF_OK);
  for (int k = 0; k < 2; k++) CHECK(residual(p, k, s[k], NULL) < 1e-14);
  end();
}

static void bad_indices(void)
{
  begin(false);
  const sunindextype pointer = SM_INDEXPTRS_S(A)[6], row = SM_INDEXVALS_S(E)[9];
  SM_INDEXPTRS_S(A)[6] = SM_INDEXPTRS_S(A)[7] + 1;
  CHECK(steif_pencil_update(p) == STEIF_BAD_INPUT && says("column 7 of A"));
  SM_INDEXPTRS_S(A)[6] = pointer;
  SM_INDEXVALS_S(E)[9] = N;
  CHECK(steif_pencil_update(p) == STEIF_BAD_INPUT && says("column 4 of E") &&
        says("row index 40"));
  CHECK(steif_pencil_factor(p, 1, &(steif_shift){1, 0}) == STEIF_BAD_INPUT);
  SM_INDEXVALS_S(E)[9] = row;
  SM_INDEXPTRS_S(E)[0] = 1;
  CHECK(steif_pencil_update(p) == STEIF_BAD_INPUT && says("column 1 of E"));
  SM_INDEXPTRS_S(E)[0] = 0;
  CHECK(steif_pencil_factor(p, 1, &(steif_shift){1, 0}) == STEIF_OK);
  end();
}

/* Two columns that only row 0 could serve. */
static void structurally_singular(void)
{
  begin(true);
  SUNContext sun = steif_sundials(ctx);
  SUNMatrix none = SUNSparseMatrix(4, 4, 4, CSC_MAT, sun);
  SUNMatrix two = SUNSparseMatrix(4, 4, 4, CSC_MAT, sun);
  for (int j = 0; j < 4; j++) SM_INDEXPTRS_S(two)
  [j] = j, SM_INDEXVALS_S(two)[j] = j < 2 ? 0 : j, SM_DATA_S(two)[j] = 1.75;
  SM_INDEXPTRS_S(two)[4] = 4;
  steif_pencil *q = steif_pencil_new(ctx, none, two);
  CHECK(steif_pencil_factor(q, 1, &(steif_shift){2.25, 0}) == STEIF_SINGULAR);
  CHECK(says("s = 2.25+0i") && says("rank 3 of 4"));
  steif_pencil_free(&q);
  SUNMatDestroy(none), SUNMatDestroy(two);
  end();
}

/* s I - A with A = tridiag(1, -2, 1) has the eigenvalues s + 2 - 2 cos(k pi / (n + 1)). */
static void determinant(void)
{
  enum { ENTRIES = 3 * N - 2 };
  ctx = steif_context_new(NULL);
  SUNContext sun = steif_sundials(ctx);
  A = SUNSparseMatrix(N, N, ENTRIES, CSC_MAT, sun);
  sunindextype used = 0;
  for (int j = 0; j < N; j++) {
    SM_INDEXPTRS_S(A)[j] = used;
    for (int i = j > 0 ? j - 1 : 0; i < N && i <= j + 1; i++) {
      SM_INDEXVALS_S(A)[used] = i;
      SM_DATA_S(A)[used++] = i == j ? -2 : 1;
    }
  }
  SM_INDEXPTRS_S(A)[N] = used;
  p = steif_pencil_new(ctx, NULL, A);
  const steif_shift s[3] = {{1.7, 0}, {-0.83, 2.9}, {-7.1, 0}};
  double value;
  CHECK(stf_pencil_logdet(p, 0, &value) == STEIF_BAD_INPUT);
  CHECK(says("slot 0"));
  CHECK(steif_pencil_factor(p, 3, s) == STEIF_OK);
  for (int i = 0; i < 3; i++) {
    double expected = 0;
    for (int k = 1; k <= N; k++)
      expected += log(hypot(s[i].re + 2 - 2 * cos(k * acos(-1) / (N + 1)), s[i].im));
    CHECK(stf_pencil_logdet(p, i, &value) == STEIF_OK);
    CLOSE(value, expected, 1e-14);
  }
  steif_pencil_free(&p);
  SUNMatDestroy(A);
  A = SUNDenseMatrix(2, 2, sun);
  SM_ELEMENT_D(A, 0, 0) = SM_ELEMENT_D(A, 1, 1) = 1;
  p = steif_pencil_new(ctx, NULL, A);
  CHECK(steif_pencil_factor(p, 1, s) == STEIF_OK);
  CHECK(stf_pencil_logdet(p, 0, &value) == STEIF_UNSUPPORTED);
  E = NULL;
  end();
}

/* Diagonal entries whose squares leave the range of numbers, among others. */
static void determinant_of_extremes(void)
{
  static const double d[7] = {3.7e-200, -0.61, 2.9e190, 5.3e-17, 1.9, -8.3e120, 7.1e-290};
  ctx = steif_context_new(NULL);
  A = SUNSparseMatrix(7, 7, 7, CSC_MAT, steif_sundials(ctx));
  E = SUNMatClone(A);
  double expected[2] = {0, 0}, value;
  for (int j = 0; j < 7; j++) {
    SM_INDEXPTRS_S(A)
    [j] = SM_INDEXPTRS_S(E)[j] = SM_INDEXVALS_S(A)[j] = SM_INDEXVALS_S(E)[j] = j;
    SM_DATA_S(A)[j] = 0, SM_DATA_S(E)[j] = d[j];
    expected[0] += log(fabs(d[j])) + log(2.3), expected[1] += log(fabs(d[j])) + log(2.5);
  }
  SM_INDEXPTRS_S(A)[7] = SM_INDEXPTRS_S(E)[7] = 7;
  p = steif_pencil_new(ctx, E, A);
  const steif_shift s[2] = {{-2.3, 0}, {1.5, 2}};
  CHECK(steif_pencil_factor(p, 2, s) == STEIF_OK);
  for (int i = 0; i < 2; i++) {
    CHECK(stf_pencil_logdet(p, i, &value) == STEIF_OK);
    CLOSE(value, expected[i], 1e-14);
  }
  end();
}

/* Of r = b - M x row by row: rounding for a solution; for x = 0 all of b, in rows without b
 * nothing. */
static void backward_errors(void)
{
  begin(false);
  const steif_shift s[2] = {{1.3, 0}, {0.9, 2.1}};
  double x[2 * N], r[2 * N], b[2 * N], size[N];
  CHECK(steif_pencil_factor(p, 2, s) == STEIF_OK);
  for (int k = 0; k < 2; k++) {
    const int length = k ? 2 * N : N;
    for (int i = 0; i < length; i++) b[i] = i < length / 4 ? cos(1.7 * i) : 0;
    memcpy(x, b, sizeof x), memcpy(r, b, sizeof r);
    stf_sparse_direct(p, k, x);
    const double good = stf_sparse_residual(p, k, x, r, size);
    CHECK(good < 1e-13);
    memcpy(r, b, sizeof r);
    x[length / 2] += 1e-6;
    CHECK(stf_sparse_residual(p, k, x, r, size) > 1e-9);
    memset(x, 0, sizeof x), memcpy(r, b, sizeof r);
    CLOSE(stf_sparse_residual(p, k, x, r, size), 0.5, 1e-15);
    for (int i = 0; i < length; i++) CHECK(r[i] == b[i]);
    x[0] = NAN;
    CHECK(!(stf_sparse_residual(p, k, x, r, size) <= 1));
  }
  end();
}

/* Who looks at residuals may keep pivots that have become bad. */
static void trusted_pivots(void)
{
  long factors[2];
  for (int trusted = 0; trusted < 2; trusted++) {
    ctx = steif_context_new(NULL);
    A = SUNSparseMatrix(2, 2, 4, CSC_MAT, steif_sundials(ctx));
    static const double value[2][4] = {{4.1, 0.3, 0.7, 2.9}, {1e-13, 0.3, 0.7, 2.9}};
    for (int k = 0; k < 4; k++) SM_INDEXVALS_S(A)[k] = k % 2, SM_DATA_S(A)[k] = value[0][k];
    for (int j = 0; j < 3; j++) SM_INDEXPTRS_S(A)[j] = 2 * j;
    E = SUNMatClone(A);
    SUNMatZero(E);
    p = steif_pencil_new(ctx, E, A);
    p->keeps_pivots = trusted;
    CHECK(steif_pencil_factor(p, 1, &(steif_shift){1, 0}) == STEIF_OK);
    memcpy(SM_DATA_S(A), value[1], sizeof value[1]);
    CHECK(steif_pencil_update(p) == STEIF_OK);
    CHECK(steif_pencil_factor(p, 1, &(steif_shift){1, 0}) == STEIF_OK);
    factors[trusted] = steif_pencil_statistics(p)->factors;
    end();
  }
  CHECK(factors[0] == 2 && factors[1] == 1);
}

CU_TestInfo tests_of_sparse[] = {
  {"one analysis serves all shifts, real and complex", one_analysis},
  {"a refactorisation is counted and equals a factorisation", refactor_is_factor},
  {"pivots that became bad are found by their growth and replaced", growth},
  {"pivots that vanished are replaced", vanished_pivot},
  {"a changed pattern is analysed anew", pattern_changes},
  {"matrices may be filled after the pencil was made", filled_later},
  {"duplicate entries add up", duplicates},
  {"bad index arrays are refused by place, and may be mended", bad_indices},
  {"a pattern without full rank is called so", structurally_singular},
  {"the determinant is the product of the eigenvalues", determinant},
  {"a determinant of factors outside the range of squares", determinant_of_extremes},
  {"backward errors row by row", backward_errors},
  {"trusted pivots are kept", trusted_pivots},
  CU_TEST_INFO_NULL,
};
