/* test_frame.c: what an action refuses, when it does not certify, operators, short memory.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "gear.h"
#include "grid.h"
#include "suite.h"
#include <nvector/nvector_manyvector.h>
#include <stdlib.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

enum { N = 120 };

static steif_context *ctx;
static SUNContext sun;
static SUNMatrix A;
static N_Vector v, w;

static void open(void)
{
  ctx = steif_context_new(NULL);
  sun = steif_sundials(ctx);
  A = grid_tridiagonal(N, 1e4, -2e4, 1e4, sun);
  v = N_VNew_Serial(N, sun), w = N_VNew_Serial(N, sun);
  grid_fill(N, 7, NV_DATA_S(v));
}

static void close(void)
{
  SUNMatDestroy(A), N_VDestroy(v), N_VDestroy(w);
  steif_context_free(&ctx);
}

static int refused(SUNMatrix M, const steif_operator *op, N_Vector like, steif_action_options o)
{
  steif_action *a = steif_action_new(ctx, M, op, like, &o);
  const int code = a ? STEIF_OK : steif_status(ctx);
  steif_action_free(&a);
  return code;
}

static void construction(void)
{
  open();
  SUNMatrix wide = SUNSparseMatrix(N, N + 1, 5, CSC_MAT, sun),
            rows = SUNSparseMatrix(N, N, 5, CSR_MAT, sun);
  SUNMatrix dense = SUNDenseMatrix(N, N, sun);
  N_Vector longer = N_VNew_Serial(N + 1, sun);
  const steif_operator op = {.A = NULL};
  const steif_action_options o = {0};
  CHECK(refused(wide, NULL, v, o) == STEIF_BAD_INPUT);
  CHECK(strstr(steif_message(ctx), "square") != NULL);
  CHECK(refused(rows, NULL, v, o) == STEIF_UNSUPPORTED);
  CHECK(refused(dense, NULL, v, o) == STEIF_UNSUPPORTED);
  CHECK(refused(A, NULL, longer, o) == STEIF_BAD_INPUT);
  CHECK(refused(A, &op, v, o) == STEIF_BAD_INPUT);
  CHECK(refused(NULL, NULL, v, o) == STEIF_BAD_INPUT);
  CHECK(refused(NULL, &op, v, o) == STEIF_BAD_INPUT);
  CHECK(refused(A, NULL, NULL, o) == STEIF_BAD_INPUT);
  CHECK(refused(A, NULL, v, (steif_action_options){.method = 4}) == STEIF_BAD_INPUT);
  CHECK(refused(A, NULL, v, (steif_action_options){.spectrum = -1}) == STEIF_BAD_INPUT);
  CHECK(refused(A, NULL, v, (steif_action_options){.tolerance = 1.5}) == STEIF_BAD_INPUT);
  CHECK(refused(A, NULL, v, (steif_action_options){.tolerance = NAN}) == STEIF_BAD_INPUT);
  CHECK(refused(A, NULL, v, (steif_action_options){.dimension = 2}) == STEIF_BAD_INPUT);
  CHECK(refused(A, NULL, v, (steif_action_options){.dimension = 201}) == STEIF_BAD_INPUT);
  CHECK(refused(A, NULL, v, (steif_action_options){.products = -1}) == STEIF_BAD_INPUT);
  SM_DATA_S(A)[7] = NAN;
  CHECK(refused(A, NULL, v, o) == STEIF_NOT_FINITE);
  CHECK(steif_action_new(NULL, A, NULL, v, NULL) == NULL);
  SUNMatDestroy(wide), SUNMatDestroy(rows), SUNMatDestroy(dense), N_VDestroy(longer);
  close();
}

static void arguments(void)
{
  open();
  steif_action *a = steif_action_new(ctx, A, NULL, v, NULL);
  N_Vector longer = N_VNew_Serial(N + 1, sun), b[2] = {v, longer};
  CHECK(steif_action_apply(a, NAN, 0, &v, w, NULL) == STEIF_BAD_INPUT);
  CHECK(steif_action_apply(a, INFINITY, 0, &v, w, NULL) == STEIF_BAD_INPUT);
  CHECK(strstr(steif_message(ctx), "finite") != NULL);
  CHECK(steif_action_apply(a, 0.1, -1, &v, w, NULL) == STEIF_BAD_INPUT);
  CHECK(steif_action_apply(a, 0.1, 9, &v, w, NULL) == STEIF_BAD_INPUT);
  CHECK(steif_action_apply(a, 0.1, 0, NULL, w, NULL) == STEIF_BAD_INPUT);
  CHECK(steif_action_apply(a, 0.1, 0, &v, NULL, NULL) == STEIF_BAD_INPUT);
  CHECK(steif_action_apply(a, 0.1, 0, &v, v, NULL) == STEIF_BAD_INPUT);
  CHECK(steif_action_apply(a, 0.1, 1, b, w, NULL) == STEIF_BAD_INPUT);
  CHECK(steif_action_apply(NULL, 0.1, 0, &v, w, NULL) == STEIF_BAD_INPUT);
  CHECK(steif_action_update(NULL) == STEIF_BAD_INPUT);
  NV_Ith_S(v, 77) = NAN;
  CHECK(steif_action_apply(a, 0.1, 0, &v, w, NULL) == STEIF_NOT_FINITE);
  steif_action_free(&a), steif_action_free(NULL), steif_action_free(&a);
  N_VDestroy(longer);
  close();
}

/* t = 0 and zero vectors need no method; new values are seen after an update. */
static void simple_cases(void)
{
  open();
  steif_action *a = steif_action_new(ctx, A, NULL, v, NULL);
  N_Vector zero = N_VNew_Serial(N, sun), b[3] = {NULL, zero, v};
  N_VConst(0, zero);
  CHECK(!steif_action_apply(a, 0, 2, b, w, NULL));
  for (int i = 0; i < N; i++) CLOSE(NV_Ith_S(w, i), NV_Ith_S(v, i) / 2, 2 * U);
  CHECK(!steif_action_apply(a, 0.3, 1, b, w, NULL));
  for (int i = 0; i < N; i++) CHECK(NV_Ith_S(w, i) == 0);
  for (int k = 0; k < 3 * N - 2; k++) SM_DATA_S(A)[k] = SM_DATA_S(A)[k] < 0 ? -4.2 : 0;
  CHECK(!steif_action_update(a));
  CHECK(!steif_action_apply(a, 0.5, 0, &v, w, NULL));
  for (int i = 0; i < N; i++) CLOSE(NV_Ith_S(w, i), exp(-2.1) * NV_Ith_S(v, i), 1e-10);
  N_VDestroy(zero);
  steif_action_free(&a);
  close();
}

