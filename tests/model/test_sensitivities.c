/* test_sensitivities.c: derivatives by parameters of models whose starts do not say them, and without factors.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fixture.h"
#include <math.h>
#include <steif/collection.h>
#include <steif/gradient.h>
#include <steif/parameters.h>
#include <steif/sensitivity.h>

/* S of the last unknown by the first `count` parameters at the end; false: not solved. */
static bool derivatives(fixture *s, const char *method, enum steif_storage storage, double rtol,
                        int count, sunrealtype *S)
{
  steif_options o = steif_defaults();
  o.rtol = rtol, o.sensitivities = 1, o.force_storage = 1, o.storage = storage;
  steif_solver *solver = steif_solver_new(s->ctx, &s->p, method, &o);
  bool well = solver && steif_solve_to(solver, s->p.t1) == STEIF_OK;
  N_Vector dy = N_VNew_Serial(s->p.n, steif_sundials(s->ctx));
  for (int k = 0; well && k < count; k++) {
    well = steif_sensitivity(solver, s->p.t1, k, dy) == STEIF_OK;
    S[k] = NV_Ith_S(dy, s->p.n - 1);
  }
  if (!well) printf("\n  %s: %s", method, steif_message(s->ctx));
  N_VDestroy(dy);
  steif_solver_free(&solver);
  return well;
}

static void closely(const char *method, const sunrealtype *S, const sunrealtype *exact,
                    int count, double error)
{
  for (int k = 0; k < count; k++) {
    const bool close = fabs(S[k] - exact[k]) <= error * fabs(exact[k]);
    if (!close) printf("\n  %s, parameter %d: %.12g, not %.12g", method, k + 1, S[k], exact[k]);
    CHECK(close);
  }
}

/* transamp: its start is consistent for one supply voltage Ub, and its matrix E of capacitors has no zero rows. By
 * Ub, Uf, alpha, beta, R0 and R at rtol 1e-8: rodas5p and hw43, which agree in eight digits. */
static void derivatives_of_starts_follow_the_equations(void)
{
  static const sunrealtype exact[] = {0.26535820, -2.3163375,     2.0743050,
                                      14933.6473, -1.43724873e-5, -1.85539703e-5};
  static const char *const methods[] = {"bdf", "radau:s=3", "auto"};
  fixture s;
  CU_ASSERT_FATAL(fixture_example(&s, "transamp.steif") == STEIF_OK);
  for (size_t m = 0; m < sizeof methods / sizeof *methods; m++)
    for (int sparse = 0; sparse < 2; sparse++) {
      sunrealtype S[6] = {0};
      CHECK(derivatives(&s, methods[m], sparse ? STEIF_SPARSE : STEIF_DENSE, 1e-6, 6, S));
      closely(methods[m], S, exact, 6, 1e-4);
    }
  fixture_close(&s);
}

/* a + b = s is held by the jump of the start, 0 = b - p a behind it: b = p s / (1 + p) exp(-t / (1 + p)), in closed form. No
 * row of E is without entries. */
static void a_jump_of_the_start_in_closed_form(void)
{
  static const char *const methods[] = {"radau:s=3", "bdf", "rodas4p", "dirk:hw43",
                                        "gauss:s=3"};
  static const char text[] = "param p = 2\nstate a = 1, b = 2\nlet r = b - p*a\n"
                             "a' + b' = -a\na' + b' = -a + r + r^2\ntime 0 to 1\n";
  const double p = 2, s0 = 3, e = exp(-1 / (1 + p)), d = 1 / (1 + p);
  const sunrealtype exact = s0 * e * d * d * (1 + p * d);
  fixture s;
  CU_ASSERT_FATAL(fixture_text(&s, text, "") == STEIF_OK);
  for (size_t m = 0; m < sizeof methods / sizeof *methods; m++)
    for (int sparse = 0; sparse < 2; sparse++) {
      sunrealtype S = 0;
      CHECK(derivatives(&s, methods[m], sparse ? STEIF_SPARSE : STEIF_DENSE, 1e-8, 1, &S));
      closely(methods[m], &S, &exact, 1, 1e-6);
    }
  fixture_close(&s);
}

