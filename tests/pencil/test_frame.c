/* test_frame.c: what the frame refuses, keeps and names.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "gear.h"
#include "suite.h"
#include <string.h>

static const SUNMatrix_ID storages[] = {SUNMATRIX_DENSE, SUNMATRIX_BAND, SUNMATRIX_SPARSE};
enum { STORAGES = 3, N = 22 };

static gear g;
static steif_context *ctx;
static SUNMatrix E, A;
static N_Vector x, y;
static steif_pencil *p;

static void begin(SUNMatrix_ID id, int n)
{
  gear_fill(&g, n, false, 812u);
  ctx = steif_context_new(NULL);
  SUNContext sun = steif_sundials(ctx);
  E = gear_matrix(g.E, n, id, sun), A = gear_matrix(g.A, n, id, sun);
  x = gear_vector(n, 17, sun), y = gear_vector(n, 18, sun);
  p = steif_pencil_new(ctx, E, A);
}

static void end(void)
{
  steif_pencil_free(&p);
  SUNMatDestroy(E), SUNMatDestroy(A);
  N_VDestroy(x), N_VDestroy(y);
  steif_context_free(&ctx);
}

static bool says(const char *what)
{
  const bool found = strstr(steif_message(ctx), what) != NULL;
  if (!found) printf("\n  \"%s\" lacks \"%s\"", steif_message(ctx), what);
  return found;
}

static void constructor(void)
{
  begin(SUNMATRIX_DENSE, N);
  SUNContext sun = steif_sundials(ctx);
  SUNMatrix small = SUNDenseMatrix(N - 1, N - 1, sun), flat = SUNDenseMatrix(3, 4, sun);
  SUNMatrix band = SUNBandMatrix(N, 1, 1, sun), rows = SUNSparseMatrix(N, N, 5, CSR_MAT, sun);
  CHECK(!steif_pencil_new(NULL, E, A));
  CHECK(!steif_pencil_new(ctx, E, NULL) && steif_status(ctx) == STEIF_BAD_INPUT &&
        says("A is NULL"));
  CHECK(!steif_pencil_new(ctx, small, A) && steif_status(ctx) == STEIF_BAD_INPUT);
  CHECK(says("E is 21 x 21 where 22 x 22"));
  CHECK(!steif_pencil_new(ctx, NULL, flat) && steif_status(ctx) == STEIF_BAD_INPUT);
  CHECK(says("A is 3 x 4"));
  CHECK(!steif_pencil_new(ctx, band, A) && steif_status(ctx) == STEIF_BAD_INPUT);
  CHECK(says("different storage"));
  CHECK(!steif_pencil_new(ctx, NULL, rows) && steif_status(ctx) == STEIF_UNSUPPORTED);
  CHECK(says("SUNSparseMatrix_ToCSC"));
  CHECK(!steif_pencil_new_operator(ctx, NULL, x) && steif_status(ctx) == STEIF_BAD_INPUT);
  steif_operator op = gear_operator(&g);
  op.tolerance = -1;
  CHECK(!steif_pencil_new_operator(ctx, &op, x) && says("-1"));
  SUNMatDestroy(small), SUNMatDestroy(flat), SUNMatDestroy(band), SUNMatDestroy(rows);
  end();
}

static void arguments(void)
{
  begin(SUNMATRIX_BAND, N);
  const steif_shift s[2] = {{1.25, 0}, {0.5, 3.5}};
  N_Vector shorter = N_VNew_Serial(N - 1, steif_sundials(ctx)), none = NULL;
  CHECK(steif_pencil_factor(p, 0, s) == STEIF_BAD_INPUT);
  CHECK(steif_pencil_factor(p, STEIF_PENCIL_SLOTS + 1, s) == STEIF_BAD_INPUT && says("65"));
  CHECK(steif_pencil_factor(p, 1, NULL) == STEIF_BAD_INPUT);
  CHECK(steif_pencil_factor(p, 1, &(steif_shift){1, NAN}) == STEIF_NOT_FINITE);
  CHECK(steif_pencil_solve(p, 0, 1, &x, NULL) == STEIF_BAD_INPUT && says("slot 0 of 0"));
  CHECK(steif_pencil_factor(p, 2, s) == STEIF_OK);
  CHECK(steif_pencil_solve(p, -1, 1, &x, NULL) == STEIF_BAD_INPUT);
  CHECK(steif_pencil_solve(p, 2, 1, &x, NULL) == STEIF_BAD_INPUT && says("slot 2 of 2"));
  CHECK(steif_pencil_solve(p, 0, 0, &x, NULL) == STEIF_BAD_INPUT);
  CHECK(steif_pencil_solve(p, 0, 1, NULL, NULL) == STEIF_BAD_INPUT);
  CHECK(steif_pencil_solve(p, 1, 1, &x, NULL) == STEIF_BAD_INPUT && says("0.5+3.5i"));
  CHECK(steif_pencil_solve(p, 0, 1, &none, NULL) == STEIF_BAD_INPUT && says("re[0] is NULL"));
  CHECK(steif_pencil_solve(p, 1, 1, &x, &shorter) == STEIF_BAD_INPUT);
  CHECK(says("im[0] has 21 components where the pencil has 22"));
  CHECK(steif_pencil_product(p, 'F', x, y) == STEIF_BAD_INPUT && says("'F'"));
  CHECK(steif_pencil_product(p, 'A', x, x) == STEIF_BAD_INPUT);
  CHECK(steif_pencil_product(p, 'A', shorter, y) == STEIF_BAD_INPUT);
  CHECK(steif_pencil_update(NULL) == STEIF_BAD_INPUT && !steif_pencil_statistics(NULL));
  N_VDestroy(shorter);
  end();
}

static void values_not_finite(void)
{
  for (int i = 0; i < STORAGES; i++) {
    begin(storages[i], N);
    g.A[7 + N * 8] = NAN;
    gear_copy(g.A, N, A);
    CHECK(steif_pencil_update(p) == STEIF_NOT_FINITE && says("entry (8, 9) of A"));
    CHECK(steif_pencil_factor(p, 1, &(steif_shift){3, 0}) == STEIF_NOT_FINITE);
    g.A[7 + N * 8] = 0.31, g.E[5 + N * 4] = INFINITY;
    gear_copy(g.A, N, A), gear_copy(g.E, N, E);
    CHECK(steif_pencil_update(p) == STEIF_NOT_FINITE && says("entry (6, 5) of E") &&
          says("inf"));
    g.E[5 + N * 4] = 1e300;
    gear_copy(g.E, N, E);
    CHECK(steif_pencil_update(p) == STEIF_OK);
    CHECK(steif_pencil_factor(p, 1, &(steif_shift){1e12, 0}) == STEIF_NOT_FINITE);
    CHECK(says("overflows"));
    CHECK(steif_pencil_solve(p, 0, 1, &x, NULL) == STEIF_BAD_INPUT);
    end();
  }
}

/* A = diag(d) with d_4 = 1.5 and E the identity on the same storage: s = 1.5 is singular, in column
 * 4 whatever the order of elimination. */
