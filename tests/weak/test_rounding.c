/* test_rounding.c: rounding levels against values known otherwise, and verdicts that rounding must not
 * turn.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "weak/data.h"
#include "weak/judged.h"
#include <sunmatrix/sunmatrix_dense.h>

/* <x_h, g> of backward Euler, convention R, x(0-) = (1, .., k), f = 0: the symbol (s_h/s) (I + s_h N)^-1 N
 * with s_h = (1 - e^{-sh})/h gives sum_q N^{q+1} x_0 sum_r beta_{q,r} h^r g^(q+r)(0) with
 * beta_{q,r} = (q+1)! S(q+1+r, q+1) / (q+1+r)!, S Stirling's numbers of the second kind; the sum ends
 * since g is a polynomial where the layer is. */
static long double closed(int k, long double h)
{
  long double sum = 0, S[24][24] = {{1}};
  for (int n = 1; n < 24; n++)
    for (int m = 1; m <= n; m++) S[n][m] = m * S[n - 1][m] + S[n - 1][m - 1];
  for (int q = 0; q + 1 < k; q++)
    for (int r = 0; q + r <= 8; r++) {
      long double beta = S[q + 1 + r][q + 1], power = 1;
      for (int i = q + 2; i <= q + 1 + r; i++) beta /= i;
      for (int i = 0; i < r; i++) power *= h;
      sum += (q + 2) * beta * power * steif_test_function(0, q + r);
    }
  return sum;
}

static void levels_are_those_of_closed_values(void)
{
  steif_context *ctx = steif_context_new(NULL);
  int seen = 0, near = 0;
  for (int k = 3; k <= 12; k++) {
    steif_weak_row row[7];
    steif_weak_result result;
    CHECK(!weak_rows(ctx, "be", k, "H-inc", STEIF_R, NULL, 1.0 / 20, 7, row, &result));
    for (int i = 0; i < 7; i++) {
      const double made = fabs((double)(row[i].value - closed(k, row[i].h)));
      CHECK(made <= 4 * row[i].rounding);
      const bool visible = made > 1e-13 * fabs(row[i].value);
      seen += visible, near += visible && row[i].rounding <= 30 * made;
    }
  }
  CHECK(seen > 30 && 10 * near > 9 * seen);
  steif_context_free(&ctx);
}

/* Errors of Gauss's method with 3 stages on N-inc at h = 1/64, 1/128, ..., weak order 2; and of backward
 * Euler at index 12, order 1: 113-bit arithmetic, 33 digits. */
static const struct known {
  const char *method;
  int k;
  enum steif_convention convention;
  int first, order; /* 1/h; weak order */
  double error[5];
} known[] = {
  {"gauss:s=3",
   4,
   STEIF_STAGE,
   64,
   2,
   {.119079704885, .02981030616575, .007455100241128, .001863932790781, 4.6599e-4}},
  {"gauss:s=3",
   5,
   STEIF_STAGE,
   64,
   2,
   {-6.635260667829, -1.660174326352, -.4151285291008, -.1037874414955, -2.5947e-2}},
  {"be", 12, STEIF_R, 16, 1, {71739.42309, 35238.01451, 17452.72568, 8683.609623, 4330.96062}},
  {"be", 11, STEIF_R, 64, 1, {16246.76101, 8051.061803, 4007.360165, 0, 0}},
};

static void errors_are_right_within_their_levels(void)
{
  steif_context *ctx = steif_context_new(NULL);
  for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
    const struct known *a = known + i;
    steif_weak_row row[5];
    steif_weak_result result;
    CHECK(!weak_rows(ctx, a->method, a->k, "N-inc", a->convention, NULL, 1.0 / a->first, 5, row,
                     &result));
    CHECK(result.converges != 0);
    CHECK(isnan(result.order) || fabs(result.order - a->order) < 0.25);
    for (int j = 0; j < 5 && a->error[j] != 0; j++)
      CHECK(fabs(row[j].error - a->error[j]) <=
            1.25 * row[j].rounding + 1e-4 * fabs(a->error[j]));
  }
  steif_context_free(&ctx);
}

/* Weak orders on H-inc at k = 2, 3, 4 by the order of the adjoint method at index k - 1 (test_duality.c);
 * 9: exact. Steps from coarse to where rounding is all there is: verdicts may be open, not wrong. */
