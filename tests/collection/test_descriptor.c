/* test_descriptor.c: the generated descriptor systems have the sizes and the structure they claim,
 * and their exact starts are those of the definition.
 *
 * The independent computation is dense: finite eigenvalues by the QZ algorithm of LAPACK; x(0+) and
 * the impulses as Laurent coefficients at infinity of
 *   X(s) = (s E + F)^{-1} (E x(0-) + sum_j f^(j)(0) s^{-j-1}) = ... + c_1 s + c_0 + x(0+)/s + ...
 * by the trapezoidal rule on a circle beyond the finite eigenvalues.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "known_structure.h"
#include "fixture.h"
#include "lapack.h"
#include <complex.h>
#include <stdlib.h>

void dggev_(const char *left, const char *right, const int *n, double *a, const int *lda,
            double *b, const int *ldb, double *re, double *im, double *beta, double *vl,
            const int *ldvl, double *vr, const int *ldvr, double *work, const int *lwork,
            int *info, size_t, size_t);

enum { POINTS = 64 };

typedef struct start {
  fixture s;
  stf_exact_start x;
  SUNMatrix E, A;
} start;

static int start_open(start *q, const char *spec)
{
  *q = (start){0};
  if (fixture_open(&q->s, spec)) return 1;
  const steif_problem *p = &q->s.p;
  q->E = fixture_matrix(&q->s, p->nnz_E), q->A = fixture_matrix(&q->s, p->nnz);
  CHECK(p->E(0, q->s.y, q->s.yp, q->E, p->user) == 0);
  CHECK(p->A(0, q->s.y, q->s.yp, q->A, p->user) == 0);
  const int code = stf_exact_start_find(q->s.ctx, p, &q->x);
  if (code) printf("\n  %s: %s", spec, steif_message(q->s.ctx));
  CU_ASSERT_EQUAL(code, STEIF_OK);
  return code;
}

static void start_close(start *q)
{
  if (q->E) SUNMatDestroy(q->E), SUNMatDestroy(q->A);
  stf_exact_start_clear(q->s.ctx, &q->x);
  CHECK(!q->x.x_plus && !q->x.c);
  fixture_close(&q->s);
}

/* Counted by hand: of Stokes' E the faces 2 m (m-1), of F two five-point stencils and twice the
 * gradient, which a removed corner cell takes two entries from; of the springs two tridiagonal
 * blocks, -I and twice 2c - 1; of the ladder eight to a rung, two of the source, four to a cutset;
 * of the network three to each bus, two to each of 67 chords, five to each of 50 generators. */
static void sizes_are_those_announced(void)
{
  static const struct {
    const char *spec;
    sunindextype n, nnz_E, nnz;
    int index;
    sunindextype finite;
  } sizes[] = {{"stokes", 735, 480, 4192, 2, 225},
               {"stokes:m=32", 3007, 1984, 17600, 2, 961},
               {"springs", 420, 400, 1474, 3, 360},
               {"springs:n=3000,c=300", 6300, 6000, 22194, 3, 5400},
               {"hidden:lambda=1e6", 421, 401, 1477, 3, 361},
               {"ladder", 679, 439, 1754, 2, 398},
               {"ladder:n=5000", 16999, 10999, 43994, 2, 9998},
               {"ladder:n=300000", 1019999, 659999, 2639994, 2, 599998},
               {"bus", 300, 100, 984, 1, 100},
               {"blocks", 16, 256, 256, 3, 10},
               {"blocks:sizes=2x50.3x20,nf=300,rho=100", 460, 211600, 211600, 3, 300},
               {"blocks:index=4,nf=7,kind=stiff", 11, 121, 121, 4, 7},
               {"switchrlc", 5, 3, 10, 2, 2},
               {"impact", 5, 4, 8, 3, 2}};
  for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
    start q;
    if (start_open(&q, sizes[k].spec)) continue;
    CU_ASSERT_EQUAL(q.s.p.n, sizes[k].n);
    CU_ASSERT_EQUAL(q.s.p.nnz_E, sizes[k].nnz_E);
    CU_ASSERT_EQUAL(q.s.p.nnz, sizes[k].nnz);
    CU_ASSERT_EQUAL(q.s.p.dae_index, sizes[k].index);
    CU_ASSERT_EQUAL(q.x.index, sizes[k].index);
    CU_ASSERT_EQUAL(q.x.finite, sizes[k].finite);
    CHECK(!q.x.c == (sizes[k].index <= 1));
    CHECK(q.s.p.linear && steif_problem_form(q.s.ctx, &q.s.p) == STEIF_DESCRIPTOR);
    start_close(&q);
  }
}

