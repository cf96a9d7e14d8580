/* test_scaling.c: scales of rows and columns by the largest entries and by all entries.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "scaling.h"
#include "random.h"
#include "suite.h"
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

enum { N = 7 };

/* Entries of size 1/2 .. 1, half of them 0 off the diagonal, in units 2^-20 .. 2^20. */
static void draw(stf_random *r, double *A)
{
  int row[N], column[N];
  for (int i = 0; i < N; i++) {
    row[i] = (int)stf_random_in(r, -20, 20);
    column[i] = (int)stf_random_in(r, -20, 20);
  }
  for (int j = 0; j < N; j++)
    for (int i = 0; i < N; i++) {
      const bool there = i == j || stf_random_in(r, 0, 1) < 0.5;
      A[i + N * j] = there ? ldexp(stf_random_in(r, 0.5, 1), row[i] + column[j]) : 0;
    }
}

static bool power_of_two(double x) { return x > 0 && ldexp(1, ilogb(x)) == x; }

static stf_scales scaled(const double *A, double even, double *room)
{
  stf_scales s = {.n = N, .row = room, .column = room + N, .largest = room + 2 * N};
  s.even = even;
  stf_scaling_largest(&s, 1, &(stf_summand){NULL, NULL, A, 1});
  return s;
}

/* Differences of 2^80 in the units come down to a factor of two about 1 in six halvings. */
static void largest_entries_come_near_to_one(void)
{
  stf_random r = {4711u};
  for (int round = 0; round < 50; round++) {
    double A[N * N], room[4 * N], bits = 0;
    draw(&r, A);
    const stf_scales s = scaled(A, 0, room);
    CHECK(!s.empty);
    for (int i = 0; i < N; i++) {
      double of_row = 0, of_column = 0;
      for (int j = 0; j < N; j++) {
        of_row = fmax(of_row, A[i + N * j] * s.row[i] * s.column[j]);
        of_column = fmax(of_column, A[j + N * i] * s.row[j] * s.column[i]);
      }
      CHECK(of_row > 0.25 && of_row < 4 && of_column > 0.25 && of_column < 4);
      CHECK(power_of_two(s.row[i]) && power_of_two(s.column[i]));
      bits += log2(s.row[i]) + log2(s.column[i]);
    }
    CHECK(s.bits == bits);
  }
}

static void a_transpose_has_the_scales_exchanged(void)
{
  stf_random r = {815u};
  double A[N * N], T[N * N], room[8 * N];
  draw(&r, A);
  for (int k = 0; k < N * N; k++) T[k / N + N * (k % N)] = A[k];
  const stf_scales a = scaled(A, 0, room), t = scaled(T, 0, room + 4 * N);
  CHECK(!memcmp(a.row, t.column, N * sizeof *a.row));
  CHECK(!memcmp(a.column, t.row, N * sizeof *a.row));
}

/* The same matrix dense, by columns of entries, and as two summands, one of them with a factor. */
static void summands_are_measured_together(void)
{
  const sunindextype ptr[] = {0, 2, 3, 4}, row[] = {0, 2, 1, 2};
  const double value[] = {8, 0.125, 1024, 3};
  const double dense[] = {8, 0, 0.125, 0, 1024, 0, 0, 0, 3};
  const double first[] = {4, 0, 0, 0, 0, 0, 0, 0, 1.5},
               rest[] = {0, 0, 0.125, 0, 1024, 0, 0, 0, 0};
  double room[3][12];
  stf_scales s[3];
  for (int k = 0; k < 3; k++)
    s[k] = (stf_scales){.n = 3, .row = room[k], .column = room[k] + 3, .largest = room[k] + 6};
  stf_scaling_largest(&s[0], 1, &(stf_summand){ptr, row, value, 1});
  stf_scaling_largest(&s[1], 1, &(stf_summand){NULL, NULL, dense, 1});
  stf_scaling_largest(&s[2], 2, (stf_summand[]){{NULL, NULL, first, 2}, {NULL, NULL, rest, 1}});
  for (int k = 1; k < 3; k++) CHECK(!memcmp(room[0], room[k], 6 * sizeof(double)));
  CHECK(s[0].bits == s[1].bits && s[1].bits == s[2].bits && !s[0].empty);
}

static void empty_and_even_ones_are_told(void)
{
  double A[N * N] = {0}, room[4 * N];
  for (int i = 0; i < N; i++) A[i + N * i] = ldexp(1, i);
  CHECK(!scaled(A, 0, room).empty);
  const stf_scales left = scaled(A, 64, room);
  CHECK(left.bits == 0 && left.row[N - 1] == 1 && left.column[0] == 1);
  CHECK(scaled(A, 63, room).bits != 0);
  A[3 + N * 3] = 0;
  CHECK(scaled(A, 0, room).empty);
}

static SUNMatrix matrix(steif_context *ctx, const double *A)
{
  SUNMatrix M = SUNDenseMatrix(N, N, steif_sundials(ctx));
  memcpy(SM_DATA_D(M), A, N * N * sizeof *A);
  return M;
}

/* E and F of entries 1/2 .. 1 in units of equations, unknowns and time that are 2^120 apart. */
static void units_cancel(void)
{
  stf_random r = {99u};
  double e[N * N], f[N * N];
  int exponent[2 * N];
  enum stf_evenness even;
  steif_context *ctx = steif_context_new(NULL);
  for (int k = 0; k < N * N; k++) {
    const int unit = 15 * (k % N - 3) - 15 * (k / N - 3);
    const bool there = k % N == k / N || stf_random_in(&r, 0, 1) < 0.4;
    e[k] = there ? ldexp(stf_random_in(&r, 0.5, 1), unit + 30) : 0;
    f[k] = ldexp(stf_random_in(&r, 0.5, 1), unit);
  }
  SUNMatrix E = matrix(ctx, e), F = matrix(ctx, f);
  CHECK(stf_scaling_needed(E, F));
  CHECK(!stf_scaling_logarithmic(ctx, E, F, exponent, &even) && even == STF_EVEN);
  for (int i = 1; i < N; i++) { /* what rows and columns have in common is free */
    CHECK(abs(exponent[i - 1] - exponent[i] - 15) <= 1);
    CHECK(abs(exponent[N + i] - exponent[N + i - 1] - 15) <= 1);
  }
  SM_ELEMENT_D(F, 2, 3) = 1e-200;
  CHECK(!stf_scaling_logarithmic(ctx, E, F, exponent, &even) && even == STF_UNEVEN);
  SUNMatDestroy(E), SUNMatDestroy(F);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_scaling[] = {
  {"the largest entries come near to 1", largest_entries_come_near_to_one},
  {"a transpose has the scales exchanged", a_transpose_has_the_scales_exchanged},
  {"summands are measured together", summands_are_measured_together},
  {"empty rows and even matrices are told", empty_and_even_ones_are_told},
  {"units of equations and unknowns cancel", units_cancel},
  CU_TEST_INFO_NULL};
