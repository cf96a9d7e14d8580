/* test_batch.c: shifts side by side against dense products of their factors, against KLU, and
 * with pivots and memory that fail.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "base/failing.h"
#include "multishift.h"
#include "pencil.h"
#include "gear.h"
#include "suite.h"
#include <complex.h>
#include <string.h>

enum { N = 47, BLOCKS = 6, LANES = STF_LANES };
static const int first[BLOCKS + 1] = {0, 1, 9, 10, 12, 30, N};

typedef double complex number;

static steif_context *ctx;
static SUNMatrix E, A;
static steif_pencil *p;
static stf_sequence *sequence;
static const stf_steps *q; /* of it */
static stf_multishift batch;

static const steif_shift shifts[LANES] = {{1.3, 0.7}, {-0.4, 2.1}, {3.7, -1.9}, {0.2, 0.35}};

/* Random, block upper triangular before rows and columns are mixed; E has a third of the
 * entries. */
static void begin(const steif_setup *setup, unsigned seed)
{
  static double e[N * N], a[N * N];
  unsigned state = seed;
  memset(e, 0, sizeof e), memset(a, 0, sizeof a);
  for (int b = 0; b < BLOCKS; b++)
    for (int j = first[b]; j < first[b + 1]; j++)
      for (int i = 0; i < first[b + 1]; i++) {
        const int k = i * 20 % N + N * (j * 33 % N);
        const double chance = gear_random(&state), x = gear_random(&state);
        if (i == j || chance > 0.7 || i == j + 1) a[k] = x + (i == j) * 0.3;
        if (chance < -0.3 && (i >= first[b] || chance < -0.8)) e[k] = x;
      }
  ctx = steif_context_new(setup);
  E = gear_matrix(e, N, SUNMATRIX_SPARSE, steif_sundials(ctx));
  A = gear_matrix(a, N, SUNMATRIX_SPARSE, steif_sundials(ctx));
  p = steif_pencil_new(ctx, E, A);
}

static int open(void)
{
  if (!p) return steif_status(ctx);
  int code = steif_pencil_factor(p, 1, shifts);
  if (!code) code = stf_sequence_open(p, 0, &sequence);
  q = (const stf_steps *)sequence;
  if (!code) code = stf_multishift_open(sequence, &batch);
  if (!code) memcpy(batch.s, shifts, sizeof shifts);
  return code;
}

static void end(void)
{
  stf_multishift_close(&batch);
  stf_sequence_close(&sequence);
  steif_pencil_free(&p);
  SUNMatDestroy(E), SUNMatDestroy(A);
  steif_context_free(&ctx);
}

static number at(const double *x, sunindextype k, int lane)
{
  x += 2 * LANES * k + lane;
  return x[0] + I * x[LANES];
}

/* s E - A in the order of the pivots; the two matrices apart. */
static void dense(steif_shift s, number *M)
{
  memset(M, 0, sizeof *M * N * N);
  for (int which = 0; which < 2; which++) {
    SUNMatrix from = which ? A : E;
    const number factor = which ? -1 : s.re + I * s.im;
    for (int k = 0; k < N; k++)
      for (sunindextype t = SM_INDEXPTRS_S(from)[sequence->unknown[k]];
           t < SM_INDEXPTRS_S(from)[sequence->unknown[k] + 1]; t++)
        M[q->place[SM_INDEXVALS_S(from)[t]] + N * k] += factor * SM_DATA_S(from)[t];
  }
}

/* L U of one lane, with the entries above the blocks taken from M. */
static void product(int lane, const number *M, number *LU)
{
  static number L[N * N], U[N * N];
  memset(L, 0, sizeof L), memset(U, 0, sizeof U);
  for (int k = 0; k < N; k++) {
    L[k + N * k] = 1, U[k + N * k] = 1 / at(batch.pivot, k, lane);
    for (SuiteSparse_long t = q->lower[k]; t < q->lower[k + 1]; t++)
      L[q->below[t] + N * k] = at(batch.l, t, lane);
    for (SuiteSparse_long t = q->upper[k]; t < q->upper[k + 1]; t++)
      U[q->above[t] + N * k] = at(batch.u, t, lane);
  }
  for (int b = 0; b < q->blocks; b++)
    for (int j = q->first[b]; j < q->first[b + 1]; j++)
      for (int i = 0; i < N; i++) {
        LU[i + N * j] = i < q->first[b] ? M[i + N * j] : 0;
        for (int k = 0; k < N && i >= q->first[b]; k++)
          LU[i + N * j] += L[i + N * k] * U[k + N * j];
      }
}

/* min over columns of max |M| / max |U|, both within blocks. */
static double least_growth(int lane, const number *M)
{
  double least = 1;
  for (int b = 0; b < q->blocks; b++)
    for (int k = q->first[b]; k < q->first[b + 1]; k++) {
      double of_m = 0, of_u = 1 / cabs(at(batch.pivot, k, lane));
      for (int i = q->first[b]; i < q->first[b + 1]; i++) of_m = fmax(of_m, cabs(M[i + N * k]));
      for (SuiteSparse_long t = q->upper[k]; t < q->upper[k + 1]; t++)
        of_u = fmax(of_u, cabs(at(batch.u, t, lane)));
      least = fmin(least, of_m / of_u);
    }
  return least;
}