/* sum += M x, terms += |M| |x|. */
static void accumulate(SUNMatrix M, double factor, const double *x, double *sum, double *terms)
{
  const int dense = SUNMatGetID(M) == SUNMATRIX_DENSE;
  const sunindextype n = dense ? SM_COLUMNS_D(M) : SM_COLUMNS_S(M);
  for (sunindextype j = 0; j < n; j++) {
    const sunindextype from = dense ? 0 : SM_INDEXPTRS_S(M)[j],
                       to = dense ? n : SM_INDEXPTRS_S(M)[j + 1];
    for (sunindextype k = from; k < to; k++) {
      const sunindextype i = dense ? k : SM_INDEXVALS_S(M)[k];
      const double term = factor * (dense ? SM_ELEMENT_D(M, i, j) : SM_DATA_S(M)[k]) * x[j];
      sum[i] += term, terms[i] += fabs(term);
    }
  }
}

/* F a + E b = 0, row by row to rounding of the terms; a or b may be NULL, and b may be a
 * difference of two vectors like `from`. */
static void vanishes(const start *q, const double *a, const double *b, const double *from,
                     const char *what, double tolerance)
{
  const size_t n = (size_t)q->s.p.n;
  double *sum = calloc(3 * n, sizeof *sum), *terms = sum + n, worst = 0, largest = 0;
  if (a) accumulate(q->A, -1, a, sum, terms);
  if (b) accumulate(q->E, 1, b, sum, terms);
  if (from) accumulate(q->E, 1, from, terms + n, terms);
  for (size_t i = 0; i < n; i++) largest = fmax(largest, terms[i]);
  for (size_t i = 0; i < n; i++) {
    const double floor = 1e-6 * largest;
    worst = fmax(worst, fabs(sum[i]) / fmax(fmax(terms[i], floor), 1e-300));
  }
  if (!(worst <= tolerance)) printf("\n  %s: %s is %.2e", q->s.p.name, what, worst);
  CU_ASSERT(worst <= tolerance);
  free(sum);
}

static void impulses_satisfy_the_equations(void)
{
  static const struct {
    const char *spec;
    double tolerance;
  } cases[] = {{"stokes", 1e-14},
               {"stokes:m=32,seed=4711", 1e-14},
               {"springs", 1e-14},
               {"springs:n=3000,c=300,seed=29", 1e-14},
               {"springs:n=7,c=7", 1e-14},
               {"hidden", 1e-14},
               {"hidden:lambda=1e8", 1e-14},
               {"ladder", 1e-14},
               {"ladder:n=5000", 1e-14},
               {"ladder:n=2", 1e-14},
               {"bus:n=37", 1e-13},
               {"blocks", 1e-13},
               {"blocks:sizes=5.2,kappa=1e3", 1e-11},
               {"blocks:sizes=3x10.2x10,nf=150,rho=1e3,kind=stiff", 1e-11},
               {"switchrlc:v1=-2.5", 1e-14},
               {"impact:gap=0.13", 1e-14}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    start q;
    if (start_open(&q, cases[k].spec)) continue;
    const sunindextype n = q.s.p.n;
    const int last = q.x.index - 2;
    const double tolerance = cases[k].tolerance;
    double *jump = calloc((size_t)n, sizeof *jump), largest = 0;
    for (sunindextype i = 0; i < n; i++) {
      jump[i] = q.x.x_plus[i] - q.s.p.y0[i];
      if (last >= 0) largest = fmax(largest, fabs(q.x.c[last * n + i]));
    }
    CHECK(last < 0 || largest > 1e-7);
    vanishes(&q, last < 0 ? NULL : q.x.c, jump, q.s.p.y0, "F c_0 + E (x+ - x-)", tolerance);
    for (int i = 1; i <= last; i++)
      vanishes(&q, q.x.c + i * n, q.x.c + (i - 1) * n, NULL, "F c_i + E c_{i-1}", tolerance);
    if (last >= 0) vanishes(&q, NULL, q.x.c + last * n, NULL, "E c_{k-2}", tolerance);
    free(jump);
    start_close(&q);
  }
}

/* The matrices by columns, -A = F. */
static void densify(const start *q, double *E, double *F)
{
  const sunindextype n = q->s.p.n;
  for (sunindextype j = 0; j < n; j++)
    for (sunindextype i = 0; i < n; i++) {
      E[i + n * j] = fixture_element(q->E, i, j);
      F[i + n * j] = -fixture_element(q->A, i, j);
    }
}

