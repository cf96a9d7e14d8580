/* test_verdict.c: what rows with known errors entitle to say.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"
#include "weak/judged.h"
#include <string.h>

enum { ROWS = 6 };

/* Steps 0.1, 0.05, ...; orders are those of the errors. */
static void rows_of(steif_weak_row *row, size_t count, const double *error, double rounding)
{
  for (size_t i = 0; i < count; i++)
    row[i] = (steif_weak_row){.h = 0.1 / (1 << i),
                              .value = 1,
                              .error = error[i],
                              .order = i ? log2(fabs(error[i - 1] / error[i])) : NAN,
                              .rounding = rounding,
                              .usable = rounding <= 0.1 * fabs(error[i])};
}

static bool begins(const steif_weak_result *r, const char *words)
{
  const bool same = !strncmp(r->verdict, words, strlen(words));
  if (!same) printf("\n  '%s', expected '%s'", r->verdict, words);
  return same;
}

/* Errors below their rounding levels are zero where these are far below the value; a level of a millionth of
 * the value hides errors that steps would show. */
static void a_high_level_is_no_zero(void)
{
  static const double error[] = {1e-7, 1e-7, 1e-7};
  steif_weak_row row[3];
  rows_of(row, 3, error, 1e-6);
  steif_weak_result r = judged(row, 3);
  CHECK(r.converges == -1 && begins(&r, "undecided: rounding from h = 0.1 on"));
  static const double less[] = {1e-14, 1e-14, 1e-14};
  rows_of(row, 3, less, 1e-13);
  r = judged(row, 3);
  CHECK(r.converges == 1 && begins(&r, "exact to rounding"));
}

/* Three zeros in a row are none by chance; two may be. */
static void two_zeros_decide_nothing(void)
{
  static const double zero[] = {0, 0, 0}, two[] = {1e-3, 0, 0}, three[] = {1e-3, 0, 0, 0};
  steif_weak_row row[4];
  rows_of(row, 2, zero, 1e-14);
  steif_weak_result r = judged(row, 2);
  CHECK(r.converges == -1 && begins(&r, "undecided: three rows decide"));
  rows_of(row, 3, two, 1e-14);
  r = judged(row, 3);
  CHECK(r.converges == -1 && begins(&r, "undecided: rounding from h = 0.05 on"));
  rows_of(row, 4, three, 1e-14);
  r = judged(row, 4);
  CHECK(r.converges == 1 && begins(&r, "converges weakly, below rounding from h = 0.05 on"));
}

/* c1 h + c2 h^2 where the second term rules at first: orders on the way from 2 to 1. Order 2 is said of neither
 * pair of steps between which the observed order falls by more than a quarter. */
static void orders_that_differ_are_none(void)
{
  double error[ROWS];
  steif_weak_row row[ROWS];
  for (int i = 0; i < ROWS; i++) {
    const double h = 0.1 / (1 << i);
    error[i] = 0.005 * h + h * h;
  }
  rows_of(row, ROWS, error, 1e-14);
  for (size_t count = 3; count <= ROWS; count++) {
    const steif_weak_result r = judged(row, count);
    CHECK(r.converges == -1);
  }
  static const double jump[] = {0.32, 0.08, 0.04}; /* orders 2 and 1 */
  rows_of(row, 3, jump, 1e-14);
  steif_weak_result r = judged(row, 3);
  CHECK(r.converges == -1 && begins(&r, "undecided: the observed orders 2.00 and 1.00 differ"));
  static const double steady[] = {0.16, 0.08, 0.04};
  rows_of(row, 3, steady, 1e-14);
  r = judged(row, 3);
  CHECK(r.converges == 1 && begins(&r, "converges weakly, order 1.00"));
  CLOSE(r.order, 1, 1e-12);
}

/* Rows of order 1 beside impulses that would not converge if they are there: undecided where they may be rounding, no
 * convergence where they are there; beside parts that are all known rows decide. */
static void a_part_in_doubt_decides_nothing(void)
{
  const part known = {.q = STF_SMOOTH, .converges = 1, .order = 1, .least = 1};
  part other = {.q = 2, .converges = 0, .doubtful = true, .order = NAN, .size = 4.5e-8};
  for (int k = 0; k < 3; k++) {
    parts all = {.known = true,
                 .least = INFINITY,
                 .lowest = {.order = INFINITY},
                 .bad = {.converges = 1},
                 .most = 1};
    steif_weak_result r = {
      .converges = 1, .order = 1, .verdict = "converges weakly, order 1.00"};
    other.doubtful = k == 0;
    stf_parts_note(&all, &known);
    if (k < 2) stf_parts_note(&all, &other);
    stf_parts_conclude(&all, true, &r);
    CHECK(r.converges == (k == 0 ? -1 : k - 1));
    CHECK(begins(&r, k == 0
                       ? "undecided: order 1.00 with these steps; that of impulses of order 2"
                     : k == 1 ? "does not converge weakly: impulses of order 2"
                              : "converges weakly, order 1.00"));
  }
}

CU_TestInfo tests_of_verdict[] = {
  {"a high rounding level is no zero", a_high_level_is_no_zero},
  {"two zeros decide nothing", two_zeros_decide_nothing},
  {"orders that differ are none", orders_that_differ_are_none},
  {"a part in doubt decides nothing", a_part_in_doubt_decides_nothing},
  CU_TEST_INFO_NULL};
