/* test_kinetic.c: jumps of velocities and charges at an inconsistent start: by impulses of the constraints, with the
 * mass matrix as it is; refused where these do not determine them; and what a look at a good start costs.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "consistent/masses.h"
#include "repair.h"
#include "suite.h"
#include <nvector/nvector_serial.h>
#include <steif/solver.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

/* -- q' = v, M v' = -G^T lambda, 0 = G q: M (v+ - v-) = -G^T Lambda, G v+ = 0 --------------------- */

static const double M[4] = {2, 1.2, 1.2, 1}, G[2] = {1, 0.5};

static int pushed(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  const double *u = NV_DATA_S(y);
  (void)t, (void)user;
  for (int i = 0; i < 2; i++) NV_Ith_S(r, i) = u[2 + i], NV_Ith_S(r, 2 + i) = -G[i] * u[4];
  NV_Ith_S(r, 4) = G[0] * u[0] + G[1] * u[1];
  return 0;
}

static int masses(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  SM_ELEMENT_D(E, 0, 0) = SM_ELEMENT_D(E, 1, 1) = 1;
  for (int i = 0; i < 4; i++) SM_ELEMENT_D(E, 2 + i / 2, 2 + i % 2) = M[i];
  return 0;
}

static void velocities_jump_in_the_norm_of_the_whole_mass_matrix(void)
{
  static const double y0[] = {0.5, -1, 1, 0.4, 0};
  const double det = M[0] * M[3] - M[1] * M[2];
  const double push[2] = {(M[3] * G[0] - M[1] * G[1]) / det, (M[0] * G[1] - M[2] * G[0]) / det};
  const double Lambda = (G[0] * y0[2] + G[1] * y0[3]) / (G[0] * push[0] + G[1] * push[1]);
  const steif_problem p = {
    .name = "plate", .n = 5, .t1 = 1, .y0 = y0, .f = pushed, .E = masses};
  steif_context *ctx = steif_context_new(NULL);
  steif_options o = steif_defaults();
  o.rtol = 1e-8;
  steif_solver *s = steif_solver_new(ctx, &p, "radau:s=3", &o);
  CU_ASSERT_FATAL(s != NULL);
  const double *y = N_VGetArrayPointer(steif_solution(s));
  for (int i = 0; i < 2; i++) {
    CLOSE(y[i], y0[i], 1e-12);
    CLOSE(y[2 + i], y0[2 + i] - Lambda * push[i], 1e-7);
  }
  CHECK(fabs(G[0] * y[2] + G[1] * y[3]) < 1e-12);
  steif_solver_free(&s);
  steif_context_free(&ctx);
}

/* -- y1' = z y2, y2' = z, y1 + y2 = 1 from (0.2, 0.3): the impulse acts along (y2, 1) ----------------
 * At y(t-): 1.3 Z = 0.5. At y(t+): Z (1 + 0.3 + Z) = 0.5. */

static int bilinear(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  const double *u = NV_DATA_S(y);
  (void)t, (void)user;
  NV_Ith_S(r, 0) = u[2] * u[1];
  NV_Ith_S(r, 1) = u[2];
  NV_Ith_S(r, 2) = u[0] + u[1] - 1;
  return 0;
}

static void jumps_that_are_not_unique_are_refused_with_both(void)
{
  static const double y0[] = {0.2, 0.3, 0}, near[] = {0.7 + 1e-5, 0.3, 0};
  steif_problem p = {
    .name = "bilinear", .n = 3, .t1 = 1, .y0 = y0, .f = bilinear, .E = two_derivatives};
  steif_context *ctx = steif_context_new(NULL);
  steif_options o = steif_defaults();
  char left[32], right[32];
  snprintf(left, sizeof left, "%.5f", 0.7 - 0.5 / 1.3);
  snprintf(right, sizeof right, "%.5f", 0.7 - (sqrt(1.69 + 2) - 1.3) / 2);
  steif_solver *s = steif_solver_new(ctx, &p, "radau:s=3", &o);
  const char *text = steif_message(ctx);
  CHECK(!s && steif_status(ctx) == STEIF_BAD_INPUT);
  CHECK(strstr(text, "is not unique") && strstr(text, left) && strstr(text, right));
  if (s || !strstr(text, right)) printf("\n  %s (%s, %s)", text, left, right);
  steif_solver_free(&s);
  p.y0 = near; /* within the tolerance both are one */
  s = steif_solver_new(ctx, &p, "radau:s=3", &o);
  CHECK(s != NULL);
  steif_solver_free(&s);
  steif_context_free(&ctx);
}

/* -- what a consistent start of index 1 costs: the factors that show the index serve the check, too ----- */

static int chain(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  (void)t, (void)user;
  NV_Ith_S(r, 0) = -NV_Ith_S(y, 1);
  NV_Ith_S(r, 1) = NV_Ith_S(y, 1) - NV_Ith_S(y, 0) * NV_Ith_S(y, 0);
  return 0;
}

static int one(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  SM_ELEMENT_D(E, 0, 0) = 1;
  return 0;
}

static void a_good_start_takes_one_factorisation(void)
{
  static const double good[] = {2, 4}, bad[] = {2, 3};
  for (int k = 0; k < 2; k++) {
    const steif_problem p = {
      .name = "square", .n = 2, .t1 = 1, .y0 = k ? bad : good, .f = chain, .E = one};
    steif_context *ctx = steif_context_new(NULL);
    stf_repair r = {.ctx = ctx,
                    .pool = stf_pool_new(ctx),
                    .given = &p,
                    .policy = STEIF_REPAIR,
                    .rtol = 1e-6,
                    .atol = 1e-6};
    CHECK(stf_repair_start(&r) == STEIF_OK);
    CHECK(k ? r.factors > 1 && r.report.moved == 1 : r.factors == 1 && r.report.moved == 0);
    stf_pool_free(&r.pool);
    steif_context_free(&ctx);
  }
}

CU_TestInfo tests_of_kinetic[] = {
  {"velocities jump in the norm of the whole mass matrix",
   velocities_jump_in_the_norm_of_the_whole_mass_matrix},
  {"jumps that are not unique are refused with both",
   jumps_that_are_not_unique_are_refused_with_both},
  {"a good start takes one factorisation", a_good_start_takes_one_factorisation},
  CU_TEST_INFO_NULL};
