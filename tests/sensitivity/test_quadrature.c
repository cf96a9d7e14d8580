/* test_quadrature.c: integrals beside the solution, and their derivatives.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "base/failing.h"
#include "forcing.h"
#include <string.h>

/* g: the unknown of the number that `user` points to, and its square. */
static int unknown(sunrealtype t, N_Vector y, sunrealtype *value, void *user)
{
  (void)t;
  value[0] = NV_Ith_S(y, *(const int *)user);
  value[1] = value[0] * value[0];
  return 0;
}

static void integrals(steif_context *ctx, const char *name, int i, const char *method,
                      sunrealtype rtol, sunrealtype t, int columns, sunrealtype *q,
                      sunrealtype *dq)
{
  steif_problem p;
  int at = i;
  const steif_quadrature quadrature = {.count = 2, .value = unknown, .user = &at};
  steif_options o = steif_defaults();
  CU_ASSERT_FATAL(!steif_problem_find(ctx, name, &p));
  p.quadrature = &quadrature;
  o.rtol = rtol, o.t1 = t, o.sensitivities = columns > 0;
  steif_solver *s = steif_solver_new(ctx, &p, method, &o);
  const int code = s ? steif_solve_to(s, t) : steif_status(ctx);
  if (code) printf("\n  %s %s: %s", name, method, steif_message(ctx));
  CU_ASSERT_FATAL(!code);
  CHECK(!steif_quadrature_values(s, t, q));
  for (int k = 0; k < columns; k++) {
    sunrealtype both[2];
    CHECK(!steif_quadrature_sensitivity(s, t, k, both));
    dq[k] = both[0];
  }
  steif_solver_free(&s);
  steif_problem_clear(ctx, &p);
}

/* Radau IIA with 5 to 9 stages in 113-bit arithmetic, two numbers of stages agree. */
static const struct {
  const char *problem;
  int unknown, columns;
  sunrealtype t, q, dq[9];
} known[] = {
  {"rober",
   2,
   3,
   0.4,
   0.00302627479108087,
   {0.0737798474579308, -1.32810837233716e-8, 2.43170073079241e-12}},
  {"rober",
   2,
   3,
   40,
   7.98858586229491,
   {129.776482861602, -3.62638337322859e-4, 6.04429342100946e-8}},
  {"rober",
   2,
   3,
   4000,
   2822.89337452086,
   {21660.8913290106, -0.0844289327884305, 1.40715897382561e-5}},
  {"chemakzo",
   0,
   9,
   180,
   31.2642161949441,
   {-0.4279803827489, -0.1739629386550, -0.03014970786549, 0.5173379340702, -2.431794541060e-4,
    -0.8061649757004, 0.003751738449615, -7.242654559274, 0.008844489963836}},
  {"pendulum3:index=2",
   4,
   4,
   1,
   12.2005228296252,
   {-9.8556015800332, 1.0046484791063, 4.5241759954676, 0.19159636333813}}};

static void integrals_to_eight_digits(void)
{
  static const char *const methods[] = {"radau:s=3", "radau:s=5"};
  steif_context *ctx = steif_context_new(NULL);
  for (size_t i = 0; i < sizeof known / sizeof *known; i++)
    for (int m = 0; m < 2; m++) {
      sunrealtype q[2], dq[9];
      integrals(ctx, known[i].problem, known[i].unknown, methods[m], 1e-10, known[i].t,
                known[i].columns, q, dq);
      CLOSE(q[0], known[i].q, 1e-8);
      for (int k = 0; k < known[i].columns; k++) CLOSE(dq[k], known[i].dq[k], 3e-8);
    }
  steif_context_free(&ctx);
}

static int pendulum(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  (void)t, (void)user;
  NV_Ith_S(ydot, 0) = NV_Ith_S(y, 1);
  NV_Ith_S(ydot, 1) = -sin(NV_Ith_S(y, 0));
  return 0;
}

static int power(sunrealtype t, N_Vector y, sunrealtype *value, void *user)
{
  (void)t, (void)user;
  value[0] = NV_Ith_S(y, 1) * sin(NV_Ith_S(y, 0));
  return 0;
}

static const sunrealtype swing[] = {1.5, 0};

