/* test_further.c: runs with another end, copies, restarts.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "base/failing.h"
#include "oscillator.h"
#include "suite.h"
#include <string.h>

static int equal(steif_solver *a, steif_solver *b)
{
  const sunrealtype *x = NV_DATA_S(steif_solution(a)), *y = NV_DATA_S(steif_solution(b));
  return steif_time(a) == steif_time(b) && !memcmp(x, y, 2 * sizeof *x);
}

/* To the end, step by step, alike? */
static int go_on_alike(steif_solver *a, steif_solver *b)
{
  for (int k = 0; k < 300; k++) {
    const int x = steif_solve_step(a), y = steif_solve_step(b);
    if (x != y || !equal(a, b)) return 0;
    if (x) return 1;
  }
  return 1;
}

static const char *const methods[] = {"radau:s=3",    "gauss:s=2", "bdf",
                                      "dirk:hw43",    "rodas4",    "exprb43",
                                      "glm:irks,p=3", "dopri87",   "auto"};
enum { METHODS = sizeof methods / sizeof *methods };

/* The end is not felt before it comes near: a run extended on its way is the run with that end. */
static void an_extended_run_is_the_longer_one(void)
{
  steif_context *ctx = steif_context_new(NULL);
  const steif_problem p = oscillator();
  for (int m = 0; m < METHODS; m++) {
    steif_options o = steif_defaults();
    o.h0 = 1e-5, o.t1 = 2.5;
    if (!strcmp(methods[m], "auto")) continue; /* weighs the way that is left */
    steif_solver *a = under_way(ctx, &p, methods[m], &o);
    o.t1 = 3;
    steif_solver *b = under_way(ctx, &p, methods[m], &o);
    CU_ASSERT_FATAL(a && b && !steif_solver_extend(a, 3));
    CHECK(equal(a, b) && go_on_alike(a, b));
    CHECK(!steif_solve_to(a, 3) && steif_time(a) == 3);
    steif_solver_free(&a), steif_solver_free(&b);
  }
  steif_context_free(&ctx);
}

/* y_1(3) in one run. */
static sunrealtype in_one(steif_context *ctx, const char *method, sunrealtype rtol)
{
  const steif_problem p = oscillator();
  steif_options o = steif_defaults();
  o.rtol = rtol;
  steif_solver *s = steif_solver_new(ctx, &p, method, &o);
  CU_ASSERT_FATAL(s && !steif_solve_to(s, 3));
  const sunrealtype y = NV_Ith_S(steif_solution(s), 0);
  steif_solver_free(&s);
  return y;
}

/* From the end on: as accurate as one run of the method. */
static void a_finished_run_goes_on(void)
{
  steif_context *ctx = steif_context_new(NULL);
  const steif_problem p = oscillator();
  steif_options o = steif_defaults();
  const sunrealtype exact = in_one(ctx, "radau:s=5", 1e-10);
  o.t1 = 1;
  for (int m = 0; m < METHODS; m++) {
    steif_solver *s = steif_solver_new(ctx, &p, methods[m], &o);
    CU_ASSERT_FATAL(s && !steif_solve_to(s, 1) && steif_solve_step(s) == STEIF_BAD_INPUT);
    CHECK(!steif_solver_extend(s, 2) && !steif_solve_to(s, 2) && !steif_solver_extend(s, 3));
    CHECK(!steif_solve_to(s, 3));
    const sunrealtype error = fabs(in_one(ctx, methods[m], o.rtol) - exact);
    CHECK(fabs(NV_Ith_S(steif_solution(s), 0) - exact) <= 3 * error + o.rtol);
    steif_solver_free(&s);
  }
  steif_context_free(&ctx);
}

/* Constant steps: a whole number of them, a shorter last one, one across the end. */
static void grids_go_on(void)
{
  static const struct {
    const char *method;
    sunrealtype first, second;
    long steps;
  } row[] = {{"radau:s=2", 0.5, 0.75, 15},
             {"radau:s=2", 0.52, 0.72, 15},
             {"bdf:p=2", 0.52, 0.75, 15},
             {"bdf:p=2", 0.52, 0.54, 11},
             {"glm:bdf,p=2", 0.5, 0.75, 15}};
  steif_context *ctx = steif_context_new(NULL);
  const steif_problem p = oscillator();
  for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
    steif_options o = steif_defaults();
    o.h = 0.05, o.t1 = row[i].first;
    steif_solver *s = steif_solver_new(ctx, &p, row[i].method, &o);
    if (!s) continue; /* a method that is not on the list */
    CHECK(!steif_solve_to(s, row[i].first) && !steif_solver_extend(s, row[i].second));
    CHECK(!steif_solve_to(s, row[i].second) && steif_time(s) == row[i].second);
    CHECK(steif_statistics(s)->steps == row[i].steps);
    steif_solver_free(&s);
  }
  steif_context_free(&ctx);
}

