/* Dense output and stages.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "smooth.h"
#include <sunmatrix/sunmatrix_dense.h>

/* Largest error inside all steps of length h, but those of a starting procedure. */
static double inside_error(steif_context *ctx, const char *method, double h)
{
  static const double inside[] = {0.27, 0.5, 0.81};
  steif_options o = steif_defaults();
  o.h = h;
  steif_solver *s = smooth_open(ctx, &smooth, method, &o);
  N_Vector y = N_VClone(steif_solution(s));
  double worst = 0;
  while (steif_time(s) < 2 - h / 2) {
    CHECK(!steif_solve_step(s));
    for (int i = 0; i < 3; i++) {
      const double t = steif_time(s) - inside[i] * steif_statistics(s)->h_last;
      if (t < 0.6) continue;
      CHECK(!steif_dense(s, t, y));
      worst = fmax(worst, smooth_error(t, y));
    }
  }
  N_VDestroy(y);
  steif_solver_free(&s);
  return worst;
}

/* The lower of the order at the end and that of the interpolation: degree s + 1 of collocation,
 * p + 1 of BDF, 2 (linear), 3 (with the slope at the end) or 4 (with both slopes) of DIRK, 4
 * (Hermite) of explicit methods. */
static void dense_output_has_its_order(void)
{
  static const struct {
    const char *method;
    double order;
  } rows[] = {{"be", 1},
              {"bdf:p=2,start=exact", 2},
              {"bdf:p=3,start=exact", 3},
              {"bdf:p=4,start=exact", 4},
              {"bdf:p=5,start=exact", 5},
              {"gauss:s=1", 2},
              {"gauss:s=2", 3},
              {"gauss:s=3", 4},
              {"radau:s=1", 1},
              {"radau:s=2", 3},
              {"radau:s=3", 4},
              {"radau1a:s=2", 3},
              {"radau1a:s=3", 4},
              {"lobatto3c:s=2", 2},
              {"lobatto3c:s=3", 4},
              {"dirk:cranknicolson", 2},
              {"dirk:crouzeix23", 2},
              {"dirk:alexander2", 2},
              {"dirk:alexander3", 3},
              {"dirk:trbdf2", 2},
              {"dirk:hw43", 3},
              {"dirk:esdirk43", 4},
              {"rodas4", 4},
              {"rodas5p", 4},
              {"euler", 1},
              {"rk4", 4}};
  steif_context *ctx = steif_context_new(NULL);
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    const double coarse = inside_error(ctx, rows[i].method, 1.75 / 40),
                 fine = inside_error(ctx, rows[i].method, 1.75 / 80);
    const int good = fabs(log2(coarse / fine) - rows[i].order) < 0.4;
    if (!good) printf("\n  %s: %.3g, order %.2f", rows[i].method, coarse, log2(coarse / fine));
    CHECK(good);
  }
  steif_context_free(&ctx);
}

static void dense_output_meets_both_ends(void)
{
  static const char *const methods[] = {
    "radau:s=3",       "gauss:s=2", "lobatto3c:s=3", "bdf:p=4", "dirk:hw43",
    "dirk:crouzeix23", "rk4",       "dirk:trbdf2",   "rodas4",  "rodas5p",
    "dopri87",         "exprb32",   "exprb43"};
  steif_context *ctx = steif_context_new(NULL);
  for (int m = 0; m < 13; m++)
    for (int chosen = 0; chosen < 2; chosen++) {
      steif_method_info info;
      steif_options o = steif_defaults();
      CHECK(!steif_method_find(ctx, methods[m], &info));
      if (chosen && !info.adaptive) continue;
      o.h = chosen ? 0 : 0.031;
      steif_solver *s = smooth_open(ctx, &smooth, methods[m], &o);
      N_Vector y = N_VClone(steif_solution(s)), before = N_VClone(y);
      for (int k = 0; k < 9; k++) {
        N_VScale(1, steif_solution(s), before);
        const double t = steif_time(s);
        CHECK(!steif_solve_step(s));
        CHECK(!steif_dense(s, t, y));
        for (int i = 0; i < 2; i++) CLOSE(NV_Ith_S(y, i), NV_Ith_S(before, i), 1e-13);
        CHECK(!steif_dense(s, steif_time(s), y));
        for (int i = 0; i < 2; i++)
          CLOSE(NV_Ith_S(y, i), NV_Ith_S(steif_solution(s), i), 1e-13);
      }
      N_VDestroy(y), N_VDestroy(before);
      steif_solver_free(&s);
    }
  steif_context_free(&ctx);
}

