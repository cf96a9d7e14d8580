/* test_crew.c: slots factored side by side, and what memory is asked for.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "base/failing.h"
#include "gear.h"
#include "pencil.h"
#include "suite.h"
#include <stdlib.h>
#include <string.h>

static const SUNMatrix_ID storages[] = {SUNMATRIX_DENSE, SUNMATRIX_BAND, SUNMATRIX_SPARSE};
enum { STORAGES = 3, SHIFTS = 5 };

/* Convection and diffusion, n points in rows of m (m = 1: in one row): above the sizes at which
 * slots go side by side. */
static double entry(int i, int j, int m)
{
  const int d = i - j;
  return d == 0 ? -4.2 - 0.1 * (i % 7) : d == 1 || d == m ? 1.3 : d == -1 || d == -m ? 0.8 : 0;
}

static SUNMatrix large(SUNMatrix_ID id, int *n, SUNContext sun)
{
  *n = id == SUNMATRIX_DENSE ? 211 : 2116;
  const int m = id == SUNMATRIX_SPARSE ? 46 : 2;
  SUNMatrix M = id == SUNMATRIX_DENSE  ? SUNDenseMatrix(*n, *n, sun)
                : id == SUNMATRIX_BAND ? SUNBandMatrix(*n, m, m, sun)
                                       : SUNSparseMatrix(*n, *n, 5 * *n, CSC_MAT, sun);
  SUNMatZero(M);
  sunindextype k = 0;
  for (int j = 0; j < *n; j++) {
    if (id == SUNMATRIX_SPARSE) SM_INDEXPTRS_S(M)[j] = k;
    for (int i = j > m ? j - m : 0; i < *n && i <= j + m; i++) {
      const double x = entry(i, j, m);
      if (id == SUNMATRIX_DENSE) SM_ELEMENT_D(M, i, j) = x;
      if (id == SUNMATRIX_BAND) SM_ELEMENT_B(M, i, j) = x;
      if (id == SUNMATRIX_SPARSE && x != 0) SM_INDEXVALS_S(M)[k] = i, SM_DATA_S(M)[k++] = x;
    }
  }
  if (id == SUNMATRIX_SPARSE) SM_INDEXPTRS_S(M)[*n] = k;
  return M;
}

/* All slots factored twice by so many threads; solutions to x, which is allocated. */
static double *factored(SUNMatrix_ID id, int threads, steif_pencil_stats *stats, int *n)
{
  steif_context *ctx = steif_context_new(&(steif_setup){.threads = threads});
  SUNContext sun = steif_sundials(ctx);
  SUNMatrix A = large(id, n, sun);
  steif_pencil *p = steif_pencil_new(ctx, NULL, A);
  const steif_shift s[2][SHIFTS] = {{{1.7, 0}, {0.3, 2}, {2.1, 0}, {0.7, -5}, {4, 11}},
                                    {{1.9, 0}, {0.4, 2}, {2.3, 0}, {0.6, -5}, {3, 11}}};
  double *x = malloc(sizeof *x * 2 * SHIFTS * (size_t)*n);
  for (int round = 0; round < 2; round++) CHECK(steif_pencil_factor(p, SHIFTS, s[round]) == 0);
  for (int k = 0; k < SHIFTS; k++) {
    N_Vector re = gear_vector(*n, 3u + (unsigned)k, sun), im = gear_vector(*n, 8, sun);
    CHECK(steif_pencil_solve(p, k, 1, &re, &im) == STEIF_OK);
    memcpy(x + 2 * k * *n, NV_DATA_S(re), sizeof *x * (size_t)*n);
    memcpy(x + (2 * k + 1) * *n, NV_DATA_S(im), sizeof *x * (size_t)*n);
    N_VDestroy(re), N_VDestroy(im);
  }
  *stats = *steif_pencil_statistics(p);
  steif_pencil_free(&p);
  SUNMatDestroy(A);
  steif_context_free(&ctx);
  return x;
}

