/* test_higher.c: starts of index 2 and 3 whose components without a derivative are off, and what it costs to see that
 * a start is consistent and which index it has.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "consistent/masses.h"
#include "repair.h"
#include "suite.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <steif/solver.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

static long calls; /* of f */

/* -- a pendulum by its constraint on velocities, or on positions, beside w' = z, 0 = z^2 - w ---- */

enum { N = 7, G = 10 };

static int beside_f(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  const sunrealtype *u = N_VGetArrayPointer(y);
  const int index = *(const int *)user;
  (void)t;
  calls++;
  NV_Ith_S(r, 0) = u[2];
  NV_Ith_S(r, 1) = u[3];
  NV_Ith_S(r, 2) = -u[4] * u[0];
  NV_Ith_S(r, 3) = -u[4] * u[1] - G;
  NV_Ith_S(r, 4) = index == 2 ? u[0] * u[2] + u[1] * u[3] : u[0] * u[0] + u[1] * u[1] - 1;
  NV_Ith_S(r, 5) = u[6];
  NV_Ith_S(r, 6) = u[6] * u[6] - u[5];
  return 0;
}

static int beside_mass(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  for (int i = 0; i < N; i++)
    if (i != 4 && i != 6) SM_ELEMENT_D(E, i, i) = 1;
  return 0;
}

static steif_problem beside(const sunrealtype *y0, int *index, const int *declared)
{
  return (steif_problem){.name = "beside",
                         .n = N,
                         .t1 = 0.5,
                         .y0 = y0,
                         .f = beside_f,
                         .E = beside_mass,
                         .index = declared,
                         .user = index};
}

/* w = (1 + t/2)^2 and z = 1 + t/2, whatever z is guessed. */
static void algebraic_parts_of_index_one_are_repaired(void)
{
  static const char *const methods[] = {"auto", "radau:s=3", "bdf"};
  static const sunrealtype guesses[] = {0.99, 1.1, 2};
  static const int numbers[2][N] = {{1, 1, 1, 1, 2, 1, 1}, {1, 1, 2, 2, 3, 1, 1}};
  steif_context *ctx = steif_context_new(NULL);
  for (int k = 0; k < 3 * 3 * 2 * 2; k++) {
    int index = 2 + k / 9 % 2;
    const sunrealtype y0[N] = {1, 0, 0, 0, 0, 1, guesses[k % 3]}, rtol = 1e-6;
    const steif_problem p = beside(y0, &index, k / 18 ? numbers[index - 2] : NULL);
    steif_options o = steif_defaults();
    o.rtol = o.atol = rtol;
    steif_solver *s = steif_solver_new(ctx, &p, methods[k / 3 % 3], &o);
    CU_ASSERT_FATAL(s != NULL);
    CHECK(steif_initial_used(s)->moved == 1);
    CHECK(strstr(steif_initial_used(s)->message, "moved y7 by") != NULL);
    CHECK(strstr(steif_initial_used(s)->message, "to fulfil e7") != NULL);
    CHECK(steif_solve_to(s, 0.5) == STEIF_OK);
    CLOSE(NV_Ith_S(steif_solution(s), 5), 1.5625, 10 * rtol);
    CLOSE(NV_Ith_S(steif_solution(s), 6), 1.25, 10 * rtol);
    steif_solver_free(&s);
  }
  steif_context_free(&ctx);
}

/* -- Hessenberg form of index 2 (Hairer and Wanner II, VII): (e^t, e^-2t, e^2t) ----------------------- */

static int hessenberg_f(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  const sunrealtype *u = N_VGetArrayPointer(y);
  (void)t, (void)user;
  NV_Ith_S(r, 0) = u[0] * u[1] * u[1] * u[2] * u[2];
  NV_Ith_S(r, 1) = u[0] * u[0] * u[1] * u[1] - 3 * u[1] * u[1] * u[2];
  NV_Ith_S(r, 2) = u[0] * u[0] * u[1] - 1;
  return 0;
}

