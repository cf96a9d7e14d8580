/* test_sympl.c: errors and orders of splitting methods on the pendulum. Figures: recomputation of the book chapter's experiments in extended precision
 * (mpmath), errors in the larger component.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"
#include <nvector/nvector_serial.h>
#include <steif/analysis.h>
#include <steif/data.h>
#include <steif/linear.h>
#include <steif/steif.h>
#include <string.h>

typedef struct row {
  const char *method;
  double error[5];
} row;

/* `floor`: rounding of the run. */
static void errors_are(const char *problem, double t1, double h, int count, const row *r,
                       size_t rows, double digits, double floor)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  CU_ASSERT_FATAL(steif_problem_find(ctx, problem, &p) == STEIF_OK);
  for (size_t i = 0; i < rows; i++) {
    steif_order_row got[5];
    steif_options o = steif_defaults();
    o.t1 = t1, o.newton = 1e-6;
    const int code = steif_order_measure(ctx, &p, r[i].method, &o, h, (size_t)count, got);
    if (code) printf("\n  %s: %s", r[i].method, steif_message(ctx));
    CHECK(code == STEIF_OK);
    for (int k = 0; !code && k < count; k++) {
      const double error = r[i].error[k];
      CLOSE(got[k].error, error, digits + floor / error);
    }
  }
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

static void errors_of_compositions_on_the_pendulum(void)
{
  static const row rows[] = {
    {"verlet", {7.77299389e-02, 1.93721346e-02, 4.83885020e-03, 1.20944554e-03}},
    {"yoshida4", {2.06649189e-02, 1.30062022e-03, 8.12729192e-05, 5.07877658e-06}},
    {"suzuki4", {3.30159575e-04, 2.11125498e-05, 1.32657301e-06, 8.30191724e-08}},
    {"pefrl", {9.37765402e-05, 5.80692778e-06, 3.62069279e-07, 2.26157507e-08}},
    {"blanesmoan6", {6.92191850e-06, 4.26853470e-07, 2.65909671e-08, 1.66058128e-09}},
    {"rkn6", {2.69508894e-06, 1.86794138e-07, 1.19601547e-08, 7.51966647e-10}},
    {"yoshida6", {2.76623838e-04, 4.49925331e-06, 7.09273433e-08, 1.11061940e-09}},
    {"kahanli6", {3.39237828e-05, 5.30279038e-07, 8.28473024e-09, 1.29443804e-10}},
    {"rkn11", {1.10677822e-08, 1.70702949e-10, 2.65844860e-12, 4.15035776e-14}},
    {"suzuki6", {6.29838452e-08, 9.11956631e-10, 1.39634892e-11, 2.17058688e-13}},
    {"suzuki8", {9.13663333e-08, 5.47311679e-10, 2.31861324e-12, 9.23248294e-15}},
    {"kahanli8", {4.31480830e-08, 1.76180342e-10, 6.95440619e-13, 2.72488127e-15}},
    {"gauss:s=2", {4.18501077e-04, 2.64235047e-05, 1.65577967e-06, 1.03554122e-07}},
    {"gauss:s=3", {8.85921696e-07, 1.42654827e-08, 2.24576029e-10, 3.51558e-12}},
    {"gauss:s=4", {4.29852529e-09, 1.72801390e-11, 6.7990e-14, 2.66e-16}},
  };
  errors_are("pendulum", 10, 0.5, 4, rows, sizeof rows / sizeof *rows, 4e-9, 1e-14);
}

/* 1.6: at t = 10 with 0.1, 0.05, 0.025, 0.0125. */
static void errors_of_simple_methods_on_the_pendulum(void)
{
  static const row rows[] = {
    {"symeuler", {2.1008643512e-03, 1.0627015613e-03, 5.2986627166e-04, 2.6400455107e-04}},
    {"verlet", {3.0965367101e-03, 7.7402454544e-04, 1.9349926255e-04, 4.8374385683e-05}},
    {"gauss:s=1", {4.9574815327e-03, 1.2399603018e-03, 3.1002675104e-04, 7.7508976943e-05}},
    {"rk4", {4.4575692708e-06, 2.8930852799e-07, 1.8406173620e-08, 1.1603547290e-09}},
  };
  errors_are("pendulum", 10, 0.1, 4, rows, 4, 1e-9, 2e-14);
}

/* The state after one step from (1, 0) with h = 0.1, by hand: kick first (0.995, -0.09975),
 * drift first (0.995, -0.1), Euler p-first (0.99, -0.1), q-first (1, -0.1). */