static void no_verdict_is_wrong(void)
{
  static const struct {
    const char *method;
    int order[3];
  } truth[] = {{"be", {1, 1, 1}},
               {"radau:s=2", {2, 1, 0}},
               {"radau:s=3", {3, 2, 1}},
               {"radau1a:s=2", {9, 2, 1}},
               {"lobatto3c:s=2", {9, 1, 0}},
               {"lobatto3c:s=3", {9, 2, 1}},
               {"gauss:s=1", {2, 2, 2}},
               {"gauss:s=2", {2, 0, -2}},
               {"gauss:s=3", {4, 4, 2}},
               {"dirk:alexander2", {1, 0, -1}},
               {"dirk:alexander2b", {2, 1, 0}},
               {"dirk:alexander3", {1, 0, -1}},
               {"dirk:crouzeix23", {2, 1, 0}}};
  steif_context *ctx = steif_context_new(NULL);
  int decided = 0, all = 0;
  for (size_t i = 0; i < sizeof truth / sizeof *truth; i++)
    for (int k = 2; k <= 4; k++)
      for (int h = 5; h <= 1280; h *= 4) {
        steif_weak_row row[4];
        steif_weak_result result;
        CHECK(!weak_rows(ctx, truth[i].method, k, "H-inc", i ? STEIF_STAGE : STEIF_R, NULL,
                         1.0 / h, 4, row, &result));
        const bool wrong =
          result.converges >= 0 && result.converges != (truth[i].order[k - 2] > 0);
        if (wrong) printf("\n  %s, k=%d, h=1/%d: %s", truth[i].method, k, h, result.verdict);
        CHECK(!wrong);
        decided += result.converges >= 0, all++;
      }
  CHECK(3 * decided > 2 * all);
  steif_context_free(&ctx);
}

/* Radau IIA with 3 stages on the block of index 5: impulses of order 0 dominate and converge with order 3,
 * those of order 3 stay wrong by 1e3 c_3, which these steps do not show. */
static void impulses_may_be_too_small_to_be_seen(void)
{
  enum { n = 5 };
  steif_context *ctx = steif_context_new(NULL);
  sunrealtype x0[n] = {0, 5, 0, 0, 1e-12};
  const steif_linear l = {SUNDenseMatrix(n, n, steif_sundials(ctx)),
                          SUNDenseMatrix(n, n, steif_sundials(ctx)), NULL, NULL};
  for (int i = 0; i < n; i++) SM_ELEMENT_D(l.F, i, i) = 1;
  for (int i = 0; i + 1 < n; i++) SM_ELEMENT_D(l.E, i, i + 1) = 1;
  steif_weak_row row[4];
  steif_weak_result result;
  const steif_weak_query query = {.method = "radau:s=3",
                                  .linear = &l,
                                  .x0 = x0,
                                  .convention = STEIF_STAGE,
                                  .h = 1.0 / 64,
                                  .rows = 4};
  CHECK(!steif_weak_measure(ctx, &query, row, &result) && fabs(row[3].order - 3) < 0.05);
  CHECK(result.converges == 0 && strstr(result.verdict, "impulses of order 3") != NULL);
  x0[4] = 0;
  CHECK(!steif_weak_measure(ctx, &query, row, &result) && result.converges == 1);
  SUNMatDestroy(l.E), SUNMatDestroy(l.F);
  steif_context_free(&ctx);
}

/* E x' + x = 0 with E = (1, -1; 1, -1), E^2 = 0, from x(0-) in its kernel: the solution is 0 and so is what
 * is paired, to rounding of x(0-) that no order may be read from. */
static void nothing_has_no_order(void)
{
  static const char *const method[] = {"be", "radau:s=2", "gauss:s=2", "dirk:alexander3"};
  steif_context *ctx = steif_context_new(NULL);
  const sunrealtype x0[] = {1. / 3, 1. / 3};
  const steif_linear l = {SUNDenseMatrix(2, 2, steif_sundials(ctx)),
                          SUNDenseMatrix(2, 2, steif_sundials(ctx)), NULL, NULL};
  for (int i = 0; i < 2; i++) {
    SM_ELEMENT_D(l.F, i, i) = 1;
    SM_ELEMENT_D(l.E, i, 0) = 1, SM_ELEMENT_D(l.E, i, 1) = -1;
  }
  for (int i = 0; i < 4; i++) {
    steif_weak_row row[4];
    steif_ball_row norm[4];
    steif_weak_result result;
    steif_weak_ball ball;
    const steif_weak_query query = {.method = method[i],
                                    .linear = &l,
                                    .x0 = x0,
                                    .convention = i ? STEIF_STAGE : STEIF_R,
                                    .h = 0.1,
                                    .rows = 4,
                                    .component = STEIF_ALL};
    CHECK(!steif_weak_measure(ctx, &query, row, &result) && result.converges != 0);
    CHECK(!steif_weak_measure_ball(ctx, &query, 0, norm, &ball) && ball.converges != 0);
    CHECK(fabs(row[3].error) < 1e-13 && !row[3].usable && !norm[3].usable);
  }
  SUNMatDestroy(l.E), SUNMatDestroy(l.F);
  steif_context_free(&ctx);
}

/* Nothing but multiples of the data tells the rounding of it. */
static void without_a_second_run_nothing_is_decided(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_weak_row row[4];
  steif_weak_result result;
  CHECK(!weak_rows(ctx, "auto", 2, "N-inc", STEIF_R, NULL, 1.0 / 64, 4, row, &result));
  CHECK(result.converges == -1 && isnan(result.order));
  CHECK(strstr(result.verdict, "no second run") != NULL);
  steif_context_free(&ctx);
}