/* Number of eigenvalues below `limit` in modulus, and the largest of them. */
static int finite(const start *q, double limit, double *radius)
{
  const int n = (int)q->s.p.n, length = 40 * n, one = 1;
  const size_t m = (size_t)n;
  double *E = calloc(2 * m * m + 43 * m, sizeof *E), *F = E + m * m, *re = F + m * m;
  double *im = re + m, *beta = im + m, *work = beta + m;
  int info, count = 0;
  densify(q, E, F);
  for (size_t k = 0; k < m * m; k++) E[k] = -E[k];
  dggev_("N", "N", &n, F, &n, E, &n, re, im, beta, NULL, &one, NULL, &one, work, &length, &info,
         1, 1);
  CU_ASSERT_EQUAL(info, 0);
  *radius = 0;
  for (size_t k = 0; k < m; k++) {
    const double modulus = hypot(re[k], im[k]);
    if (!(modulus < limit * fabs(beta[k]))) continue;
    count++;
    *radius = fmax(*radius, modulus / fabs(beta[k]));
  }
  free(E);
  return count;
}

/* X = M^-1 X: with residuals in long double the error is that of rounding X, whatever LAPACK does. */
static void refined(int n, const double complex *M, double complex *X)
{
  const size_t m = (size_t)n;
  const int one = 1;
  double complex *LU = calloc(m * m + 2 * m, sizeof *LU), *b = LU + m * m, *r = b + m;
  int info, *pivot = calloc(m, sizeof *pivot);
  for (size_t k = 0; k < m * m; k++) LU[k] = M[k];
  zgetrf_(&n, &n, (double *)LU, &n, pivot, &info);
  CU_ASSERT_EQUAL(info, 0);
  for (int i = 0; i < n; i++) b[i] = r[i] = X[i], X[i] = 0;
  for (int sweep = 0; sweep < 4; sweep++) {
    zgetrs_("N", &n, &one, (double *)LU, &n, pivot, (double *)r, &n, &info, 1);
    for (int i = 0; i < n; i++) X[i] += r[i];
    for (int i = 0; i < n; i++) {
      long double complex sum = b[i];
      for (int j = 0; j < n; j++) sum -= (long double complex)M[i + n * j] * X[j];
      r[i] = (double complex)sum;
    }
  }
  free(LU), free(pivot);
}

/* X(s), rows and columns of the matrix scaled by powers of two to entries about 1. */
static void resolvent(const start *q, int index, double complex s, const double *E,
                      const double *F, double complex *M, double complex *X)
{
  const int n = (int)q->s.p.n;
  double *column = calloc((size_t)n, sizeof *column);
  for (int i = 0; i < n; i++) {
    X[i] = 0;
    for (int j = 0; j < n; j++) X[i] += E[i + n * j] * q->s.p.y0[j];
  }
  for (int j = 0; j < index; j++) {
    CHECK(q->s.p.g(0, j, q->s.r, q->s.p.user) == 0);
    for (int i = 0; i < n; i++) X[i] += NV_Ith_S(q->s.r, i) * cpow(s, -j - 1);
  }
  for (int k = 0; k < n * n; k++) M[k] = s * E[k] + F[k];
  for (int sweep = 0; sweep < 6; sweep++)
    for (int i = 0; i < n; i++) {
      double row = 0, col = 0;
      for (int j = 0; j < n; j++) row = fmax(row, cabs(M[i + n * j]));
      row = exp2(-floor(log2(row)));
      for (int j = 0; j < n; j++) M[i + n * j] *= row, col = fmax(col, cabs(M[j + n * i]));
      X[i] *= row;
      col = exp2(-floor(log2(col)));
      for (int j = 0; j < n; j++) M[j + n * i] *= col;
      column[i] = sweep ? column[i] * col : col;
    }
  refined(n, M, X);
  for (int i = 0; i < n; i++) X[i] *= column[i];
  free(column);
}

/* Relative to the component, or to a thousandth of the largest; where all vanish, absolute. */
static void same(const start *q, const double *is, const double *must, const char *what,
                 double tolerance)
{
  double largest = 0, worst = 0;
  for (sunindextype i = 0; i < q->s.p.n; i++) largest = fmax(largest, fabs(is[i]));
  if (largest == 0) largest = 1e3;
  for (sunindextype i = 0; i < q->s.p.n; i++)
    worst = fmax(worst, fabs(is[i] - must[i]) / fmax(fabs(must[i]), 1e-3 * largest));
  if (!(worst <= tolerance)) printf("\n  %s: %s off by %.2e", q->s.p.name, what, worst);
  CU_ASSERT(worst <= tolerance);
}