static void one_step_by_hand(void)
{
  static const struct {
    const char *method;
    double q, p;
  } rows[] = {{"verlet:first=kick,compensated=0", 0.995, -0.09975},
              {"verlet:first=kick,compensated=1", 0.995, -0.09975},
              {"verlet:first=drift", 0.995, -0.1},
              {"symeuler:first=p,compensated=1", 0.99, -0.1},
              {"symeuler:first=kick", 0.99, -0.1},
              {"symeuler:first=q", 1, -0.1}};
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  CU_ASSERT_FATAL(steif_problem_find(ctx, "harmonic", &p) == STEIF_OK);
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    steif_options o = steif_defaults();
    o.h = 0.1, o.t1 = 0.3;
    steif_solver *s = steif_solver_new(ctx, &p, rows[i].method, &o);
    CU_ASSERT_FATAL(s != NULL);
    CHECK(steif_solve_step(s) == STEIF_OK);
    CLOSE(NV_Ith_S(steif_solution(s), 0), rows[i].q, 3e-16);
    CLOSE(NV_Ith_S(steif_solution(s), 1), rows[i].p, 3e-16);
    steif_solver_free(&s);
  }
  steif_context_free(&ctx);
}

/* One force per step where the last serves the next; the start asks f itself, twice moved,
 * and kick. */
static void the_last_force_serves_the_next_step(void)
{
  static const struct {
    const char *method;
    long at_start, per_step;
  } rows[] = {{"verlet:first=kick", 4, 1},
              {"verlet:first=drift", 3, 1},
              {"rkn6", 4, 6},
              {"pefrl", 3, 4},
              {"kahanli8", 4, 17},
              {"symeuler", 3, 1}};
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  CU_ASSERT_FATAL(steif_problem_find(ctx, "kepler:e=0.3", &p) == STEIF_OK);
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    steif_options o = steif_defaults();
    o.h = 1.0 / 64, o.t1 = 1;
    steif_solver *s = steif_solver_new(ctx, &p, rows[i].method, &o);
    CU_ASSERT_FATAL(s != NULL);
    CHECK(steif_solve_to(s, 1) == STEIF_OK);
    CU_ASSERT_EQUAL(steif_statistics(s)->nfe, rows[i].at_start + 64 * rows[i].per_step);
    CU_ASSERT_EQUAL(steif_statistics(s)->nje, 0);
    steif_solver_free(&s);
  }
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* Between the steps the same method is used: the error there is that of the steps. */
static void between_steps_the_order_is_kept(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  CU_ASSERT_FATAL(steif_problem_find(ctx, "pendulum", &p) == STEIF_OK);
  steif_options o = steif_defaults();
  o.h = 0.25, o.t1 = 10;
  steif_solver *s = steif_solver_new(ctx, &p, "kahanli8", &o);
  N_Vector exact = N_VNew_Serial(2, steif_sundials(ctx));
  CU_ASSERT_FATAL(s && exact);
  for (double t = 0.37; t < 10; t += 0.83) {
    CHECK(steif_solve_to(s, t) == STEIF_OK);
    CHECK(p.exact(t, exact, NULL, p.user) == 0);
    for (int i = 0; i < 2; i++)
      CLOSE_FLOOR(NV_Ith_S(steif_solution(s), i), NV_Ith_S(exact, i), 3e-10, 1);
  }
  N_VDestroy(exact);
  steif_solver_free(&s);
  steif_context_free(&ctx);
}

/* Beyond h = 2 Verlet's step on the oscillator grows without bound: it is stopped when it
 * overflows. */
static void overflow_is_never_accepted(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  CU_ASSERT_FATAL(steif_problem_find(ctx, "harmonic", &p) == STEIF_OK);
  for (int i = 0; i < 3; i++) {
    static const char *const methods[] = {"verlet", "verlet:first=drift", "symeuler"};
    steif_options o = steif_defaults();
    o.h = 5, o.t1 = 5e3;
    steif_solver *s = steif_solver_new(ctx, &p, methods[i], &o);
    CU_ASSERT_FATAL(s != NULL);
    CHECK(steif_solve_to(s, 5e3) == STEIF_NOT_FINITE);
    CHECK(strstr(steif_message(ctx), "overflowed") != NULL);
    CHECK(isfinite(NV_Ith_S(steif_solution(s), 0)) && isfinite(NV_Ith_S(steif_solution(s), 1)));
    steif_solver_free(&s);
  }
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_sympl[] = {
  {"errors of compositions on the pendulum are those of extended precision",
   errors_of_compositions_on_the_pendulum},
  {"errors of simple methods on the pendulum are those of the chapter",
   errors_of_simple_methods_on_the_pendulum},
  {"one step is the one by hand", one_step_by_hand},
  {"the last force serves the next step", the_last_force_serves_the_next_step},
  {"between steps the order is kept", between_steps_the_order_is_kept},
  {"overflow is never accepted", overflow_is_never_accepted},
  CU_TEST_INFO_NULL};
