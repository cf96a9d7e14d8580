/* test_eigenvalues.c: finite eigenvalues of pencils of which they are known in closed form, dense and
 * sparse, and what cannot be asked for.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "impulse/families.h"
#include "impulse/systems.h"
#include <steif/eigenvalues.h>

static const double pi = 3.14159265358979323846;

/* -1/2 +- 3 i, |s| = sqrt(9.25), and three infinite ones. */
static void five_by_five(void)
{
  steif_context *ctx = steif_context_new(NULL);
  SUNMatrix E = dense5(ctx, ut5_E), F = dense5(ctx, ut5_F);
  steif_structure s;
  steif_eigenvalues e;
  CHECK(!steif_structure_find(ctx, E, F, NULL, &s));
  CHECK(!steif_eigenvalues_find(ctx, E, F, NULL, &s, NULL, &e));
  CHECK(e.count == 2 && e.all && e.certified);
  for (int k = 0; k < 2; k++) {
    CLOSE(e.value[k].re, -0.5, 1e-12);
    CLOSE(e.value[k].im, k ? 3 : -3, 1e-12);
    CLOSE(e.value[k].damping, 0.5 / sqrt(9.25), 1e-12);
    CLOSE(e.value[k].frequency, 3 / (2 * pi), 1e-12);
    CHECK(e.value[k].residual < 1e-13);
  }
  steif_eigenvalues_clear(ctx, &e);
  steif_structure_clear(ctx, &s);
  SUNMatDestroy(E), SUNMatDestroy(F);
  steif_context_free(&ctx);
}

/* Rates w of random families, behind transformations and beside chains at infinity. */
static void families_come_back(void)
{
  steif_context *ctx = steif_context_new(NULL);
  for (unsigned seed = 1; seed <= 6; seed++) {
    const family f = {"stiff", 8, {3, 2, 1}, 10, true, 10};
    sample p;
    sample_open(&p, &f, seed);
    SUNMatrix E = dense(ctx, p.n, p.E), F = dense(ctx, p.n, p.F);
    steif_structure s;
    steif_eigenvalues e;
    CHECK(!steif_structure_find(ctx, E, F, NULL, &s));
    CHECK(!steif_eigenvalues_find(ctx, E, F, NULL, &s, NULL, &e));
    CHECK(e.count == 8 && e.certified);
    for (int k = 0; k < e.count; k++) {
      CLOSE(e.value[k].re, -0.1 * pow(100, k / 7.), 1e-7);
      CHECK(e.value[k].im == 0 && e.value[k].damping == 1 && e.value[k].frequency == 0);
    }
    steif_eigenvalues_clear(ctx, &e);
    steif_structure_clear(ctx, &s);
    SUNMatDestroy(E), SUNMatDestroy(F);
    sample_close(&p);
  }
  steif_context_free(&ctx);
}

/* P diag(s I - D, 1) Q with P and Q from whole numbers of determinant 1 and units of 2^-20 to 2^20. */
static const double mixed_E[36] = {-0.5,
                                   0,
                                   64,
                                   -0.1875,
                                   0.5,
                                   3145728,
                                   0,
                                   1.1920928955078125e-07,
                                   1.1920928955078125e-07,
                                   -4.656612873077393e-10,
                                   2.2351741790771484e-08,
                                   -0.171875,
                                   0,
                                   0,
                                   3.0517578125e-05,
                                   -8.940696716308594e-08,
                                   0,
                                   4,
                                   0,
                                   0,
                                   -1024,
                                   4,
                                   -96,
                                   671088640,
                                   128,
                                   0,
                                   -15360,
                                   44,
                                   -112,
                                   -805306368,
                                   0.0078125,
                                   0,
                                   -1.0625,
                                   0.003173828125,
                                   -0.01953125,
                                   40960},
                    mixed_F[36] = {-2,
                                   0,
                                   224,
                                   -0.625,
                                   1,
                                   16252928,
                                   -1.4901161193847656e-08,
                                   0,
                                   3.0994415283203125e-06,
                                   -8.381903171539307e-09,
                                   -4.470348358154297e-08,
                                   0.7421875,
                                   0,
                                   0,
                                   -9.1552734375e-05,
                                   2.384185791015625e-07,
                                   0,
                                   -12,
                                   0,
                                   0,
                                   0,
                                   0,
                                   192,
                                   -1610612736,
                                   384,
                                   0,
                                   -43008,
                                   120,
                                   -288,
                                   -2348810240,
                                   0.0234375,
                                   0,
                                   -2.625,
                                   0.00732421875,
                                   0.0078125,
                                   -356352};

