/* test_sensitivities.c: derivatives by parameters of models whose starts do not say them, and without factors.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fixture.h"
#include <math.h>
#include <steif/collection.h>
#include <steif/gradient.h>
#include <steif/hessian.h>
#include <steif/parameters.h>
#include <steif/sensitivity.h>

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
      CHECK(
        fixture_derivatives(&s, methods[m], sparse ? STEIF_SPARSE : STEIF_DENSE, 1e-6, 6, S));
      fixture_closely(methods[m], S, exact, 6, 1e-4);
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
      CHECK(
        fixture_derivatives(&s, methods[m], sparse ? STEIF_SPARSE : STEIF_DENSE, 1e-8, 1, &S));
      fixture_closely(methods[m], &S, &exact, 1, 1e-6);
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
    CHECK(fixture_derivatives(&s, methods[m], STEIF_SPARSE, 1e-8, 3, sparse));
    CHECK(fixture_derivatives(&s, methods[m], STEIF_KRYLOV, 1e-8, 3, S));
    fixture_closely(methods[m], S, sparse, 3, 1e-6);
    s.p.jac = NULL;
    if (products) CHECK(fixture_derivatives(&s, methods[m], STEIF_KRYLOV, 1e-8, 3, S));
    fixture_closely(methods[m], S, sparse, 3, 1e-6);
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

/* x' = -k x and y = 2 x^2, or y = 2 x where the model is linear, in the three forms with E: dy/dk(1) is -4 e^(-2 k) or
 * -2 e^(-k). In the second x'^2 x^2/4 stands on both sides. */
static void of_daes_without_matrices(void)
{
  static const char *const texts[] = {
    "param k = 1.5\nstate x = 1, y = 2\nx' = -k*x\n0 = y - 2*x^2\ntime 0 to 1\n",
    "param k = 1.5\nstate x = 1, y = 2\nx' + y*x'^3/8 = -k*x*(1 + x^2*x'^2/4)\n0 = y - "
    "2*x^2\ntime 0 to 1\n",
    "form descriptor\nparam k = 1.5\nstate x = 1, y = 2\nx' = -k*x\n0 = y - 2*x\ntime 0 to "
    "1\n"};
  for (int i = 0; i < 3; i++) {
    fixture s;
    CU_ASSERT_FATAL(!fixture_text(&s, texts[i], ""));
    for (int krylov = 0; krylov < 2; krylov++) {
      const sunrealtype exact = i < 2 ? -4 * exp(-3) : -2 * exp(-1.5);
      sunrealtype S = 0;
      CHECK(
        fixture_derivatives(&s, "radau:s=3", krylov ? STEIF_KRYLOV : STEIF_DENSE, 1e-8, 1, &S));
      fixture_closely("radau:s=3", &S, &exact, 1, 1e-6);
    }
    back(s.ctx, &s.p, "radau:s=3", 1);
    fixture_close(&s);
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
    CHECK(fixture_derivatives(&s, methods[m], STEIF_DENSE, 1e-7, 2, S));
    fixture_closely(methods[m], S, (sunrealtype[]){0.75, -0.25}, 2, 1e-6);
    fixture_close(&s);
    for (int consistent = 0; consistent < 2; consistent++) { /* for k = 3 alone */
      CU_ASSERT_FATAL(
        !fixture_text(&s,
                      consistent ? "param k = 3\nstate x = 1, y = 3\n0 = k*x - y\nx' = -x\n"
                                   "time 0 to 1\n"
                                 : "param k = 3\nstate x = 1, y = 2\n0 = k*x - y\nx' = -x\n"
                                   "time 0 to 1\n",
                      ""));
      CHECK(fixture_derivatives(&s, methods[m], STEIF_DENSE, 1e-8, 1, S));
      fixture_closely(methods[m], S, (sunrealtype[]){0.36787944117144233}, 1, 1e-6);
      fixture_close(&s);
    }
  }
}

/* A base that is 0 at the start: y(1) = k (1 - log 2) for n = 1, and dy/dn is k times the integral of t log t/(1 + t)^2
 * over [0, 1], log 2 - pi^2/12. A base below 0 with a whole exponent has a derivative by k, (t - 1)^4/4 - 1/4. */
