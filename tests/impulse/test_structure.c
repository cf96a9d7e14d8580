/* test_structure.c: regularity, index, Weyr characteristic and certificate of
 * dense pencils. SPDX-License-Identifier: BSD-3-Clause */
#include "staircase.h"
#include "impulse/families.h"
#include <sunmatrix/sunmatrix_band.h>
#include <sunmatrix/sunmatrix_sparse.h>

static const enum steif_algorithm both[] = {STEIF_STAIRCASE, STEIF_QZ};

static bool lists(const sunindextype *list, sunindextype count, int wanted,
                  const sunindextype *values)
{
  bool same = count == wanted;
  for (int i = 0; same && i < wanted; i++) same = list[i] == values[i];
  return same;
}

/* Eigenvalues -1/2 +- 3i: |.| = sqrt(9.25). Offenders: Phi_2 = Q N^2 P of the
 * factors in integers, a column (-1, -1, 1, 0, 0) times a row (0, -1, 1, -1,
 * 1). */
static void five_by_five(void)
{
  steif_context *ctx = steif_context_new(NULL);
  for (int i = 0; i < 2; i++) {
    SUNMatrix E = dense5(ctx, ut5_E), F = dense5(ctx, ut5_F);
    steif_structure s;
    CHECK(steif_structure_find(ctx, E, F, &(steif_analysis){.algorithm = both[i]}, &s) == 0);
    CHECK(s.n == 5 && s.rank_E == 4 && s.regular && s.index == 3 && s.index_least == 3);
    CHECK(s.finite == 2 && s.infinite == 3 && s.certified);
    CHECK(lists(s.weyr, s.weyr_count, 3, (const sunindextype[]){1, 1, 1}));
    CHECK(lists(s.unknowns, s.unknowns_count, 3, (const sunindextype[]){0, 1, 2}));
    CHECK(lists(s.equations, s.equations_count, 4, (const sunindextype[]){1, 2, 3, 4}));
    CLOSE(s.radius, sqrt(9.25), 1e-13);
    CHECK(s.gap > 1e12 && s.rcond > 1e-4 && s.rcond < 1 && fabs(s.count - 2) < 1e-5);
    CHECK(s.degree >= 2 && s.degree <= 5);
    CHECK(!strcmp(s.method, i ? "qz" : "staircase"));
    CHECK(strstr(s.message, "regular, index 3: 2 finite eigenvalues (largest 3.04), "
                            "3 infinite in a chain of 3; gap ") == s.message);
    CHECK(!!strstr(s.message, i ? "certified by the staircase"
                                : "certified by the generalised Schur form"));
    steif_structure_clear(ctx, &s);
    CHECK(!s.weyr && !s.equations && !s.unknowns);
    SUNMatDestroy(E), SUNMatDestroy(F);
  }
  steif_context_free(&ctx);
}

/* Rows (1,0,1,0,0), (0,1,1,0,1), 0, 0, 0, from the integer factors. */
static void slow_projector(void)
{
  static const double rows[5][5] = {{1, 0, 1, 0, 0}, {0, 1, 1, 0, 1}};
  static const double stretch[5] = {1, 3e-7, 2e5, 0.7, 4e8};
  steif_context *ctx = steif_context_new(NULL);
  SUNMatrix E = dense5(ctx, ut5_E), F = dense5(ctx, ut5_F);
  double P[25];
  CHECK(steif_projector_find(ctx, E, F, NULL, P) == STEIF_OK);
  for (int i = 0; i < 5; i++)
    for (int j = 0; j < 5; j++) CLOSE_FLOOR(P[5 * j + i], rows[i][j], 1e-11, 1);
  /* With unknowns in other units, x = D z, it is D^{-1} P D. */
  for (int i = 0; i < 5; i++)
    for (int j = 0; j < 5; j++)
      SM_ELEMENT_D(E, i, j) *= stretch[j], SM_ELEMENT_D(F, i, j) *= stretch[j];
  CHECK(steif_projector_find(ctx, E, F, NULL, P) == STEIF_OK);
  for (int i = 0; i < 5; i++)
    for (int j = 0; j < 5; j++)
      CLOSE_FLOOR(P[5 * j + i] * stretch[i] / stretch[j], rows[i][j], 1e-9, 1);
  SUNMatDestroy(E), SUNMatDestroy(F);
  steif_context_free(&ctx);
}