static void what_cannot_be_extended_is_told(void)
{
  static const sunrealtype mesh[] = {0, 0.1, 0.3};
  steif_context *ctx = steif_context_new(NULL);
  const steif_problem p = oscillator();
  steif_options o = steif_defaults();
  steif_solver *s = under_way(ctx, &p, "bdf", &o), *same = under_way(ctx, &p, "bdf", &o);
  CU_ASSERT_FATAL(s && same);
  const sunrealtype bad[] = {0, steif_time(s), NAN, INFINITY, -1};
  for (int i = 0; i < 5; i++) CHECK(steif_solver_extend(s, bad[i]) == STEIF_BAD_INPUT);
  CHECK(strstr(steif_message(ctx), "must lie after the time reached") != NULL);
  CHECK(steif_solver_extend(NULL, 5) == STEIF_BAD_INPUT);
  CHECK(go_on_alike(s, same)); /* unharmed */
  steif_solver_free(&s), steif_solver_free(&same);
  o.mesh = mesh, o.mesh_size = 3;
  s = steif_solver_new(ctx, &p, "radau:s=2", &o);
  CHECK(s && steif_solver_extend(s, 1) == STEIF_BAD_INPUT);
  steif_solver_free(&s), steif_context_free(&ctx);
}

static void copies_go_on_alike(void)
{
  steif_context *ctx = steif_context_new(NULL);
  const steif_problem p = oscillator();
  for (int m = 0; m < METHODS; m++) {
    steif_solver *a = under_way(ctx, &p, methods[m], NULL);
    steif_solver *b = a ? steif_solver_copy(a, NULL) : NULL;
    CU_ASSERT_FATAL(a && b);
    CHECK(equal(a, b) && steif_statistics(a)->nfe == steif_statistics(b)->nfe);
    CHECK(go_on_alike(a, b));
    steif_solver_free(&a), steif_solver_free(&b);
  }
  CHECK(steif_solver_copy(NULL, NULL) == NULL);
  steif_context_free(&ctx);
}

/* A restarted solver makes the steps of a new one: with another state and time, tolerance, right-hand side. */
static void a_restart_is_a_new_run(void)
{
  static sunrealtype soft = 20;
  static const sunrealtype y1[] = {-1.3, 0.4};
  steif_context *ctx = steif_context_new(NULL);
  const steif_problem p = oscillator();
  N_Vector y = N_VMake_Serial(2, (sunrealtype *)y1, steif_sundials(ctx));
  for (int m = 0; m < METHODS; m++)
    for (int change = 0; change < 3; change++) {
      steif_problem q = p, fresh = p;
      steif_options o = steif_defaults();
      if (change == 1) o.rtol = 1e-5;
      if (change == 2) q.user = fresh.user = &soft;
      fresh.t0 = 0.75, fresh.y0 = y1, o.t1 = 3;
      steif_solver *a = under_way(ctx, &p, methods[m], NULL);
      steif_solver *b = steif_solver_new(ctx, &fresh, methods[m], &o);
      CU_ASSERT_FATAL(a && b);
      for (int again = 0; again < 2; again++) /* and once more */
        CHECK(!steif_solver_restart(a, 0.75, y, NULL, change == 2 ? &q : NULL, &o));
      CHECK(steif_time(a) == 0.75 && steif_statistics(a)->steps == 0);
      if (strcmp(methods[m], "auto")) CHECK(go_on_alike(a, b));
      CHECK(!steif_solve_to(a, 3) && !steif_solve_to(b, 3));
      CLOSE_FLOOR(NV_Ith_S(steif_solution(a), 0), NV_Ith_S(steif_solution(b), 0), 1e-5, 1);
      steif_solver_free(&a), steif_solver_free(&b);
    }
  N_VDestroy(y), steif_context_free(&ctx);
}

