/* Counters against counts by hand, and runs that repeat bit for bit.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "smooth.h"

/* A linear problem: one Jacobian and one factorisation per run and shift, one solve and one
 * evaluation of f per stage and step; the Jacobian callback is given f at its point. */
static void linear_problems_cost_one_factorisation(void)
{
  static const struct {
    const char *method;
    long stages, lanes;
  } rows[] = {{"be", 1, 1},        {"bdf:p=1", 1, 1},         {"radau:s=1", 1, 1},
              {"radau:s=3", 3, 2}, {"gauss:s=4", 4, 2},       {"radau:s=7", 7, 4},
              {"gauss:s=2", 2, 1}, {"dirk:alexander2", 2, 1}, {"dirk:alexander3", 3, 1}};
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  CU_ASSERT_FATAL(!steif_problem_find(ctx, "stiffpair", &p));
  for (size_t m = 0; m < sizeof rows / sizeof *rows; m++) {
    steif_options o = steif_defaults();
    o.h = p.t1 / 37;
    const int dirk = rows[m].method[0] == 'd';
    const long each = dirk ? rows[m].stages : rows[m].lanes; /* solves in a step */
    steif_solver *s = smooth_open(ctx, &p, rows[m].method, &o);
    CHECK(!steif_solve_to(s, p.t1));
    const steif_stats *n = steif_statistics(s);
    CHECK(n->steps == 37 && n->rejected == 0 && n->newton_fails == 0);
    CHECK(n->nje == 1);
    CHECK(n->nlu == rows[m].lanes);
    CHECK(n->nsolve == 37 * each);
    CHECK(n->newton == 37 * (dirk ? rows[m].stages : 1));
    CHECK(n->nfe == 37 * rows[m].stages + 1);
    CLOSE(n->h_last, p.t1 / 37, 1e-15);
    steif_solver_free(&s);
  }
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* The ramp of bdf:p=3 passes orders 1, 2, 3: one shift each. */
static void a_ramp_costs_its_orders(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  CU_ASSERT_FATAL(!steif_problem_find(ctx, "stiffpair", &p));
  steif_options o = steif_defaults();
  o.h = p.t1 / 29;
  steif_solver *s = smooth_open(ctx, &p, "bdf:p=3", &o);
  CHECK(!steif_solve_to(s, p.t1));
  const steif_stats *n = steif_statistics(s);
  CHECK(n->steps == 29 && n->nje == 1 && n->nlu == 3 && n->nsolve == 29 && n->nfe == 30);
  steif_solver_free(&s);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

typedef struct calls {
  long f, jac;
} calls;

static int f(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  ((calls *)user)->f++;
  return smooth.f(t, y, out, NULL);
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
               N_Vector b, N_Vector c)
{
  ((calls *)user)->jac++;
  return smooth.jac(t, y, fy, J, NULL, a, b, c);
}

/* Every call is counted, but the slope at the start: that is part of making the solver. */
static void counters_are_those_of_the_callbacks(void)
{
  static const char *const methods[] = {"radau:s=3", "bdf:p=4", "dirk:trbdf2", "be",
                                        "gauss:s=5", "rk4",     "radau:s=12"};
  static const double h[] = {0, 0, 0, 0.07, 0.07, 0.07, 0.35};
  for (int m = 0; m < 7; m++)
    for (int differences = 0; differences < 2; differences++) {
      calls c = {0};
      steif_context *ctx = steif_context_new(NULL);
      steif_problem p = smooth;
      steif_options o = steif_defaults();
      p.f = f, p.jac = differences ? NULL : jac, p.user = &c, o.h = h[m];
      steif_solver *s = smooth_open(ctx, &p, methods[m], &o);
      CHECK(!steif_solve_to(s, 2));
      const steif_stats *n = steif_statistics(s);
      CHECK(c.f == n->nfe + 1);
      if (!differences && strcmp(methods[m], "rk4")) CHECK(c.jac == n->nje && c.jac > 0);
      CHECK(n->steps > 0 && n->cpu_s >= 0);
      steif_solver_free(&s);
      steif_context_free(&ctx);
    }
}

/* End values of a run with a number of threads; freed by the caller. */
static N_Vector end_of(const char *problem, const char *method, double h, double t1,
                       int threads)
{
  steif_context *ctx = steif_context_new(&(steif_setup){.threads = threads});
  steif_problem p;
  CU_ASSERT_FATAL(!steif_problem_find(ctx, problem, &p));
  steif_options o = steif_defaults();
  o.rtol = 1e-4, o.h = h, o.t1 = t1 > 0 ? t1 : p.t1;
  steif_solver *s = smooth_open(ctx, &p, method, &o);
  CHECK(!steif_solve_to(s, o.t1));
  N_Vector end = N_VNew_Serial(p.n, steif_sundials(ctx));
  N_VScale(1, steif_solution(s), end);
  end->sunctx = NULL; /* outlives its context */
  steif_solver_free(&s);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
  return end;
}

static void equal(N_Vector a, N_Vector b)
{
  CHECK(!memcmp(NV_DATA_S(a), NV_DATA_S(b), (size_t)NV_LENGTH_S(a) * sizeof(double)));
}

static void runs_repeat_bit_for_bit(void)
{
  static const struct {
    const char *problem, *method;
    double h, t1;
  } rows[] = {{"hires", "radau:s=3", 0, 0},        {"vdpol", "bdf:p=5", 0, 0},
              {"chemakzo", "radau:s=5", 0, 0},     {"medakzo:n=100", "dirk:trbdf2", 0, 0},
              {"stiffpair", "gauss:s=3", 0.01, 0}, {"bruss2d:n=32", "radau:s=5", 0, 0.02},
              {"transamp", "radau:s=3", 0, 0.01},  {"heat:n=300", "radau:s=7", 0.01, 0.1}};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    N_Vector run[3];
    for (int k = 0; k < 3; k++)
      run[k] = end_of(rows[i].problem, rows[i].method, rows[i].h, rows[i].t1, k < 2 ? 1 : 2);
    equal(run[0], run[1]);
    equal(run[0], run[2]);
    for (int k = 0; k < 3; k++) N_VDestroy(run[k]);
  }
}

CU_TestInfo tests_of_counts[] = {
  {"linear problems cost one factorisation", linear_problems_cost_one_factorisation},
  {"a ramp costs its orders", a_ramp_costs_its_orders},
  {"counters are those of the callbacks", counters_are_those_of_the_callbacks},
  {"runs repeat bit for bit, on one thread and two", runs_repeat_bit_for_bit},
  CU_TEST_INFO_NULL};
