/* The multifrontal LU behind sparse pencils: symbolic invariants, solutions, bad pivots.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fill_order.h"
#include "multifrontal.h"
#include "gear.h"
#include "suite.h"
#include <stdlib.h>

/* A square of m x m points, each with `of` unknowns coupled in full at the point and one by one to
 * its neighbours below and on the right only (the pattern is not symmetric), or to all four. */
static SUNMatrix square(int m, int of, bool one_sided, SUNContext sun)
{
  const int n = m * m * of;
  unsigned seed = 4711;
  SUNMatrix M = SUNSparseMatrix(n, n, (of + 4) * n, CSC_MAT, sun);
  sunindextype used = 0;
  for (int j = 0; j < n; j++) {
    const int at = j / of, x = at % m, y = at / m;
    SM_INDEXPTRS_S(M)[j] = used;
    const int near[] = {x + 1 < m ? at + 1 : -1, y + 1 < m ? at + m : -1,
                        x && !one_sided ? at - 1 : -1, y && !one_sided ? at - m : -1};
    for (int k = 0; k < of; k++) {
      SM_INDEXVALS_S(M)[used] = at * of + k;
      SM_DATA_S(M)[used++] = at * of + k == j ? -4.3 + gear_random(&seed) : gear_random(&seed);
    }
    for (int k = 0; k < 4; k++) {
      if (near[k] < 0) continue;
      SM_INDEXVALS_S(M)[used] = near[k] * of + j % of;
      SM_DATA_S(M)[used++] = 1 + 0.3 * gear_random(&seed);
    }
  }
  SM_INDEXPTRS_S(M)[n] = used;
  return M;
}

/* max |(s - A) x - b| / ((|s| + max |A|) n max |x| ...): residuals are of the size of rounding. */
static double residual(SUNMatrix A, double s, const double *x, const double *b)
{
  const sunindextype n = SM_COLUMNS_S(A);
  double *r = malloc(sizeof *r * (size_t)n), most = 0, size = 0;
  for (sunindextype i = 0; i < n; i++) r[i] = s * x[i] - b[i], size = fmax(size, fabs(x[i]));
  for (sunindextype j = 0; j < n; j++)
    for (sunindextype k = SM_INDEXPTRS_S(A)[j]; k < SM_INDEXPTRS_S(A)[j + 1]; k++)
      r[SM_INDEXVALS_S(A)[k]] -= SM_DATA_S(A)[k] * x[j];
  for (sunindextype i = 0; i < n; i++) most = fmax(most, fabs(r[i]));
  free(r);
  return most / (10 * size);
}

/* The order is a permutation, the fronts cover the columns, every entry has one place, rows below
 * ascend and go to rows of the parent. */
static void symbolic_invariants(void)
{
  steif_context *ctx = steif_context_new(NULL);
  const struct {
    int m, of;
    bool one_sided;
  } cases[] = {{1, 1, false}, {2, 3, true}, {17, 1, false}, {12, 2, true}, {31, 2, false}};
  for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
    SUNMatrix A = square(cases[c].m, cases[c].of, cases[c].one_sided, steif_sundials(ctx));
    const sunindextype n = SM_COLUMNS_S(A);
    stf_pattern u = {.n = n, .nnz = SM_INDEXPTRS_S(A)[n]};
    u.ptr = calloc((size_t)(n + 1 + u.nnz), sizeof *u.ptr), u.row = u.ptr + n + 1;
    for (sunindextype k = 0; k <= n; k++) u.ptr[k] = SM_INDEXPTRS_S(A)[k];
    for (sunindextype k = 0; k < u.nnz; k++) u.row[k] = SM_INDEXVALS_S(A)[k];
    stf_multifrontal *f;
    CU_ASSERT_FATAL(!stf_multifrontal_open(ctx, &u, &f));
    int *seen = calloc((size_t)u.nnz + (size_t)n, sizeof *seen), columns = 0;
    sunindextype entries = 0;
    for (int k = 0; k < n; k++) CHECK(f->place[f->order[k]] == k && !seen[f->order[k]]++);
    for (int k = 0; k < n; k++) seen[k] = 0;
    for (int s = 0; s < f->count; s++) {
      const stf_front *g = &f->front[s];
      CHECK(g->first == columns && g->width > 0 && (g->parent > s || g->parent == -1));
      CHECK((g->parent == -1) == (g->below == 0));
      columns += g->width;
      for (int k = 0; k < g->below; k++) {
        const int row = f->rows[g->row + k], into = f->into[g->row + k];
        const stf_front *up = &f->front[g->parent];
        CHECK(row >= columns && row < n && (!k || row > f->rows[g->row + k - 1]));
        CHECK(row ==
              (into < up->width ? up->first + into : f->rows[up->row + into - up->width]));
      }
      for (sunindextype e = g->entry; e < g->entry + g->entries; e++, entries++) {
        CHECK(!seen[f->entry[e]]++);
        CHECK(f->target[e] < (sunindextype)g->width * (g->width + 2 * g->below));
      }
    }
    CHECK(columns == n && entries == u.nnz);
    free(seen), free(u.ptr);
    stf_multifrontal_free(ctx, &f);
    SUNMatDestroy(A);
  }
  steif_context_free(&ctx);
}

