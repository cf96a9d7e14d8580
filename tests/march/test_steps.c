/* Given steps: equal ones and meshes, and the order of the solution at the end.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "smooth.h"
#include <sunmatrix/sunmatrix_dense.h>

static void equal_steps_are_lowered_to_fit(void)
{
  static const struct {
    double h;
    long steps;
  } rows[] = {{0.3, 6}, {0.25, 7}, {0.175, 10}, {1.75 / 3, 3}, {5, 1}, {1.75, 1}, {1.7499, 2}};
  steif_context *ctx = steif_context_new(NULL);
  for (int i = 0; i < 7; i++) {
    steif_options o = steif_defaults();
    o.h = rows[i].h;
    steif_solver *s = smooth_open(ctx, &smooth, "be", &o);
    CHECK(!steif_solve_to(s, 2));
    const steif_stats *n = steif_statistics(s);
    CHECK(n->steps == rows[i].steps);
    CLOSE(n->h_last, 1.75 / (double)rows[i].steps, 1e-15);
    CHECK(n->h_last <= rows[i].h * (1 + 1e-12));
    CHECK(steif_time(s) == 2);
    steif_solver_free(&s);
  }
  steif_context_free(&ctx);
}

/* 10^5 steps of 1.75e-5: accepted times are t1 less whole steps, not a sum of rounded ones. */
static void the_clock_does_not_drift(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_options o = steif_defaults();
  o.h = 1.75e-5;
  steif_solver *s = smooth_open(ctx, &smooth, "be", &o);
  for (long k = 1; k <= 100000; k++) {
    CHECK(!steif_solve_step(s));
    if (k % 7919 && k < 99990) continue;
    const double t = (double)(0.25L + k * (1.75L / 100000));
    CHECK(fabs(steif_time(s) - t) <= 4.5e-16);
  }
  CHECK(steif_time(s) == 2 && steif_statistics(s)->steps == 100000);
  CLOSE_FLOOR(smooth_error(2, steif_solution(s)), 0, 1e-5, 1);
  CHECK(steif_solve_step(s) == STEIF_BAD_INPUT);
  CHECK(strstr(steif_message(ctx), "at its end t1 = 2"));
  steif_solver_free(&s);
  steif_context_free(&ctx);
}

static void meshes_are_followed(void)
{
  static const double mesh[] = {0.25, 0.3, 0.31, 0.9, 1.4375, 1.44, 1.7};
  steif_context *ctx = steif_context_new(NULL);
  steif_options o = steif_defaults();
  o.mesh = mesh, o.mesh_size = 7, o.h = 0.5; /* the mesh comes first */
  steif_solver *s = smooth_open(ctx, &smooth, "radau:s=3", &o);
  for (int i = 1; i < 7; i++) {
    CHECK(!steif_solve_step(s));
    CHECK(steif_time(s) == mesh[i]);
    CLOSE(steif_statistics(s)->h_last, mesh[i] - mesh[i - 1], 1e-15);
  }
  CHECK(steif_solve_step(s) == STEIF_BAD_INPUT);
  CHECK(steif_solve_to(s, 1.9) == STEIF_BAD_INPUT); /* the mesh ends before t1 of the problem */
  CLOSE_FLOOR(smooth_error(1.7, steif_solution(s)), 0, 1e-4, 1);
  steif_solver_free(&s);
  steif_context_free(&ctx);
}

/* t1 = 0 stands for the problem's end, but the end of a mesh may be 0. */
static void a_mesh_may_end_at_zero(void)
{
  static const double mesh[] = {-1.3, -0.6, -0.1, 0};
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p = smooth;
  steif_options o = steif_defaults();
  p.t0 = -1.3, o.mesh = mesh, o.mesh_size = 4;
  steif_solver *s = smooth_open(ctx, &p, "radau:s=2", &o);
  CHECK(steif_solve_to(s, 0.1) == STEIF_BAD_INPUT);
  CHECK(!steif_solve_to(s, 0) && steif_time(s) == 0 && steif_statistics(s)->steps == 3);
  CHECK(steif_solve_step(s) == STEIF_BAD_INPUT);
  steif_solver_free(&s);
  steif_context_free(&ctx);
}

static void bad_meshes_are_refused(void)
{
  static const double late[] = {0.3, 0.5}, falling[] = {0.25, 0.5, 0.4},
                      twice[] = {0.25, 0.5, 0.5}, infinite[] = {0.25, INFINITY}, one[] = {0.25},
                      back[] = {0.25, 0.1};
  const struct {
    const double *mesh;
    size_t size;
    const char *words;
  } rows[] = {{one, 1, "at least 2 times, got 1"},     {one, 0, "at least 2 times, got 0"},
              {late, 2, "the mesh begins at 0.29999"}, {falling, 3, "number 2 is 0.4"},
              {twice, 3, "number 2 is 0.5 after 0.5"}, {back, 2, "number 1 is 0.1"},
              {infinite, 2, "number 1 is inf"}};
  for (int i = 0; i < 7; i++) {
    steif_options o = steif_defaults();
    o.mesh = rows[i].mesh, o.mesh_size = rows[i].size;
    smooth_refused(&smooth, "be", &o, STEIF_BAD_INPUT, rows[i].words);
  }
}