static void side_by_side(void)
{
  for (int i = 0; i < STORAGES; i++) {
    int n;
    steif_pencil_stats alone, together;
    double *x = factored(storages[i], 1, &alone, &n);
    for (int threads = 2; threads <= 4; threads += 2) {
      double *y = factored(storages[i], threads, &together, &n);
      CHECK(memcmp(x, y, sizeof *x * 2 * SHIFTS * (size_t)n) == 0);
      CHECK(memcmp(&alone, &together, sizeof alone) == 0);
      free(y);
    }
    CHECK(alone.factors + alone.refactors == 2 * SHIFTS && alone.solves == SHIFTS);
    CHECK(alone.refactors == (storages[i] == SUNMATRIX_SPARSE ? SHIFTS : 0));
    free(x);
  }
}

/* A = c I has the one eigenvalue c: the slot with that shift fails, its sentence reaches the
 * context, and the others stand. */
static void one_of_many_fails(void)
{
  steif_context *ctx = steif_context_new(&(steif_setup){.threads = 3});
  SUNContext sun = steif_sundials(ctx);
  int n;
  SUNMatrix A = large(SUNMATRIX_SPARSE, &n, sun);
  for (int j = 0; j < n; j++)
    for (sunindextype k = SM_INDEXPTRS_S(A)[j]; k < SM_INDEXPTRS_S(A)[j + 1]; k++)
      SM_DATA_S(A)[k] = SM_INDEXVALS_S(A)[k] == j ? 0.75 : 0;
  steif_pencil *p = steif_pencil_new(ctx, NULL, A);
  const steif_shift s[4] = {{0.25, 0}, {0.75, 3}, {0.75, 0}, {1.25, 0}};
  CHECK(steif_pencil_factor(p, 4, s) == STEIF_SINGULAR);
  CHECK(strstr(steif_message(ctx), "s = 0.75+0i") != NULL);
  N_Vector re = gear_vector(n, 21, sun), im = gear_vector(n, 22, sun);
  for (int k = 0; k < 4; k++)
    CHECK(steif_pencil_solve(p, k, 1, &re, &im) == (k == 2 ? STEIF_BAD_INPUT : STEIF_OK));
  N_VDestroy(re), N_VDestroy(im);
  steif_pencil_free(&p);
  SUNMatDestroy(A);
  steif_context_free(&ctx);
}

enum { N = 33 };
static gear g;
static failing fails;

/* A life of a pencil of one kind; the first code that is not 0. `work`: requests for memory
 * after everything had been done once. */
static int life(int kind, long *work)
{
  const steif_setup setup = failing_setup(&fails);
  steif_context *ctx = steif_context_new(&setup);
  if (!ctx) return STEIF_NO_MEMORY;
  SUNContext sun = steif_sundials(ctx);
  SUNMatrix E = NULL, A = NULL;
  if (kind < STORAGES)
    E = gear_matrix(g.E, N, storages[kind], sun), A = gear_matrix(g.A, N, storages[kind], sun);
  N_Vector re[2] = {gear_vector(N, 1, sun), gear_vector(N, 2, sun)};
  N_Vector im[2] = {gear_vector(N, 3, sun), gear_vector(N, 4, sun)};
  const steif_operator op = gear_operator(&g);
  steif_pencil *p =
    kind < STORAGES ? steif_pencil_new(ctx, E, A) : steif_pencil_new_operator(ctx, &op, re[0]);
  int code = p ? STEIF_OK : steif_status(ctx);
  for (int round = 0; !code && round < 3; round++) {
    const steif_shift s[2] = {{2.5 + 0.1 * round, 0}, {1.5, 2.5 + 0.1 * round}};
    if (round == 1) *work = fails.served;
    code = steif_pencil_update(p);
    if (!code) code = steif_pencil_factor(p, 2, s);
    if (!code) code = steif_pencil_solve(p, 0, 2, re, NULL);
    if (!code) code = steif_pencil_solve(p, 1, 2, re, im);
    if (!code) code = steif_pencil_product(p, 'E', re[0], re[1]);
  }
  *work = fails.served - *work;
  steif_pencil_free(&p);
  if (E) SUNMatDestroy(E), SUNMatDestroy(A);
  for (int i = 0; i < 2; i++) N_VDestroy(re[i]), N_VDestroy(im[i]);
  steif_context_free(&ctx);
  return code;
}

