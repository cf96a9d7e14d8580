/* test_fill.c: one callback fills E in any storage. SPDX-License-Identifier: BSD-3-Clause */
#include "fixture.h"
#include <steif/solver.h>

enum { N = 4 };

/* Rows and columns in no order, one place twice. */
static const sunindextype row[] = {2, 0, 1, 3, 1, 0, 2}, column[] = {2, 0, 1, 3, 0, 1, 2};
static const sunrealtype value[] = {1.5, 1, 2, 4, -1, 0.5, 1.5};
static const double exact[N][N] = {{1, 0.5, 0, 0}, {-1, 2, 0, 0}, {0, 0, 3, 0}, {0, 0, 0, 4}};

static int E(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix M, void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  return steif_fill_triplets(M, 7, row, column, value);
}

static int diagonal(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix M, void *user)
{
  (void)t, (void)y, (void)yp;
  return steif_fill_diagonal(M, user);
}

static int f(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  (void)t, (void)user;
  for (int i = 0; i < N; i++) NV_Ith_S(out, i) = -(1 + i) * NV_Ith_S(y, i);
  return 0;
}

static const sunrealtype y0[] = {1, 2, 3, 4};
static const sunindextype at[] = {0, 1, 2, 3, 4}, rows[] = {0, 1, 2, 3};
static const steif_pattern pattern = {at, rows};

static steif_problem problem(enum steif_storage storage)
{
  return (steif_problem){.name = "filled",
                         .n = N,
                         .t1 = 1,
                         .y0 = y0,
                         .f = f,
                         .E = E,
                         .storage = storage,
                         .lower = 1,
                         .upper = 1,
                         .pattern = &pattern};
}

static void one_callback_serves_all_storages(void)
{
  for (enum steif_storage storage = STEIF_DENSE; storage <= STEIF_SPARSE; storage++) {
    const steif_problem p = problem(storage);
    fixture s;
    CU_ASSERT_FATAL(!fixture_open(&s, &p, storage));
    for (int i = 0; i < N; i++)
      for (int j = 0; j < N; j++) CHECK(fixture_element(s.system.E, i, j) == exact[i][j]);
    fixture_close(&s);
  }
}

/* 2 y' = -y and so on: y_i = y0_i exp(-(1 + i) t / d_i), with the methods and baselines that take E. */
static void diagonals_are_solved(void)
{
  static sunrealtype d[] = {2, 1, 4, 0.5};
  static const char *const methods[] = {"radau:s=3", "bdf", "rodas4", "ida", "arkode"};
  for (enum steif_storage storage = STEIF_DENSE; storage <= STEIF_SPARSE; storage++)
    for (int m = 0; m < 5; m++) {
      steif_context *ctx = steif_context_new(NULL);
      steif_problem p = problem(storage);
      p.E = diagonal, p.user = d;
      steif_options o = steif_defaults();
      o.rtol = 1e-8;
      steif_solver *s = steif_solver_new(ctx, &p, methods[m], &o);
      CHECK(s && steif_solve_to(s, 1) == STEIF_OK);
      for (int i = 0; s && i < N; i++)
        CLOSE_FLOOR(NV_Ith_S(steif_solution(s), i), y0[i] * exp(-(1 + i) / d[i]), 2e-6, 1);
      steif_solver_free(&s);
      steif_context_free(&ctx);
    }
}

static void wrong_entries_are_refused(void)
{
  static const sunindextype outside[] = {0, 4}, far[] = {0, 3};
  steif_context *ctx = steif_context_new(NULL);
  SUNMatrix band = SUNBandMatrix(N, 1, 1, steif_sundials(ctx));
  SUNMatrix rows_first = SUNSparseMatrix(N, N, 9, CSR_MAT, steif_sundials(ctx));
  CHECK(steif_fill_triplets(band, 2, outside, far, value) == STEIF_BAD_INPUT);
  CHECK(steif_fill_triplets(band, 2, at, far, value) == STEIF_BAD_INPUT);
  CHECK(steif_fill_triplets(band, 1, NULL, far, value) == STEIF_BAD_INPUT);
  CHECK(steif_fill_triplets(NULL, 1, at, far, value) == STEIF_BAD_INPUT);
  CHECK(steif_fill_triplets(rows_first, 1, at, at, value) == STEIF_BAD_INPUT);
  CHECK(steif_fill_diagonal(NULL, NULL) == STEIF_BAD_INPUT);
  CHECK(steif_fill_diagonal(band, NULL) == STEIF_OK && SM_ELEMENT_B(band, 2, 2) == 1);
  SUNMatDestroy(band);
  SUNMatDestroy(rows_first);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_fill[] = {
  {"one callback serves all storages", one_callback_serves_all_storages},
  {"diagonals are solved", diagonals_are_solved},
  {"wrong entries are refused", wrong_entries_are_refused},
  CU_TEST_INFO_NULL};
