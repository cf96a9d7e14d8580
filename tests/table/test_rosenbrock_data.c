/* test_rosenbrock_data.c: the numbers of Rosenbrock methods fulfil the equations that define them. With
 * u = Gamma k the rows of the transformed method are a = alpha Gamma^{-1} and C = diag(1/gamma) - Gamma^{-1}
 * (Hairer and Wanner, Solving ODEs II, IV.7): alpha and Gamma come back, and with them the conditions of
 * order 1 to 4 of Table 7.1, and alpha_i = sum_j alpha_ij, gamma_i = sum_j gamma_ij for f that depend on t.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "rosenbrock_data.h"
#include "suite.h"

enum { S = STF_RODAS_STAGES };

typedef struct coefficients {
  int s;
  double A[S][S], G[S][S], B[S][S]; /* alpha, Gamma, their sum */
  double b[S], a[S];                /* weights; sums of the rows of alpha */
} coefficients;

/* Gamma, the inverse of the lower triangular diag(1/gamma) - C. */
static void find_gamma(const stf_rodas *r, coefficients *k)
{
  for (int j = 0; j < r->s; j++)
    for (int i = j; i < r->s; i++) {
      double sum = i == j;
      for (int m = j; m < i; m++) sum += r->c[i * (i - 1) / 2 + m] * k->G[m][j];
      k->G[i][j] = r->g * sum;
    }
}

/* Row i of a, i = s: that of the solution. */
static void row_of(const stf_rodas *r, int i, double *row)
{
  const int last = i < r->rows ? i : r->rows - 1;
  for (int j = 0; j < r->s; j++) row[j] = 0;
  for (int j = 0; j < last; j++) row[j] = r->a[last * (last - 1) / 2 + j];
  for (int j = last; j < i; j++) row[j] = 1;
}

static void find(const stf_rodas *r, coefficients *k)
{
  *k = (coefficients){.s = r->s};
  find_gamma(r, k);
  for (int i = 0; i <= r->s; i++) {
    double row[S];
    row_of(r, i, row);
    for (int j = 0; j < r->s; j++) {
      double sum = 0;
      for (int m = j; m < r->s; m++) sum += row[m] * k->G[m][j];
      if (i == r->s)
        k->b[j] = sum;
      else
        k->A[i][j] = sum;
    }
  }
  for (int i = 0; i < r->s; i++)
    for (int j = 0; j < r->s; j++) {
      k->a[i] += k->A[i][j];
      k->B[i][j] = k->A[i][j] + k->G[i][j];
    }
}

/* y = M x, or x itself multiplied by powers of a. */
static void apply(const coefficients *k, const double M[S][S], const double *x, double *y)
{
  for (int i = 0; i < k->s; i++) {
    y[i] = 0;
    for (int j = 0; j < k->s; j++) y[i] += M[i][j] * x[j];
  }
}

static double weigh(const coefficients *k, int power, const double *x)
{
  double sum = 0;
  for (int i = 0; i < k->s; i++) sum += k->b[i] * pow(k->a[i], power) * x[i];
  return sum;
}

static void conditions_of_order(const stf_rodas *r, const coefficients *k)
{
  static const double one[S] = {1, 1, 1, 1, 1, 1, 1, 1}, near = 2e-12;
  double beta[S], twice[S], thrice[S], squares[S], x[S];
  apply(k, k->B, one, beta);
  apply(k, k->B, beta, twice);
  apply(k, k->B, twice, thrice);
  for (int i = 0; i < k->s; i++) squares[i] = k->a[i] * k->a[i];
  CLOSE(weigh(k, 0, one), 1, near);
  CLOSE(weigh(k, 0, beta), 1. / 2, near);
  CLOSE(weigh(k, 2, one), 1. / 3, near);
  CLOSE(weigh(k, 0, twice), 1. / 6, near);
  CHECK(r->order >= 4);
  CLOSE(weigh(k, 3, one), 1. / 4, near);
  apply(k, k->A, beta, x);
  CLOSE(weigh(k, 1, x), 1. / 8, near);
  apply(k, k->B, squares, x);
  CLOSE(weigh(k, 0, x), 1. / 12, near);
  CLOSE(weigh(k, 0, thrice), 1. / 24, near);
}

static void all_numbers_fit(void)
{
  for (size_t t = 0; t < stf_rodas_count; t++) {
    const stf_rodas *r = &stf_rodas_tables[t];
    coefficients k;
    find(r, &k);
    for (int i = 0; i < r->s; i++) {
      double sum = 0;
      for (int j = 0; j < r->s; j++) sum += k.G[i][j];
      CLOSE_FLOOR(k.a[i], r->alpha[i], 2e-12, 1);
      CLOSE_FLOOR(sum, r->gamma[i], 2e-12, 1);
    }
    conditions_of_order(r, &k);
  }
}

CU_TestInfo tests_of_rosenbrock_data[] = {
  {"Rosenbrock methods fulfil their conditions", all_numbers_fit}, CU_TEST_INFO_NULL};