/* y' = k y, k = 3 up to an event at 1.3 and -2 from there on. Long steps of methods that evaluate f for dense output,
 * which has changed when they are asked. */
static double growth;

static int grows(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  (void)t, (void)user;
  N_VScale(growth, y, ydot);
  return 0;
}

static int passes(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  (void)y, (void)user;
  g[0] = t - 1.3;
  return 0;
}

static int turns(sunrealtype t, N_Vector y, const int *fired, void *user)
{
  (void)t, (void)y, (void)fired, (void)user;
  growth = -2;
  return STEIF_RESTART;
}

static void times_before_an_event_are_as_they_were(void)
{
  static const char *const methods[] = {"dopri87", "exprb32", "exprb43", "radau:s=3",
                                        "bdf",     "cvode",   "arkode"};
  static const sunrealtype one = 1;
  steif_context *ctx = steif_context_new(NULL);
  for (int m = 0; m < 7; m++) {
    const steif_problem p = {.name = "turning",
                             .n = 1,
                             .t1 = 2,
                             .y0 = &one,
                             .f = grows,
                             .events = 1,
                             .event = passes,
                             .handle_event = turns};
    steif_options o = steif_defaults();
    o.rtol = 1e-7;
    growth = 3;
    steif_solver *s = steif_solver_new(ctx, &p, methods[m], &o);
    CU_ASSERT_PTR_NOT_NULL_FATAL(s);
    for (int k = 1; k <= 20; k++) {
      const double t = 0.1 * k, exact = t < 1.3 ? exp(3 * t) : exp(3.9 - 2 * (t - 1.3));
      CHECK(!steif_solve_to(s, t));
      CLOSE(NV_Ith_S(steif_solution(s), 0), exact, 5e-5);
    }
    steif_solver_free(&s);
  }
  steif_context_free(&ctx);
}

static void times_between_steps_are_dense_output(void)
{
  static const char *const methods[] = {"radau:s=3", "bdf:p=4", "dirk:trbdf2", "cvode"};
  steif_context *ctx = steif_context_new(NULL);
  for (int m = 0; m < 4; m++) {
    steif_solver *s = smooth_open(ctx, &smooth, methods[m], NULL);
    N_Vector y = N_VClone(steif_solution(s));
    for (int k = 1; k < 9; k++) {
      const double t = 0.25 + 0.19 * k;
      CHECK(!steif_solve_to(s, t) && steif_time(s) == t);
      CHECK(!steif_dense(s, t, y));
      for (int i = 0; i < 2; i++) CHECK(NV_Ith_S(y, i) == NV_Ith_S(steif_solution(s), i));
      CLOSE_FLOOR(smooth_error(t, y), 0, 1e-4, 1);
    }
    N_VDestroy(y);
    steif_solver_free(&s);
  }
  steif_context_free(&ctx);
}

/* Of the Hessenberg form y1' = y1 y2^2 z^2, y2' = y1^2 y2^2 - 3 y2^2 z with the constraint
 * y1^2 y2 = 1 (index 2) or its derivative 2 y2 z^2 - 3 z + y1^2 = 0 (index 1):
 * y = (e^t, e^-2t), z = e^2t. */
static int hessenberg(sunrealtype t, N_Vector v, N_Vector out, void *user)
{
  const double a = NV_Ith_S(v, 0), b = NV_Ith_S(v, 1), z = NV_Ith_S(v, 2);
  (void)t;
  NV_Ith_S(out, 0) = a * b * b * z * z, NV_Ith_S(out, 1) = a * a * b * b - 3 * b * b * z;
  NV_Ith_S(out, 2) = *(int *)user == 2 ? a * a * b - 1 : 2 * b * z * z - 3 * z + a * a;
  return 0;
}

