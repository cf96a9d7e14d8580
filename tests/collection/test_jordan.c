/* test_jordan.c: the nilpotent block, its forcing of every order, starts and storages.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fixture.h"

static const char *const cases[] = {"H-inc", "N-inc", "N-cons", "sin-inc", "sin-cons"};
enum { CASES = sizeof cases / sizeof *cases };

static void open_case(fixture *s, int k, const char *kind, const char *storage)
{
  char spec[80];
  snprintf(spec, sizeof spec, "jordan:k=%d,case=%s,storage=%s", k, kind, storage);
  if (fixture_open(s, spec)) CU_FAIL_FATAL("no problem, no test");
}

/* g of order q, as a state for the differences. */
typedef struct derivative {
  const steif_problem *p;
  int q;
} derivative;

static int forcing(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  const derivative *d = user;
  (void)yp;
  return d->p->g(t, d->q, y, d->p->user);
}

static void derivatives_agree(const char *spec, int orders, double h)
{
  fixture s;
  if (fixture_open(&s, spec)) return;
  for (int q = 0; q < orders; q++) {
    derivative d = {&s.p, q};
    fixture other = s;
    other.p.user = &d;
    fixture_difference(&other, forcing, 0.37, h);
    CHECK(s.p.g(0.37, q + 1, s.y, s.p.user) == 0);
    const double scale = N_VMaxNorm(s.y);
    N_VLinearSum(1, s.y, -1, s.yp, s.r);
    CLOSE_FLOOR(N_VMaxNorm(s.r) / (scale > 1 ? scale : 1), 0, 2e-10, 1);
  }
  fixture_close(&s);
}

static void forcing_derivatives_agree_with_differences(void)
{
  derivatives_agree("jordan:k=6,case=N-cons", 9, 2e-2);
  derivatives_agree("jordan:k=6,case=sin-inc", 9, 5e-3);
  derivatives_agree("jordan:k=4,case=H-inc", 5, 2e-2);
  derivatives_agree("ut5", 9, 5e-3);
}

static void forcing_is_what_the_name_says(void)
{
  fixture s;
  open_case(&s, 5, "N-inc", "dense");
  CHECK(s.p.g(0.7, 0, s.y, s.p.user) == 0);
  for (int m = 1; m <= 5; m++) CLOSE(NV_Ith_S(s.y, m - 1), cos(0.7 + m), 1e-15);
  CHECK(s.p.g(0.7, -1, s.y, s.p.user) != 0);
  CLOSE(s.p.t1, 1, 0);
  fixture_close(&s);
  open_case(&s, 5, "sin-cons", "dense");
  CHECK(s.p.g(0.7, 3, s.y, s.p.user) == 0);
  for (int m = 1; m <= 5; m++) CLOSE(NV_Ith_S(s.y, m - 1), -m * m * m * cos(0.7 * m), 1e-14);
  CLOSE(s.p.t1, 2, 0);
  fixture_close(&s);
}

/* x_s by the definition sum_i (-1)^i N^i f^(i): x_k = f_k, x_m = f_m - x_{m+1}'. */
static void smooth_part_satisfies_the_equation_to_rounding(void)
{
  for (int k = 1; k <= 12; k++)
    for (int c = 0; c < CASES; c++) {
      fixture s;
      open_case(&s, k, cases[c], "dense");
      CHECK(s.p.exact(0.83, s.y, s.yp, s.p.user) == 0);
      CHECK(s.p.g(0.83, 0, s.w, s.p.user) == 0);
      const double scale = 1 + N_VMaxNorm(s.yp);
      for (int m = 0; m < k; m++) {
        const double next = m + 1 < k ? NV_Ith_S(s.yp, m + 1) : 0;
        CLOSE_FLOOR((next + NV_Ith_S(s.y, m) - NV_Ith_S(s.w, m)) / scale, 0, 1e-14, 1);
      }
      fixture_close(&s);
    }
}

static void starts_are_as_named(void)
{
  for (int k = 1; k <= 12; k++)
    for (int c = 0; c < CASES; c++) {
      fixture s;
      open_case(&s, k, cases[c], "dense");
      CHECK(s.p.exact(0, s.y, s.yp, s.p.user) == 0);
      const int consistent = strstr(cases[c], "cons") != NULL;
      CHECK(consistent == (s.p.yp0 != NULL));
      for (int m = 1; m <= k; m++) {
        const double smooth = NV_Ith_S(s.y, m - 1);
        const double expected = consistent ? smooth : c == 3 ? smooth + 0.1 * m : m;
        CLOSE_FLOOR(s.p.y0[m - 1], expected, 1e-15, 1);
        if (consistent) CLOSE_FLOOR(s.p.yp0[m - 1], NV_Ith_S(s.yp, m - 1), 1e-15, 1);
      }
      fixture_close(&s);
    }
}

static void index_counts_from_the_last_component(void)
{
  static const int expected[] = {3, 3, 3, 2, 1};
  fixture s;
  open_case(&s, 5, "N-cons", "dense");
  CU_ASSERT_EQUAL(s.p.dae_index, 5);
  for (int i = 0; i < 5; i++) CU_ASSERT_EQUAL(s.p.index[i], expected[i]);
  fixture_close(&s);
  open_case(&s, 1, "N-cons", "dense");
  CU_ASSERT_EQUAL(s.p.dae_index, 1);
  CU_ASSERT_EQUAL(s.p.index[0], 1);
  fixture_close(&s);
}

static void storages_hold_the_same_matrices(void)
{
  static const char *const storage[] = {"dense", "band", "sparse"};
  for (int c = 0; c < 3; c++)
    for (int k = 1; k <= 5; k += 2) {
      fixture s;
      open_case(&s, k, "N-inc", storage[c]);
      SUNMatrix E = fixture_matrix(&s, s.p.nnz_E), A = fixture_matrix(&s, s.p.nnz);
      CHECK(s.p.E(0.2, s.y, s.yp, E, s.p.user) == 0 && s.p.A(0.2, s.y, s.yp, A, s.p.user) == 0);
      for (int i = 0; i < k; i++)
        for (int j = 0; j < k; j++) {
          CLOSE(fixture_element(E, i, j), j == i + 1, 0);
          CLOSE(fixture_element(A, i, j), i == j ? -1 : 0, 0);
        }
      SUNMatDestroy(E), SUNMatDestroy(A);
      fixture_close(&s);
    }
}

static void a_matrix_that_is_too_small_is_rejected(void)
{
  fixture s;
  open_case(&s, 6, "N-inc", "sparse");
  SUNMatrix E = fixture_matrix(&s, 3);
  CHECK(s.p.E(0, s.y, s.yp, E, s.p.user) < 0);
  SUNMatDestroy(E);
  s.p.storage = STEIF_BAND, s.p.upper = 0;
  E = fixture_matrix(&s, 0);
  CHECK(s.p.E(0, s.y, s.yp, E, s.p.user) < 0);
  SUNMatDestroy(E);
  fixture_close(&s);
}

CU_TestInfo tests_of_jordan[] = {
  {"forcing derivatives agree with differences", forcing_derivatives_agree_with_differences},
  {"the forcing is what the name says", forcing_is_what_the_name_says},
  {"the smooth part satisfies the equation to rounding",
   smooth_part_satisfies_the_equation_to_rounding},
  {"starts are as named", starts_are_as_named},
  {"the index counts from the last component", index_counts_from_the_last_component},
  {"storages hold the same matrices", storages_hold_the_same_matrices},
  {"a matrix that is too small is rejected", a_matrix_that_is_too_small_is_rejected},
  CU_TEST_INFO_NULL};