/* Factors of ILU(0) beside exact matrices, and nothing but differences of f along vectors. */
static void without_factors(void)
{
  static const char *const methods[] = {"bdf",       "radau:s=3", "gauss:s=3",
                                        "dirk:hw43", "rodas4p",   "glm:irks"};
  fixture s;
  CU_ASSERT_FATAL(fixture_example(&s, "brusselator.steif:n=20") == STEIF_OK);
  for (size_t m = 0; m < sizeof methods / sizeof *methods; m++) {
    const bool products = strcmp(methods[m], "rodas4p") != 0; /* which needs jac */
    const steif_problem given = s.p;
    sunrealtype sparse[3] = {0}, S[3] = {0};
    CHECK(derivatives(&s, methods[m], STEIF_SPARSE, 1e-8, 3, sparse));
    CHECK(derivatives(&s, methods[m], STEIF_KRYLOV, 1e-8, 3, S));
    closely(methods[m], S, sparse, 3, 1e-6);
    s.p.jac = NULL;
    if (products) CHECK(derivatives(&s, methods[m], STEIF_KRYLOV, 1e-8, 3, S));
    closely(methods[m], S, sparse, 3, 1e-6);
    s.p = given;
  }
  fixture_close(&s);
}

static int last(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  (void)t, (void)user;
  g[0] = NV_Ith_S(y, NV_LENGTH_S(y) - 1);
  return 0;
}

/* dJ/dp and dJ/dy0 of y_n(t1) by GMRES, factors, and the columns forward, in the same prescribed steps. */
static void back(steif_context *ctx, const steif_problem *p, const char *method, double t1)
{
  static const enum steif_storage storage[] = {STEIF_KRYLOV, STEIF_SPARSE};
  const steif_functional J = {.count = 1, .end = last};
  steif_gradient g[2] = {{0}};
  steif_options o = steif_defaults();
  o.t1 = t1, o.h = t1 / 20, o.newton = 1e-8, o.force_storage = 1;
  for (int k = 0; k < 2; k++) {
    o.storage = storage[k];
    const int code = steif_gradient_find(ctx, p, method, &o, &J, &g[k]);
    if (code) printf("\n  %s, %s: %s", p->name, method, steif_message(ctx));
    CU_ASSERT_FATAL(code == STEIF_OK);
  }
  double most = 0;
  for (sunindextype i = 0; i < p->n; i++) most = fmax(most, fabs(g[1].dy0[i]));
  for (sunindextype i = 0; i < p->n; i++) CLOSE_FLOOR(g[0].dy0[i], g[1].dy0[i], 1e-8, most);
  o.storage = STEIF_KRYLOV, o.sensitivities = p->parameters != NULL;
  steif_solver *forward = steif_solver_new(ctx, p, method, &o);
  CU_ASSERT_FATAL(forward && steif_solve_to(forward, t1) == STEIF_OK);
  N_Vector S = N_VNew_Serial(p->n, steif_sundials(ctx));
  for (int k = 0; k < g[0].parameters; k++) {
    CHECK(steif_sensitivity(forward, t1, k, S) == STEIF_OK);
    CLOSE_FLOOR(g[0].dp[k], NV_Ith_S(S, p->n - 1), 1e-11, N_VMaxNorm(S));
    CLOSE_FLOOR(g[0].dp[k], g[1].dp[k], 1e-8, N_VMaxNorm(S));
  }
  N_VDestroy(S);
  steif_solver_free(&forward);
  steif_gradient_free(ctx, &g[0]), steif_gradient_free(ctx, &g[1]);
}

static void gradients_without_factors(void)
{
  static const char *const methods[] = {"bdf:p=2", "radau:s=3", "radau:s=5", "dirk:hw43"};
  static const char *const grids[] = {"bruss2d:n=6", "heat:n=40"};
  for (size_t m = 0; m < sizeof methods / sizeof *methods; m++) {
    fixture s;
    CU_ASSERT_FATAL(fixture_example(&s, "brusselator.steif:n=50") == STEIF_OK);
    back(s.ctx, &s.p, methods[m], 1);
    fixture_close(&s);
    for (int k = 0; k < 2; k++) {
      steif_context *ctx = steif_context_new(NULL);
      steif_problem p;
      CU_ASSERT_FATAL(steif_problem_find(ctx, grids[k], &p) == STEIF_OK);
      back(ctx, &p, methods[m], k ? 0.05 : 0.5);
      steif_problem_clear(ctx, &p);
      steif_context_free(&ctx);
    }
  }
}