enum { TWENTY = 20 };
static void put(double *A, int i, int j, double value) { A[j * TWENTY + i] = value; }

/* [s 1] and its transpose beside 17 regular equations; `shuffle` moves rows and
 * columns. */
static void singular_pencil(double *E, double *F, bool shuffle)
{
  for (int i = 0; i < TWENTY; i++) {
    const int row = shuffle ? (7 * i + 3) % TWENTY : i, column = shuffle ? 13 * i % TWENTY : i;
    if (i == 0) { /* L_1 takes columns 0 and 1 */
      put(E, row, column, 1);
      put(F, row, shuffle ? 13 : 1, 1);
    } else if (i == 1) { /* L_1^T takes rows 1 and 2 */
      put(E, row, shuffle ? 26 % TWENTY : 2, 1);
    } else if (i == 2) {
      put(F, row, column, 1);
    } else {
      put(E, row, column, i % 3 ? 1 + 0.1 * i : 0);
      put(F, row, column, 0.3 * i - 2.2);
    }
  }
}

static void singular_pencil_is_refused(void)
{
  steif_context *ctx = steif_context_new(NULL);
  double *E = calloc(TWENTY * TWENTY, sizeof *E), *F = calloc(TWENTY * TWENTY, sizeof *F);
  singular_pencil(E, F, true);
  steif_structure s = look(ctx, TWENTY, E, F, STEIF_AUTOMATIC);
  CHECK(!s.regular && s.index == -1 && s.finite == -1 && s.infinite == -1 && s.certified);
  CHECK(s.rcond < TWENTY * STF_EPS && s.rank_E == 13);
  CHECK(lists(s.unknowns, s.unknowns_count, 2, (const sunindextype[]){0, 13}));
  CHECK(lists(s.equations, s.equations_count, 2, (const sunindextype[]){10, 17}));
  CHECK(!!strstr(s.message, "patterns of E and F allow rank 19 of 20"));
  CHECK(!!strstr(s.message, "the first is equation 11) and 2 unknowns"));
  steif_structure_clear(ctx, &s);
  double P[TWENTY * TWENTY];
  SUNMatrix e = dense(ctx, TWENTY, E), f = dense(ctx, TWENTY, F);
  CHECK(steif_projector_find(ctx, e, f, NULL, P) == STEIF_SINGULAR);
  SUNMatDestroy(e), SUNMatDestroy(f);
  free(E), free(F);
  steif_context_free(&ctx);
}

/* The same hidden by random rotations of equations and unknowns: no zero is
 * left to see, and the rounding of the rotations leaves det(s E + F) some 1e-17
 * that is not 0, so that nothing is certified. */
static void rotated_singular_pencil_is_refused(void)
{
  steif_context *ctx = steif_context_new(NULL);
  const size_t count = TWENTY * TWENTY;
  double *A[6];
  for (int i = 0; i < 6; i++) A[i] = calloc(count, sizeof(double));
  for (unsigned seed = 1; seed <= 6; seed++) {
    sample p = {.n = TWENTY, .state = 4711 + 13 * seed};
    memset(A[0], 0, count * sizeof(double)), memset(A[1], 0, count * sizeof(double));
    singular_pencil(A[0], A[1], false);
    orthogonal(&p, A[2]), orthogonal(&p, A[3]);
    for (int i = 0; i < 2; i++) {
      multiply(TWENTY, A[2], A[i], false, A[4]);
      multiply(TWENTY, A[4], A[3], false, A[i]);
    }
    steif_structure s = look(ctx, TWENTY, A[0], A[1], both[seed % 2]);
    CHECK(!s.regular && s.index == -1 && !s.certified);
    CHECK(strstr(s.message, "singular to rounding: ") == s.message);
    CHECK(s.rcond < TWENTY * STF_EPS && s.unknowns_count > 0 && s.equations_count > 0);
    if (s.regular) printf("\n  seed %u: %s", seed, s.message);
    steif_structure_clear(ctx, &s);
  }
  for (int i = 0; i < 6; i++) free(A[i]);
  steif_context_free(&ctx);
}