/* D = diag(2, 0, 0, -2, 4): zeros are certified beside what is not 0, in any units. */
static void zeros_in_mixed_units(void)
{
  static const double wanted[5] = {-2, 0, 0, 2, 4};
  double found[5];
  steif_context *ctx = steif_context_new(NULL);
  SUNMatrix e = dense(ctx, 6, mixed_E), f = dense(ctx, 6, mixed_F);
  steif_structure s;
  steif_eigenvalues v;
  CHECK(!steif_structure_find(ctx, e, f, NULL, &s));
  CHECK(!steif_eigenvalues_find(ctx, e, f, NULL, &s, NULL, &v));
  CHECK(s.index == 1 && v.count == 5 && v.all && v.certified);
  for (int k = 0; k < 5 && v.count == 5; k++) {
    int at = k;
    for (; at > 0 && found[at - 1] > v.value[k].re; at--) found[at] = found[at - 1];
    found[at] = v.value[k].re;
    CHECK(fabs(v.value[k].im) < 1e-7 && v.value[k].residual < 1e-12);
  }
  for (int k = 0; k < 5 && v.count == 5; k++) CHECK(fabs(found[k] - wanted[k]) < 1e-7);
  steif_eigenvalues_clear(ctx, &v);
  steif_structure_clear(ctx, &s);
  SUNMatDestroy(e), SUNMatDestroy(f);
  steif_context_free(&ctx);
}

/* x_i' = x_{i-1} - 2 x_i + x_{i+1} on n points, the ends fixed (`open`: free), and the sum of all as one
 * more unknown: s = 2 cos(k pi / (n + 1)) - 2, k = 1 .. n (free: 2 cos(k pi / n) - 2, k = 0 .. n - 1). */
static void line(steif_context *ctx, int n, bool free_ends, SUNMatrix *to_E, SUNMatrix *to_F)
{
  SUNContext sun = steif_sundials(ctx);
  SUNMatrix E = *to_E = SUNSparseMatrix(n + 1, n + 1, n, CSC_MAT, sun);
  SUNMatrix F = *to_F = SUNSparseMatrix(n + 1, n + 1, 4 * n + 1, CSC_MAT, sun);
  sunindextype *ptr = SM_INDEXPTRS_S(F), *row = SM_INDEXVALS_S(F), used = 0;
  for (int j = 0; j <= n; j++) {
    SM_INDEXPTRS_S(E)[j] = j;
    if (j < n) SM_INDEXVALS_S(E)[j] = j, SM_DATA_S(E)[j] = 1;
    ptr[j] = used;
    for (int i = j - 1; i <= j + 1 && j < n; i++) {
      if (i < 0 || i >= n) continue;
      const bool end = free_ends && (j == 0 || j == n - 1);
      row[used] = i, SM_DATA_S(F)[used++] = i == j ? end ? 1 : 2 : -1;
    }
    row[used] = n, SM_DATA_S(F)[used++] = j < n ? 1 : -1;
  }
  SM_INDEXPTRS_S(E)[n + 1] = n;
  ptr[n + 1] = used;
}

