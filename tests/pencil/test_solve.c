/* test_solve.c: every back end solves, and they agree with one another.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "gear.h"
#include "suite.h"

static const SUNMatrix_ID storages[] = {SUNMATRIX_DENSE, SUNMATRIX_BAND, SUNMATRIX_SPARSE};
enum { STORAGES = 3, OPERATOR = 3, KINDS = 4, RHS = 11 };

static const steif_shift shifts[] = {{2.7182, 0}, {-3.25, 0}, {1.61, 7.39}, {0.577, -40.3}};
enum { SHIFTS = 4 };

typedef struct bench {
  gear g;
  steif_context *ctx;
  SUNMatrix E, A;
  N_Vector like;
  steif_pencil *p;
} bench;

static void begin(bench *b, int kind, int n, bool identity)
{
  gear_fill(&b->g, n, identity, 20240u + (unsigned)n);
  b->ctx = steif_context_new(NULL);
  SUNContext sun = steif_sundials(b->ctx);
  b->E = b->A = NULL;
  b->like = gear_vector(n, 99, sun);
  if (kind == OPERATOR) {
    const steif_operator op = gear_operator(&b->g);
    b->p = steif_pencil_new_operator(b->ctx, &op, b->like);
  } else {
    if (!identity) b->E = gear_matrix(b->g.E, n, storages[kind], sun);
    b->A = gear_matrix(b->g.A, n, storages[kind], sun);
    b->p = steif_pencil_new(b->ctx, b->E, b->A);
  }
  if (!b->p) printf("\n  %s", steif_message(b->ctx));
}

static void end(bench *b)
{
  steif_pencil_free(&b->p);
  if (b->E) SUNMatDestroy(b->E);
  if (b->A) SUNMatDestroy(b->A);
  N_VDestroy(b->like);
  steif_context_free(&b->ctx);
}

/* Solve with slot k for `count` right-hand sides made from their numbers; the worst residual. */
static double solve(bench *b, int k, int count, double *first)
{
  const bool complex = shifts[k].im != 0;
  SUNContext sun = steif_sundials(b->ctx);
  const int n = b->g.n;
  N_Vector re[RHS], im[RHS], br[RHS], bi[RHS];
  double worst = 0;
  for (int i = 0; i < count; i++) {
    re[i] = gear_vector(n, 700u + (unsigned)i, sun),
    br[i] = gear_vector(n, 700u + (unsigned)i, sun);
    im[i] = gear_vector(n, 900u + (unsigned)i, sun),
    bi[i] = gear_vector(n, 900u + (unsigned)i, sun);
  }
  const int code = steif_pencil_solve(b->p, k, count, re, complex ? im : NULL);
  if (code) printf("\n  %s", steif_message(b->ctx));
  CHECK(code == STEIF_OK);
  for (int i = 0; i < count; i++)
    worst = fmax(worst, gear_residual(&b->g, shifts[k], NV_DATA_S(re[i]),
                                      complex ? NV_DATA_S(im[i]) : NULL, NV_DATA_S(br[i]),
                                      complex ? NV_DATA_S(bi[i]) : NULL));
  for (int i = 0; first && i < n; i++)
    first[i] = NV_Ith_S(re[count - 1], i),
    first[n + i] = complex ? NV_Ith_S(im[count - 1], i) : 0;
  for (int i = 0; i < count; i++)
    N_VDestroy(re[i]), N_VDestroy(im[i]), N_VDestroy(br[i]), N_VDestroy(bi[i]);
  return worst;
}

/* Backward errors: some eps with partial pivoting; KLU keeps a diagonal pivot down to 0.001 of the
 * largest, so that entries may grow a thousandfold; what was asked for with GMRES. */
static const double backward[KINDS] = {1e-14, 1e-14, 1e-11, 1e-10};

static void residuals(int n, bool identity, int count)
{
  for (int kind = 0; kind < KINDS; kind++) {
    bench b;
    begin(&b, kind, n, identity);
    CU_ASSERT_FATAL(b.p != NULL);
    CHECK(steif_pencil_factor(b.p, SHIFTS, shifts) == STEIF_OK);
    for (int k = 0; k < SHIFTS; k++) CHECK(solve(&b, k, count, NULL) < backward[kind]);
    CHECK(steif_pencil_statistics(b.p)->solves == (long)SHIFTS * count);
    end(&b);
  }
}

static void one_rhs(void)
{
  residuals(23, false, 1);
  residuals(1, true, 1);
}

