/* test_exact.c: pencils exactly as they are given, by ranks modulo primes: degrees and chains at infinity
 * derived by hand, primes that divide what they should not, and sums that rounding has spoilt.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "modular.h"
#include "prime_field.h"
#include "suite.h"
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

enum { MOST = 5 };
static const uint64_t mersenne = ((uint64_t)1 << 61) - 1;

/* Matrices by rows. */
typedef struct example {
  const char *name;
  int n;
  double E[9], F[9];
  int count; /* of the chains at infinity; -1: they do not end within MOST */
  sunindextype weyr[MOST];
  uint64_t unlucky; /* a prime that sees something else; 0: none here */
  int wrong;        /* how many numbers it sees, -1: they do not end */
  sunindextype seen[MOST];
} example;

static SUNMatrix matrix(steif_context *ctx, int n, const double *rows, bool sparse)
{
  SUNMatrix D = SUNDenseMatrix(n, n, steif_sundials(ctx));
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) SM_ELEMENT_D(D, i, j) = rows[i * n + j];
  if (!sparse) return D;
  SUNMatrix S = SUNSparseFromDenseMatrix(D, 0, CSC_MAT);
  SUNMatDestroy(D);
  return S;
}

static void chains_are(steif_context *ctx, const stf_field *f, const char *name, int count,
                       const sunindextype *weyr)
{
  sunindextype found[MOST] = {0};
  int got;
  CHECK(!stf_field_chains(ctx, f, MOST, found, &got));
  bool same = got == count;
  for (int k = 0; same && k < count; k++) same = found[k] == weyr[k];
  CHECK(same);
  if (!same) printf("\n  %s: %d chains, %d", name, got, count);
}

/* det(s E + F) by hand; a chain at infinity for every degree that is lost. With leading coefficients 3
 * and 7 and the modulus 3 or 7 a finite eigenvalue seems infinite, or all does. */
static const example examples[] = {
  /* s^2 - s^2 + ...: (s+1)(s+2) - s^2 = 3 s + 2 */
  {"a floating capacitor", 2, {1, -1, -1, 1}, {1, 0, 0, 2}, 1, {1}, 3, 2, {1, 1}},
  /* v_1 = v_2 is prescribed: the current of the source takes the charge */
  {"a capacitor across a source",
   3,
   {1, -1, 0, -1, 1, 0, 0, 0, 0},
   {1, 0, 1, 0, 2, -1, 1, -1, 0},
   2,
   {2, 1},
   3,
   -1,
   {0}},
  {"a ring of 1, 2, 3",
   3,
   {4, -1, -3, -1, 3, -2, -3, -2, 5},
   {1, 0, 0, 0, 1, 0, 0, 0, 1},
   1,
   {1},
   3,
   3,
   {1, 1, 1}},
  /* 0.1 + 0.2 is rounded: det E = 6.1e-18, and one eigenvalue is -5.4e16 */
  {"a ring of 0.1, 0.2, 0.3",
   3,
   {0.1 + 0.3, -0.1, -0.3, -0.1, 0.1 + 0.2, -0.2, -0.3, -0.2, 0.2 + 0.3},
   {1, 0, 0, 0, 1, 0, 0, 0, 1},
   0,
   {0},
   0,
   0,
   {0}},
  /* rows 2 and 3 of F agree but for a multiple: det = -4 + 4 = 0 there, a chain of 2 */
  {"a pattern that allows one",
   3,
   {1, 0, 0, 0, 0, 0, 0, 0, 0},
   {0, 1, 0, 1, 1, 2, 0, 2, 4},
   2,
   {2, 1},
   0,
   0,
   {0}},
  /* det E = 7 */
  {"a determinant of 7", 2, {3, 1, 2, 3}, {1, 0, 0, 1}, 0, {0}, 7, 1, {1}},
};
enum { EXAMPLES = sizeof examples / sizeof *examples };

static void by_hand(void)
{
  steif_context *ctx = steif_context_new(NULL);
  for (int k = 0; k < 2 * EXAMPLES; k++) {
    const example *e = examples + k / 2;
    stf_field f;
    SUNMatrix E = matrix(ctx, e->n, e->E, k % 2), F = matrix(ctx, e->n, e->F, k % 2);
    bool singular;
    CHECK(!stf_field_open(ctx, E, F, false, &f));
    CHECK(!stf_field_singular(ctx, &f, &singular) && !singular);
    chains_are(ctx, &f, e->name, e->count, e->weyr);
    f.prime[0] = f.prime[1] = mersenne;
    chains_are(ctx, &f, e->name, e->count, e->weyr);
    if (e->unlucky) {
      f.prime[0] = f.prime[1] = e->unlucky;
      chains_are(ctx, &f, e->name, e->wrong, e->seen);
      f.prime[0] = mersenne; /* one that is not unlucky is enough */
      chains_are(ctx, &f, e->name, e->count, e->weyr);
    }
    SUNMatDestroy(E), SUNMatDestroy(F);
  }
  steif_context_free(&ctx);
}

