/* test_counterexample.c: equations that decay while a method grows (Steyer and Van Vleck, arXiv
 * 1709.02059, theorem 3.4, corrected for nodes that are no integers).
 * SPDX-License-Identifier: BSD-3-Clause */
#include "base/failing.h"
#include "suite.h"
#include <nvector/nvector_serial.h>
#include <steif/collection.h>
#include <steif/counterexample.h>
#include <steif/lyapunov.h>
#include <steif/solver.h>
#include <string.h>

/* h = 0.1, rate = 1: exponents of the scalar recurrences ln |M(0.1)| / 0.1 and of the product of the
 * steps on 2 cos(2 pi t/h) - 1, of formulas the principal roots in 30 digits; means of the products of
 * sines. */
static const struct row {
  const char *method;
  int nodes;
  double exponent, cosine, mean, digits;
} rows[] = {
  {"be", 1, 1.053605, 1.053605, 0.5, 1e-6},
  {"dirk:cranknicolson", 1, 1.000835, 1.000835, 0.5, 1e-6},
  {"bdf:p=2", 1, 1.003123, 1.003123, 0.5, 1e-6},
  {"bdf:p=3", 1, 1.0002, 1.0002, 0.5, 1e-4},
  {"bdf:p=4", 1, 1.000016957823, 1.000016957823, 0.5, 1e-11},
  {"bdf:p=5", 1, 1.000001347946, 1.000001347946, 0.5, 1e-11},
  {"bdf:p=6", 1, 1.000000, 1.000000, 0.5, 1e-6},
  {"glm:ab,p=2", 1, 0.996105, 0.996105, 0.5, 1e-6},
  {"glm:ab,p=3", 1, 0.999663171669, 0.999663171669, 0.5, 1e-11},
  {"glm:ab,p=4", 1, 0.999970, 0.999970, 0.5, 1e-6},
  {"glm:am,p=3", 1, 1.000040, 1.000040, 0.5, 1e-6},
  {"glm:am,p=4", 1, 1.000002439997, 1.000002439997, 0.5, 1e-11},
  {"glm:dimsim1", 1, 0.998453, 0.998453, 0.5, 1e-6},
  {"glm:dimsim2", 1, 1.000401, 1.000401, 0.5, 1e-6},
  {"gauss:s=1", 1, 1.000835, -3.0228, 0.5, 1e-6},
  {"rk4", 2, 0.999999, -1.7451, 0.125, 1e-6},
  {"gauss:s=2", 2, 1.000000, -0.5188, 0.139474, 1e-6},
  {"radau:s=2", 2, 0.999986, -1.2253, 0.1875, 1e-6},
  {"dirk:alexander2", 2, 1.000401, -0.7976, 0.216718, 1e-6},
  {"glm:nord22", 2, 1.002002, -3.5196, 0.125, 1e-6},
};

static void every_method_has_one(void)
{
  steif_context *ctx = steif_context_new(NULL);
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    const struct row *r = &rows[i];
    steif_problem p;
    steif_counterexample e = {.exponent = NAN};
    const int code = steif_counterexample_new(ctx, r->method, 0.1, 1, &p, &e);
    if (code) printf("\n  %s: %s", r->method, steif_message(ctx));
    CHECK(code == STEIF_OK);
    CHECK(e.nodes == r->nodes);
    CLOSE(e.exponent, r->exponent, r->digits);
    CLOSE(e.constant, e.exponent, 1e-9);
    CLOSE(e.cosine, r->cosine, r->digits > 1e-5 ? r->digits : 1e-4);
    CLOSE(e.mean, r->mean, 5e-6);
    CLOSE(e.E * e.mean, 2, 1e-14);
    steif_counterexample_clear(ctx, &p);
  }
  steif_context_free(&ctx);
}

/* The example of the introduction of the same paper, C with the factor 2/3 it lacks in print: a = 1.2,
 * b = -0.14, -0.15, waves of period h = 0.1 instead of 2 pi, so that BDF2 sees one matrix in all steps.
 * The equation decays; rho(C) is above 1 between beta = 62 and 87 and not for large beta. Time is
 * stretched to the period 2 pi. rho: eigenvalues of C in 30 digits. */
static void a_rotation_in_every_step(void)
{
  static const struct {
    double beta, rho, tolerance;
  } row[] = {{62, 1.04917253972725, 1e-3}, /* a complex pair */
             {64, 3.44945611965731, 1e-11},   {70, 2.97889811610100, 1e-11},
             {80, 1.26707803927214, 1e-11},   {85, 1.05778329554754, 1e-11},
             {86.9, 1.00191724265359, 1e-11}, {87.1, 0.99655226441423, 1e-11},
             {90, 0.92762310921163, 1e-11},   {100, 0.77048131323400, 1e-11},
             {1000, 0.19790710383607, 1e-11}};
  const double pi = 3.14159265358979323846, scale = 0.1 / (2 * pi);
  steif_context *ctx = steif_context_new(NULL);
  for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
    char name[160];
    double exponent = NAN;
    steif_problem p;
    snprintf(name, sizeof name, "steyer:a=%.17g,b1=%.17g,b2=%.17g,beta=%.17g,omega=1",
             1.2 * scale, -0.14 * scale, -0.15 * scale, row[i].beta * scale);
    const steif_lyapunov_options o = {
      .h = 2 * pi, .t1 = 2 * pi * 4000, .transient = 2 * pi * 400, .count = 1};
    CU_ASSERT_FATAL(steif_problem_find(ctx, name, &p) == STEIF_OK);
    CHECK(steif_lyapunov(ctx, &p, "bdf:p=2", &o, &exponent, NULL, NULL) == STEIF_OK);
    CLOSE(exp(2 * pi * exponent), row[i].rho, row[i].tolerance);
    steif_problem_clear(ctx, &p);
  }
  steif_context_free(&ctx);
}