static void lowest_indices(void)
{
  steif_context *ctx = steif_context_new(NULL);
  /* x' = -F x in other coordinates: E regular. */
  steif_structure s = look(ctx, 2, (const double[]){2.3, 0.4, -1.1, 0.9},
                           (const double[]){0.7, 1.9, -0.2, 0.6}, STEIF_AUTOMATIC);
  CHECK(s.index == 0 && s.finite == 2 && s.infinite == 0 && s.weyr_count == 0 && s.certified);
  CHECK(s.rank_E == 2 && s.equations_count == 0 && !s.weyr);
  /* det(s E + F) = 2.51 s^2 + 4.18 s + 0.8. */
  CLOSE(s.radius, (4.18 + sqrt(4.18 * 4.18 - 4 * 2.51 * 0.8)) / (2 * 2.51), 1e-13);
  CHECK(!!strstr(s.message, "none infinite"));
  steif_structure_clear(ctx, &s);
  /* x_1' + 0.7 x_1 + 0.4 x_2 = 0, 1.3 x_1 + 2.6 x_2 = 0: x_1' = -0.5 x_1. */
  s =
    look(ctx, 2, (const double[]){1, 0, 0, 0}, (const double[]){0.7, 1.3, 0.4, 2.6}, STEIF_QZ);
  CHECK(s.index == 1 && s.finite == 1 && s.infinite == 1 && s.certified && s.rank_E == 1);
  CLOSE(s.radius, 0.5, 1e-13);
  CHECK(!!strstr(s.message, "1 finite eigenvalue (largest 0.5), 1 infinite; gap"));
  steif_structure_clear(ctx, &s);
  steif_context_free(&ctx);
}

static void one_unknown(void)
{
  static const struct {
    double E, F;
    int regular, index;
  } cases[] = {{0, 2.7, 1, 1}, {3.1, 0.8, 1, 0}, {5.3, 0, 1, 0}, {0, 0, 0, -1}};
  steif_context *ctx = steif_context_new(NULL);
  for (int i = 0; i < 4; i++)
    for (int a = 0; a < 2; a++) {
      steif_structure s = look(ctx, 1, &cases[i].E, &cases[i].F, both[a]);
      CHECK(s.regular == cases[i].regular && s.index == cases[i].index && s.certified);
      CHECK(s.index != 1 || isinf(s.gap));
      steif_structure_clear(ctx, &s);
    }
  steif_context_free(&ctx);
}

/* A source of current i feeds a coil, one of voltage a capacitor: two chains of 2, and whatever their
 * units both equations are differentiated and both unknowns may carry impulses. Unknowns e, j, v, i;
 * L j' - e = 0, j = f_2, C v' + i = f_3, v = f_4. */
static void all_chains_are_named(void)
{
  steif_context *ctx = steif_context_new(NULL);
  for (int k = 0; k < 5; k++) {
    const double L = pow(10, -3 * k), C = pow(10, -6 * k + 3);
    const double E[16] = {[4] = L, [10] = C}, F[16] = {[0] = -1, [5] = 1, [11] = 1, [14] = 1};
    steif_structure s = look(ctx, 4, E, F, STEIF_AUTOMATIC);
    CHECK(s.index == 2 && s.finite == 0);
    CHECK(lists(s.equations, s.equations_count, 2, (const sunindextype[]){1, 3}));
    CHECK(lists(s.unknowns, s.unknowns_count, 2, (const sunindextype[]){0, 3}));
    steif_structure_clear(ctx, &s);
  }
  steif_context_free(&ctx);
}

static void empty_rows_are_named(void)
{
  steif_context *ctx = steif_context_new(NULL);
  SUNMatrix E = dense5(ctx, ut5_E), F = dense5(ctx, ut5_F);
  for (int j = 0; j < 5; j++) SM_ELEMENT_D(E, 3, j) = SM_ELEMENT_D(F, 3, j) = 0;
  steif_structure s;
  CHECK(steif_structure_find(ctx, E, F, NULL, &s) == STEIF_OK);
  CHECK(!s.regular && s.degree == -1 && s.unknowns_count > 0);
  CHECK(lists(s.equations, s.equations_count, 1, (const sunindextype[]){3}));
  CHECK(!!strstr(s.message, "singular pencil: equation 4 is empty"));
  steif_structure_clear(ctx, &s);
  const steif_names names = {(const char *const[]){"a", "b", "c", "loop", "e"}, NULL};
  for (int i = 0; i < 5; i++) SM_ELEMENT_D(E, i, 1) = SM_ELEMENT_D(F, i, 1) = 0;
  for (int a = 0; a < 2; a++) {
    const steif_analysis called = {.algorithm = a ? STEIF_CONTOUR : STEIF_STAIRCASE,
                                   .names = &names};
    CHECK(steif_structure_find(ctx, E, F, &called, &s) == STEIF_OK);
    CHECK(!s.regular && s.certified &&
          lists(s.unknowns, s.unknowns_count, 1, (const sunindextype[]){1}));
    CHECK(!!strstr(s.message, "equation 4 (loop) is empty"));
    CHECK(!!strstr(s.message, "unknown 2 is in no equation"));
    steif_structure_clear(ctx, &s);
  }
  SUNMatDestroy(E), SUNMatDestroy(F);
  steif_context_free(&ctx);
}