/* The integral of sin y1 y1', whose error by constant steps falls with the order of the method. */
static sunrealtype off(steif_context *ctx, const char *method, sunrealtype h)
{
  const steif_quadrature quadrature = {.count = 1, .value = power};
  const steif_problem p = {
    .name = "swing", .n = 2, .t1 = 3, .y0 = swing, .f = pendulum, .quadrature = &quadrature};
  steif_options o = steif_defaults();
  sunrealtype q;
  o.h = h;
  steif_solver *s = steif_solver_new(ctx, &p, method, &o);
  CU_ASSERT_FATAL(s && !steif_solve_to(s, 3));
  CHECK(!steif_quadrature_values(s, 3, &q));
  steif_solver_free(&s);
  return q;
}

static void order_is_that_of_the_method(void)
{
  static const struct {
    const char *spec;
    int order;
    sunrealtype first; /* step */
  } of[] = {{"radau:s=2", 3, 0.05},       {"radau:s=3", 5, 0.1},      {"gauss:s=2", 4, 0.1},
            {"lobatto3c:s=3", 4, 0.1},    {"dirk:esdirk43", 4, 0.05}, {"dirk:hw43", 4, 0.05},
            {"dirk:alexander2", 2, 0.05}, {"bdf:p=2", 2, 0.05},       {"rk4", 4, 0.05}};
  steif_context *ctx = steif_context_new(NULL);
  for (size_t m = 0; m < sizeof of / sizeof *of; m++) {
    sunrealtype q[3];
    for (int i = 0; i < 3; i++) q[i] = off(ctx, of[m].spec, of[m].first / (1 << i));
    const sunrealtype order = log2(fabs((q[0] - q[1]) / (q[1] - q[2])));
    if (!(order > of[m].order - 0.3)) printf("\n  %s: %.3g", of[m].spec, order);
    CHECK(order > of[m].order - 0.3);
  }
  steif_context_free(&ctx);
}

/* The integral of the velocity of a ball is its height, less that of the start: v jumps at impacts, and so does what
 * dq/dp gains there. At 1 by H, g, e as in test_events.c. */
static void impacts_are_passed(void)
{
  static const char *const methods[] = {"radau:s=3", "dirk:hw43", "bdf"};
  static const sunrealtype dy[] = {1.386502226263018, -0.09362872311284219, 2.42944691807002};
  steif_context *ctx = steif_context_new(NULL);
  for (int m = 0; m < 3; m++) {
    sunrealtype q[2], dq[3];
    integrals(ctx, "bounce", 1, methods[m], 1e-9, 1, 3, q, dq);
    CLOSE(q[0], 0.46800445252603631 - 1, 1e-7);
    for (int k = 0; k < 3; k++) CLOSE(dq[k], dy[k] - (k == 0), 1e-7);
  }
  steif_context_free(&ctx);
}

static int spike(sunrealtype t, N_Vector y, sunrealtype *value, void *user)
{
  (void)y, (void)user;
  value[0] = 1e-2 / ((t - 0.3) * (t - 0.3) + 1e-2);
  return 0;
}

static int still(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  (void)t, (void)y, (void)user;
  NV_Ith_S(ydot, 0) = 1;
  return 0;
}

/* y does not show the spike, and steps over it are long without the test: atan has the integral. */
static void tests_see_what_y_does_not(void)
{
  static const char *const methods[] = {"radau:s=3", "gauss:s=3", "radau:s=5", "dirk:hw43"};
  static const sunrealtype zero[] = {0};
  const steif_quadrature quadrature = {.count = 1, .value = spike};
  const steif_problem p = {
    .name = "spike", .n = 1, .t1 = 1, .y0 = zero, .f = still, .quadrature = &quadrature};
  const sunrealtype exact = 0.1 * (atan(7) + atan(3));
  steif_context *ctx = steif_context_new(NULL);
  for (int m = 0; m < 4; m++)
    for (int tested = 0; tested < 2; tested++) {
      steif_options o = steif_defaults();
      sunrealtype q;
      o.rtol = 1e-8, o.test_quadratures = tested, o.h0 = 1e-3;
      steif_solver *s = steif_solver_new(ctx, &p, methods[m], &o);
      CU_ASSERT_FATAL(s && !steif_solve_to(s, 1));
      CHECK(!steif_quadrature_values(s, 1, &q));
      if (tested)
        CLOSE(q, exact, 1e-5);
      else
        CHECK(fabs(q - exact) > 1e-5 * exact);
      steif_solver_free(&s);
    }
  steif_context_free(&ctx);
}