static void hunger(void)
{
  gear_fill(&g, N, false, 777u);
  for (int kind = 0; kind <= STORAGES; kind++) {
    long k = 0, work;
    for (int code = STEIF_NO_MEMORY; code;) {
      fails = (failing){.refuse_at = ++k};
      code = life(kind, &work);
      CHECK(fails.alive == 0);
      CHECK(code == (fails.served >= k ? STEIF_NO_MEMORY : STEIF_OK));
      if (k > 2000) break;
    }
    CHECK(k > 5 && k < 2000);
  }
}

static void thrift(void)
{
  gear_fill(&g, N, false, 777u);
  for (int kind = 0; kind <= STORAGES; kind++) {
    long work = -1;
    fails = (failing){0};
    CHECK(life(kind, &work) == STEIF_OK);
    CHECK(work == 0);
  }
}

/* Large enough for threads, and a chain: cheap. */
static SUNMatrix chain(int n, SUNContext sun)
{
  SUNMatrix M = SUNSparseMatrix(n, n, 3 * n, CSC_MAT, sun);
  sunindextype k = 0;
  for (int j = 0; j < n; j++) {
    SM_INDEXPTRS_S(M)[j] = k;
    for (int i = j ? j - 1 : 0; i < n && i <= j + 1; i++)
      SM_INDEXVALS_S(M)[k] = i, SM_DATA_S(M)[k++] = entry(i, j, 1);
  }
  SM_INDEXPTRS_S(M)[n] = k;
  return M;
}

static void solves_side_by_side(void)
{
  enum { LANES = 4, LONG = 8100 };
  static const steif_shift s[LANES] = {{0.3, 2}, {1.7, 0}, {0.7, -5}, {4, 11}};
  for (int threads = 1; threads <= 3; threads++) {
    steif_context *c = steif_context_new(&(steif_setup){.threads = threads});
    SUNContext sun = steif_sundials(c);
    SUNMatrix A = chain(LONG, sun);
    steif_pencil *p = steif_pencil_new(c, NULL, A);
    CHECK(steif_pencil_factor(p, LANES, s) == STEIF_OK);
    N_Vector re[LANES], im[LANES], alone[2];
    for (int k = 0; k < LANES; k++) {
      re[k] = gear_vector(LONG, 5u + (unsigned)k, sun);
      im[k] = s[k].im != 0 ? gear_vector(LONG, 17u + (unsigned)k, sun) : NULL;
    }
    CHECK(stf_parallel_solve(p, LANES, re, im) == STEIF_OK);
    CHECK(steif_pencil_statistics(p)->solves == LANES);
    for (int k = 0; k < LANES; k++) {
      alone[0] = gear_vector(LONG, 5u + (unsigned)k, sun);
      alone[1] = gear_vector(LONG, 17u + (unsigned)k, sun);
      CHECK(steif_pencil_solve(p, k, 1, alone, im[k] ? alone + 1 : NULL) == STEIF_OK);
      CHECK(!memcmp(NV_DATA_S(re[k]), NV_DATA_S(alone[0]), LONG * sizeof(double)));
      if (im[k]) CHECK(!memcmp(NV_DATA_S(im[k]), NV_DATA_S(alone[1]), LONG * sizeof(double)));
      N_VDestroy(re[k]), N_VDestroy(alone[0]), N_VDestroy(alone[1]);
      if (im[k]) N_VDestroy(im[k]);
    }
    steif_pencil_free(&p), SUNMatDestroy(A);
    steif_context_free(&c);
  }
}

CU_TestInfo tests_of_crew[] = {
  {"solves side by side are those one by one, bit for bit", solves_side_by_side},
  {"one, two and four threads agree bit for bit", side_by_side},
  {"a failure beside others is told, the others stand", one_of_many_fails},
  {"every allocation may fail without crash or leak", hunger},
  {"nothing is allocated once every slot has been factored", thrift},
  CU_TEST_INFO_NULL,
};