/* Singular values 2, 1 and 4e-14 of E: rounding of 3 x 3 matrices of size 2 is
 * 5e-15. */
static void close_decisions_stay_undecided(void)
{
  steif_context *ctx = steif_context_new(NULL);
  const double E[9] = {2, 0, 0, 0, 1, 0, 0, 0, 4e-14};
  const double F[9] = {0.3, 0.7, 0.2, -0.6, 1.1, 0.9, 0.4, -0.8, 1.7};
  for (int i = 0; i < 2; i++) {
    steif_structure s = look(ctx, 3, E, F, both[i]);
    CHECK(s.regular && s.index == -1 && s.index_least == 0 && s.finite == -1 && !s.certified);
    CHECK(strstr(s.message, "regular, index undecided, at least 0: ") == s.message);
    if (!i) CHECK(s.gap < 1e3 && s.gap > 1);
    steif_structure_clear(ctx, &s);
  }
  steif_context_free(&ctx);
}

/* Rows and columns in units 1e-9 .. 1e9: powers of 2 bring them back. */
static void units_do_not_matter(void)
{
  static const double row[5] = {1e9, 3e-7, 2e5, 0.7, 4e-8};
  static const double column[5] = {5e-6, 8e8, 1.3, 2e-9, 6e4};
  steif_context *ctx = steif_context_new(NULL);
  SUNMatrix E = dense5(ctx, ut5_E), F = dense5(ctx, ut5_F);
  for (int i = 0; i < 5; i++)
    for (int j = 0; j < 5; j++) {
      SM_ELEMENT_D(E, i, j) *= row[i] * column[j];
      SM_ELEMENT_D(F, i, j) *= row[i] * column[j];
    }
  steif_structure s;
  CHECK(steif_structure_find(ctx, E, F, NULL, &s) == STEIF_OK);
  CHECK(s.index == 3 && s.finite == 2 && s.certified && s.gap > 1e8);
  CLOSE(s.radius, sqrt(9.25), 1e-9);
  steif_structure_clear(ctx, &s);
  SUNMatDestroy(E), SUNMatDestroy(F);
  steif_context_free(&ctx);
}

static void sparse_and_dense_agree(void)
{
  steif_context *ctx = steif_context_new(NULL);
  SUNMatrix E = dense5(ctx, ut5_E), F = dense5(ctx, ut5_F);
  SUNMatrix e = SUNSparseFromDenseMatrix(E, 0, CSC_MAT);
  steif_structure a, b;
  CHECK(steif_structure_find(ctx, E, F, NULL, &a) == STEIF_OK);
  CHECK(steif_structure_find(ctx, e, F, NULL, &b) == STEIF_OK);
  CHECK(a.index == 3 && b.index == 3 && a.gap == b.gap && a.rcond == b.rcond);
  CHECK(a.degree == b.degree && !strcmp(a.message, b.message) && b.certified);
  steif_structure_clear(ctx, &a), steif_structure_clear(ctx, &b);
  SUNMatDestroy(E), SUNMatDestroy(F), SUNMatDestroy(e);
  steif_context_free(&ctx);
}

static void refused(steif_context *ctx, SUNMatrix E, SUNMatrix F,
                    const steif_analysis *analysis, int code, const char *words)
{
  steif_structure s;
  CHECK(steif_structure_find(ctx, E, F, analysis, &s) == code);
  CHECK(!!strstr(steif_message(ctx), words));
  if (!strstr(steif_message(ctx), words)) printf("\n  %s", steif_message(ctx));
  CHECK(!s.weyr && !s.equations);
}

