/* test_demand.c: derivatives of f that are not known matter only where equations are differentiated.
 * SPDX-License-Identifier: BSD-3-Clause */
#include <steif/runs.h>
#include "impulse/families.h"
#include "impulse/systems.h"

/* C v' + i = f_1, L j' + v - R j = f_2 and v = f_3 through a source of current i: index 2, in which only
 * f_3 is differentiated: i = f_1 - C f_3'. */
static const double circuit_E[9] = {[0] = 2.5, [4] = 0.4}, /* by columns */
  circuit_F[9] = {[1] = 1, [2] = 1, [4] = 1.75, [6] = 1};

static SUNMatrix matrix(steif_context *ctx, bool sparse, const double *x)
{
  SUNMatrix M = SUNDenseMatrix(3, 3, steif_sundials(ctx)), S;
  memcpy(SM_DATA_D(M), x, 9 * sizeof *x);
  if (!sparse) return M;
  S = SUNSparseFromDenseMatrix(M, 0, CSC_MAT);
  SUNMatDestroy(M);
  return S;
}

/* (3 + sqrt(t), 0, 3/4 + sin 2t), or with its root in the last row: no derivative of that at 0. */
static int rough(sunrealtype t, int q, N_Vector g, void *last)
{
  const sunrealtype root = q == 0 ? sqrt(t) : t > 0 && q == 1 ? 0.5 / sqrt(t) : NAN;
  NV_Ith_S(g, 0) = (q ? 0 : 3) + (last ? 0 : root);
  NV_Ith_S(g, 1) = 0;
  NV_Ith_S(g, 2) = (q ? 0 : 0.75) + pow(2, q) * sin(2 * t + q * acos(0.0)) + (last ? root : 0);
  return 0;
}

static void only_differentiated_equations_ask(void)
{
  static const double x0[3] = {1.25, -0.5, 3};
  const steif_names names = {(const char *const[]){"node", "coil", "source"}, NULL};
  steif_context *ctx = steif_context_new(NULL);
  for (int way = 0; way < 4; way++) {
    const steif_analysis a = {.algorithm = way > 1 ? STEIF_CONTOUR : STEIF_STAIRCASE,
                              .names = &names};
    steif_linear l = {.E = matrix(ctx, way % 2, circuit_E),
                      .F = matrix(ctx, way % 2, circuit_F)};
    steif_impulse i;
    CHECK(!steif_impulse_find(ctx, l.E, l.F, x0, 0, rough, NULL, &a, NULL, &i));
    CU_ASSERT_FATAL(i.x_plus != NULL);
    CHECK(i.index == 2 && i.certified);
    CLOSE(i.x_plus[2], 3 - 2.5 * 2, 1e-12);
    CLOSE(i.c[2], 2.5 * (1.25 - 0.75), 1e-12);
    steif_impulse_clear(ctx, &i);
    CHECK(steif_impulse_find(ctx, l.E, l.F, x0, 0, rough, ctx, &a, NULL, &i) ==
          STEIF_BAD_INPUT);
    CHECK(!!strstr(steif_message(ctx), "equation 3 (source) has none"));
    SUNMatDestroy(l.E), SUNMatDestroy(l.F);
  }
  steif_context_free(&ctx);
}

static int unknown_slope(sunrealtype t, int q, N_Vector g, void *user)
{
  (void)t;
  N_VConst(0.25, g);
  if (q) NV_Ith_S(g, *(int *)user) = NAN;
  return 0;
}

/* Full matrices whose pattern allows more finite eigenvalues than their values leave: every right-hand
 * side may be differentiated. */
static void hidden_structure_asks_for_all(void)
{
  static const double x0[5] = {1, 2, 3, 4, 5};
  steif_context *ctx = steif_context_new(NULL);
  SUNMatrix E = dense5(ctx, ut5_E), F = dense5(ctx, ut5_F);
  steif_structure s;
  CHECK(!steif_structure_find(ctx, E, F, NULL, &s) && s.degree > s.finite);
  steif_structure_clear(ctx, &s);
  for (int k = 0; k < 5; k++) {
    steif_impulse i;
    CHECK(steif_impulse_find(ctx, E, F, x0, 0, unknown_slope, &k, NULL, NULL, &i) ==
          STEIF_BAD_INPUT);
  }
  SUNMatDestroy(E), SUNMatDestroy(F);
  steif_context_free(&ctx);
}

/* A run meets sqrt(t) at its start and is not stopped by it. */
static int last(sunrealtype t, N_Vector x, void *user)
{
  (void)t;
  memcpy(user, NV_DATA_S(x), 3 * sizeof(double));
  return 0;
}
static void runs_go_on(void)
{
  static const double x0[3] = {1.25, -0.5, 3};
  double x[3] = {0};
  steif_context *ctx = steif_context_new(NULL);
  const steif_linear l = {matrix(ctx, false, circuit_E), matrix(ctx, false, circuit_F), rough,
                          NULL};
  const steif_linear_output out = {NULL, last, x};
  steif_options o = steif_defaults();
  o.t1 = 0.5;
  CHECK(!steif_linear_run(ctx, &l, x0, 0, "radau:s=3", &o, NULL, 0, NULL, &out));
  CLOSE(x[0], 0.75 + sin(1.0), 1e-5);
  CLOSE(x[2], 3 + sqrt(0.5) - 2.5 * 2 * cos(1.0), 1e-5);
  SUNMatDestroy(l.E), SUNMatDestroy(l.F);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_demand[] = {
  {"only differentiated equations ask for derivatives", only_differentiated_equations_ask},
  {"hidden structure asks for all", hidden_structure_asks_for_all},
  {"runs go on", runs_go_on},
  CU_TEST_INFO_NULL};