/* A chain costs about one flop an entry, a square grid ever more. */
static void work_of_orders(void)
{
  steif_context *ctx = steif_context_new(NULL);
  double work[3], entries;
  const int side[] = {10, 20, 40};
  for (int k = 0; k < 3; k++) {
    SUNMatrix A = square(side[k], 1, false, steif_sundials(ctx));
    work[k] = stf_fill_work(SM_COLUMNS_S(A), SM_INDEXPTRS_S(A), SM_INDEXVALS_S(A), &entries);
    work[k] /= entries;
    SUNMatDestroy(A);
  }
  CHECK(work[0] > 3 && work[1] > 1.4 * work[0] && work[2] > 1.4 * work[1]);
  sunindextype column[101], row[300], used = 0;
  for (int j = 0; j < 100; j++) {
    column[j] = used;
    for (int i = j ? j - 1 : 0; i <= j + 1 && i < 100; i++) row[used++] = i;
  }
  column[100] = used;
  /* 99 quotients, 99 products and differences; 99 + 99 + 100 entries */
  CLOSE(stf_fill_work(100, column, row, &entries), 99 * 3.0, 1e-14);
  CLOSE(entries, 298, 1e-14);
  steif_context_free(&ctx);
}

/* Above and below the size from which on dissection orders; any number of right-hand sides. */
static void solutions(void)
{
  steif_context *ctx = steif_context_new(NULL);
  SUNContext sun = steif_sundials(ctx);
  for (int c = 0; c < 4; c++) {
    SUNMatrix A = square(c < 2 ? 15 : 29, 1 + c % 2, c == 1, sun);
    const int n = (int)SM_COLUMNS_S(A);
    steif_pencil *p = steif_pencil_new(ctx, NULL, A);
    CHECK(!steif_pencil_factor(p, 1, &(steif_shift){0.37, 0}));
    for (int count = 1; count <= 19; count += 1 + count / 4) {
      N_Vector x[19], b[19];
      for (int k = 0; k < count; k++)
        x[k] = gear_vector(n, 7u + (unsigned)k, sun),
        b[k] = gear_vector(n, 7u + (unsigned)k, sun);
      CHECK(!steif_pencil_solve(p, 0, count, x, NULL));
      for (int k = 0; k < count; k++) {
        CHECK(residual(A, 0.37, NV_DATA_S(x[k]), NV_DATA_S(b[k])) < 2e-15);
        N_VDestroy(x[k]), N_VDestroy(b[k]);
      }
    }
    for (sunindextype k = 0; k < SM_INDEXPTRS_S(A)[n]; k++) SM_DATA_S(A)[k] *= 1.13;
    CHECK(!steif_pencil_update(p) && !steif_pencil_factor(p, 1, &(steif_shift){0.91, 0}));
    N_Vector x = gear_vector(n, 3, sun), b = gear_vector(n, 3, sun);
    CHECK(!steif_pencil_solve(p, 0, 1, &x, NULL));
    CHECK(residual(A, 0.91, NV_DATA_S(x), NV_DATA_S(b)) < 2e-15);
    const steif_pencil_stats *t = steif_pencil_statistics(p);
    CHECK(t->analyses == 1 && t->factors == 1 && t->refactors == 1 && t->fallbacks == 0);
    N_VDestroy(x), N_VDestroy(b);
    steif_pencil_free(&p);
    SUNMatDestroy(A);
  }
  steif_context_free(&ctx);
}