static void bad_matrices_are_refused(void)
{
  steif_context *ctx = steif_context_new(NULL);
  SUNContext sun = steif_sundials(ctx);
  SUNMatrix E = dense5(ctx, ut5_E), F = dense5(ctx, ut5_F), tall = SUNDenseMatrix(5, 4, sun);
  SUNMatrix four = SUNDenseMatrix(4, 4, sun), band = SUNBandMatrix(5, 1, 1, sun);
  SUNMatrix byrow = SUNSparseFromDenseMatrix(E, 0, CSR_MAT);
  SUNMatrix csc = SUNSparseFromDenseMatrix(E, 0, CSC_MAT);
  refused(ctx, NULL, F, NULL, STEIF_BAD_INPUT, "matrix E is missing");
  refused(ctx, E, tall, NULL, STEIF_BAD_INPUT, "matrix F is 5 x 4");
  refused(ctx, E, four, NULL, STEIF_BAD_INPUT, "E is of order 5, F of order 4");
  refused(ctx, band, F, NULL, STEIF_UNSUPPORTED, "neither dense nor sparse");
  refused(ctx, byrow, F, NULL, STEIF_UNSUPPORTED, "stored by rows");
  refused(ctx, E, F, &(steif_analysis){.algorithm = (enum steif_algorithm)9}, STEIF_BAD_INPUT,
          "algorithm 9");
  refused(ctx, E, F, &(steif_analysis){.radius = -2.5}, STEIF_BAD_INPUT, "radius -2.5");
  SM_ELEMENT_D(F, 2, 3) = NAN;
  refused(ctx, E, F, NULL, STEIF_NOT_FINITE, "entry (3, 4) of F is");
  SM_DATA_S(csc)[SM_INDEXPTRS_S(csc)[3]] = INFINITY;
  refused(ctx, csc, E, NULL, STEIF_NOT_FINITE, "entry (3, 4) of E is inf");
  CHECK(steif_structure_find(ctx, E, E, NULL, NULL) == STEIF_BAD_INPUT);
  CHECK(steif_projector_find(ctx, E, E, NULL, NULL) == STEIF_BAD_INPUT);
  steif_structure_clear(ctx, NULL), steif_impulse_clear(ctx, NULL);
  SUNMatDestroy(E), SUNMatDestroy(F), SUNMatDestroy(tall), SUNMatDestroy(four);
  SUNMatDestroy(band), SUNMatDestroy(byrow), SUNMatDestroy(csc);
  steif_context_free(&ctx);
}

/* Every allocation in turn is the first that fails. */
static void memory_may_run_short(void)
{
  sample p;
  sample_open(&p, &table[1].family, 3);
  int code = STEIF_NO_MEMORY, hungry = 0;
  for (long meals = 1; code != STEIF_OK && meals < 1000; meals++) {
    long left = meals;
    steif_context *ctx = steif_context_new(
      &(steif_setup){.allocate = starving, .release = feeding, .user = &left});
    if (!ctx) continue;
    SUNMatrix E = dense(ctx, p.n, p.E), F = dense(ctx, p.n, p.F);
    steif_structure s;
    code = steif_structure_find(ctx, E, F, NULL, &s);
    CHECK(code == STEIF_OK || (code == STEIF_NO_MEMORY && !s.weyr && !s.unknowns));
    hungry += code == STEIF_NO_MEMORY;
    steif_structure_clear(ctx, &s);
    SUNMatDestroy(E), SUNMatDestroy(F);
    steif_context_free(&ctx);
  }
  CHECK(code == STEIF_OK && hungry > 40);
  sample_close(&p);
}

CU_TestInfo tests_of_structure[] = {
  {"the 5 x 5 pencil of index 3 is recognised", five_by_five},
  {"its slow projector is found, in any units", slow_projector},
  {"a singular pencil is refused, its rows and columns named", singular_pencil_is_refused},
  {"a rotated singular pencil is refused", rotated_singular_pencil_is_refused},
  {"index 0 and index 1 are told apart", lowest_indices},
  {"one unknown is enough", one_unknown},
  {"an empty row is named", empty_rows_are_named},
  {"all chains are named, in whatever units", all_chains_are_named},
  {"close decisions stay undecided", close_decisions_stay_undecided},
  {"units of equations and unknowns do not matter", units_do_not_matter},
  {"sparse and dense matrices give one answer", sparse_and_dense_agree},
  {"bad matrices are refused with a sentence", bad_matrices_are_refused},
  {"memory may run short anywhere", memory_may_run_short},
  CU_TEST_INFO_NULL};
