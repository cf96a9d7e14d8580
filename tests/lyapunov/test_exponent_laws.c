/* test_exponent_laws.c: laws that exact exponents satisfy, on exponents that do and that do not.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "base/failing.h"
#include "suite.h"
#include <nvector/nvector_serial.h>
#include <steif/collection.h>
#include <steif/lyapunov.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

static const double pi = 3.14159265358979323846;

typedef struct run {
  double exponent[4], error[4];
  steif_lyapunov_facts facts;
  steif_lyapunov_check check[6];
  int count, code;
  char message[400];
} run;

/* options.count exponents of p, and the laws. */
static run measure(steif_context *ctx, const steif_problem *p, const char *method,
                   steif_lyapunov_options o, double accuracy, double period)
{
  run r = {.code = STEIF_OK};
  o.error = r.error;
  r.code = steif_lyapunov(ctx, p, method, &o, r.exponent, NULL, &r.facts);
  if (r.code == STEIF_OK)
    r.code = steif_lyapunov_verify(ctx, p, method, &o, accuracy, period, r.exponent, &r.facts,
                                   r.check, &r.count);
  snprintf(r.message, sizeof r.message, "%s", steif_message(ctx));
  return r;
}

/* The eigenvalues of the product of 64 steps against QR over 30 whole periods: two ways to the same
 * number. */
