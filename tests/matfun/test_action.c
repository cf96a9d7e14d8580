/* test_action.c: phi functions of large matrices applied to vectors, against sine bases and
 * dense functions.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "gear.h"
#include "grid.h"
#include "suite.h"
#include <stdlib.h>
#include <string.h>

enum { N = 999, SMALL = 60 };

static steif_context *ctx;
static SUNContext sun;

static void open(void)
{
  ctx = steif_context_new(NULL);
  sun = steif_sundials(ctx);
}

static void close(void) { steif_context_free(&ctx); }

static void below(const char *what, double t, int k, double error, double tolerance)
{
  if (!(error <= tolerance))
    printf("\n  %s, t = %g, phi_%d: error %.2e, allowed %.2e", what, t, k, error, tolerance);
  CHECK(error <= tolerance);
}

/* The estimate may not fall short by more than rounding, which the solves make about 1e-12 of
 * v. */
static void heat_case(steif_action *a, const double *S, double t, int k, unsigned seed)
{
  double *exact = malloc(N * sizeof *exact);
  N_Vector v = N_VNew_Serial(N, sun), w = N_VNew_Serial(N, sun), b[3] = {NULL, NULL, NULL};
  steif_action_report r;
  grid_fill(N, seed, NV_DATA_S(v));
  grid_heat(N, S, t, k, NV_DATA_S(v), exact);
  b[k] = v;
  CHECK(!steif_action_apply(a, t, k, b, w, &r));
  const double error = grid_distance(N, NV_DATA_S(w), exact), size = grid_norm(N, exact);
  below(seed ? "random v" : "smooth v", t, k, error, 1e-10 * size);
  CHECK(error <= r.error + 2e-12 * grid_norm(N, NV_DATA_S(v)));
  CLOSE(r.norm, size, 1e-9);
  CLOSE(r.norm_tA, 4e6 * t, 1e-12);
  CHECK(r.method == STEIF_ACTION_RATIONAL && r.solves <= 36 && r.solves >= r.dimension);
  free(exact), N_VDestroy(v), N_VDestroy(w);
}

static void heat(void)
{
  open();
  SUNMatrix A = grid_tridiagonal(N, 1e6, -2e6, 1e6, sun);
  N_Vector like = N_VNew_Serial(N, sun);
  double *S = grid_sines(N);
  steif_action *a = steif_action_new(ctx, A, NULL, like, NULL);
  CU_ASSERT_FATAL(a && S);
  for (double t = 1e-4; t < 2; t *= 100)
    for (int k = 0; k <= 2; k++)
      for (unsigned seed = 0; seed <= 4321; seed += 4321) heat_case(a, S, t, k, seed);
  steif_action_free(&a);
  free(S), SUNMatDestroy(A), N_VDestroy(like);
  close();
}

/* 96 x 96 grid: one factorisation serves several times near each other and all phi functions.
 */
static void heat_on_a_square(void)
{
  enum { SIDE = 96, SIZE = SIDE * SIDE };
  open();
  SUNMatrix A = grid_five_points(SIDE, sun);
  N_Vector v = N_VNew_Serial(SIZE, sun), w = N_VNew_Serial(SIZE, sun), b[2] = {NULL, NULL};
  double *S = grid_sines(SIDE), *exact = malloc(SIZE * sizeof *exact);
  steif_action *a = steif_action_new(ctx, A, NULL, v, NULL);
  CU_ASSERT_FATAL(a && S && exact);
  grid_fill(SIZE, 977, NV_DATA_S(v));
  long factors = 0;
  for (int k = 0; k < 6; k++) {
    const double t = 210 * (1 + 0.11 * k);
    steif_action_report r;
    b[k % 2] = v, b[(k + 1) % 2] = NULL;
    CHECK(!steif_action_apply(a, t, k % 2, b, w, &r));
    grid_heat_2d(SIDE, S, t, k % 2, NV_DATA_S(v), exact);
    below("square", t, k % 2, grid_distance(SIZE, NV_DATA_S(w), exact),
          1e-10 * grid_norm(SIZE, exact));
    CHECK(r.method == STEIF_ACTION_RATIONAL);
    factors += r.factors;
  }
  CHECK(factors == 1);
  steif_action_free(&a);
  free(S), free(exact), SUNMatDestroy(A), N_VDestroy(v), N_VDestroy(w);
  close();
}