/* The same pencil dense and sparse, real shifts and complex ones. */
static void dense_agrees(void)
{
  steif_context *ctx = steif_context_new(NULL);
  SUNContext sun = steif_sundials(ctx);
  SUNMatrix A = square(17, 2, false, sun);
  const sunindextype n = SM_COLUMNS_S(A);
  SUNMatrix D = SUNDenseMatrix(n, n, sun);
  for (sunindextype j = 0; j < n; j++)
    for (sunindextype k = SM_INDEXPTRS_S(A)[j]; k < SM_INDEXPTRS_S(A)[j + 1]; k++)
      SM_ELEMENT_D(D, SM_INDEXVALS_S(A)[k], j) = SM_DATA_S(A)[k];
  steif_pencil *p = steif_pencil_new(ctx, NULL, A), *q = steif_pencil_new(ctx, NULL, D);
  const steif_shift s[] = {{1.3, 0}, {0.4, 2.2}, {-0.2, 0}, {1.3, 1e-13}};
  CHECK(!steif_pencil_factor(p, 4, s) && !steif_pencil_factor(q, 3, s));
  double near = 0, log_det = 0;
  CHECK(!stf_pencil_logdet(p, 0, &log_det) && !stf_pencil_logdet(p, 3, &near)); /* KLU's */
  CLOSE(log_det, near, 1e-12);
  for (int k = 0; k < 3; k++) {
    N_Vector v[4];
    for (int i = 0; i < 4; i++) v[i] = gear_vector((int)n, 5u + (unsigned)i / 2, sun);
    const bool complex = s[k].im != 0;
    CHECK(!steif_pencil_solve(p, k, 1, v, complex ? v + 2 : NULL));
    CHECK(!steif_pencil_solve(q, k, 1, v + 1, complex ? v + 3 : NULL));
    for (sunindextype i = 0; i < n; i++) {
      CLOSE_FLOOR(NV_Ith_S(v[0], i), NV_Ith_S(v[1], i), 1e-12, 1);
      CLOSE_FLOOR(NV_Ith_S(v[2], i), NV_Ith_S(v[3], i), 1e-12, 1);
    }
    for (int i = 0; i < 4; i++) N_VDestroy(v[i]);
  }
  steif_pencil_free(&p), steif_pencil_free(&q);
  SUNMatDestroy(A), SUNMatDestroy(D);
  steif_context_free(&ctx);
}

/* E = diag(1, 0) with constraints [0 B; B^T 0] at s = 0 has no pivot on the diagonal, and with
 * 1e-9 there only bad ones: KLU takes over and solves. */
static void bad_pivots_go_to_klu(void)
{
  for (int tiny = 0; tiny < 2; tiny++) {
    steif_context *ctx = steif_context_new(NULL);
    SUNContext sun = steif_sundials(ctx);
    enum { HALF = 150, TWICE = 2 * HALF };
    SUNMatrix A = SUNSparseMatrix(TWICE, TWICE, 3 * TWICE, CSC_MAT, sun);
    sunindextype used = 0;
    for (int j = 0; j < TWICE; j++) {
      const int other = j < HALF ? j + HALF : j - HALF;
      SM_INDEXPTRS_S(A)[j] = used;
      SM_INDEXVALS_S(A)[used] = j, SM_DATA_S(A)[used++] = tiny ? 1e-9 : 0;
      SM_INDEXVALS_S(A)[used] = other, SM_DATA_S(A)[used++] = 2 + 0.01 * j;
      if (j % HALF + 1 < HALF) SM_INDEXVALS_S(A)[used] = other + 1, SM_DATA_S(A)[used++] = 0.7;
    }
    SM_INDEXPTRS_S(A)[TWICE] = used;
    steif_pencil *p = steif_pencil_new(ctx, NULL, A);
    for (int round = 0; round < 2; round++) {
      CHECK(!steif_pencil_update(p) && !steif_pencil_factor(p, 1, &(steif_shift){0, 0}));
      N_Vector x = gear_vector(TWICE, 9, sun), b = gear_vector(TWICE, 9, sun);
      CHECK(!steif_pencil_solve(p, 0, 1, &x, NULL));
      CHECK(residual(A, 0, NV_DATA_S(x), NV_DATA_S(b)) < 1e-15);
      N_VDestroy(x), N_VDestroy(b);
    }
    const steif_pencil_stats *t = steif_pencil_statistics(p);
    CHECK(t->factors == 1 && t->refactors == 1);
    steif_pencil_free(&p);
    SUNMatDestroy(A);
    steif_context_free(&ctx);
  }
}

CU_TestInfo tests_of_multifrontal[] = {
  {"symbolic invariants", symbolic_invariants},
  {"work of orders", work_of_orders},
  {"solutions for any number of right-hand sides", solutions},
  {"dense and sparse agree, real and complex", dense_agrees},
  {"bad pivots go to KLU", bad_pivots_go_to_klu},
  CU_TEST_INFO_NULL,
};
