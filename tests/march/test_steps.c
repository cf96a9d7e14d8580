/* Given steps: equal ones and meshes, and the order of the solution at the end.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "smooth.h"
#include <sunmatrix/sunmatrix_dense.h>

/* The interval is [0.25, 2]. */
static void a_step_is_used_as_it_is(void)
{
  static const struct {
    double h;
    long steps;
    double last;
  } rows[] = {{0.3, 6, 0.25},          {0.25, 7, 0.25},     {0.175, 10, 0.175},
              {1.75 / 3, 3, 1.75 / 3}, {1.7499, 2, 0.0001}, {1.75, 1, 1.75}};
  steif_context *ctx = steif_context_new(NULL);
  for (int i = 0; i < 6; i++) {
    steif_options o = steif_defaults();
    o.h = rows[i].h;
    steif_solver *s = smooth_open(ctx, &smooth, "radau:s=2", &o);
    for (long k = 1; k < rows[i].steps; k++) {
      CHECK(!steif_solve_step(s) && steif_statistics(s)->h_last == rows[i].h);
      CLOSE(steif_time(s), 0.25 + (double)k * rows[i].h, 1e-15);
    }
    CHECK(!steif_solve_step(s) && steif_time(s) == 2);
    CLOSE(steif_statistics(s)->h_last, rows[i].last, 1e-11);
    CHECK(steif_solve_step(s) == STEIF_BAD_INPUT);
    steif_solver_free(&s);
  }
  steif_context_free(&ctx);
}

static void any_step_is_used_as_it_is(void)
{
  steif_context *ctx = steif_context_new(NULL);
  unsigned bits = 7;
  for (int i = 0; i < 100; i++) {
    bits =
      1664525 * bits + 1013904223; /* D. E. Knuth, The Art of Computer Programming 2, 3.3.4 */
    const double h = 0.002 + 1.7 * pow(bits / 4294967296.0, 3);
    steif_options o = steif_defaults();
    o.h = h;
    steif_solver *s = smooth_open(ctx, &smooth, "rk4", &o);
    const long whole = (long)floor(1.75 / h);
    long made = 0;
    for (; steif_time(s) < 2; made++) {
      CHECK(!steif_solve_step(s));
      if (made < whole) CHECK(steif_statistics(s)->h_last == h);
    }
    CHECK(made == whole + (1.75 - (double)whole * h > 2e-15) && steif_time(s) == 2);
    steif_solver_free(&s);
  }
  steif_context_free(&ctx);
}

/* A multistep method steps across the end and has its own order there; a run to the next point of its
 * grid, where nothing is interpolated, has the same error within the variation of the solution. */
static void multistep_methods_step_across_the_end(void)
{
  static const struct {
    const char *method;
    double order;
  } rows[] = {
    {"be", 1}, {"bdf:p=2,start=exact", 2}, {"bdf:p=4,start=exact", 4}, {"glm:irks,p=3", 3}};
  steif_context *ctx = steif_context_new(NULL);
  for (int i = 0; i < 4; i++) {
    double error[2];
    for (int k = 0; k < 2; k++) {
      steif_options o = steif_defaults();
      o.h = ldexp(1.75 / 30.4, -k); /* 31 steps of which the last is used to 0.4; 61 and 0.8 */
      steif_solver *s = smooth_open(ctx, &smooth, rows[i].method, &o);
      CHECK(!steif_solve_to(s, 2) && steif_time(s) == 2);
      CHECK(steif_statistics(s)->steps == (k ? 61 : 31) && steif_statistics(s)->h_last == o.h);
      CHECK(steif_solve_step(s) == STEIF_BAD_INPUT);
      CHECK(!steif_solve_to(s, 2));
      error[k] = smooth_error(2, steif_solution(s));
      CHECK(!steif_solve_to(s, 2 - 0.2 * o.h));
      CHECK(smooth_error(2 - 0.2 * o.h, steif_solution(s)) < 2 * error[k]);
      steif_solver_free(&s);
    }
    const int good = fabs(log2(error[0] / error[1]) - rows[i].order) < 0.5;
    if (!good) printf("\n  %s: order %.2f", rows[i].method, log2(error[0] / error[1]));
    CHECK(good);
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

static void steps_that_cannot_fit_are_rejected(void)
{
  static const struct {
    double h;
    const char *words;
  } rows[] = {{1e-300, "take a larger h"},
              {1e-17, "take a larger h"},
              {1.7e-9, "steps of the interval of length 1.75, more than 1000000000"},
              {1.76, "no step of h = 1.76 fits between t = 0.25 and 2: take h = 1.75 or less"},
              {-0.1, "h = -0.1"}};
  for (int i = 0; i < 5; i++) {
    steif_options o = steif_defaults();
    o.h = rows[i].h;
    smooth_refused(&smooth, "be", &o, STEIF_BAD_INPUT, rows[i].words);
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
  {"a step is used as it is", a_step_is_used_as_it_is},
  {"any step is used as it is", any_step_is_used_as_it_is},
  {"multistep methods step across the end", multistep_methods_step_across_the_end},
  {"the clock does not drift over 1e5 steps", the_clock_does_not_drift},
  {"meshes are followed", meshes_are_followed},
  {"a mesh may end at zero", a_mesh_may_end_at_zero},
  {"bad meshes are refused", bad_meshes_are_refused},
  {"steps that cannot fit are rejected", steps_that_cannot_fit_are_rejected},
  {"bdf without slopes starts with steps as long", first_steps_without_slopes},
  {"fixed steps reach their order", fixed_steps_reach_their_order},
  CU_TEST_INFO_NULL};
