/* test_claims.c: what discrete.h claims of every scheme, on the oscillator and on systems of
 * some hundred states.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "oscillator.h"
#include "suite.h"
#include <nvector/nvector_serial.h>
#include <stdbool.h>
#include <steif/forcing.h>
#include <stdlib.h>
#include <string.h>

/* Output of matched, whose state is its own, for u = sin 2t, k = 3: largest error on [0, 4]. */
static double matched_error(double dt)
{
  double A[4], h[2], x[2] = {0, 0}, most = 0;
  steif_context *ctx = steif_context_new(NULL);
  const steif_state_space s = oscillator(3, A);
  steif_discrete d;
  CHECK(steif_c2d(ctx, &s, "matched", dt, &d) == STEIF_OK);
  for (long j = 0; (double)j * dt <= 4; j++) {
    const double t = (double)j * dt, u = sin(2 * t), *F = d.form.A, *C = d.form.C;
    exact(3, SINE, t, h);
    most = fmax(most, fabs(C[0] * x[0] + C[1] * x[1] + d.form.D[0] * u - h[0]));
    const double next = F[0] * x[0] + F[2] * x[1] + d.form.B[0] * u;
    x[1] = F[1] * x[0] + F[3] * x[1] + d.form.B[1] * u, x[0] = next;
  }
  steif_discrete_clear(ctx, &d);
  steif_context_free(&ctx);
  return most;
}

static void orders_are_those_of_the_list(void)
{
  const steif_scheme *s;
  size_t i = 0;
  for (; (s = steif_scheme_at(i)); i++) {
    const char *name = strcmp(s->name, "gbt") ? s->name : "gbt:alpha=0.7";
    const bool own = !strcmp(name, "matched");
    const double coarse =
      own ? matched_error(1. / 128) : worst(name, 3, SINE, 1. / 128, LENGTH, NULL);
    const double fine =
      own ? matched_error(1. / 256) : worst(name, 3, SINE, 1. / 256, LENGTH, NULL);
    CLOSE_FLOOR(log2(coarse / fine), s->order, 0.04, 1);
    CHECK(strlen(s->about) > 10);
  }
  CHECK(i == 12);
  CLOSE(log2(worst("gbt:alpha=0.5", 3, SINE, 1. / 128, LENGTH, NULL) /
             worst("gbt:alpha=0.5", 3, SINE, 1. / 256, LENGTH, NULL)),
        2, 0.01);
}

/* Numbers in (-1, 1) from a linear congruence. */
static void scatter(size_t count, double size, double *x)
{
  unsigned long state = 20260611;
  for (size_t i = 0; i < count; i++) {
    state = (state * 1103515245UL + 12345UL) & 0x7fffffffUL;
    x[i] = size * ((double)state / 0x40000000UL - 1);
  }
}

enum { N = 150, M = 3 };

/* C = A B + beta C for N x N matrices A. */
static void times(int columns, const double *A, const double *B, double beta, double *C)
{
  for (int j = 0; j < columns; j++)
    for (int i = 0; i < N; i++) {
      double sum = beta * C[i + N * j];
      for (int k = 0; k < N; k++) sum += A[i + N * k] * B[k + N * j];
      C[i + N * j] = sum;
    }
}

static double gap(size_t count, const double *x, const double *y)
{
  double most = 0;
  for (size_t i = 0; i < count; i++) most = fmax(most, fabs(x[i] - y[i]));
  return most;
}