static void singular(int n)
{
  for (int i = 0; i < STORAGES; i++) {
    begin(storages[i], n);
    for (int j = 0; j < n; j++)
      for (int k = 0; k < n; k++) {
        g.E[k + n * j] *= k == j, g.A[k + n * j] *= k == j;
        if (k == j) g.E[k + n * j] = 1, g.A[k + n * j] = k == 4 ? 1.5 : -0.5 * k;
      }
    gear_copy(g.E, n, E), gear_copy(g.A, n, A);
    const steif_shift s[3] = {{2.5, 0}, {1.5, 0}, {1.5, 0.25}};
    steif_pencil_update(p);
    CHECK(steif_pencil_factor(p, 3, s) == STEIF_SINGULAR);
    CHECK(says("s = 1.5+0i") && says("column 5"));
    CHECK(steif_pencil_solve(p, 0, 1, &x, NULL) == STEIF_OK);
    CHECK(steif_pencil_solve(p, 1, 1, &x, NULL) == STEIF_BAD_INPUT);
    CHECK(steif_pencil_solve(p, 2, 1, &x, &y) == STEIF_OK);
    CHECK(steif_pencil_factor(p, 1, &(steif_shift){1.5, 0}) == STEIF_SINGULAR);
    g.A[4 + n * 4] = 0, g.E[4 + n * 4] = 0;
    gear_copy(g.E, n, E), gear_copy(g.A, n, A);
    steif_pencil_update(p);
    CHECK(steif_pencil_factor(p, 1, &(steif_shift){0.75, -8.5}) == STEIF_SINGULAR);
    CHECK(says("s = 0.75-8.5i"));
    end();
  }
}

static void singular_shift(void)
{
  singular(9);
  singular(N);
}

static void kept(void)
{
  for (int i = 0; i < STORAGES; i++) {
    begin(storages[i], N);
    const steif_pencil_stats *stats = steif_pencil_statistics(p);
    steif_shift s[3] = {{1.5, 0}, {2.5, 4.5}, {0.125, 9}};
    CHECK(steif_pencil_factor(p, 3, s) == STEIF_OK && stats->factors == 3);
    CHECK(steif_pencil_factor(p, 3, s) == STEIF_OK);
    CHECK(stats->factors + stats->refactors == 3);
    s[1].im = 5.5;
    CHECK(steif_pencil_factor(p, 3, s) == STEIF_OK);
    CHECK(stats->factors + stats->refactors == 4);
    CHECK(steif_pencil_factor(p, 1, s) == STEIF_OK);
    CHECK(steif_pencil_solve(p, 2, 1, &x, &y) == STEIF_OK);
    CHECK(steif_pencil_update(p) == STEIF_OK);
    CHECK(steif_pencil_solve(p, 2, 1, &x, &y) == STEIF_BAD_INPUT);
    CHECK(steif_pencil_factor(p, 3, s) == STEIF_OK);
    CHECK(stats->factors + stats->refactors == 7);
    end();
  }
}

/* A slot takes a real shift after a complex one and the other way round. */
static void changed_arithmetic(void)
{
  for (int i = 0; i < STORAGES; i++)
    for (int n = 7; n <= N; n += N - 7) {
      begin(storages[i], n);
      for (int k = 0; k < 4; k++) {
        const steif_shift s = {3.5 + k, k % 2 ? 1.75 : 0};
        N_Vector re = N_VClone(x), im = N_VClone(y);
        N_VScale(1, x, re), N_VScale(1, y, im);
        CHECK(steif_pencil_factor(p, 1, &s) == STEIF_OK);
        CHECK(steif_pencil_solve(p, 0, 1, &re, &im) == STEIF_OK);
        CHECK(gear_residual(&g, s, NV_DATA_S(re), NV_DATA_S(im), NV_DATA_S(x), NV_DATA_S(y)) <
              1e-14);
        N_VDestroy(re), N_VDestroy(im);
      }
      end();
    }
}

CU_TestInfo tests_of_frame[] = {
  {"the constructor refuses what does not fit and says so", constructor},
  {"bad slots, counts and vectors are refused by name", arguments},
  {"the entry that is NaN or infinite is named", values_not_finite},
  {"a singular shift is named with its column; the others stand", singular_shift},
  {"a slot is factored again only when something changed", kept},
  {"a slot changes between real and complex arithmetic", changed_arithmetic},
  CU_TEST_INFO_NULL,
};