static int mass(sunrealtype t, N_Vector v, N_Vector vp, SUNMatrix E, void *user)
{
  (void)t, (void)v, (void)vp, (void)user;
  SM_ELEMENT_D(E, 0, 0) = SM_ELEMENT_D(E, 1, 1) = 1;
  return 0;
}

static int exponentials(sunrealtype t, N_Vector v, N_Vector vp, void *user)
{
  (void)user;
  const double rate[] = {1, -2, 2};
  for (int i = 0; i < 3; i++) {
    NV_Ith_S(v, i) = exp(rate[i] * t);
    if (vp) NV_Ith_S(vp, i) = rate[i] * exp(rate[i] * t);
  }
  return 0;
}

/* Largest errors of y and z inside the steps, from t = 0.3 on. */
static void dae_error(steif_context *ctx, int index, const char *method, double h,
                      double *worst)
{
  static const int levels[] = {1, 1, 2};
  const steif_problem p = {.name = "hessenberg",
                           .n = 3,
                           .t1 = 1,
                           .start = exponentials,
                           .f = hessenberg,
                           .E = mass,
                           .exact = exponentials,
                           .index = index == 2 ? levels : NULL,
                           .user = &index};
  steif_options o = steif_defaults();
  o.h = h;
  steif_solver *s = smooth_open(ctx, &p, method, &o);
  N_Vector v = N_VClone(steif_solution(s)), exact = N_VClone(v);
  worst[0] = worst[1] = 0;
  while (steif_time(s) < 1 - h / 2) {
    CHECK(!steif_solve_step(s));
    for (int k = 1; k < 6; k++) {
      const double t = steif_time(s) - k * h / 6;
      if (t < 0.3) continue;
      CHECK(!steif_dense(s, t, v) && !exponentials(t, exact, NULL, NULL));
      for (int i = 0; i < 3; i++)
        worst[i / 2] = fmax(worst[i / 2], fabs(NV_Ith_S(v, i) - NV_Ith_S(exact, i)));
    }
  }
  N_VDestroy(v), N_VDestroy(exact);
  steif_solver_free(&s);
}

/* Index 1: algebraic components lose nothing with methods that end in a stage, but the order of the
 * slope at the end with DIRK. Index 2: s of s + 1. */
static void algebraic_components_have_their_order(void)
{
  static const struct {
    int index;
    const char *method;
    double y, z;
  } rows[] = {{1, "radau:s=2", 3, 3},
              {1, "radau:s=3", 4, 4},
              {1, "lobatto3c:s=3", 4, 3},
              {1, "radau1a:s=3", 4, 3},
              {1, "bdf:p=2,start=exact", 2, 2},
              {1, "bdf:p=3,start=exact", 3, 3},
              {1, "dirk:hw43", 3, 2},
              {1, "dirk:trbdf2", 2, 2},
              {1, "rodas4", 4, 3.2},
              {1, "rodas4p", 3.7, 3.5},
              {1, "rodas4p2", 3.2, 3.2},
              {1, "rodas5p", 4, 3.8},
              {2, "radau:s=2", 3, 2},
              {2, "radau:s=3", 4, 3},
              {2, "bdf:p=2,start=exact", 2, 2},
              {2, "bdf:p=3,start=exact", 3, 3}};
  steif_context *ctx = steif_context_new(NULL);
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    double coarse[2], fine[2];
    dae_error(ctx, rows[i].index, rows[i].method, 1. / 40, coarse);
    dae_error(ctx, rows[i].index, rows[i].method, 1. / 80, fine);
    const double y = log2(coarse[0] / fine[0]), z = log2(coarse[1] / fine[1]);
    const int good = fabs(y - rows[i].y) < 0.4 && fabs(z - rows[i].z) < 0.4;
    if (!good) printf("\n  index %d %s: %.2f, %.2f", rows[i].index, rows[i].method, y, z);
    CHECK(good);
  }
  steif_context_free(&ctx);
}