static void bad_input_is_named(void)
{
  static const sunrealtype zero[] = {0};
  const steif_quadrature quadrature = {.count = 1, .value = spike}, none = {.count = 0};
  steif_problem p = {.name = "spike", .n = 1, .t1 = 1, .y0 = zero, .f = still};
  steif_context *ctx = steif_context_new(NULL);
  steif_options o = steif_defaults();
  sunrealtype q;
  o.test_quadratures = 1;
  CHECK(!steif_solver_new(ctx, &p, "radau:s=3", &o) && steif_status(ctx) == STEIF_BAD_INPUT);
  p.quadrature = &quadrature;
  CHECK(!steif_solver_new(ctx, &p, "bdf", &o) && steif_status(ctx) == STEIF_UNSUPPORTED);
  p.quadrature = &none, o.test_quadratures = 0;
  CHECK(!steif_solver_new(ctx, &p, "radau:s=3", &o) && steif_status(ctx) == STEIF_BAD_INPUT);
  p.quadrature = NULL;
  steif_solver *s = steif_solver_new(ctx, &p, "radau:s=3", &o);
  CU_ASSERT_FATAL(s && !steif_solve_to(s, 1));
  CHECK(steif_quadrature_values(s, 1, &q) == STEIF_BAD_INPUT);
  CHECK(steif_quadrature_values(NULL, 1, &q) == STEIF_BAD_INPUT);
  steif_solver_free(&s);
  p.quadrature = &quadrature;
  s = steif_solver_new(ctx, &p, "cvode", &o);
  CU_ASSERT_FATAL(s && !steif_solve_to(s, 1));
  CHECK(!steif_quadrature_values(s, 1, &q) && q > 0);
  CHECK(steif_quadrature_values(s, -1, &q) == STEIF_BAD_INPUT);
  CHECK(steif_quadrature_sensitivity(s, 1, 0, &q) == STEIF_BAD_INPUT);
  steif_solver_free(&s);
  steif_context_free(&ctx);
}

static int life(steif_context *ctx, failing *memory)
{
  struct forcing F;
  int at = 0;
  sunrealtype q[2];
  steif_options o = steif_defaults();
  const steif_quadrature quadrature = {.count = 2, .value = unknown, .user = &at};
  forcing_open(&F, 0);
  F.p[1] = 1, F.problem.quadrature = &quadrature;
  o.sensitivities = 1, o.t1 = 1;
  steif_solver *s = steif_solver_new(ctx, &F.problem, "radau:s=3", &o);
  int code = s ? steif_solve_step(s) : steif_status(ctx);
  const long before = memory->served;
  if (!code) code = steif_solve_to(s, 1);
  if (!code) CHECK(memory->served == before);
  if (!code) CHECK(!steif_quadrature_sensitivity(s, 1, 1, q));
  steif_solver_free(&s);
  return code;
}

static void memory_may_fail_anywhere(void)
{
  for (long k = 1;; k++) {
    failing memory = {.refuse_at = k};
    steif_setup setup = failing_setup(&memory);
    setup.threads = 1;
    steif_context *ctx = steif_context_new(&setup);
    const int code = ctx ? life(ctx, &memory) : STEIF_NO_MEMORY;
    steif_context_free(&ctx);
    CHECK(memory.alive == 0);
    if (memory.served < k) {
      CHECK(code == STEIF_OK && k > 20);
      break;
    }
    CHECK(code == STEIF_NO_MEMORY);
  }
}

CU_TestInfo tests_of_quadrature[] = {
  {"integrals to eight digits", integrals_to_eight_digits},
  {"the order is that of the method", order_is_that_of_the_method},
  {"impacts are passed", impacts_are_passed},
  {"tests see what y does not", tests_see_what_y_does_not},
  {"bad input is named", bad_input_is_named},
  {"memory may fail anywhere", memory_may_fail_anywhere},
  CU_TEST_INFO_NULL};
