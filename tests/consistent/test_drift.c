/* test_drift.c: what index does to the errors of equal steps, and what a consistent point at the end gives
 * back: E. Hairer, C. Lubich, M. Roche, The Numerical Solution of Differential-Algebraic Systems by
 * Runge-Kutta Methods, Springer 1989.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"
#include <nvector/nvector_serial.h>
#include <stdbool.h>
#include <steif/analysis.h>
#include <steif/data.h>
#include <steif/linear.h>
#include <steif/steif.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

enum { N = 5 };
static const double end = 20;

static void run(const char *problem, const char *method, const steif_options *o, double *y)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  CU_ASSERT_FATAL(!steif_problem_find(ctx, problem, &p));
  steif_solver *s = steif_solver_new(ctx, &p, method, o);
  CHECK(s && !steif_solve_to(s, end));
  memcpy(y, N_VGetArrayPointer(steif_solution(s)), N * sizeof *y);
  steif_solver_free(&s);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* Errors of positions, velocities and the multiplier. */
static void errors(const double *y, const double *exact, double *error)
{
  error[0] = hypot(y[0] - exact[0], y[1] - exact[1]);
  error[1] = hypot(y[2] - exact[2], y[3] - exact[3]);
  error[2] = fabs(y[4] - exact[4]);
}

/* The consistent point next to y at index 3. */
static void settle(double *y)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  steif_start start;
  CU_ASSERT_FATAL(!steif_problem_find(ctx, "pendulum3", &p));
  const steif_point at = {.y = y, .t = end};
  CHECK(!steif_consistent(ctx, &p, &at, NULL, &start));
  memcpy(y, start.y, N * sizeof *y);
  steif_start_clear(&start);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* Radau IIA with three stages: 2s - 1, s, s - 2 at index 3; 2s - 1, 2s - 1, s at index 2. Velocities of
 * index 3 lie between s and s + 1 at these steps. The multiplier of a consistent point is a function of
 * positions and velocities, and as good as they are projected. */
static void orders_fall_with_the_index(void)
{
  static const struct {
    const char *problem;
    bool settled;
    double order[3];
  } rows[] = {{"pendulum3:index=3", false, {5, 3.3, 2}},
              {"pendulum3:index=2", false, {5, 5, 3}},
              {"pendulum3:index=1", false, {5, 5, 5}},
              {"pendulum3:index=3", true, {5, 5, 5}}};
  double exact[N];
  run("pendulum3:index=1", "radau:s=7", &(steif_options){.rtol = 1e-13, .t1 = end}, exact);
  settle(exact);
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    double error[2][3];
    for (int k = 0; k < 2; k++) {
      double y[N];
      run(rows[i].problem, "radau:s=3", &(steif_options){.h = k ? 0.025 : 0.05, .t1 = end}, y);
      if (rows[i].settled) settle(y);
      errors(y, exact, error[k]);
    }
    for (int part = 0; part < 3; part++) {
      const double order = log2(error[0][part] / error[1][part]);
      CLOSE_FLOOR(order, rows[i].order[part], 0.4, 1);
    }
  }
}