/* A pendulum of index 3 from a place that a parameter says: x^2 + y^2 = 1 stays true of its derivatives, and the start that
 * is computed is accurate to its tolerance alone. */
static void starts_on_constraints_have_derivatives(void)
{
  static const char text[] =
    "param x0 = 0.8, g = 9.81\nstate x = x0, y ~ -0.6, u ~ 0, v ~ 0, T\nx' = u\ny' = v\n"
    "u' = -T*x\nv' = -T*y - g\nrod: 0 = x^2 + y^2 - 1\ntime 0 to 1\n";
  fixture s;
  CU_ASSERT_FATAL(!fixture_text(&s, text, ""));
  steif_options o = steif_defaults();
  o.rtol = 1e-9, o.sensitivities = 1;
  steif_solver *solver = steif_solver_new(s.ctx, &s.p, "radau:s=5", &o);
  CU_ASSERT_PTR_NOT_NULL_FATAL(solver);
  N_Vector S = N_VClone(steif_solution(solver));
  CHECK(!steif_solve_to(solver, 1) && !steif_sensitivity(solver, 1, 0, S));
  const double *y = N_VGetArrayPointer(steif_solution(solver)), *d = N_VGetArrayPointer(S);
  CLOSE_FLOOR(y[0] * d[0] + y[1] * d[1], 0, 1e-8, 1);
  CLOSE(d[0], -0.946539, 1e-5); /* by differences of runs, 1e-11 */
  N_VDestroy(S);
  steif_solver_free(&solver);
  fixture_close(&s);
}

/* Two capacitors put together at the start, a linear system of index 2: v = 4 C1/(C1 + C2), whose derivatives are
 * 4 C2/(C1 + C2)^2 and -4 C1/(C1 + C2)^2; and y = k x of index 1, y by k exp(-1). */
static void jumps_of_linear_starts(void)
{
  static const char *const methods[] = {"radau:s=3", "bdf", "radau:s=5"};
  fixture s;
  for (size_t m = 0; m < sizeof methods / sizeof *methods; m++) {
    sunrealtype S[2] = {0};
    CU_ASSERT_FATAL(!fixture_text(&s,
                                  "param C1 = 1, C2 = 3\nstate i = 0, v1 = 4, v2 = 0\n"
                                  "C1*v1' = -i\nC2*v2' = i\n0 = v1 - v2\ntime 0 to 1\n",
                                  ""));
    CHECK(derivatives(&s, methods[m], STEIF_DENSE, 1e-7, 2, S));
    closely(methods[m], S, (sunrealtype[]){0.75, -0.25}, 2, 1e-6);
    fixture_close(&s);
    for (int consistent = 0; consistent < 2; consistent++) { /* for k = 3 alone */
      CU_ASSERT_FATAL(
        !fixture_text(&s,
                      consistent ? "param k = 3\nstate x = 1, y = 3\n0 = k*x - y\nx' = -x\n"
                                   "time 0 to 1\n"
                                 : "param k = 3\nstate x = 1, y = 2\n0 = k*x - y\nx' = -x\n"
                                   "time 0 to 1\n",
                      ""));
      CHECK(derivatives(&s, methods[m], STEIF_DENSE, 1e-8, 1, S));
      closely(methods[m], S, (sunrealtype[]){0.36787944117144233}, 1, 1e-6);
      fixture_close(&s);
    }
  }
}

CU_TestInfo tests_of_sensitivities[] = {
  {"jumps of linear starts", jumps_of_linear_starts},
  {"starts on constraints", starts_on_constraints_have_derivatives},
  {"derivatives of starts follow the equations", derivatives_of_starts_follow_the_equations},
  {"a jump of the start in closed form", a_jump_of_the_start_in_closed_form},
  {"without factors", without_factors},
  {"gradients without factors", gradients_without_factors},
  CU_TEST_INFO_NULL};
