/* test_regular.c: small pencils by circles: low and high index, badly scaled, singular.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "generated.h"
#include "impulse/systems.h"

static bool says(const char *text, const char *what)
{
  const bool found = strstr(text, what) != NULL;
  if (!found) printf("\n  \"%s\" lacks \"%s\"", text, what);
  return found;
}

/* Full copies of the two matrices and what circles find in them. */
static void small(int n, const double *e, const double *f, const steif_analysis *analysis,
                  steif_structure *found, steif_context *ctx)
{
  SUNMatrix E = system_dense(ctx, n, e), F = system_dense(ctx, n, f);
  *found = (steif_structure){0};
  const steif_analysis by = system_by_circles(analysis);
  CHECK(steif_structure_find(ctx, E, F, &by, found) == STEIF_OK);
  SUNMatDestroy(E), SUNMatDestroy(F);
}

static void low_indices(void)
{
  static const double e0[4] = {2, 1, -1, 3}, e1[4] = {2, 1, 0, 0}, f[4] = {1, -3, 0.5, 2};
  static const double e5[25] = {[1] = 1.5, [7] = -0.75, [13] = 2, [19] = 1.25};
  static const double f5[25] = {[0] = 1, [6] = -2, [12] = 0.5, [18] = 3, [24] = 1};
  static const double none[4] = {0};
  steif_context *ctx = steif_context_new(NULL);
  steif_structure s;
  small(2, e0, f, NULL, &s, ctx);
  CHECK(s.index == 0 && s.finite == 2 && s.certified);
  steif_structure_clear(ctx, &s);
  small(2, e1, f, NULL, &s, ctx);
  CHECK(s.index == 1 && s.finite == 1 && s.certified && s.equations_count == 0);
  steif_structure_clear(ctx, &s);
  small(2, none, f, NULL, &s, ctx);
  CHECK(s.index == 1 && s.finite == 0 && s.certified);
  steif_structure_clear(ctx, &s);
  small(5, e5, f5, NULL, &s, ctx);
  CHECK(s.index == 5 && s.finite == 0 && s.certified);
  CHECK(s.equations_count == 4 && s.unknowns_count == 4);
  steif_structure_clear(ctx, &s);
  small(5, e5, f5, &(steif_analysis){.index_most = 3}, &s, ctx);
  CHECK(s.index == -1 && !s.certified);
  steif_structure_clear(ctx, &s);
  steif_context_free(&ctx);
}

/* Entries of algebraic couplings say nothing about eigenvalues: u' + diag(1, 2) u + 1e8 g l = 0,
 * 1e8 g . u = 0 with g = (1, 1) has the one eigenvalue -3/2. The circle shrinks to its size. */
static void large_couplings(void)
{
  static const double e[9] = {[0] = 1, [4] = 1};
  static const double f[9] = {[0] = 1, [4] = 2, [2] = 1e8, [5] = 1e8, [6] = 1e8, [7] = 1e8};
  steif_context *ctx = steif_context_new(NULL);
  steif_structure s;
  small(3, e, f, NULL, &s, ctx);
  CHECK(s.index == 2 && s.finite == 1 && s.certified);
  CHECK(s.radius > 1.5 && s.radius < 150);
  steif_structure_clear(ctx, &s);
  steif_context_free(&ctx);
}

/* Blocks L_1 and L_1^T and stable ones, hidden by transformations so that the pattern is full. */
static void singular_pencil(void)
{
  enum { N = 20 };
  double e[N * N] = {0}, f[N * N] = {0};
  stf_random r = {7};
  e[0] = 1, f[1] = 1;             /* row 0: [s 1] */
  e[N + 2] = 1, f[2 * N + 2] = 1; /* column 2: [s; 1] */
  for (int i = 3; i < N; i++) e[i * N + i] = 1, f[i * N + i] = stf_random_in(&r, 0.5, 3);
  for (int turn = 0; turn < 600; turn++) {
    const int i = (int)stf_random_below(&r, N),
              j = (i + 1 + (int)stf_random_below(&r, N - 1)) % N;
    const double angle = stf_random_in(&r, 0, 6), c = cos(angle), d = sin(angle);
    for (int side = 0; side < 4; side++) {
      double *M = side % 2 ? f : e;
      for (int k = 0; k < N; k++) {
        double *p = side < 2 ? &M[i * N + k] : &M[k * N + j];
        double *q = side < 2 ? &M[j * N + k] : &M[k * N + i];
        const double x = *p, y = *q;
        *p = c * x + d * y;
        *q = c * y - d * x;
      }
    }
  }
  steif_context *ctx = steif_context_new(NULL);
  steif_structure s;
  small(N, e, f, NULL, &s, ctx);
  CHECK(!s.regular && s.index == -1 && s.degree == N);
  CHECK(s.rcond < 1e-15);
  CHECK(says(s.message, "singular to rounding") && !s.certified);
  steif_structure_clear(ctx, &s);
  static const double e3[9] = {[0] = 1, [5] = 1}, f3[9] = {[1] = 1, [8] = 1};
  small(3, e3, f3, NULL, &s, ctx);
  CHECK(!s.regular && s.degree == -1 && s.equations_count == 2 && s.unknowns_count == 2);
  CHECK(says(s.message, "rank 2 of 3"));
  steif_structure_clear(ctx, &s);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_regular[] = {
  {"indices 0 to 5, and one beyond those looked for", low_indices},
  {"large algebraic entries do not hold the circle up", large_couplings},
  {"singular pencils are rejected, by values and by pattern", singular_pencil},
  CU_TEST_INFO_NULL};