static void outside_the_last_step_is_refused(void)
{
  static const char *const methods[] = {"radau:s=3", "bdf:p=3", "rk4", "cvode"};
  steif_context *ctx = steif_context_new(NULL);
  for (int m = 0; m < 4; m++) {
    steif_options o = steif_defaults();
    o.h = m < 3 ? 0.07 : 0;
    steif_solver *s = smooth_open(ctx, &smooth, methods[m], &o);
    N_Vector y = N_VClone(steif_solution(s));
    if (m < 3) {
      CHECK(steif_dense(s, 0.25, y) == STEIF_BAD_INPUT);
      CHECK(strstr(steif_message(ctx), "no step has been made"));
    }
    for (int k = 0; k < 4; k++) CHECK(!steif_solve_step(s));
    const double t = steif_time(s), h = steif_statistics(s)->h_last;
    const double bad[] = {t + 0.01 * h, t - 1.01 * h, NAN, INFINITY};
    for (int i = 0; i < 4; i++) {
      CHECK(steif_dense(s, bad[i], y) == STEIF_BAD_INPUT);
      CHECK(strstr(steif_message(ctx), "outside the last step"));
    }
    CHECK(!steif_dense(s, t - 0.99 * h, y));
    N_VDestroy(y);
    steif_solver_free(&s);
  }
  steif_context_free(&ctx);
}

/* y_{n+1} = y_n + h sum b_i f(t_n + c_i h, X_i) with the stages as they are shown. */
static void stages_make_the_step(void)
{
  static const struct {
    const char *method;
    int stages;
    double h;
  } rows[] = {{"radau:s=3", 3, 0.1},   {"radau:s=3", 3, 0},
              {"gauss:s=4", 4, 0.1},   {"dirk:alexander3", 3, 0.1},
              {"dirk:hw43", 5, 0},     {"lobatto3c:s=3", 3, 0.1},
              {"be", 0, 0.1},          {"bdf:p=3", 0, 0},
              {"rk4", 0, 0.1},         {"cvode", 0, 0},
              {"dirk:trbdf2", 3, 0.1}, {"gauss:s=2", 2, 0}};
  steif_context *ctx = steif_context_new(NULL);
  for (size_t m = 0; m < sizeof rows / sizeof *rows; m++) {
    steif_options o = steif_defaults();
    o.h = rows[m].h;
    steif_solver *s = smooth_open(ctx, &smooth, rows[m].method, &o);
    N_Vector y = N_VClone(steif_solution(s)), slope = N_VClone(y), *X;
    const double *c, *b;
    int count = -1;
    CHECK(!steif_stages(s, &count, &c, &b, &X) && count == 0); /* none before the first step */
    for (int k = 0; k < 3; k++) {
      N_VScale(1, steif_solution(s), y);
      const double t = steif_time(s);
      CHECK(!steif_solve_step(s) && !steif_stages(s, &count, &c, &b, &X));
      const double h = steif_time(s) - t;
      CHECK(count == rows[m].stages);
      for (int i = 0; i < count; i++) {
        CHECK(!smooth.f(t + c[i] * h, X[i], slope, NULL));
        N_VLinearSum(1, y, h * b[i], slope, y);
      }
      for (int i = 0; count && i < 2; i++)
        CLOSE(NV_Ith_S(y, i), NV_Ith_S(steif_solution(s), i), rows[m].h > 0 ? 1e-11 : 1e-7);
    }
    N_VDestroy(y), N_VDestroy(slope);
    steif_solver_free(&s);
  }
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_dense[] = {
  {"dense output has its order", dense_output_has_its_order},
  {"algebraic components have their order", algebraic_components_have_their_order},
  {"dense output meets both ends", dense_output_meets_both_ends},
  {"times before an event", times_before_an_event_are_as_they_were},
  {"times between steps are dense output", times_between_steps_are_dense_output},
  {"outside the last step is refused", outside_the_last_step_is_refused},
  {"stages make the step", stages_make_the_step},
  CU_TEST_INFO_NULL};