/* exp(t tridiag(-1, 0, 1)) is orthogonal; ||tA||_1 = 600. The skew matrix is recognised. */
static void waves(void)
{
  enum { SIZE = 400 };
  open();
  SUNMatrix A = grid_tridiagonal(SIZE, -1, 0, 1, sun);
  N_Vector v = N_VNew_Serial(SIZE, sun), w = N_VNew_Serial(SIZE, sun);
  double *S = grid_sines(SIZE), exact[SIZE];
  grid_fill(SIZE, 3301, NV_DATA_S(v));
  for (int sign = -1; sign <= 1; sign += 2) {
    steif_action_report r;
    steif_action *a = steif_action_new(ctx, A, NULL, v, NULL);
    CU_ASSERT_FATAL(a && S);
    CHECK(!steif_action_apply(a, sign * 300, 0, &v, w, &r));
    grid_waves(SIZE, S, sign * 300, NV_DATA_S(v), exact);
    const double error = grid_distance(SIZE, NV_DATA_S(w), exact);
    below("waves", sign * 300, 0, error, 1e-10 * r.norm);
    CHECK(error <= r.error + 1e-12 * r.norm);
    CHECK(r.method == STEIF_ACTION_POLYNOMIAL && r.dimension == 30 && r.factors == 0);
    CHECK(r.products < 3000 && r.steps > 10);
    CLOSE(r.norm, grid_norm(SIZE, NV_DATA_S(v)), 1e-10);
    steif_action_free(&a);
  }
  free(S), SUNMatDestroy(A), N_VDestroy(v), N_VDestroy(w);
  close();
}

/* Convection and diffusion, nonsymmetric; combinations with all b_k, some, and one, by all
 * methods against the dense function, for t of both signs. */
static void combine_case(SUNMatrix A, int method, double t, unsigned present)
{
  double dense[SMALL * SMALL] = {0}, flat[4 * SMALL] = {0}, exact[SMALL];
  N_Vector b[4], v[4], w = N_VNew_Serial(SMALL, sun);
  unsigned seed = 17 + present;
  for (int j = 0; j < SMALL; j++)
    for (sunindextype k = SM_INDEXPTRS_S(A)[j]; k < SM_INDEXPTRS_S(A)[j + 1]; k++)
      dense[SM_INDEXVALS_S(A)[k] + SMALL * j] = t * SM_DATA_S(A)[k];
  for (int k = 0; k < 4; k++) {
    v[k] = N_VNew_Serial(SMALL, sun);
    b[k] = present >> k & 1 ? v[k] : NULL;
    for (int i = 0; i < SMALL; i++) {
      NV_Ith_S(v[k], i) = (1 + 40 * k * k) * gear_random(&seed);
      if (b[k]) flat[i + SMALL * k] = NV_Ith_S(v[k], i);
    }
  }
  CHECK(!steif_phi_combine(ctx, SMALL, 3, dense, flat, exact));
  const steif_action_options o = {.method = method, .tolerance = 1e-11};
  steif_action *a = steif_action_new(ctx, A, NULL, w, &o);
  CU_ASSERT_FATAL(a != NULL);
  steif_action_report r;
  const int code = steif_action_apply(a, t, 3, b, w, &r);
  if (code) printf("\n  %s", steif_message(ctx));
  CHECK(code == STEIF_OK && r.method == method);
  below("combination", t, (int)present, grid_distance(SMALL, NV_DATA_S(w), exact),
        2e-11 * grid_norm(SMALL, exact));
  steif_action_free(&a);
  for (int k = 0; k < 4; k++) N_VDestroy(v[k]);
  N_VDestroy(w);
}

static void combinations(void)
{
  open();
  SUNMatrix A = grid_tridiagonal(SMALL, 1.7, -2.9, 1.1, sun);
  for (unsigned present = 1; present < 16; present += 2)
    for (double t = 0.3; t < 40; t *= 7) {
      combine_case(A, STEIF_ACTION_POLYNOMIAL, t, present);
      combine_case(A, STEIF_ACTION_TAYLOR, t, present);
      combine_case(A, STEIF_ACTION_RATIONAL, t, present);
    }
  for (int method = STEIF_ACTION_POLYNOMIAL; method <= STEIF_ACTION_TAYLOR; method++)
    combine_case(A, method, -1.9, 11), combine_case(A, method, -6.5, 1);
  combine_case(A, STEIF_ACTION_RATIONAL, 3.7, 14);
  SUNMatDestroy(A);
  close();
}

/* The Taylor method asks for powers where the norm exceeds 63, and still meets the tolerance.
 */