static void steps_below_the_clock_are_refused(void)
{
  static const double tiny[] = {1e-300, 1e-17};
  for (int i = 0; i < 2; i++) {
    steif_options o = steif_defaults();
    o.h = tiny[i];
    smooth_refused(&smooth, "be", &o, STEIF_BAD_INPUT, "than a clock can tell apart");
  }
}

static double end_error(steif_context *ctx, const char *method, double h)
{
  steif_options o = steif_defaults();
  o.h = h;
  steif_solver *s = smooth_open(ctx, &smooth, method, &o);
  CHECK(!steif_solve_to(s, 2));
  const double error = smooth_error(2, steif_solution(s));
  steif_solver_free(&s);
  return error;
}

/* Orders of the tables and formulas: Hairer, Norsett, Wanner I and Hairer, Wanner II. `error`
 * is what h = 1.75/32 (BDF: 1.75/64) reaches. */
static void fixed_steps_reach_their_order(void)
{
  static const struct {
    const char *method;
    double order, error;
  } rows[] = {{"be", 1, 2e-2},
              {"bdf:p=2,start=exact", 2, 2e-3},
              {"bdf:p=3,start=exact", 3, 2e-4},
              {"bdf:p=4,start=exact", 4, 3e-5},
              {"bdf:p=5,start=exact", 5, 1e-5},
              {"gauss:s=1", 2, 5e-4},
              {"gauss:s=2", 4, 2e-7},
              {"radau:s=2", 3, 1e-5},
              {"radau:s=3", 5, 1e-8},
              {"radau1a:s=2", 3, 1e-5},
              {"lobatto3c:s=3", 4, 1e-6},
              {"dirk:alexander2", 2, 5e-4},
              {"dirk:alexander3", 3, 5e-5},
              {"dirk:trbdf2", 2, 5e-4},
              {"dirk:hw43", 4, 1e-5},
              {"euler", 1, 2e-2},
              {"rk4", 4, 1e-6}};
  steif_context *ctx = steif_context_new(NULL);
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    const double n = rows[i].method[0] == 'b' ? 64 : 32;
    const double coarse = end_error(ctx, rows[i].method, 1.75 / n),
                 fine = end_error(ctx, rows[i].method, 1.75 / (2 * n));
    const int good = fabs(log2(coarse / fine) - rows[i].order) < 0.45 && coarse < rows[i].error;
    if (!good) printf("\n  %s: %.3g, order %.2f", rows[i].method, coarse, log2(coarse / fine));
    CHECK(good);
  }
  steif_context_free(&ctx);
}

static int unit(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  SM_ELEMENT_D(E, 0, 0) = SM_ELEMENT_D(E, 1, 1) = 1;
  return 0;
}

/* Without y' the way from y_0 to y_1, of size h, is no error of bdf: its first step is as long as
 * with y' within a factor, h ~ rtol^(1/2) and not rtol. */
static void first_steps_without_slopes(void)
{
  static const double rtol[] = {1e-4, 1e-8}, y0[] = {1 / 1.0625, 0.247403959254522930};
  steif_context *ctx = steif_context_new(NULL);
  for (int i = 0; i < 2; i++) {
    double first[2];
    for (int mass = 0; mass < 2; mass++) {
      steif_problem p = smooth;
      p.start = NULL, p.y0 = y0;
      if (mass) p.E = unit;
      steif_options o = steif_defaults();
      o.rtol = rtol[i], o.h0 = 0.1;
      steif_solver *s = smooth_open(ctx, &p, "bdf", &o);
      CHECK(!steif_solve_step(s));
      first[mass] = steif_time(s) - p.t0;
      CHECK(!steif_solve_to(s, 2));
      CLOSE_FLOOR(smooth_error(2, steif_solution(s)), 0, 5 * rtol[i], 1);
      steif_solver_free(&s);
    }
    CHECK(first[1] > first[0] / 2 && first[1] < 8 * first[0]);
  }
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_steps[] = {
  {"equal steps are lowered to fit", equal_steps_are_lowered_to_fit},
  {"the clock does not drift over 1e5 steps", the_clock_does_not_drift},
  {"meshes are followed", meshes_are_followed},
  {"a mesh may end at zero", a_mesh_may_end_at_zero},
  {"bad meshes are refused", bad_meshes_are_refused},
  {"steps below the clock are refused", steps_below_the_clock_are_refused},
  {"bdf without slopes starts with steps as long", first_steps_without_slopes},
  {"fixed steps reach their order", fixed_steps_reach_their_order},
  CU_TEST_INFO_NULL};
