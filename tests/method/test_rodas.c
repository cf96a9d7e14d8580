/* The stages of Rosenbrock methods for few unknowns, put into their equations.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "lu.h"
#include "suite.h"
#include <math.h>
#include <string.h>

enum { N = STF_ROSENBROCK, STAGES = 3 };

static double uniform(unsigned *seed)
{
  *seed = (unsigned)((unsigned long long)*seed * 48271 % 2147483647);
  return *seed / 1073741823.5 - 1;
}

static void fill(int count, unsigned seed, double *x)
{
  for (int i = 0; i < count; i++) x[i] = uniform(&seed);
}

/* Row i of (shift M - J) u - f - slope f_t - M g / h, M = I where it is NULL. */
static double residual(int n, int i, const double *M, const double *J, double shift,
                       const double *u, const stf_rosenbrock_stage *g, const double *sum)
{
  double r = -g->f[i] - g->slope * g->ft[i];
  for (int j = 0; j < n; j++) {
    const double m = M ? M[i + n * j] : i == j;
    r += (shift * m - J[i + n * j]) * u[j] - m * sum[j] / g->h;
  }
  return r;
}

static void one_stage(int n, const double *M, const double *J, double h, int last)
{
  static const double a[] = {1.75, -0.625, 0.375}, c[] = {-4.5, 2.25};
  double data[STAGES][N], f[N], ft[N], y[N], Y[N], before[N], sum[N] = {0};
  const double shift = 4 / h;
  stf_rosenbrock R;
  stf_rosenbrock_stage g = {
    .i = STAGES - 1, .a = last ? NULL : a, .c = c, .h = h, .slope = 0.3 * h, .f = f, .ft = ft};
  fill(STAGES * N, 5 + (unsigned)n, data[0]), fill(N, 17, f), fill(N, 29, ft), fill(N, 31, y);
  fill(N, 37, Y);
  memcpy(before, Y, sizeof Y);
  g.y = y, g.Y = Y;
  for (int j = 0; j < STAGES; j++) g.u[j] = data[j];
  for (int j = 0; j < STAGES - 1; j++)
    for (int k = 0; k < n; k++) sum[k] += c[j] * data[j][k];
  stf_rosenbrock_open(&R, n, M);
  CHECK(!stf_rosenbrock_factor(&R, J, shift));
  stf_rosenbrock_solve(&R, &g);
  for (int i = 0; i < n; i++) {
    double next = last ? before[i] + data[STAGES - 1][i] : y[i];
    for (int j = 0; !last && j < STAGES; j++) next += a[j] * data[j][i];
    CLOSE_FLOOR(residual(n, i, M, J, shift, data[STAGES - 1], &g, sum), 0, 1e-13 / h, 1);
    CLOSE_FLOOR(Y[i], next, 1e-14, 1);
  }
}

static void stages_solve_their_equations(void)
{
  double J[N * N], M[N * N];
  for (int n = 1; n <= N; n++) {
    fill(n * n, 71 + (unsigned)n, J), fill(n * n, 83 + (unsigned)n, M);
    for (int i = 0; i < n; i++) M[i + n * i] += 3;
    for (int last = 0; last < 2; last++) {
      one_stage(n, NULL, J, 0.15, last);
      one_stage(n, M, J, 0.15, last);
      one_stage(n, M, J, 7.5, last);
    }
  }
}

/* Pivots move rows: the diagonal of this matrix is empty. */
static void rows_are_exchanged(void)
{
  double J[N * N] = {0};
  static const double M[N * N] = {0};
  for (int j = 0; j < N; j++) J[(j + 3) % N + N * j] = 2.5 + j;
  one_stage(N, M, J, 0.5, 0);
}

static void a_vanishing_pivot_is_named(void)
{
  static const double M[9] = {0},
                      J[9] = {4, 2, 1, 2, 9, 8.5, 6, 11, 9.5}; /* column 2 = 0 + 1 */
  double bad[9];
  stf_rosenbrock R;
  stf_rosenbrock_open(&R, 3, M);
  CHECK(stf_rosenbrock_factor(&R, J, 1) == 3);
  memcpy(bad, J, sizeof bad), bad[4] = NAN;
  CHECK(stf_rosenbrock_factor(&R, bad, 1) > 0);
}

CU_TestInfo tests_of_rodas[] = {
  {"stages solve their equations", stages_solve_their_equations},
  {"rows are exchanged", rows_are_exchanged},
  {"a vanishing pivot is named", a_vanishing_pivot_is_named},
  CU_TEST_INFO_NULL,
};