static void factors(void)
{
  static number M[N * N], LU[N * N];
  for (unsigned seed = 1; seed < 6; seed++) {
    begin(NULL, seed);
    CU_ASSERT_FATAL(open() == STEIF_OK);
    CHECK(q->blocks >= BLOCKS / 2 && q->column[N] == q->row[N]);
    stf_multishift_factor(&batch, 1e-12, NULL);
    for (int lane = 0; lane < LANES; lane++) {
      double off = 0, size = 0, log_det = 0;
      dense(shifts[lane], M);
      product(lane, M, LU);
      for (int i = 0; i < N * N; i++) off = fmax(off, cabs(LU[i] - M[i]));
      for (int i = 0; i < N * N; i++) size = fmax(size, cabs(M[i]));
      CHECK(batch.good[lane] && off <= 1e-14 * size / batch.growth[lane]);
      CLOSE(batch.growth[lane], least_growth(lane, M), 1e-12);
      for (int k = 0; k < N; k++) log_det -= log(cabs(at(batch.pivot, k, lane)));
      CLOSE(batch.log_det[lane], log_det, 1e-12);
    }
    end();
  }
}

/* Three powers of z = 1 / s, some rows scaled; each node also by KLU at its own pivots. */
static void solutions(void)
{
  static double g[3 * N], scale[N], x[2 * N];
  for (int i = 0; i < 3 * N; i++) g[i] = sin(1.7 * i);
  for (int i = 0; i < N; i++) scale[i] = i % 4 ? 1 : 0.5;
  const stf_polynomial b = {2, g, g + N, scale};
  for (int refined = 0; refined < 2; refined++) {
    begin(NULL, 77);
    CU_ASSERT_FATAL(open() == STEIF_OK);
    CU_ASSERT_FATAL(steif_pencil_factor(p, LANES, shifts) == STEIF_OK);
    stf_multishift_factor(&batch, 0, &b);
    stf_multishift_refine(&batch, &b, refined ? 2 : 0, 0);
    for (int lane = 0; lane < LANES; lane++) {
      const number z = 1 / (shifts[lane].re + I * shifts[lane].im);
      double off = 0, size = 0, log_det;
      for (int i = 0; i < N; i++) {
        const number right = scale[i] * (g[i] + z * (g[N + i] + z * g[2 * N + i]));
        x[2 * i] = creal(right), x[2 * i + 1] = cimag(right);
      }
      stf_sparse_direct(p, lane, x);
      for (int k = 0; k < N; k++) {
        const number there = x[2 * sequence->unknown[k]] + I * x[2 * sequence->unknown[k] + 1];
        off = fmax(off, cabs(at(batch.x, k, lane) - there)), size = fmax(size, cabs(there));
      }
      CHECK(off <= 1e-12 * size);
      CHECK(stf_pencil_logdet(p, lane, &log_det) == STEIF_OK);
      CLOSE(batch.log_det[lane], log_det, 1e-12);
      CHECK(batch.solves[lane] == (refined ? 3 : 1) && batch.error[lane] < 1e-14);
    }
    end();
  }
}

/* The same shift beside others, and in another lane, bit for bit. */
static void lanes_alone(void)
{
  static double x[2][N * 2 * LANES];
  static const stf_polynomial b = {.constant = x[1]};
  steif_shift other[LANES];
  for (int i = 0; i < N; i++) x[1][i] = cos(2.3 * i);
  begin(NULL, 9);
  CU_ASSERT_FATAL(open() == STEIF_OK);
  stf_multishift_factor(&batch, 1e-12, &b);
  stf_multishift_refine(&batch, &b, 2, STF_EPS);
  memcpy(x[0], batch.x, sizeof x[0]);
  for (int lane = 0; lane < LANES; lane++)
    other[lane] = lane == 1 ? shifts[3] : (steif_shift){NAN, lane};
  const double log_det = batch.log_det[3], error = batch.error[3];
  const int solves = batch.solves[3];
  memcpy(batch.s, other, sizeof other);
  stf_multishift_factor(&batch, 1e-12, &b);
  stf_multishift_refine(&batch, &b, 2, STF_EPS);
  for (int k = 0; k < N; k++) CHECK(at(batch.x, k, 1) == at(x[0], k, 3));
  CHECK(batch.log_det[1] == log_det && batch.error[1] == error && batch.solves[1] == solves);
  for (int lane = 0; lane < LANES; lane++) CHECK(batch.good[lane] == (lane == 1));
  end();
}

/* [s - 2, 1; -1, s - 2] beside a loose unknown: singular at 2 + i, where i + 1/i = 0 is exact;
 * near to it a pivot is small, and good for those who ask for nothing but that it is not 0. */