static int run(SUNMatrix M, steif_action_options o, double t, steif_action_report *r)
{
  steif_action *a = steif_action_new(ctx, M, NULL, v, &o);
  const int code = a ? steif_action_apply(a, t, 0, &v, w, r) : steif_status(ctx);
  steif_action_free(&a);
  return code;
}

static void tolerances_not_met(void)
{
  steif_action_report r;
  double exact[N], *S = grid_sines(N);
  open();
  grid_heat(N, S, 1e4 / (121.0 * 121.0) * 2e-3, 0, NV_DATA_S(v), exact);
  CHECK(run(A, (steif_action_options){.method = STEIF_ACTION_RATIONAL, .dimension = 6}, 2e-3,
            &r) == STEIF_NOT_CERTIFIED);
  CHECK(r.error > 1e-10 * r.norm && r.error < r.norm && r.solves == 6);
  CHECK(grid_distance(N, NV_DATA_S(w), exact) <= r.error); /* the best there is, honestly */
  CHECK(strstr(steif_message(ctx), "rational") != NULL);
  CHECK(run(A, (steif_action_options){.method = STEIF_ACTION_POLYNOMIAL, .products = 40}, 1,
            &r) == STEIF_NOT_CERTIFIED);
  CHECK(run(A, (steif_action_options){.method = STEIF_ACTION_TAYLOR, .products = 40}, 1, &r) ==
        STEIF_NOT_CERTIFIED);
  CHECK(isinf(r.error) && r.products < 1000);
  free(S);
  close();
}

/* Waves declared to be diffusion: the rational space fails, the polynomial one takes over. */
static void second_choice(void)
{
  steif_action_report r;
  open();
  SUNMatrix skew = grid_tridiagonal(N, -1, 0, 1, sun);
  steif_action_options o = {.spectrum = STEIF_SPECTRUM_SECTORIAL, .dimension = 30};
  CHECK(run(skew, o, 90, &r) == STEIF_OK);
  CHECK(r.method == STEIF_ACTION_POLYNOMIAL && r.solves > 0 && r.products > 100);
  CLOSE(r.norm, grid_norm(N, NV_DATA_S(v)), 1e-10);
  CHECK(steif_status(ctx) == STEIF_OK);
  o.method = STEIF_ACTION_RATIONAL;
  CHECK(run(skew, o, 90, &r) == STEIF_NOT_CERTIFIED);
  /* 10/t = 5 is an eigenvalue: the shifted matrix is singular. */
  SUNMatrix five = grid_tridiagonal(N, 0, 5, 0, sun);
  CHECK(run(five, o, 2, &r) == STEIF_SINGULAR);
  SUNMatDestroy(skew), SUNMatDestroy(five);
  close();
}

