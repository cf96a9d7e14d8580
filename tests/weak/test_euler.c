/* test_euler.c: backward Euler against the 30 weak values, its constants, and Richardson.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "weak/data.h"

/* <x_h, g> at h = 1/64 with 15 digits, component 1, conventions P and R. */
static const struct row {
  const char *name;
  int k;
  double exact, P, R;
} rows[] = {
  {"H-inc", 2, 2.0, 1.67003274486033, 1.87945213180456},
  {"H-inc", 3, -22.0, -17.5648068231243, -19.6343981136943},
  {"H-inc", 4, 202.0, 158.977713011738, 174.841179700849},
  {"H-inc", 5, -1478.0, -1163.68011893279, -1259.8034586736},
  {"H-inc", 6, 8602.0, 6891.19252263063, 7340.78327514446},
  {"N-cons", 2, 0.145743485951604, 0.147298388456907, 0.144943452895846},
  {"N-cons", 3, 0.2563052259126585, 0.251359259487881, 0.248202773070159},
  {"N-cons", 4, 0.3468428095914897, 0.363331753867752, 0.363561839856409},
  {"N-cons", 5, 0.3886505690311419, 0.588711478447499, 0.610580265413057},
  {"N-cons", 6, 0.3684730183689024, -1.46461002510452, -1.6114752912942},
  {"N-inc", 2, 2.561890322498746, 2.14048057597052, 2.41545961424653},
  {"N-inc", 3, -29.38860791840363, -23.469084816091, -26.227262233082},
  {"N-inc", 4, 224.5979088503104, 176.629939001777, 194.101613729813},
  {"N-inc", 5, -1309.578251451839, -1031.05875873249, -1115.21862948557},
  {"N-inc", 6, 7118.476571781406, 5702.21673161947, 6074.41957641285},
};
enum { ROWS = sizeof rows / sizeof *rows };

static void values_at_a_64th(void)
{
  steif_context *ctx = steif_context_new(NULL);
  for (int i = 0; i < ROWS; i++)
    for (int p = 0; p < 2; p++) {
      steif_weak_row row;
      steif_weak_result result;
      CHECK(weak_rows(ctx, "be", rows[i].k, rows[i].name, p ? STEIF_P : STEIF_R, NULL, 1.0 / 64,
                      1, &row, &result) == STEIF_OK);
      CLOSE(row.value, p ? rows[i].P : rows[i].R, rows[i].k <= 4 ? 1e-12 : 1e-10);
      CLOSE(result.exact, rows[i].exact, 4e-15);
      CHECK(result.converges == -1);
    }
  steif_context_free(&ctx);
}

/* (a) |err/h - E_1| halves with h and is below 1.5 % of E_1 at 2^-10; (b) order in [0.9, 1.1]. */
static void check_constant(steif_context *ctx, int k, const char *name, enum steif_convention c)
{
  steif_weak_row row[4];
  steif_weak_result result;
  CHECK(weak_rows(ctx, "be", k, name, c, NULL, 1.0 / 128, 4, row, &result) == STEIF_OK);
  double before = 0;
  for (int i = 0; i < 4; i++) {
    const double off = fabs(row[i].error / row[i].h - result.first);
    if (i > 0) CHECK(before / off >= 1.9 && before / off <= 2.1);
    if (i > 1) CHECK(row[i].order >= 0.9 && row[i].order <= 1.1);
    if (i == 3) CHECK(off <= 0.015 * fabs(result.first));
    before = off;
  }
  CHECK(result.converges == 1);
  CHECK(!strncmp(result.verdict, "converges weakly, order ", 24));
}

static void first_order_constant_is_the_limit(void)
{
  steif_context *ctx = steif_context_new(NULL);
  for (int i = 0; i < ROWS; i++) {
    check_constant(ctx, rows[i].k, rows[i].name, STEIF_P);
    check_constant(ctx, rows[i].k, rows[i].name, STEIF_R);
  }
  steif_context_free(&ctx);
}

/* Romberg columns of N-inc, h = 2^-4 .. 2^-9: relative error of the last entry of each column. */
static const struct romberg {
  int k;
  enum steif_convention c;
  double error[6];
} rombergs[] = {
  {2, STEIF_P, {2.21e-2, 4.66e-4, 1.15e-5, 3.68e-7, 1.53e-8, 8.18e-10}},
  {2, STEIF_R, {7.37e-3, 6.62e-5, 7.77e-7, 1.21e-8, 2.49e-10, 6.66e-12}},
  {3, STEIF_P, {2.74e-2, 6.69e-4, 1.87e-5, 6.49e-7, 2.76e-8, 1.35e-9}},
  {3, STEIF_R, {1.41e-2, 1.95e-4, 3.26e-6, 7.01e-8, 1.90e-9, 6.02e-11}},
  {4, STEIF_R, {1.80e-2, 2.96e-4, 5.58e-6, 1.25e-7, 3.11e-9, 6.60e-11}},
  {5, STEIF_R, {1.97e-2, 3.33e-4, 5.95e-6, 1.10e-7, 1.57e-9, 1.11e-11}},
};

/* The values at h = 2^-9 carry rounding of about eps h^-(k-2) / 20 of their size. */
static void richardson_removes_the_constant(void)
{
  steif_context *ctx = steif_context_new(NULL);
  for (size_t r = 0; r < sizeof rombergs / sizeof *rombergs; r++) {
    steif_weak_row row[6];
    steif_weak_result result;
    CHECK(weak_rows(ctx, "be", rombergs[r].k, "N-inc", rombergs[r].c, NULL, 1.0 / 16, 6, row,
                    &result) == STEIF_OK);
    double T[6];
    for (int i = 0; i < 6; i++) T[i] = row[i].value;
    const double noise = 1e-15 + 1e-17 * pow(512, rombergs[r].k - 2);
    for (int m = 0; m < 6; m++) {
      const double error = fabs(T[5] / result.exact - 1);
      CLOSE(error, rombergs[r].error[m], 0.006 + noise / rombergs[r].error[m]);
      for (int i = 5; i > m; i--) T[i] += (T[i] - T[i - 1]) / (ldexp(1, m + 1) - 1);
    }
  }
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_euler[] = {
  {"the 30 weak values at h = 1/64 are met", values_at_a_64th},
  {"error over h tends to the first-order constant", first_order_constant_is_the_limit},
  {"Romberg columns have the tabled errors", richardson_removes_the_constant},
  CU_TEST_INFO_NULL};
