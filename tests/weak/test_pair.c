/* test_pair.c: conventions P, R and C, and the powers of (N + hI)^{-1} N in integers.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "weak/data.h"

/* int_a^b (1-t)^8 = ((1-a)^9 - (1-b)^9)/9 with unequal steps, values of high entropy. */
static void conventions_weigh_as_defined(void)
{
  const sunrealtype t[] = {0, 0.11, 0.36, 0.83, 1.4}, x[] = {0.731, -1.294, 2.618, 0.577, -9.3};
  const double G[] = {1 / 9.0, pow(0.89, 9) / 9, pow(0.64, 9) / 9, pow(0.17, 9) / 9, 0};
  double P = 0, R = 0;
  for (int i = 0; i < 4; i++) {
    P += x[i] * (G[i] - G[i + 1]);
    R += x[i + 1] * (G[i] - G[i + 1]);
  }
  CLOSE(steif_pair(STEIF_P, 4, t, x), P, 1e-13);
  CLOSE(steif_pair(STEIF_R, 4, t, x), R, 1e-13);
  const double C = 0.11 * (0.731 - 1.294 * pow(0.89, 8)) + 0.25 * 2.618 * pow(0.64, 8) +
                   0.47 * 0.577 * pow(0.17, 8);
  CLOSE(steif_pair(STEIF_C, 4, t, x), C, 1e-14);
  CHECK(isnan(steif_pair(STEIF_STAGE, 4, t, x)));
  CHECK(steif_pair(STEIF_R, 0, t, x) == 0);
}

static long choose(int n, int r)
{
  long c = 1;
  for (int i = 1; i <= r; i++) c = c * (n - r + i) / i;
  return n < 0 || r < 0 || r > n ? 0 : c;
}

/* With h = 1 every entry is an integer: M = sum_{m>=1} (-1)^{m-1} N^m, and row 0 of M^i by
 * repeated multiplication must be (-1)^j C(i+j-1, i-1) on superdiagonal i + j. */
static void powers_have_alternating_signs(void)
{
  for (int k = 2; k <= 7; k++) {
    long row[MOST] = {1};
    for (int i = 1; i < k; i++) {
      long next[MOST] = {0};
      for (int a = 0; a < k; a++)
        for (int m = 1; a + m < k; m++) next[a + m] += m % 2 ? row[a] : -row[a];
      for (int a = 0; a < k; a++) {
        row[a] = next[a];
        const int j = a - i;
        CHECK(row[a] == (j < 0 ? 0 : (j % 2 ? -1 : 1) * choose(i + j - 1, i - 1)));
      }
    }
  }
}

/* z^[i] = h^{-(i+1)} sum_j (-1)^j C(i,j) on steps j+1 .. j+2 tends to delta^(i), not to
 * (-1)^i delta^(i): <z, g> -> (-1)^i g^(i)(0) > 0 for this g, with first-order factor (i+3)/2. */
static void differences_tend_to_delta(void)
{
  enum { n = 1 << 11 };
  static sunrealtype t[n + 1], x[n + 1];
  const sunrealtype h = 1.0 / n;
  for (int j = 0; j <= n; j++) t[j] = j * h;
  for (int i = 0; i < 4; i++) {
    for (int j = 0; j <= n; j++) x[j] = 0;
    for (int j = 0; j <= i; j++)
      x[j + 1] = (j % 2 ? -1 : 1) * (double)choose(i, j) * pow(n, i + 1);
    const double limit = (i % 2 ? -1 : 1) * steif_test_function(0, i);
    const double slope = (i % 2 ? -1 : 1) * (i + 3) / 2.0 * steif_test_function(0, i + 1);
    const double value = steif_pair(STEIF_P, n, t, x);
    CHECK(limit > 0);
    CLOSE((value - limit) / h, slope, 0.01);
  }
}

CU_TestInfo tests_of_pair[] = {
  {"conventions weigh a sequence as defined, steps unequal", conventions_weigh_as_defined},
  {"powers of (N+hI)^-1 N alternate in sign as binomials", powers_have_alternating_signs},
  {"difference quotients of steps tend to delta derivatives", differences_tend_to_delta},
  CU_TEST_INFO_NULL};
