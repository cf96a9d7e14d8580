/* test_finite.c: the state space behind E x' = A x + B u, and its discretisation. Answers by hand.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"
#include <steif/analysis.h>
#include <steif/data.h>
#include <steif/linear.h>
#include <steif/steif.h>
#include <string.h>

static steif_context *ctx;

static steif_finite_part found(const steif_state_space *s, const double *E)
{
  steif_finite_part part;
  const int code = steif_finite_part_find(ctx, s, E, &part);
  if (code) printf("\n  %s", steif_message(ctx));
  CU_ASSERT_FATAL(code == STEIF_OK);
  return part;
}

static void near(size_t count, const double *x, const double *y)
{
  for (size_t i = 0; i < count; i++) CLOSE_FLOOR(x[i], y[i], 1e-14, 1);
}

/* P M Q for 3 x 3 matrices. */
static void transform(const double *P, const double *Q, double *M)
{
  double T[9] = {0}, R[9] = {0};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      for (int k = 0; k < 3; k++) T[i + 3 * j] += P[i + 3 * k] * M[k + 3 * j];
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      for (int k = 0; k < 3; k++) R[i + 3 * j] += T[i + 3 * k] * Q[k + 3 * j];
  memcpy(M, R, sizeof R);
}

/* x1' = -2 x1 + x3 + 3 u, x3' = x2, 0 = x3 + u: index 2, x1' = -2 x1 + 2 u, x2 = -u', x3 = -u, in
 * unknowns Q^{-1} x and equations combined by P, y = c x. */
static void index_two_has_a_derivative(void)
{
  double E[] = {1, 0, 0, 0, 0, 0, 0, 1, 0}, A[] = {-2, 0, 0, 0, 1, 0, 1, 0, 1};
  const double b[] = {3, 0, 1}, c[] = {0.5, -2, 7}, d = 11;
  const double P[] = {1, 0.3, -0.7, 2, 1.1, 0.4, -0.2, 0.9, 1.6},
               Q[] = {0.8, -1.2, 0.1, 0.5, 1, 2, -0.3, 0.6, 1.4};
  double B[3] = {0}, C[3] = {0};
  transform(P, Q, E), transform(P, Q, A);
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++) B[i] += P[i + 3 * k] * b[k], C[i] += c[k] * Q[k + 3 * i];
  const steif_state_space s = {.n = 3, .m = 1, .p = 1, .A = A, .B = B, .C = C, .D = &d};
  steif_finite_part part = found(&s, E);
  CHECK(part.index == 2 && part.form.n == 1 && part.terms == 1);
  CLOSE(part.form.A[0], -2, 1e-13);
  CLOSE(part.form.B[0] * part.form.C[0], 0.5 * 2, 1e-13);
  CLOSE(part.form.D[0], 11 - 7, 1e-13);
  CLOSE(part.polynomial[0], 2, 1e-13);
  steif_discrete h;
  CHECK(!steif_c2d(ctx, &part.form, "zoh", 0.25, &h));
  CLOSE(h.form.A[0], exp(-0.5), 1e-13);
  CLOSE(h.form.B[0] * h.form.C[0], 0.5 * (1 - exp(-0.5)), 1e-13);
  steif_discrete_clear(ctx, &h);
  steif_finite_part_clear(ctx, &part);
  CHECK(part.memory == NULL);
}

/* x2' = x1, x3' = x2, 0 = x3 + u: nothing but derivatives. */
static void index_three_may_have_no_state(void)
{
  const double E[] = {0, 0, 0, 1, 0, 0, 0, 1, 0}, A[] = {1, 0, 0, 0, 1, 0, 0, 0, 1},
               B[] = {0, 0, 1};
  const steif_state_space s = {.n = 3, .m = 1, .A = A, .B = B};
  steif_finite_part part = found(&s, E);
  CHECK(part.index == 3 && part.form.n == 0 && part.form.p == 3 && part.terms == 2);
  near(3, part.form.D, (const double[]){0, 0, -1});
  near(6, part.polynomial, (const double[]){0, -1, 0, -1, 0, 0});
  steif_finite_part_clear(ctx, &part);
}