/* |x| after 200 steps: 1.4e9 and 4.9e8, against e^-20 = 2.06e-9. */
static void a_run_beside_the_solution(void)
{
  enum { STEPS = 200 };
  double t[STEPS], x[STEPS], solution[STEPS];
  long made = 0;
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  CU_ASSERT_FATAL(steif_counterexample_new(ctx, "be", 0.1, 1, &p, NULL) == STEIF_OK);
  CHECK(steif_counterexample_run(ctx, &p, "be", 0.1, STEPS, t, x, solution, &made) == STEIF_OK);
  CHECK(made == STEPS);
  CLOSE(t[STEPS - 1], 20, 1e-12);
  CLOSE(x[0], 1 / 0.9, 1e-9); /* the stage sees the rate 1 */
  CLOSE(x[STEPS - 1], 1.4e9, 0.02);
  CLOSE(solution[STEPS - 1], 2.0611536224385578e-09, 1e-11);
  CHECK(steif_counterexample_run(ctx, &p, "be", 0.1, 0, t, x, solution, &made) ==
        STEIF_BAD_INPUT);
  steif_counterexample_clear(ctx, &p);
  steif_context_free(&ctx);
}

static void numbers_grow_where_the_equation_decays(void)
{
  static const struct {
    const char *method;
    double end;
  } row[] = {{"be", 1.4e9}, {"dirk:cranknicolson", 4.9e8}, {"radau:s=4", 4.85e8}};
  steif_context *ctx = steif_context_new(NULL);
  for (int i = 0; i < 3; i++) {
    steif_problem p;
    const steif_options o = {.h = 0.1};
    CU_ASSERT_FATAL(steif_counterexample_new(ctx, row[i].method, 0.1, 1, &p, NULL) == STEIF_OK);
    steif_solver *s = steif_solver_new(ctx, &p, row[i].method, &o);
    CU_ASSERT_FATAL(s != NULL);
    CHECK(steif_solve_to(s, 20) == STEIF_OK);
    CLOSE(NV_Ith_S(steif_solution(s), 0), row[i].end, 0.02);
    CHECK(p.exact(20, steif_solution(s), NULL, p.user) == 0);
    CLOSE(NV_Ith_S(steif_solution(s), 0), 2.0611536224385578e-09, 1e-11);
    steif_solver_free(&s);
    steif_counterexample_clear(ctx, &p);
  }
  steif_context_free(&ctx);
}

/* The closed solution against radau:s=5 with steps that resolve lambda. */
static void the_exact_solution_is_one(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  const steif_options o = {.rtol = 1e-12, .atol = 1e-14, .h_max = 0.005};
  CU_ASSERT_FATAL(steif_counterexample_new(ctx, "gauss:s=3", 0.1, 2, &p, NULL) == STEIF_OK);
  steif_solver *s = steif_solver_new(ctx, &p, "radau:s=5", &o);
  CU_ASSERT_FATAL(s != NULL);
  for (double t = 0.013; t < 0.5; t += 0.037) {
    CHECK(steif_solve_to(s, t) == STEIF_OK);
    const double x = NV_Ith_S(steif_solution(s), 0);
    N_Vector y = N_VClone(steif_solution(s));
    CHECK(p.exact(t, y, NULL, p.user) == 0);
    CLOSE(x, NV_Ith_S(y, 0), 1e-9);
    N_VDestroy(y);
  }
  steif_solver_free(&s);
  steif_counterexample_clear(ctx, &p);
  steif_context_free(&ctx);
}

static void nonsense_is_rejected(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  CHECK(steif_counterexample_new(ctx, "be", 0, 1, &p, NULL) == STEIF_BAD_INPUT);
  CHECK(steif_counterexample_new(ctx, "be", 0.1, INFINITY, &p, NULL) == STEIF_BAD_INPUT);
  CHECK(steif_counterexample_new(ctx, "be", 0.1, 30, &p, NULL) == STEIF_UNSUPPORTED);
  CHECK(strstr(steif_message(ctx), "h rate = 3 lies in the stability region of be"));
  CHECK(steif_counterexample_new(ctx, "cvode", 0.1, 1, &p, NULL) == STEIF_UNSUPPORTED);
  CHECK(steif_counterexample_new(ctx, "bee", 0.1, 1, &p, NULL) == STEIF_UNKNOWN_NAME);
  steif_context_free(&ctx);
}

static void short_memory_is_told(void)
{
  int code = STEIF_NO_MEMORY;
  for (long k = 1; code != STEIF_OK && k < 1000; k++) {
    failing f = {0};
    const steif_setup setup = failing_setup(&f);
    steif_context *ctx = steif_context_new(&setup);
    steif_problem p = {0};
    f.refuse_at = f.served + k;
    code = steif_counterexample_new(ctx, "radau:s=2", 0.1, 1, &p, NULL);
    CHECK(code == STEIF_OK || code == STEIF_NO_MEMORY);
    steif_counterexample_clear(ctx, &p);
    steif_context_free(&ctx);
    CHECK(f.alive == 0);
  }
  CHECK(code == STEIF_OK);
}

CU_TestInfo tests_of_counterexample[] = {
  {"every method has one", every_method_has_one},
  {"a rotation in every step: rho(C) of the introduction", a_rotation_in_every_step},
  {"numbers grow where the equation decays", numbers_grow_where_the_equation_decays},
  {"a run beside the solution", a_run_beside_the_solution},
  {"the exact solution is one", the_exact_solution_is_one},
  {"nonsense is rejected", nonsense_is_rejected},
  {"short memory is told", short_memory_is_told},
  CU_TEST_INFO_NULL};