static void bad_pivots(void)
{
  static const double e[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, a[9] = {2, 1, 0, -1, 2, 0, 0, 0, 3};
  static const double g[3] = {1.7, -0.6, 2.9};
  ctx = steif_context_new(NULL);
  E = gear_matrix(e, 3, SUNMATRIX_SPARSE, steif_sundials(ctx));
  A = gear_matrix(a, 3, SUNMATRIX_SPARSE, steif_sundials(ctx));
  p = steif_pencil_new(ctx, E, A);
  CU_ASSERT_FATAL(open() == STEIF_OK);
  batch.s[1] = (steif_shift){2, 1}, batch.s[2] = (steif_shift){2, 1 + 1e-9};
  batch.s[3] = (steif_shift){1e200, 1e200};
  const stf_polynomial b = {.constant = g};
  stf_multishift_factor(&batch, 0, &b);
  static const bool loose[LANES] = {true, false, true, false};
  for (int lane = 0; lane < LANES; lane++) CHECK(batch.good[lane] == loose[lane]);
  stf_multishift_refine(&batch, &b, 2, STF_EPS);
  for (int k = 0; k < 3; k++)
    if (sequence->unknown[k] == 2) {
      const number x = g[2] / (shifts[0].re - 3 + I * shifts[0].im);
      CHECK(cabs(at(batch.x, k, 0) - x) < 1e-15);
    }
  stf_multishift_factor(&batch, 3, NULL);
  for (int lane = 0; lane < LANES; lane++) CHECK(!batch.good[lane]);
  end();
}

/* Rows 1, 1 + d: x = (b_1 (1 + d) - b_2, b_2 - b_1) / d, of condition 4 / d. Ordinary residuals
 * leave an error of rounding times that. */
static void ill_conditioned(void)
{
  static const double d = 0x1p-30, e[4] = {0, 0, 0, 0}, a[4] = {-1, -1, -1, -1 - 0x1p-30};
  static const double g[2] = {0.7, 0.9};
  ctx = steif_context_new(NULL);
  E = gear_matrix(e, 2, SUNMATRIX_SPARSE, steif_sundials(ctx));
  A = gear_matrix(a, 2, SUNMATRIX_SPARSE, steif_sundials(ctx));
  p = steif_pencil_new(ctx, E, A);
  CU_ASSERT_FATAL(open() == STEIF_OK);
  stf_multishift_factor(&batch, 0, &(stf_polynomial){.constant = g});
  stf_multishift_refine(&batch, &(stf_polynomial){.constant = g}, 3, STF_EPS);
  for (int lane = 0; lane < LANES; lane++)
    for (int k = 0; k < 2; k++) {
      const long double x1 = ((long double)g[1] - g[0]) / d, x0 = (long double)g[0] - x1;
      const double x = (double)(sequence->unknown[k] ? x1 : x0);
      CHECK(cabs(at(batch.x, k, lane) - x) <= 2 * STF_EPS * fabs(x));
    }
  end();
}

/* Other values on the same pattern. */
static void refilled(void)
{
  static number M[N * N], LU[N * N];
  begin(NULL, 5);
  CU_ASSERT_FATAL(open() == STEIF_OK);
  for (int k = 0; k < SM_INDEXPTRS_S(A)[N]; k++) SM_DATA_S(A)[k] *= 1 + 0.1 * cos(k);
  for (int k = 0; k < SM_INDEXPTRS_S(E)[N]; k++) SM_DATA_S(E)[k] *= 1 + 0.1 * sin(k);
  CHECK(steif_pencil_update(p) == STEIF_OK);
  stf_sequence_fill(p, sequence);
  stf_multishift_factor(&batch, 0, NULL);
  for (int lane = 0; lane < LANES; lane++) {
    double off = 0;
    dense(shifts[lane], M);
    product(lane, M, LU);
    for (int i = 0; i < N * N; i++) off = fmax(off, cabs(LU[i] - M[i]));
    CHECK(off <= 1e-13 / batch.growth[lane]);
  }
  end();
}

static void hunger(void)
{
  static failing fails;
  const steif_setup setup = failing_setup(&fails);
  long asked = 0;
  int code = STEIF_NO_MEMORY;
  while (code && asked < 200) {
    fails = (failing){0};
    begin(&setup, 3);
    CU_ASSERT_FATAL(p != NULL);
    fails.refuse_at = fails.served + ++asked;
    code = open();
    CHECK(code == (fails.served >= fails.refuse_at ? STEIF_NO_MEMORY : STEIF_OK));
    end();
    CHECK(fails.alive == 0);
  }
  CHECK(asked > 20 && asked < 200);
}

CU_TestInfo tests_of_multishift[] = {
  {"L U of every lane is the matrix, determinants and growth its own", factors},
  {"solutions are those of KLU", solutions},
  {"a lane does not know its neighbours", lanes_alone},
  {"pivots that are 0, not finite or small make their lane bad alone", bad_pivots},
  {"refinement goes to rounding where the matrix is ill conditioned", ill_conditioned},
  {"new values on the same pivots", refilled},
  {"every allocation may fail without crash or leak", hunger},
  CU_TEST_INFO_NULL,
};