static void powers_of_0(void)
{
  static const sunrealtype exact[] = {-0.12931985286416791, 0.30685281944005469};
  static const char *const methods[] = {"radau:s=3", "bdf"};
  for (size_t m = 0; m < 2; m++) {
    fixture s;
    sunrealtype S[2] = {0};
    CU_ASSERT_FATAL(!fixture_text(
      &s, "param n = 1, k = 1\nstate y = 0\ny' = k*t^n/(1+t^n)\ntime 0 to 1\n", ""));
    CHECK(fixture_derivatives(&s, methods[m], STEIF_DENSE, 1e-9, 2, S));
    fixture_closely(methods[m], S, exact, 2, 1e-6);
    fixture_close(&s);
    CU_ASSERT_FATAL(
      !fixture_text(&s, "param k = 2, n = 3\nstate y = 0\ny' = k*(t-1)^n\ntime 0 to 1\n", ""));
    const int first = 0;
    steif_options o = steif_defaults();
    o.sensitivities = 1, o.active = &first, o.active_count = 1;
    steif_solver *solver = steif_solver_new(s.ctx, &s.p, methods[m], &o);
    N_Vector dy = N_VNew_Serial(1, steif_sundials(s.ctx));
    CHECK(solver && steif_solve_to(solver, 1) == STEIF_OK);
    CHECK(steif_sensitivity(solver, 1, 0, dy) == STEIF_OK);
    CLOSE(NV_Ith_S(dy, 0), -0.25, 1e-6);
    N_VDestroy(dy);
    steif_solver_free(&solver);
    fixture_close(&s);
  }
}

/* d sqrt(q)/dq at q = 0: said at once, with the parameter and the place. */
static void no_derivative_at_0(void)
{
  fixture s;
  CU_ASSERT_FATAL(!fixture_text(
    &s, "param k = 1, q = 0\nstate y = 1\ny' = -k*y + sqrt(q)\ntime 0 to 1\n", ""));
  for (int k = 0; k < 2; k++) {
    steif_options o = steif_defaults();
    o.sensitivities = 1, o.active = &k, o.active_count = 1;
    steif_solver *solver = steif_solver_new(s.ctx, &s.p, "radau:s=3", &o);
    CHECK(k == 0 ? solver && steif_solve_to(solver, 1) == STEIF_OK
                 : !solver || steif_solve_to(solver, 1) == STEIF_NOT_FINITE);
    CHECK(!k || strstr(steif_message(s.ctx), "dF/dp of parameter 2 ('q')"));
    CHECK(!k || strstr(steif_message(s.ctx), "this parameter has no derivative there"));
    steif_solver_free(&solver);
  }
  fixture_close(&s);
}

static int first(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  (void)t, (void)user;
  g[0] = NV_Ith_S(y, 0);
  return 0;
}

/* The second derivatives of x(1) in closed form: of exp(-k^2), of A sin(w)/w, of k^2/e, whose curvature lies in the
 * equation, in its derivative by a parameter that stands beside another, in the start. */
static void second_derivatives_in_closed_form(void)
{
  static const struct {
    const char *text;
    sunrealtype Hv[2];
  } of[] = {
    {"param k=1.5\nstate x=1\nx'=-k^2*x\ntime 0 to 1\n", {0.73779457314}},
    {"param A=1.2, w=2\nstate x=0\nx'=A*cos(w*t)\ntime 0 to 1\n", {0, -0.43539777497999}},
    {"param k=1.5\nstate x=k^2\nx'=-x\ntime 0 to 1\n", {0.73575888234288}}};
  static const char *const methods[] = {"radau:s=3", "dirk:hw43", "bdf:p=3"};
  static const sunrealtype rtol[] = {1e-10, 1e-9, 1e-9};
  const steif_functional J = {.count = 1, .end = first};
  for (size_t i = 0; i < sizeof of / sizeof *of; i++)
    for (size_t m = 0; m < sizeof methods / sizeof *methods; m++) {
      const sunrealtype v[] = {1, 0};
      sunrealtype Hv[2] = {0};
      fixture s;
      CU_ASSERT_FATAL(!fixture_text(&s, of[i].text, ""));
      steif_options o = steif_defaults();
      steif_gradient g = {0};
      o.rtol = rtol[m];
      steif_direction *d = steif_direction_new(s.ctx, &s.p, v, NULL);
      const int code = steif_hessian_product(s.ctx, d, methods[m], &o, &J, &g, Hv, NULL);
      if (code) printf("\n  %s: %s", methods[m], steif_message(s.ctx));
      CU_ASSERT_FATAL(code == STEIF_OK);
      for (int k = 0; k < g.parameters; k++) CLOSE_FLOOR(Hv[k], of[i].Hv[k], 1e-6, 1);
      steif_gradient_free(s.ctx, &g), steif_direction_free(&d);
      fixture_close(&s);
    }
}

CU_TestInfo tests_of_sensitivities[] = {
  {"powers of 0", powers_of_0},
  {"no derivative at 0", no_derivative_at_0},
  {"jumps of linear starts", jumps_of_linear_starts},
  {"starts on constraints", starts_on_constraints_have_derivatives},
  {"derivatives of starts follow the equations", derivatives_of_starts_follow_the_equations},
  {"a jump of the start in closed form", a_jump_of_the_start_in_closed_form},
  {"without factors", without_factors},
  {"of DAEs without matrices", of_daes_without_matrices},
  {"gradients without factors", gradients_without_factors},
  {"second derivatives in closed form", second_derivatives_in_closed_form},
  CU_TEST_INFO_NULL};