static void several_rhs(void) { residuals(37, false, RHS); }
static void identity_E(void) { residuals(29, true, 3); }

static void every_small_size(void)
{
  for (int n = 2; n <= 18; n++) residuals(n, n % 2, 2);
}

static void agree(void)
{
  enum { N = 41 };
  static double x[KINDS][SHIFTS][2 * N];
  for (int identity = 0; identity < 2; identity++) {
    for (int kind = 0; kind < KINDS; kind++) {
      bench b;
      begin(&b, kind, N, identity);
      CHECK(steif_pencil_factor(b.p, SHIFTS, shifts) == STEIF_OK);
      for (int k = 0; k < SHIFTS; k++) solve(&b, k, 2, x[kind][k]);
      end(&b);
    }
    for (int k = 0; k < SHIFTS; k++)
      for (int i = 0; i < 2 * N; i++) {
        CLOSE_FLOOR(x[1][k][i], x[0][k][i], 1e-12, 1);
        CLOSE_FLOOR(x[2][k][i], x[0][k][i], 1e-12, 1);
        CLOSE_FLOOR(x[3][k][i], x[0][k][i], 1e-8, 1);
      }
  }
}

/* [[2, 1], [0, 3]] against s = 5 + 2i: x_2 = b_2 / (s - 3), x_1 = (b_1 + x_2) / (s - 2). With
 * b = (1 + i, 4): x_2 = 4 / (2 + 2i) = 1 - i, x_1 = 2 / (3 + 2i) = (6 - 4i) / 13. */
static void by_hand(void)
{
  steif_context *ctx = steif_context_new(NULL);
  SUNContext sun = steif_sundials(ctx);
  SUNMatrix A = SUNDenseMatrix(2, 2, sun);
  SUNMatZero(A);
  SM_ELEMENT_D(A, 0, 0) = 2, SM_ELEMENT_D(A, 0, 1) = 1, SM_ELEMENT_D(A, 1, 1) = 3;
  steif_pencil *p = steif_pencil_new(ctx, NULL, A);
  N_Vector re = N_VNew_Serial(2, sun), im = N_VNew_Serial(2, sun);
  NV_Ith_S(re, 0) = 1, NV_Ith_S(im, 0) = 1, NV_Ith_S(re, 1) = 4, NV_Ith_S(im, 1) = 0;
  CHECK(steif_pencil_factor(p, 1, &(steif_shift){5, 2}) == STEIF_OK);
  CHECK(steif_pencil_solve(p, 0, 1, &re, &im) == STEIF_OK);
  CLOSE(NV_Ith_S(re, 0), 6.0 / 13, 1e-15);
  CLOSE(NV_Ith_S(im, 0), -4.0 / 13, 1e-15);
  CLOSE(NV_Ith_S(re, 1), 1, 1e-15);
  CLOSE(NV_Ith_S(im, 1), -1, 1e-15);
  N_VDestroy(re), N_VDestroy(im);
  steif_pencil_free(&p);
  SUNMatDestroy(A);
  steif_context_free(&ctx);
}

/* A real shift and a complex right-hand side: both parts are solved for. */
static void complex_rhs_real_shift(void)
{
  for (int kind = 0; kind < KINDS; kind++) {
    bench b;
    begin(&b, kind, 19, false);
    SUNContext sun = steif_sundials(b.ctx);
    CHECK(steif_pencil_factor(b.p, 1, shifts) == STEIF_OK);
    N_Vector re = gear_vector(19, 5, sun), im = gear_vector(19, 6, sun);
    N_Vector br = gear_vector(19, 5, sun), bi = gear_vector(19, 6, sun);
    CHECK(steif_pencil_solve(b.p, 0, 1, &re, &im) == STEIF_OK);
    CHECK(gear_residual(&b.g, shifts[0], NV_DATA_S(re), NV_DATA_S(im), NV_DATA_S(br),
                        NV_DATA_S(bi)) < (kind == OPERATOR ? 1e-10 : 1e-14));
    N_VDestroy(re), N_VDestroy(im), N_VDestroy(br), N_VDestroy(bi);
    end(&b);
  }
}