static void taylor_with_norms_of_powers(void)
{
  open();
  SUNMatrix A = grid_tridiagonal(N, 1e6, -2e6, 1e6, sun);
  N_Vector v = N_VNew_Serial(N, sun), w = N_VNew_Serial(N, sun);
  double *S = grid_sines(N), *exact = malloc(N * sizeof *exact);
  const steif_action_options o = {.method = STEIF_ACTION_TAYLOR};
  steif_action *a = steif_action_new(ctx, A, NULL, v, &o);
  CU_ASSERT_FATAL(a && S && exact);
  grid_fill(N, 55, NV_DATA_S(v));
  grid_heat(N, S, 1e-4, 0, NV_DATA_S(v), exact);
  steif_action_report first, second;
  CHECK(!steif_action_apply(a, 1e-4, 0, &v, w, &first));
  below("taylor", 1e-4, 0, grid_distance(N, NV_DATA_S(w), exact), 1e-10 * grid_norm(N, exact));
  CHECK(!steif_action_apply(a, 1e-4, 0, &v, w, &second));
  CHECK(second.products < first.products && second.products < 1300);
  steif_action_free(&a);
  free(S), free(exact), SUNMatDestroy(A), N_VDestroy(v), N_VDestroy(w);
  close();
}

/* A growing mode: lambda up to 3.2, ||w|| is 24 times ||v||. */
static void growth(void)
{
  open();
  SUNMatrix A = grid_tridiagonal(SMALL, 1, 1.2, 1, sun);
  N_Vector v = N_VNew_Serial(SMALL, sun), w = N_VNew_Serial(SMALL, sun);
  double *S = grid_sines(SMALL), exact[SMALL];
  grid_fill(SMALL, 0, NV_DATA_S(v));
  /* tridiag(1, 1.2, 1) = tridiag(1, -2, 1) + 3.2 I */
  grid_heat(SMALL, S, 1.0 / (61.0 * 61.0), 0, NV_DATA_S(v), exact);
  for (int i = 0; i < SMALL; i++) exact[i] *= exp(3.2);
  for (int method = STEIF_ACTION_AUTO; method <= STEIF_ACTION_TAYLOR; method++) {
    const steif_action_options o = {.method = method, .tolerance = 1e-12};
    steif_action *a = steif_action_new(ctx, A, NULL, v, &o);
    CHECK(!steif_action_apply(a, 1, 0, &v, w, NULL));
    below("growth", 1, method, grid_distance(SMALL, NV_DATA_S(w), exact),
          1e-12 * grid_norm(SMALL, exact));
    steif_action_free(&a);
  }
  free(S), SUNMatDestroy(A), N_VDestroy(v), N_VDestroy(w);
  close();
}

/* Small, medium, large and again medium norms of tA: every method leaves room for the next. */
static void methods_take_turns(void)
{
  static const struct {
    double t;
    int method;
  } turns[] = {{40, STEIF_ACTION_RATIONAL}, {12, STEIF_ACTION_POLYNOMIAL},
               {41, STEIF_ACTION_RATIONAL}, {1, STEIF_ACTION_TAYLOR},
               {39, STEIF_ACTION_RATIONAL}, {13, STEIF_ACTION_POLYNOMIAL},
               {1.1, STEIF_ACTION_TAYLOR}};
  open();
  SUNMatrix A = grid_tridiagonal(SMALL, 1, -2, 1, sun);
  N_Vector v = N_VNew_Serial(SMALL, sun), w = N_VNew_Serial(SMALL, sun), b[] = {NULL, v};
  double *S = grid_sines(SMALL), exact[SMALL];
  steif_action *a = steif_action_new(ctx, A, NULL, v, NULL);
  grid_fill(SMALL, 71, NV_DATA_S(v));
  for (size_t i = 0; i < sizeof turns / sizeof *turns; i++) {
    steif_action_report r;
    CHECK(steif_action_apply(a, turns[i].t, 1, b, w, &r) == STEIF_OK);
    CHECK(r.method == turns[i].method);
    grid_heat(SMALL, S, turns[i].t / (61.0 * 61.0), 1, NV_DATA_S(v), exact);
    below("turn", turns[i].t, 1, grid_distance(SMALL, NV_DATA_S(w), exact),
          1e-10 * grid_norm(SMALL, exact));
  }
  steif_action_free(&a);
  free(S), SUNMatDestroy(A), N_VDestroy(v), N_VDestroy(w);
  close();
}

CU_TestInfo tests_of_action[] = {
  {"heat on 999 points meets the sine basis at three times", heat},
  {"heat on a square takes one factorisation for six times", heat_on_a_square},
  {"waves are recognised and take the polynomial method", waves},
  {"combinations by three methods meet the dense function", combinations},
  {"the Taylor method estimates norms of powers once", taylor_with_norms_of_powers},
  {"methods take turns", methods_take_turns},
  {"a growing solution is relative to its own norm", growth},
  CU_TEST_INFO_NULL};