/* From its own solution, which is one of the solver's vectors; saved and loaded afterwards. */
static void a_restart_takes_its_own_solution(void)
{
  const char *path = scratch("restart");
  steif_context *ctx = steif_context_new(NULL);
  const steif_problem p = oscillator();
  for (int m = 0; m < METHODS; m++) {
    steif_solver *a = under_way(ctx, &p, methods[m], NULL);
    CU_ASSERT_FATAL(a != NULL);
    const sunrealtype t = steif_time(a), y0 = NV_Ith_S(steif_solution(a), 0);
    CHECK(!steif_solver_restart(a, t, steif_solution(a), NULL, NULL, NULL));
    CHECK(steif_time(a) == t && NV_Ith_S(steif_solution(a), 0) == y0);
    for (int k = 0; k < 9; k++) CHECK(!steif_solve_step(a));
    CHECK(!steif_checkpoint_save(a, path, NULL, 0));
    steif_solver *b = steif_checkpoint_load(ctx, path, &p, NULL);
    CU_ASSERT_FATAL(b != NULL);
    CHECK(equal(a, b) && go_on_alike(a, b));
    steif_solver_free(&a), steif_solver_free(&b);
  }
  remove(path), steif_context_free(&ctx);
}

/* Nothing is changed by a restart that cannot be; memory stays the same over a thousand. */
static void restarts_are_checked_and_thrifty(void)
{
  failing f = {0};
  steif_setup setup = failing_setup(&f);
  steif_context *ctx = steif_context_new(&setup);
  const steif_problem p = oscillator();
  steif_problem q = p;
  steif_options o = steif_defaults();
  N_Vector y = N_VNew_Serial(2, steif_sundials(ctx)),
           y3 = N_VNew_Serial(3, steif_sundials(ctx));
  steif_solver *s = under_way(ctx, &p, "bdf", NULL), *same = under_way(ctx, &p, "bdf", NULL);
  CU_ASSERT_FATAL(s && same);
  NV_Ith_S(y, 0) = 2, NV_Ith_S(y, 1) = NAN;
  CHECK(steif_solver_restart(s, 0, y, NULL, NULL, NULL) == STEIF_NOT_FINITE);
  NV_Ith_S(y, 1) = -0.66;
  CHECK(steif_solver_restart(s, NAN, y, NULL, NULL, NULL) == STEIF_NOT_FINITE);
  CHECK(steif_solver_restart(s, 0, y3, NULL, NULL, NULL) == STEIF_BAD_INPUT);
  CHECK(steif_solver_restart(s, 0, NULL, NULL, NULL, NULL) == STEIF_BAD_INPUT);
  CHECK(steif_solver_restart(s, 4, y, NULL, NULL, NULL) == STEIF_BAD_INPUT); /* behind t1 */
  q.name = "another";
  CHECK(steif_solver_restart(s, 0, y, NULL, &q, NULL) == STEIF_BAD_INPUT);
  o.h = 0.1;
  CHECK(steif_solver_restart(s, 0, y, NULL, NULL, &o) == STEIF_BAD_INPUT);
  o = steif_defaults(), o.rtol = -1;
  CHECK(steif_solver_restart(s, 0, y, NULL, NULL, &o) == STEIF_BAD_INPUT);
  CHECK(go_on_alike(s, same));
  CHECK(!steif_solver_restart(s, 0, y, NULL, NULL, NULL));
  const long alive = f.alive;
  for (int k = 0; k < 1000; k++)
    CHECK(!steif_solver_restart(s, 0, y, NULL, NULL, NULL) && !steif_solve_step(s));
  CHECK(f.alive == alive);
  steif_solver_free(&s), steif_solver_free(&same);
  N_VDestroy(y), N_VDestroy(y3), steif_context_free(&ctx);
  CHECK(f.alive == 0);
}

CU_TestInfo tests_of_further[] = {
  {"an extended run is the longer one", an_extended_run_is_the_longer_one},
  {"a finished run goes on", a_finished_run_goes_on},
  {"grids go on", grids_go_on},
  {"what cannot be extended is told", what_cannot_be_extended_is_told},
  {"copies go on alike", copies_go_on_alike},
  {"a restart is a new run", a_restart_is_a_new_run},
  {"a restart takes its own solution", a_restart_takes_its_own_solution},
  {"restarts are checked and thrifty", restarts_are_checked_and_thrifty},
  CU_TEST_INFO_NULL};