static void sparse_ones_near_a_point(void)
{
  enum { N = 600, COUNT = 7 };
  steif_context *ctx = steif_context_new(NULL);
  for (int free_ends = 0; free_ends < 2; free_ends++) {
    SUNMatrix E, F;
    steif_structure s;
    steif_eigenvalues e;
    line(ctx, N, free_ends, &E, &F);
    CHECK(!steif_structure_find(ctx, E, F, NULL, &s) && s.certified && s.finite == N);
    CHECK(steif_eigenvalues_find(ctx, E, F, NULL, &s, NULL, &e) == STEIF_UNSUPPORTED);
    const steif_eigenvalue_request near = {.count = COUNT};
    CHECK(!steif_eigenvalues_find(ctx, E, F, NULL, &s, &near, &e));
    CHECK(e.count == COUNT && e.certified && !e.all);
    for (int k = 0; k < e.count; k++) {
      const double known = 2 * cos(free_ends ? k * pi / N : (k + 1) * pi / (N + 1)) - 2;
      /* of a matrix of norm 4, solved at a distance of 1e-3 where 0 is one of them */
      CLOSE_FLOOR(e.value[k].re, known, 1e-9, 1e-3);
      CHECK(e.value[k].im == 0 && e.value[k].residual < 1e-10);
    }
    steif_eigenvalues_clear(ctx, &e);
    steif_structure_clear(ctx, &s);
    SUNMatDestroy(E), SUNMatDestroy(F);
  }
  steif_context_free(&ctx);
}

/* Masses on springs with constraints, index 3: pairs near 0 and near 1.5 i by Arnoldi's method are those
 * of the QZ algorithm. */
static void both_ways_agree(void)
{
  system_ s;
  system_open(&s, NULL, "springs:n=40");
  for (int k = 0; k < 2; k++) {
    const steif_eigenvalue_request near = {.count = 4, .im = k ? 1.5 : 0};
    const steif_analysis by[2] = {{.algorithm = STEIF_CONTOUR}, {.algorithm = STEIF_STAIRCASE}};
    steif_structure found[2];
    steif_eigenvalues e[2];
    for (int w = 0; w < 2; w++) {
      CHECK(!steif_structure_find(s.ctx, s.E, s.F, by + w, found + w));
      CHECK(!steif_eigenvalues_find(s.ctx, s.E, s.F, by + w, found + w, &near, e + w));
      CHECK(e[w].certified && e[w].count >= 4);
    }
    for (long i = 0; i < e[0].count && e[0].count == e[1].count; i++) {
      CLOSE_FLOOR(e[0].value[i].re, e[1].value[i].re, 1e-9, 1);
      CLOSE_FLOOR(e[0].value[i].im, e[1].value[i].im, 1e-9, 1);
    }
    CHECK(e[0].count == e[1].count);
    for (int w = 0; w < 2; w++) {
      steif_eigenvalues_clear(s.ctx, e + w);
      steif_structure_clear(s.ctx, found + w);
    }
  }
  system_close(&s);
}

static void bad_requests(void)
{
  steif_context *ctx = steif_context_new(NULL);
  SUNMatrix E = dense5(ctx, ut5_E), F = dense5(ctx, ut5_F);
  steif_structure s;
  steif_eigenvalues e;
  CHECK(steif_eigenvalues_find(ctx, E, F, NULL, NULL, NULL, &e) == STEIF_BAD_INPUT);
  CHECK(!steif_structure_find(ctx, E, F, NULL, &s));
  const steif_eigenvalue_request bad[] = {{.count = -1}, {.count = 6}, {.re = NAN}};
  for (int k = 0; k < 3; k++)
    CHECK(steif_eigenvalues_find(ctx, E, F, NULL, &s, bad + k, &e) == STEIF_BAD_INPUT);
  CHECK(steif_eigenvalues_find(ctx, E, F, NULL, &s, NULL, NULL) == STEIF_BAD_INPUT);
  steif_structure_clear(ctx, &s);
  SUNMatZero(F);
  CHECK(!steif_structure_find(ctx, E, F, NULL, &s) && !s.regular);
  CHECK(steif_eigenvalues_find(ctx, E, F, NULL, &s, NULL, &e) == STEIF_SINGULAR);
  steif_structure_clear(ctx, &s);
  steif_eigenvalues_clear(ctx, NULL);
  SUNMatDestroy(E), SUNMatDestroy(F);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_eigenvalues[] = {
  {"a pair of a pencil of index 3", five_by_five},
  {"rates of random families come back", families_come_back},
  {"sparse ones near a point, and at one", sparse_ones_near_a_point},
  {"zeros in mixed units", zeros_in_mixed_units},
  {"both ways agree", both_ways_agree},
  {"what cannot be asked for is told", bad_requests},
  CU_TEST_INFO_NULL};