/* The ring as it is meant: diagonals are the exact negative sums of their rows. */
static void snapped(void)
{
  const example *e = examples + 3;
  steif_context *ctx = steif_context_new(NULL);
  for (int sparse = 0; sparse < 2; sparse++) {
    SUNMatrix E = matrix(ctx, 3, e->E, sparse), F = matrix(ctx, 3, e->F, sparse);
    unsigned char rounded[3];
    stf_field f;
    CHECK(!stf_field_rounded_rows(ctx, E, rounded) && rounded[0] + rounded[1] + rounded[2] > 0);
    CHECK(!stf_field_open(ctx, E, F, true, &f));
    chains_are(ctx, &f, "snapped", 1, (const sunindextype[]){1});
    CHECK(!stf_field_rounded_rows(ctx, F, rounded) && !rounded[0] && !rounded[1] &&
          !rounded[2]);
    SUNMatDestroy(E), SUNMatDestroy(F);
  }
  /* 1e-12 is no rounding of 0.3. */
  double far[9];
  memcpy(far, e->E, sizeof far);
  far[0] *= 1 + 1e-12, far[4] *= 1 - 1e-12, far[8] *= 1 + 1e-12;
  SUNMatrix E = matrix(ctx, 3, far, false);
  unsigned char rounded[3];
  CHECK(!stf_field_rounded_rows(ctx, E, rounded) && !rounded[0] && !rounded[1] && !rounded[2]);
  SUNMatDestroy(E);
  steif_context_free(&ctx);
}

/* Two primes of 61 bits out of 5e16, and rows of a few bits. */
static void doubts_are_small(void)
{
  const example *e = examples;
  steif_context *ctx = steif_context_new(NULL);
  SUNMatrix E = matrix(ctx, e->n, e->E, false), F = matrix(ctx, e->n, e->F, false);
  stf_field f;
  CHECK(!stf_field_open(ctx, E, F, false, &f));
  /* rows (1, 1, 1) and (1, 1, 2): 1 + log2 3 and 2 + log2 3 bits at most */
  CLOSE(f.bits, 3 + 2 * log2(3), 1e-14);
  CLOSE(stf_field_doubt(&f, 2), pow(3 * f.bits / 61 / 5e16, 2), 1e-12);
  CHECK(stf_field_doubt(&f, 0) < 1e-35 && stf_field_doubt(&f, 0) > 0);
  CHECK(f.prime[0] != f.prime[1] && f.prime[0] >> 61 == 1 && f.prime[1] >> 61 == 1);
  SUNMatDestroy(E), SUNMatDestroy(F);
  steif_context_free(&ctx);
}

/* (p + 1) / 2 = 1/2, Fermat's little theorem, and doubles of all sizes. */
static void arithmetic_is_that_of_a_field(void)
{
  uint64_t state = 5;
  for (int k = 0; k < 20; k++) {
    stf_modulus m;
    const uint64_t p = k ? stf_random_prime(&state) : mersenne;
    stf_modulus_set(p, &m);
    const uint64_t a = stf_modular_whole(&m, stf_random_bits(&state) % p);
    CHECK(stf_modular_product(&m, a, stf_modular_inverse(&m, a)) == m.one);
    CHECK(stf_modular_sum(&m, a, stf_modular_negative(&m, a)) == 0);
    CHECK(stf_modular_double(&m, 0.5) == stf_modular_whole(&m, (p + 1) / 2));
    CHECK(stf_modular_double(&m, -3) == stf_modular_whole(&m, p - 3));
    const double x[] = {0x1p-1074, 0x1.123456789p300, -0x1.fp-1022, 1.7e308};
    for (int i = 0; i < 4; i++)
      CHECK(stf_modular_sum(&m, stf_modular_double(&m, x[i]), stf_modular_double(&m, -x[i])) ==
            0);
    CHECK(stf_modular_product(&m, stf_modular_double(&m, 0x1p-1074),
                              stf_modular_product(&m, stf_modular_double(&m, 0x1p1000),
                                                  stf_modular_double(&m, 0x1p74))) == m.one);
  }
}

CU_TestInfo tests_of_exact[] = {
  {"degrees and chains are those derived by hand", by_hand},
  {"rounded diagonals are snapped", snapped},
  {"the bound of a false rank is that of Hadamard", doubts_are_small},
  {"arithmetic modulo primes", arithmetic_is_that_of_a_field},
  CU_TEST_INFO_NULL};