/* The hidden constraint 2 z^2 - 3 z + 1 = 0 at t = 0 has the roots 1 and 1/2: guesses nearer to 1. */
static void multipliers_that_are_not_linear_are_repaired(void)
{
  static const char *const methods[] = {"auto", "radau:s=3", "bdf"};
  static const sunrealtype guesses[] = {0.99, 0.9, 2, 10};
  static const int numbers[] = {1, 1, 2};
  const sunrealtype e = exp(1), rtol = 1e-6;
  steif_context *ctx = steif_context_new(NULL);
  for (int k = 0; k < 4 * 3 * 2; k++) {
    const sunrealtype y0[] = {1, 1, guesses[k % 4]};
    const steif_problem p = {.name = "hessenberg",
                             .n = 3,
                             .t1 = 1,
                             .y0 = y0,
                             .f = hessenberg_f,
                             .E = two_derivatives,
                             .index = k / 12 ? numbers : NULL};
    steif_options o = steif_defaults();
    o.rtol = o.atol = rtol;
    steif_solver *s = steif_solver_new(ctx, &p, methods[k / 4 % 3], &o);
    CU_ASSERT_FATAL(s != NULL);
    CHECK(strstr(steif_initial_used(s)->message, "moved y3 by") != NULL);
    CHECK(steif_solve_to(s, 1) == STEIF_OK);
    CLOSE(NV_Ith_S(steif_solution(s), 0), e, 10 * rtol * e);
    CLOSE(NV_Ith_S(steif_solution(s), 1), 1 / (e * e), 10 * rtol);
    CLOSE(NV_Ith_S(steif_solution(s), 2), e * e, 10 * rtol * e * e);
    steif_solver_free(&s);
  }
  steif_context_free(&ctx);
}

/* -- costs ------------------------------------------------------------------------------------ */

static long calls_at_opening(steif_context *ctx, const steif_problem *p,
                             enum steif_initial initial)
{
  steif_options o = steif_defaults();
  o.rtol = o.atol = 1e-6, o.initial = initial;
  calls = 0;
  steif_solver *s = steif_solver_new(ctx, p, "radau:s=3", &o);
  CHECK(s && steif_initial_used(s)->moved == 0);
  steif_solver_free(&s);
  return calls;
}

static void a_good_start_takes_two_evaluations_and_one_factorisation(void)
{
  static const int numbers[2][N] = {{1, 1, 1, 1, 2, 1, 1}, {1, 1, 2, 2, 3, 1, 1}};
  static const sunrealtype y0[N] = {1, 0, 0, 0, 0, 1, 1};
  for (int index = 2; index <= 3; index++) {
    steif_context *ctx = steif_context_new(NULL);
    const steif_problem p = beside(y0, &index, numbers[index - 2]);
    const long given = calls_at_opening(ctx, &p, STEIF_AS_GIVEN);
    CHECK(calls_at_opening(ctx, &p, STEIF_REPAIR) <= given + 2);
    stf_repair r = {.ctx = ctx,
                    .pool = stf_pool_new(ctx),
                    .given = &p,
                    .policy = STEIF_REPAIR,
                    .rtol = 1e-6,
                    .atol = 1e-6};
    CHECK(stf_repair_start(&r) == STEIF_OK);
    CHECK(r.factors == 1 && r.report.moved == 0);
    stf_pool_free(&r.pool);
    steif_context_free(&ctx);
  }
}

/* Seven Jacobians by differences of order 4, each checked by a shorter one: 8 calls a column. */
static void the_index_is_found_by_few_evaluations(void)
{
  static const sunrealtype y0[N] = {1, 0, 0, 0, 0, 1, 1};
  for (int index = 2; index <= 3; index++) {
    steif_context *ctx = steif_context_new(NULL);
    const steif_problem p = beside(y0, &index, NULL);
    CHECK(calls_at_opening(ctx, &p, STEIF_REPAIR) <= 8 * 8 * N);
    steif_context_free(&ctx);
  }
}

CU_TestInfo tests_of_higher[] = {
  {"algebraic parts of index 1 are repaired", algebraic_parts_of_index_one_are_repaired},
  {"multipliers that are not linear are repaired",
   multipliers_that_are_not_linear_are_repaired},
  {"a good start takes two evaluations and one factorisation",
   a_good_start_takes_two_evaluations_and_one_factorisation},
  {"the index is found by few evaluations", the_index_is_found_by_few_evaluations},
  CU_TEST_INFO_NULL};