/* diag(-1, -2, ..) / 3 on two subvectors, with an exact preconditioner for the solves. */
static int decay(N_Vector x, N_Vector out, void *user)
{
  double rate = 0;
  for (int part = 0; part < 2; part++) {
    N_Vector from = N_VGetSubvector_ManyVector(x, part),
             to = N_VGetSubvector_ManyVector(out, part);
    for (int i = 0; i < NV_LENGTH_S(from); i++) {
      rate += *(double *)user;
      NV_Ith_S(to, i) = -rate * NV_Ith_S(from, i);
    }
  }
  return 0;
}

static int invert(sunrealtype re, N_Vector r, N_Vector z, sunrealtype tolerance, void *user)
{
  double rate = 0;
  (void)tolerance;
  for (int part = 0; part < 2; part++) {
    N_Vector from = N_VGetSubvector_ManyVector(r, part),
             to = N_VGetSubvector_ManyVector(z, part);
    for (int i = 0; i < NV_LENGTH_S(from); i++) {
      rate += *(double *)user;
      NV_Ith_S(to, i) = NV_Ith_S(from, i) / (re + rate);
    }
  }
  return 0;
}

static void operators(void)
{
  open();
  double third = 1.0 / 3, f[3];
  const steif_operator op = {.A = decay, .precondition = invert, .user = &third};
  N_Vector part[2] = {v, w}, many = N_VNew_ManyVector(2, part, sun), out = N_VClone(many);
  grid_fill(N, 13, NV_DATA_S(w));
  for (int spectrum = STEIF_SPECTRUM_UNKNOWN; spectrum <= STEIF_SPECTRUM_SECTORIAL;
       spectrum++) {
    const steif_action_options o = {.spectrum = spectrum};
    steif_action *a = steif_action_new(ctx, NULL, &op, many, &o);
    CU_ASSERT_FATAL(a != NULL);
    steif_action_report r;
    N_Vector b[3] = {many, NULL, many};
    const int code = steif_action_apply(a, 1.7, 2, b, out, &r);
    if (code) printf("\n  %s", steif_message(ctx));
    CHECK(code == STEIF_OK);
    CHECK(r.method == (spectrum ? STEIF_ACTION_RATIONAL : STEIF_ACTION_POLYNOMIAL));
    double error = 0;
    for (int i = 0; i < 2 * N; i++) {
      N_Vector from = N_VGetSubvector_ManyVector(many, i / N),
               to = N_VGetSubvector_ManyVector(out, i / N);
      steif_phi_scalar(2, -1.7 * (i + 1) / 3, 0, f, NULL);
      error += pow(NV_Ith_S(to, i % N) - (f[0] + f[2]) * NV_Ith_S(from, i % N), 2);
    }
    CHECK(sqrt(error) <= 1e-10 * r.norm);
    steif_action_free(&a);
  }
  const steif_action_options taylor = {.method = STEIF_ACTION_TAYLOR};
  steif_action *a = steif_action_new(ctx, NULL, &op, many, &taylor);
  CHECK(steif_action_apply(a, 1.7, 0, &many, out, NULL) == STEIF_UNSUPPORTED);
  steif_action_free(&a);
  N_VDestroy(out), N_VDestroy(many);
  close();
}

static int all_methods(steif_context *own)
{
  int code = STEIF_OK;
  for (int method = STEIF_ACTION_RATIONAL; method <= STEIF_ACTION_TAYLOR && !code; method++) {
    const steif_action_options o = {.method = method};
    steif_action *a = steif_action_new(own, A, NULL, v, &o);
    N_Vector b[2] = {v, v};
    code = a ? steif_action_apply(a, 1e-4, 1, b, w, NULL) : steif_status(own);
    steif_action_free(&a);
  }
  return code;
}

static void hunger(void)
{
  open();
  CHECK(gear_hunger(all_methods) > 30);
  close();
}

CU_TestInfo tests_of_frame[] = {
  {"wrong matrices, operators and options are refused", construction},
  {"wrong times, orders and vectors are refused", arguments},
  {"time zero, zero vectors and new values", simple_cases},
  {"a tolerance that is not met is said with the estimate", tolerances_not_met},
  {"the polynomial method takes over from a useless rational one", second_choice},
  {"operators on vectors without an array", operators},
  {"every allocation may fail without crash or leak", hunger},
  CU_TEST_INFO_NULL};