static void floquet_agrees_with_qr(void)
{
  static const char *const methods[] = {
    "be",          "bdf:p=2",    "bdf:p=4",      "dirk:alexander2", "gauss:s=2",
    "glm:dimsim2", "glm:nord22", "glm:irks,p=3", "glm:am,p=3"};
  const steif_lyapunov_options o = {.h = 2 * pi / 64, .t1 = 120 * pi, .transient = 60 * pi};
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  CU_ASSERT_FATAL(steif_problem_find(ctx, "steyer:a=1.2,b1=-0.3,b2=-0.8,beta=1,omega=1", &p) ==
                  STEIF_OK);
  for (size_t i = 0; i < sizeof methods / sizeof *methods; i++) {
    const run r = measure(ctx, &p, methods[i], o, 0, 2 * pi);
    if (r.code) printf("\n  %s: %s", methods[i], r.message);
    CHECK(r.code == STEIF_OK && r.count == 3);
    CHECK(r.check[0].law == STEIF_SUM_LAW && r.check[0].which == 0);
    CLOSE(r.check[0].expected, -1.1, 1e-12);
    CLOSE(r.check[0].tolerance, 0.01 * fmax(-r.exponent[0], -r.exponent[1]), 1e-12);
    for (int j = 0; j < 2; j++) {
      const steif_lyapunov_check *c = &r.check[1 + j];
      CHECK(c->law == STEIF_RECURRENCE_LAW && c->which == j + 1 && c->holds);
      CHECK(c->value == r.exponent[j]);
      CLOSE_FLOOR(c->expected, c->value, 1e-9, 1);
    }
  }
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* Equation (3) of Steyer and Van Vleck with 84 steps a period: the largest Floquet exponent of the
 * recurrences, whose ODE has -0.14; products of step matrices in double. */
static void leading_exponents_of_many_methods(void)
{
  static const struct {
    const char *method;
    double exponent;
  } row[] = {{"be", .6455},
             {"dirk:cranknicolson", -.0701},
             {"gauss:s=1", -.0701},
             {"bdf:p=2", .00719513},
             {"dirk:alexander2", -.0924},
             {"radau:s=2", -.1367},
             {"gauss:s=2", -.1398},
             {"bdf:p=3", -.1427},
             {"bdf:p=4", -.1450},
             {"bdf:p=5", -.1381},
             {"bdf:p=6", -.1401},
             {"rk4", -.1450},
             {"glm:ab,p=2", -.1344},
             {"glm:ab,p=3", -.1291},
             {"glm:am,p=3", -.1446},
             {"glm:dimsim1", -.1401},
             {"glm:dimsim2", -.0933},
             {"glm:nord22", -.0253}};
  const steif_lyapunov_options o = {.h = 2 * pi / 84, .t1 = 20 * pi};
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  CU_ASSERT_FATAL(steif_problem_find(ctx, "steyer", &p) == STEIF_OK);
  for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
    const run r = measure(ctx, &p, row[i].method, o, 0, 2 * pi);
    CHECK(r.code == STEIF_OK && r.count == 3);
    CLOSE_FLOOR(r.check[1].expected, row[i].exponent, 5.1e-5, 1);
  }
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* BDF2 with h = 0.02 has the sum -14.519 where the trace is -41/3; rk4 keeps it. */
static void the_sum_tells_long_steps(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  CU_ASSERT_FATAL(steif_problem_find(ctx, "lorenz", &p) == STEIF_OK);
  const steif_lyapunov_options o = {.h = 0.02, .t1 = 220, .transient = 20};
  const run wide = measure(ctx, &p, "bdf:p=2", o, 0, 0),
            good = measure(ctx, &p, "rk4", o, 0, 0),
            strict = measure(ctx, &p, "rk4", o, 1e-6, 0);
  CHECK(wide.count == 2 && !wide.check[0].holds);
  CLOSE(wide.check[0].value, -14.519, 2e-3);
  CHECK(good.count == 2 && good.check[0].holds && !strict.check[0].holds);
  for (int i = 0; i < 2; i++) { /* the flow of the numbers has an exponent 0 of its own */
    const steif_lyapunov_check *c = &(i ? good : wide).check[1];
    CHECK(c->law == STEIF_FLOW_LAW && c->which == 2 && c->expected == 0 && c->holds);
    CHECK(c->tolerance < 0.1);
  }
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* u' = (1 - |u|^2) u + i u: the circle has exponents 0 and -2; from rest at 0 or from inside with a
 * sink, (c - |u|^2) u, c < 0, the solution comes to rest. */
static int f(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  const double u = NV_Ith_S(y, 0), v = NV_Ith_S(y, 1),
               q = *(const double *)user - u * u - v * v;
  (void)t;
  NV_Ith_S(r, 0) = q * u - v, NV_Ith_S(r, 1) = q * v + u;
  return 0;
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
               N_Vector b, N_Vector c)
{
  const double u = NV_Ith_S(y, 0), v = NV_Ith_S(y, 1),
               q = *(const double *)user - u * u - v * v;
  (void)t, (void)fy, (void)a, (void)b, (void)c;
  SM_ELEMENT_D(J, 0, 0) = q - 2 * u * u, SM_ELEMENT_D(J, 0, 1) = -1 - 2 * u * v;
  SM_ELEMENT_D(J, 1, 0) = 1 - 2 * u * v, SM_ELEMENT_D(J, 1, 1) = q - 2 * v * v;
  return 0;
}

static void cycles_have_a_zero_and_rest_has_none(void)
{
  static const sunrealtype y0[] = {0.7, -0.3};
  static double excited = 1, damped = -1;
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p = {.name = "circle",
                     .n = 2,
                     .t1 = 120,
                     .y0 = y0,
                     .f = f,
                     .jac = jac,
                     .autonomous = 1,
                     .user = &excited};
  const steif_lyapunov_options o = {.h = 0.05, .transient = 20};
  const run cycle = measure(ctx, &p, "gauss:s=3", o, 0, 0);
  CHECK(cycle.code == STEIF_OK && cycle.count == 2);
  CLOSE_FLOOR(cycle.facts.flow, 0, 1e-9, 1);
  CHECK(cycle.check[1].law == STEIF_FLOW_LAW && cycle.check[1].which == 1);
  CHECK(cycle.check[1].holds && cycle.check[0].holds);
  CLOSE(cycle.exponent[1], -2, 1e-3);
  run wrong = cycle;
  steif_lyapunov_options with = o;
  with.error = wrong.error, wrong.exponent[0] = 0.05, wrong.facts.sum += 0.05;
  CHECK(steif_lyapunov_verify(ctx, &p, "gauss:s=3", &with, 0, 0, wrong.exponent, &wrong.facts,
                              wrong.check, &wrong.count) == STEIF_OK);
  CHECK(wrong.count == 2 && !wrong.check[0].holds && !wrong.check[1].holds);
  p.user = &damped;
  const run still = measure(ctx, &p, "gauss:s=3", o, 0, 0);
  CHECK(still.count == 1 && still.check[0].law == STEIF_SUM_LAW && still.check[0].holds);
  CLOSE(still.facts.flow, -1, 1e-3); /* y' decays as y does */
  p.autonomous = 0;
  CHECK(isnan(measure(ctx, &p, "gauss:s=3", o, 0, 0).facts.flow));
  steif_context_free(&ctx);
}

static void bad_questions_are_rejected(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  CU_ASSERT_FATAL(steif_problem_find(ctx, "steyer", &p) == STEIF_OK);
  const steif_lyapunov_options o = {.h = 0.1, .t1 = 40};
  const run odd = measure(ctx, &p, "bdf:p=2", o, 0, 2 * pi);
  CHECK(odd.code == STEIF_BAD_INPUT && strstr(odd.message, "62.8319 steps") != NULL);
  CHECK(measure(ctx, &p, "bdf:p=2", o, -1, 0).code == STEIF_BAD_INPUT);
  run r = {.count = 0};
  CHECK(steif_lyapunov_verify(ctx, &p, "bdf:p=2", &o, 0, 0, r.exponent, &r.facts, r.check,
                              &r.count) == STEIF_BAD_INPUT);
  CHECK(strstr(steif_message(ctx), "options.error") != NULL);
  steif_problem_clear(ctx, &p);
  CU_ASSERT_FATAL(steif_problem_find(ctx, "lorenz", &p) == STEIF_OK);
  const run bent = measure(ctx, &p, "rk4", (steif_lyapunov_options){.h = 0.01, .t1 = 2}, 0, 1);
  CHECK(bent.code == STEIF_UNSUPPORTED && strstr(bent.message, "multipliers") != NULL);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

static void short_memory_is_told(void)
{
  int code = STEIF_NO_MEMORY;
  for (long k = 1; code != STEIF_OK && k < 1000; k++) {
    failing mine = {0};
    const steif_setup setup = failing_setup(&mine);
    steif_context *ctx = steif_context_new(&setup);
    steif_problem p = {0};
    mine.refuse_at = mine.served + k;
    code = steif_problem_find(ctx, "steyer", &p);
    if (code == STEIF_OK)
      code = measure(ctx, &p, "bdf:p=2", (steif_lyapunov_options){.h = 2 * pi / 64, .t1 = 4}, 0,
                     2 * pi)
               .code;
    CHECK(code == STEIF_OK || code == STEIF_NO_MEMORY);
    steif_problem_clear(ctx, &p);
    steif_context_free(&ctx);
    CHECK(mine.alive == 0);
  }
  CHECK(code == STEIF_OK);
}

CU_TestInfo tests_of_laws[] = {
  {"Floquet's exponents are those of QR", floquet_agrees_with_qr},
  {"leading exponents of many methods", leading_exponents_of_many_methods},
  {"the sum tells steps that are too long", the_sum_tells_long_steps},
  {"cycles have an exponent 0, rest has none", cycles_have_a_zero_and_rest_has_none},
  {"bad questions are rejected", bad_questions_are_rejected},
  {"short memory is told", short_memory_is_told},
  CU_TEST_INFO_NULL};