/* Columns that lie side by side, or with a gap, are solved where they are. */
static void neighbours(void)
{
  enum { N = 31, GAP = 5 };
  for (int kind = 0; kind < STORAGES; kind++) {
    bench b;
    begin(&b, kind, N, false);
    double x[3 * (N + GAP)], y[3 * (N + GAP)];
    N_Vector v[3];
    unsigned seed = 4711;
    for (int i = 0; i < 3 * (N + GAP); i++) x[i] = y[i] = gear_random(&seed);
    for (int i = 0; i < 3; i++)
      v[i] = N_VMake_Serial(N, x + i * (N + GAP), steif_sundials(b.ctx));
    CHECK(steif_pencil_factor(b.p, 1, shifts) == STEIF_OK);
    CHECK(steif_pencil_solve(b.p, 0, 3, v, NULL) == STEIF_OK);
    for (int i = 0; i < 3; i++) {
      CHECK(gear_residual(&b.g, shifts[0], x + i * (N + GAP), NULL, y + i * (N + GAP), NULL) <
            1e-14);
      for (int k = 0; k < GAP; k++) CHECK(x[i * (N + GAP) + N + k] == y[i * (N + GAP) + N + k]);
      N_VDestroy(v[i]);
    }
    end(&b);
  }
}

/* Narrow and wide bands, in line and through LAPACK, without a dominant diagonal: rows are
 * exchanged nearly everywhere and the fill above the band is used. */
static void bandwidths(void)
{
  enum { N = 45, CASES = 8 };
  static const int lower[CASES] = {0, 0, 3, 1, 9, 12, 13, 20},
                   upper[CASES] = {0, 3, 0, 1, 14, 12, 12, 7};
  static const steif_shift s[2] = {{0.125, 0}, {0.0625, 0.1875}};
  static gear g;
  for (int c = 0; c < CASES; c++) {
    unsigned seed = 31337;
    gear_fill(&g, N, true, 1);
    for (int j = 0; j < N; j++)
      for (int i = 0; i < N; i++)
        g.A[i + N * j] = j - i <= upper[c] && i - j <= lower[c] ? gear_random(&seed) : 0;
    steif_context *ctx = steif_context_new(NULL);
    SUNContext sun = steif_sundials(ctx);
    SUNMatrix A = gear_matrix(g.A, N, SUNMATRIX_BAND, sun);
    steif_pencil *p = steif_pencil_new(ctx, NULL, A);
    CHECK(steif_pencil_factor(p, 2, s) == STEIF_OK);
    for (int k = 0; k < 2; k++) {
      N_Vector re = gear_vector(N, 5, sun), im = gear_vector(N, 6, sun);
      N_Vector br = gear_vector(N, 5, sun), bi = gear_vector(N, 6, sun);
      CHECK(steif_pencil_solve(p, k, 1, &re, &im) == STEIF_OK);
      CHECK(gear_residual(&g, s[k], NV_DATA_S(re), NV_DATA_S(im), NV_DATA_S(br),
                          NV_DATA_S(bi)) < 1e-14);
      N_VDestroy(re), N_VDestroy(im), N_VDestroy(br), N_VDestroy(bi);
    }
    steif_pencil_free(&p);
    SUNMatDestroy(A);
    steif_context_free(&ctx);
  }
}

static void products(void)
{
  for (int kind = 0; kind < KINDS; kind++)
    for (int identity = 0; identity < 2; identity++) {
      bench b;
      begin(&b, kind, 17, identity);
      N_Vector x = gear_vector(17, 31, steif_sundials(b.ctx)), out = N_VClone(x);
      for (const char *which = "EA"; *which; which++) {
        const double *M = *which == 'E' ? b.g.E : b.g.A;
        CHECK(steif_pencil_product(b.p, *which, x, out) == STEIF_OK);
        for (int i = 0; i < 17; i++) {
          double sum = 0;
          for (int j = 0; j < 17; j++) sum += M[i + 17 * j] * NV_Ith_S(x, j);
          CLOSE_FLOOR(NV_Ith_S(out, i), sum, 1e-15, 8);
        }
      }
      N_VDestroy(x), N_VDestroy(out);
      end(&b);
    }
}

CU_TestInfo tests_of_solve[] = {
  {"one right-hand side has a small residual in every storage", one_rhs},
  {"eleven right-hand sides have small residuals", several_rhs},
  {"E NULL is the identity", identity_E},
  {"sizes 2 to 18, in line and through LAPACK, solve", every_small_size},
  {"dense, band, sparse and Krylov solutions agree", agree},
  {"a complex 2 x 2 solve equals the one by hand", by_hand},
  {"a real shift takes a complex right-hand side", complex_rhs_real_shift},
  {"columns with gaps are solved in place, the gaps untouched", neighbours},
  {"narrow and wide bands solve with rows exchanged", bandwidths},
  {"products equal plain sums", products},
  CU_TEST_INFO_NULL,
};