/* Radau IIA begins for general linear methods: from x(0-) off the solution its nodal values do not converge
 * weakly at index 2, and neither does what is fitted to them. From a consistent start boxes have order 1,
 * and as a general linear method backward Euler is what it is. */
static void general_linear_methods_are_decided(void)
{
  static const char *const method[] = {"glm:bdf,p=2", "glm:bdf,p=3", "glm:irks,p=2",
                                       "glm:nord22"};
  steif_context *ctx = steif_context_new(NULL);
  steif_weak_row row[2][5];
  steif_weak_result result[2];
  enum steif_convention usual;
  for (int i = 0; i < 4; i++) {
    CHECK(!steif_convention_usual(ctx, method[i], NULL, &usual) && usual == STEIF_R);
    CHECK(!weak_rows(ctx, method[i], 2, "N-inc", STEIF_R, NULL, 1.0 / 64, 5, *row, result));
    CHECK(result->converges == 0);
    for (int j = 0; j < 5; j++) CHECK(row[0][j].rounding <= 1e-9 * fabs(row[0][j].error));
    CHECK(!weak_rows(ctx, method[i], 1, "N-cons", STEIF_R, NULL, 1.0 / 64, 5, *row, result));
    CHECK(result->converges == 1 && fabs(result->order - 1) < 0.1);
  }
  CHECK(!weak_rows(ctx, "be", 3, "N-inc", STEIF_R, NULL, 1.0 / 64, 5, row[0], result));
  CHECK(
    !weak_rows(ctx, "glm:bdf,p=1", 3, "N-inc", STEIF_R, NULL, 1.0 / 64, 5, row[1], result + 1));
  for (int j = 0; j < 5; j++)
    CHECK(fabs(row[0][j].value - row[1][j].value) <=
          4 * (row[0][j].rounding + row[1][j].rounding));
  CHECK(result[1].converges == result[0].converges);
  steif_context_free(&ctx);
}

/* Levels far below the value, errors of so many levels: of two, they are zero for all that is known; of
 * seven they are none, though too small for an order. */
static void small_is_not_zero(void)
{
  for (int times = 1; times <= 7; times += 2) {
    steif_weak_row row[3];
    for (int i = 0; i < 3; i++)
      row[i] = (steif_weak_row){.h = 0.1 / (1 << i),
                                .value = 1,
                                .error = times * 1e-14,
                                .rounding = 1e-14,
                                .order = NAN};
    const steif_weak_result r = judged(row, 3);
    CHECK(r.converges == (times < 4 ? 1 : -1));
    CHECK(strstr(r.verdict, times < 4 ? "exact to rounding" : "undecided: rounding") ==
          r.verdict);
  }
}

/* (1 - t)^n, n the user's. */
static int power(long double t, int order, long double *c, void *user)
{
  const int n = *(const int *)user;
  long double binomial = 1;
  for (int j = 0; j <= order; j++) {
    c[j] = j > n ? 0 : (j % 2 ? -binomial : binomial) * powl(1 - t, n - j);
    binomial = binomial * (n - j) / (j + 1);
  }
  return 0;
}

/* Gauss's methods carry a large alternating part to the end, where weights are tiny: their rounding decides there. */
static void weights_that_end_in_a_zero_of_high_order(void)
{
  static const char *const method[] = {"gauss:s=1", "gauss:s=2", "radau:s=3"};
  steif_context *ctx = steif_context_new(NULL);
  for (int i = 0; i < 9; i++) {
    int n = 12 + 3 * (i / 3);
    const steif_weight g = {power, &n, 1, 1e-18};
    steif_weak_row row[2][4];
    steif_weak_result result;
    for (int exact = 0; exact < 2; exact++) {
      const steif_weak_query query = {.method = method[i % 3],
                                      .problem = "jordan:k=5,case=N-inc",
                                      .convention = STEIF_STAGE,
                                      .g = &g,
                                      .h = 1.0 / 32,
                                      .rows = 4,
                                      .exact = exact};
      CHECK(steif_weak_measure(ctx, &query, row[exact], &result) == STEIF_OK);
    }
    for (int k = 0; k < 4; k++)
      CHECK(fabs((double)(row[0][k].value - row[1][k].value)) <=
            2 * row[0][k].rounding + row[1][k].rounding);
  }
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_rounding[] = {
  {"without a second run nothing is decided", without_a_second_run_nothing_is_decided},
  {"general linear methods are decided", general_linear_methods_are_decided},
  {"rounding levels are the differences to closed values", levels_are_those_of_closed_values},
  {"errors are right within their levels", errors_are_right_within_their_levels},
  {"no verdict is wrong", no_verdict_is_wrong},
  {"nothing has no order", nothing_has_no_order},
  {"impulses may be too small to be seen", impulses_may_be_too_small_to_be_seen},
  {"what is above rounding is not zero", small_is_not_zero},
  {"weights that end in a zero of high order", weights_that_end_in_a_zero_of_high_order},
  CU_TEST_INFO_NULL};