/* The same by the solver itself: what it says it has corrected is the error that there was. */
static void multipliers_are_recomputed(void)
{
  double exact[N], error[2];
  run("pendulum3:index=1", "radau:s=7", &(steif_options){.rtol = 1e-13, .t1 = end}, exact);
  settle(exact);
  for (int k = 0; k < 2; k++) {
    steif_context *ctx = steif_context_new(NULL);
    steif_problem p;
    CU_ASSERT_FATAL(!steif_problem_find(ctx, "pendulum3", &p));
    const steif_options o = {.h = k ? 0.025 : 0.05, .rtol = 1e-6, .atol = 1e-6, .t1 = end};
    steif_solver *s = steif_solver_new(ctx, &p, "radau:s=3", &o);
    CU_ASSERT_FATAL(s && !steif_solve_to(s, end));
    N_Vector y = steif_solution(s);
    const double before = fabs(NV_Ith_S(y, 4) - exact[4]), lambda = NV_Ith_S(y, 4);
    double drift, corrected;
    CHECK(steif_recompute(s, y, &drift, &corrected) == STEIF_OK);
    error[k] = fabs(NV_Ith_S(y, 4) - exact[4]);
    CHECK(error[k] < before / 10);
    CLOSE(corrected, fabs(NV_Ith_S(y, 4) - lambda) / (1e-6 * fabs(lambda) + 1e-6), 1e-6);
    CHECK(drift < corrected);
    CHECK(steif_recompute(s, NULL, NULL, NULL) == STEIF_BAD_INPUT);
    steif_solver_free(&s);
    steif_problem_clear(ctx, &p);
    steif_context_free(&ctx);
  }
  CLOSE_FLOOR(log2(error[0] / error[1]), 5, 0.4, 1);
  CHECK(steif_recompute(NULL, NULL, NULL, NULL) == STEIF_BAD_INPUT);
}

/* And by runs that are asked to, adaptive ones: multipliers are as good as positions, whose error the tolerance
 * bounds; what was corrected is told. */
static void runs_show_multipliers_recomputed(void)
{
  double exact[N];
  run("pendulum3:index=1", "radau:s=7", &(steif_options){.rtol = 1e-13, .t1 = end}, exact);
  settle(exact);
  for (int k = 0; k < 3; k++) {
    const double rtol = k == 0 ? 1e-4 : k == 1 ? 1e-6 : 1e-8;
    double error[2], drift, corrected = 0;
    for (int recompute = 0; recompute < 2; recompute++) {
      steif_context *ctx = steif_context_new(NULL);
      steif_problem p;
      CU_ASSERT_FATAL(!steif_problem_find(ctx, "pendulum3", &p));
      const steif_options o = {.rtol = rtol, .t1 = end, .recompute = recompute};
      steif_solver *s = steif_solver_new(ctx, &p, "radau:s=3", &o);
      CU_ASSERT_FATAL(s && !steif_solve_to(s, end));
      const double *y = N_VGetArrayPointer(steif_solution(s));
      error[recompute] = fabs(y[4] - exact[4]);
      CHECK(steif_recomputed(s, &drift, &corrected) == STEIF_OK);
      CHECK(recompute ? drift < 10 && corrected > 0 : isnan(drift) && isnan(corrected));
      steif_solver_free(&s);
      steif_problem_clear(ctx, &p);
      steif_context_free(&ctx);
    }
    CHECK(error[1] < 10 * rtol * fabs(exact[4]));
    CHECK(error[1] < error[0]);
  }
  CHECK(steif_recomputed(NULL, NULL, NULL) == STEIF_BAD_INPUT);
  CHECK(steif_output(NULL, 0, NULL) == STEIF_BAD_INPUT);
}

/* A bead on x = cos(angle): constraints that are no polynomials. g = x - cos(angle), and g'' = 0 gives the
 * multiplier of any angle and speed, (w^2 cos - 2 sin^2) / (1 + sin^2). */
static int bead(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  const sunrealtype *a = N_VGetArrayPointer(y), s = sin(a[0]);
  sunrealtype *f = N_VGetArrayPointer(r);
  (void)t, (void)user;
  f[0] = a[2], f[1] = a[3];
  f[2] = -2 * s - s * a[4], f[3] = -a[4];
  f[4] = a[1] - cos(a[0]);
  return 0;
}

static int four(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  for (int i = 0; i < 4; i++) SM_ELEMENT_D(E, i, i) = 1;
  return 0;
}