/* Rows 0 .. index - 1 of `out`: x(0+), c_0, ... */
static void laurent(const start *q, int index, double R, double *out)
{
  const size_t n = (size_t)q->s.p.n;
  double *E = calloc(2 * n * n, sizeof *E), *F = E + n * n;
  double complex *M = calloc(n * n + n, sizeof *M), *X = M + n * n;
  densify(q, E, F);
  for (int k = 0; k < POINTS; k++) {
    const double angle = 6.28318530717958647692 * (k + 0.5) / POINTS;
    const double complex s = R * cos(angle) + I * (R * sin(angle));
    resolvent(q, index, s, E, F, M, X);
    for (int row = 0; row < (index > 1 ? index : 1); row++)
      for (size_t i = 0; i < n; i++)
        out[(size_t)row * n + i] += creal(X[i] * cpow(s, 1 - row)) / POINTS;
  }
  free(E), free(M);
}

static void starts_are_those_of_the_definition(void)
{
  static const struct {
    const char *spec;
    double limit; /* between the finite eigenvalues and the infinite ones in double precision */
    double tolerance;
  } cases[] = {{"stokes:m=2", 1e5, 1e-12},
               {"stokes:m=5,seed=3", 1e5, 1e-11},
               {"stokes:m=5,case=cons", 1e5, 1e-11},
               {"springs:n=9,c=4", 1e3, 1e-11},
               {"springs:n=30,c=3,seed=77", 1e3, 1e-11},
               {"springs:n=5,c=5", 1e3, 1e-11},
               {"springs:n=9,c=4,case=cons", 1e3, 1e-11},
               {"hidden:n=9,c=2,lambda=31", 1e3, 1e-11},
               {"ladder:n=2", 1e7, 1e-11},
               {"ladder:n=11", 1e7, 1e-12},
               {"ladder:n=20,seed=5,case=cons", 1e7, 1e-12},
               {"bus:n=31", 1e7, 1e-12},
               {"bus:n=4", 1e7, 1e-12},
               {"blocks", 500, 1e-9},
               {"blocks:sizes=2x3.1,nf=6,kappa=10", 500, 1e-9},
               {"blocks:index=1,nf=5,kind=stiff", 500, 1e-11},
               {"blocks:index=4,nf=4,rho=1.5", 30, 1e-9},
               {"switchrlc", 1e7, 1e-11},
               {"switchrlc:v1=2.3,v2=-0.7", 1e7, 1e-11},
               {"impact", 1e3, 1e-12},
               {"impact:speed=-1.7,gap=0.21", 1e3, 1e-12}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    start q;
    double rho;
    if (start_open(&q, cases[k].spec)) continue;
    CU_ASSERT_EQUAL(finite(&q, cases[k].limit, &rho), q.x.finite);
    const size_t n = (size_t)q.s.p.n;
    double *out = calloc(n * (size_t)(q.x.index + 1), sizeof *out);
    laurent(&q, q.x.index, rho > 0 ? 2 * rho : 1, out);
    same(&q, q.x.x_plus, out, "x(0+)", cases[k].tolerance);
    const int quiet = strstr(cases[k].spec, "cons") != NULL;
    for (int i = 0; i + 1 < q.x.index; i++) {
      char name[] = "c_0";
      name[2] = (char)('0' + i);
      if (!quiet)
        same(&q, q.x.c + (size_t)i * n, out + ((size_t)i + 1) * n, name, cases[k].tolerance);
    }
    free(out);
    start_close(&q);
  }
}

/* Inside the hidden eigenvalue the mode passes for algebraic: u(0+) of the size 1/lambda, and an
 * impulse that is wrong by some per cent; outside, nothing is wrong. */
static void a_small_circle_misses_the_hidden_mode(void)
{
  start q;
  if (start_open(&q, "hidden:n=20,c=4,lambda=1e4")) return;
  const int n = 45;
  double *out = calloc((size_t)(3 * n), sizeof *out), worst = 0, size = 0;
  CU_ASSERT_EQUAL(q.s.p.n, n);
  laurent(&q, 3, 30, out);
  CHECK(fabs(out[n - 1]) < 1e-2);
  for (int i = 0; i < n; i++) {
    size = fmax(size, fabs(q.x.c[i]));
    worst = fmax(worst, fabs(out[n + i] - q.x.c[i]));
  }
  CHECK(worst > 0.01 * size && worst < size);
  for (int i = 0; i < 3 * n; i++) out[i] = 0;
  laurent(&q, 3, 3e4, out);
  CLOSE(out[n - 1], 0.7, 1e-4);
  same(&q, q.x.c, out + n, "c_0", 1e-6);
  free(out);
  start_close(&q);
}

CU_TestInfo tests_of_descriptor[] = {
  {"generated systems have the sizes they announce", sizes_are_those_announced},
  {"impulses satisfy the equations", impulses_satisfy_the_equations},
  {"starts are those of the definition", starts_are_those_of_the_definition},
  {"a small circle misses the hidden mode", a_small_circle_misses_the_hidden_mode},
  CU_TEST_INFO_NULL};