/* A hold over 2 dt is two holds over dt: Ad^2 and (1 + Ad) Bd; the logarithm takes it back. */
static void large_systems_hold_twice(steif_context *ctx, double *A, double *B, double *C)
{
  const steif_state_space s = {.n = N, .m = M, .A = A, .B = B};
  const double dt = 0.37;
  steif_discrete one, two;
  scatter(N * N, 0.15, A), scatter(N * M, 1, B);
  CHECK(steif_c2d(ctx, &s, "zoh", dt, &one) == STEIF_OK);
  CHECK(steif_c2d(ctx, &s, "zoh", 2 * dt, &two) == STEIF_OK);
  times(N, one.form.A, one.form.A, 0, C);
  CHECK(gap(N * N, C, two.form.A) < 2e-14);
  memcpy(C, one.form.B, N * M * sizeof *C);
  times(M, one.form.A, one.form.B, 1, C);
  CHECK(gap(N * M, C, two.form.B) < 2e-14);
  CHECK(one.alias > 0 && one.alias < 1);
  CHECK(steif_d2c(ctx, N, M, one.form.A, one.form.B, dt, C, C + N * N) == STEIF_OK);
  CHECK(gap(N * N, C, A) < 1e-12);
  CHECK(gap(N * M, C + N * N, B) < 1e-12);
  steif_discrete_clear(ctx, &one);
  steif_discrete_clear(ctx, &two);
}

static void large_systems(void)
{
  steif_context *ctx = steif_context_new(NULL);
  double *x = calloc(2 * N * (N + M), sizeof *x);
  CHECK(x != NULL);
  if (x) large_systems_hold_twice(ctx, x, x + N * N, x + N * (N + M));
  free(x);
  steif_context_free(&ctx);
}

/* Integrators in a row have a defective Ad = exp(dt S); its logarithm is dt S again. */
static void defective_matrices_have_logarithms(void)
{
  static const double S[] = {0, 0, 0, 1, 0, 0, 0, 1, 0}, B[] = {0, 0, 2.5};
  double A[9], b[3];
  steif_context *ctx = steif_context_new(NULL);
  const steif_state_space s = {.n = 3, .m = 1, .A = S, .B = B};
  steif_discrete d;
  CHECK(steif_c2d(ctx, &s, "zoh", 0.7, &d) == STEIF_OK);
  CHECK(steif_d2c(ctx, 3, 1, d.form.A, d.form.B, 0.7, A, b) == STEIF_OK);
  for (int i = 0; i < 9; i++) CLOSE_FLOOR(A[i], S[i], 4e-15, 1);
  for (int i = 0; i < 3; i++) CLOSE_FLOOR(b[i], B[i], 4e-15, 1);
  steif_discrete_clear(ctx, &d);
  steif_context_free(&ctx);
}

/* A forcing function of steif/forcing.h as input. */
struct text {
  steif_function *f;
  N_Vector g;
};
static int expression(double t, double *u, void *user)
{
  struct text *x = user;
  const int code = steif_function_value(t, 0, x->g, x->f);
  *u = NV_Ith_S(x->g, 0);
  return code;
}

static void expressions_drive_runs(void)
{
  double A[4], h[2 * 41], e[2];
  steif_context *ctx = steif_context_new(NULL);
  const steif_state_space s = oscillator(4, A);
  steif_discrete d;
  struct text x = {steif_function_parse(ctx, "3 - 2*ramp(t - 1)", 1, NULL),
                   N_VNew_Serial(1, steif_sundials(ctx))};
  CHECK(steif_c2d(ctx, &s, "foh", 0.1, &d) == STEIF_OK);
  CHECK(steif_discrete_run(ctx, &d, expression, &x, 0, NULL, 40, h) == STEIF_OK);
  for (int k = 0; k <= 40; k++) {
    double expected[2], ramp[2] = {0, 0};
    exact(4, ONE, 0.1 * k, e);
    if (k > 10) exact(4, RAMP, 0.1 * k - 1, ramp);
    for (int i = 0; i < 2; i++) expected[i] = 3 * e[i] - 2 * ramp[i];
    CLOSE_FLOOR(h[2 * k], expected[0], 4e-15, 1);
    CLOSE_FLOOR(h[2 * k + 1], expected[1], 4e-15, 1);
  }
  N_VDestroy(x.g);
  steif_function_free(&x.f);
  steif_discrete_clear(ctx, &d);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_claims[] = {
  {"orders are those of the list", orders_are_those_of_the_list},
  {"large systems hold twice and go back", large_systems},
  {"defective matrices have logarithms", defective_matrices_have_logarithms},
  {"expressions drive runs, exactly where they are linear", expressions_drive_runs},
  CU_TEST_INFO_NULL};