static void multipliers_of_curved_constraints_are_recomputed(void)
{
  static const double y0[] = {0.5, 0.87758256189037276, 2, -0.95885107720840601,
                              0}; /* cos, -2 sin */
  static const int index[] = {1, 1, 2, 2, 3};
  const steif_problem p = {.name = "bead",
                           .n = N,
                           .t1 = 1,
                           .y0 = y0,
                           .f = bead,
                           .E = four,
                           .index = index,
                           .dae_index = 3};
  for (int k = 0; k < 2; k++) {
    steif_context *ctx = steif_context_new(NULL);
    const double rtol = k ? 1e-8 : 1e-5;
    const steif_options o = {.rtol = rtol, .atol = rtol, .recompute = 1};
    steif_solver *s = steif_solver_new(ctx, &p, "radau:s=3", &o);
    for (int i = 1; i <= 8; i++) {
      CU_ASSERT_FATAL(s && !steif_solve_to(s, i / 8.0));
      const double *y = N_VGetArrayPointer(steif_solution(s)), c = cos(y[0]), q = 1 - c * c;
      double drift, corrected;
      CHECK(!steif_recomputed(s, &drift, &corrected) && drift < 10);
      CLOSE_FLOOR(y[4], (y[2] * y[2] * c - 2 * q) / (1 + q), 1e-8, 1);
    }
    steif_solver_free(&s);
    steif_context_free(&ctx);
  }
}

/* One step of backward Euler of 1e-6 and 1e-8 seconds, index 3: rounding in the accelerations and
 * multipliers is of the size 1e-16 / h^2, which the weights of the index leave out; two corrections do. */
static void tiny_steps_at_index_three_converge(void)
{
  static const double h[] = {1e-6, 1e-8};
  for (int k = 0; k < 2; k++) {
    steif_context *ctx = steif_context_new(NULL);
    steif_problem p;
    CU_ASSERT_FATAL(!steif_problem_find(ctx, "andrews", &p));
    const steif_options o = {.h = h[k], .t1 = h[k]};
    steif_solver *s = steif_solver_new(ctx, &p, "be", &o);
    CHECK(s && !steif_solve_to(s, h[k]));
    CHECK(steif_statistics(s)->newton <=
          3); /* the last one sees that the one before was enough */
    const double *y = N_VGetArrayPointer(steif_solution(s));
    double moved = 0;
    for (int j = 7; j < 14; j++) moved = fmax(moved, fabs(y[j] - p.y0[j]));
    CHECK(moved > 0 && moved < 2e4 * h[k]); /* velocities, by accelerations of 14222 at most */
    steif_solver_free(&s);
    p.index = NULL; /* in plain weights that rounding never falls below a tolerance */
    s = steif_solver_new(ctx, &p, "be", &o);
    const int plain = s ? steif_solve_to(s, h[k]) : steif_status(ctx);
    CHECK(plain == STEIF_NO_CONVERGENCE);
    steif_solver_free(&s);
    steif_problem_clear(ctx, &p);
    steif_context_free(&ctx);
  }
}

/* The slopes at the start of the amplifier: closed, from its resistances and capacities. The values that go
 * round with it, 51.338775, -24.9757667, -10.00564453, are off by 1e-5 to 5e-4. */
static void the_amplifier_has_its_slopes(void)
{
  static const double slope[] = {
    51.3392765171807206,  51.3392765171807206,  -166.666666666666667, -24.9703285154063289,
    -24.9703285154063289, -83.3333333333333333, -10.0002764024563387, -10.0002764024563387};
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  steif_start start;
  CU_ASSERT_FATAL(!steif_problem_find(ctx, "transamp", &p));
  CHECK(!steif_consistent(ctx, &p, NULL, NULL, &start));
  for (int j = 0; j < 8; j++) CLOSE(start.yp[j], slope[j], 1e-9);
  steif_start_clear(&start);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_drift[] = {
  {"orders fall with the index", orders_fall_with_the_index},
  {"multipliers are recomputed", multipliers_are_recomputed},
  {"runs show multipliers recomputed", runs_show_multipliers_recomputed},
  {"multipliers of curved constraints are recomputed",
   multipliers_of_curved_constraints_are_recomputed},
  {"tiny steps at index three converge", tiny_steps_at_index_three_converge},
  {"the amplifier has its slopes", the_amplifier_has_its_slopes},
  CU_TEST_INFO_NULL};