/* 0 = x1 - 2 x2 + u: x1' = -x1 + x2 = -x1/2 + u/2. */
static void index_one_is_a_feed_through(void)
{
  const double E[] = {1, 0, 0, 0}, A[] = {-1, 1, 1, -2}, B[] = {0, 1};
  const steif_state_space s = {.n = 2, .m = 1, .A = A, .B = B};
  steif_finite_part part = found(&s, E);
  CHECK(part.index == 1 && part.form.n == 1 && part.form.p == 2 && part.terms == 0);
  double H[4];
  for (double w = 0.3; w < 5; w *= 2.1) {
    const double size = 0.25 + w * w, re = 0.25 / size,
                 im = -0.5 * w / size; /* 0.5/(iw + 0.5) */
    CHECK(!steif_response(ctx, &part.form, 0, w, H));
    near(4, H, (const double[]){re, im, (re + 1) / 2, im / 2});
  }
  steif_finite_part_clear(ctx, &part);
}

static void a_regular_E_is_divided_by(void)
{
  const double E[] = {2, 0, 1, 4}, A[] = {-4, 0, -2, -12}, B[] = {2, 8};
  const steif_state_space s = {.n = 2, .m = 1, .A = A, .B = B};
  steif_finite_part part = found(&s, E);
  CHECK(part.index == 0 && part.form.n == 2 && part.terms == 0);
  double H[4];
  /* E^{-1} A = [-2 1/2; 0 -3], E^{-1} B = (0, 2) */
  CHECK(!steif_response(ctx, &part.form, 1, 0, H));
  near(4, H, (const double[]){0.25 / 3, 0, 0.5, 0});
  steif_finite_part_clear(ctx, &part);
}

static void refused(const steif_state_space *s, const double *E, int code, const char *words)
{
  steif_finite_part part;
  CHECK(steif_finite_part_find(ctx, s, E, &part) == code);
  CHECK(strstr(steif_message(ctx), words) != NULL);
  CHECK(part.memory == NULL);
}

static void bad_systems_are_refused(void)
{
  const double zero[] = {0, 0, 0, 0}, one[] = {1, 0, 0, 0}, nan[] = {1, NAN, 0, 0};
  steif_state_space s = {.n = 2, .A = one};
  steif_finite_part part;
  refused(&s, one, STEIF_SINGULAR, "singular");
  refused(&s, zero, STEIF_SINGULAR, "singular");
  refused(&s, nan, STEIF_NOT_FINITE, "E(2, 1)");
  refused(&s, NULL, STEIF_BAD_INPUT, "E is NULL");
  s.n = 0;
  refused(&s, one, STEIF_BAD_INPUT, "0 states");
  CHECK(steif_finite_part_find(ctx, NULL, one, &part) == STEIF_BAD_INPUT);
  steif_finite_part_clear(ctx, NULL);
}

/* HiPPO-LegS of 64 states: the first column of A is -B, so Bd = e_0 - Ad e_0; the eigenvalues are
 * -1 .. -64. Frobenius norm and Ad[63][0] by mpmath. */
static void legs_of_64_states(void)
{
  enum { N = 64 };
  static double A[N * N], B[N];
  for (int i = 0; i < N; i++) {
    A[i + N * i] = -(i + 1.0), B[i] = sqrt(2 * i + 1.0);
    for (int k = 0; k < i; k++) A[i + N * k] = -sqrt((2. * i + 1) * (2. * k + 1));
  }
  const steif_state_space s = {.n = N, .m = 1, .A = A, .B = B};
  steif_discrete d;
  CU_ASSERT_FATAL(!steif_c2d(ctx, &s, "zoh", 0.1, &d));
  double trace = 0, square = 0;
  for (int i = 0; i < N; i++) trace += d.form.A[i + N * i];
  for (int i = 0; i < N * N; i++) square += d.form.A[i] * d.form.A[i];
  CLOSE(trace, 9.4925333066764566, 1e-13);
  CLOSE(sqrt(square), 6.8078781279266152, 1e-13);
  CLOSE(d.form.A[N - 1], -0.0066434881647021519, 1e-12);
  for (int i = 0; i < N; i++) CLOSE_FLOOR(d.form.B[i], (i == 0) - d.form.A[i], 1e-13, 1);
  steif_discrete_clear(ctx, &d);
}

static void opened(void) { ctx = steif_context_new(NULL); }
static void closed(void) { steif_context_free(&ctx); }

CU_TestInfo tests_of_finite[] = {
  {"a context opens", opened},
  {"index two has a derivative", index_two_has_a_derivative},
  {"index three may have no state", index_three_may_have_no_state},
  {"index one is a feed-through", index_one_is_a_feed_through},
  {"a regular E is divided by", a_regular_E_is_divided_by},
  {"bad systems are refused", bad_systems_are_refused},
  {"HiPPO-LegS of 64 states", legs_of_64_states},
  {"the context closes", closed},
  CU_TEST_INFO_NULL};
