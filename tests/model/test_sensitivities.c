/* test_sensitivities.c: derivatives by parameters of models whose starts do not say them, and without factors.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fixture.h"
#include <math.h>
#include <steif/collection.h>
#include <steif/gradient.h>
#include <steif/parameters.h>
#include <steif/quadrature.h>
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
    well = steif_sensitivity_output(solver, s->p.t1, k, dy) == STEIF_OK;
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
      CHECK(derivatives(&s, "radau:s=3", krylov ? STEIF_KRYLOV : STEIF_DENSE, 1e-8, 1, &S));
      closely("radau:s=3", &S, &exact, 1, 1e-6);
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

static const char rope[] =
  "param L = 1, g = 9.81\nstate x = 0.6, y = 0, u = 1, v = 0, T\ndiscrete taut = 0\n"
  "x' = u\ny' = v\nu' = -x*T\nv' = -y*T - g\n0 = if taut > 0.5 then x^2 + y^2 - L^2 else T\n"
  "when x^2 + y^2 > L^2: taut = 1\nwhen T < 0: taut = 0\ntime 0 to 1\n";

/* A mass falls until its rope is taut, which takes its velocity along the rope away: from index 1 to 3 at an event. Flight in
 * closed form, then L theta'' = -g sin theta with rtol 1e-13 (scipy, DOP853), and differences of that by L and g of the
 * sixth order. */
static void an_event_that_changes_the_index(void)
{
  static const struct {
    const char *method;
    enum steif_storage storage;
    double rtol;
  } runs[] = {{"radau:s=3", STEIF_DENSE, 1e-9},  {"radau:s=7", STEIF_DENSE, 1e-9},
              {"radau:s=5", STEIF_DENSE, 1e-10}, {"radau:s=5", STEIF_SPARSE, 1e-6},
              {"radau:s=7", STEIF_SPARSE, 1e-8}, {"bdf", STEIF_DENSE, 1e-10}};
  static const sunrealtype exact[] = {24.1364026726, -1.86416351976};
  for (size_t r = 0; r < sizeof runs / sizeof *runs; r++) {
    fixture s;
    sunrealtype S[2] = {0};
    CU_ASSERT_FATAL(!fixture_text(&s, rope, ""));
    CHECK(derivatives(&s, runs[r].method, runs[r].storage, runs[r].rtol, 2, S));
    closely(runs[r].method, S, exact, 2, 1e-6);
    fixture_close(&s);
  }
}

/* Methods that do not find multipliers say so where an event asks for some. */
static void multipliers_that_appear_are_refused(void)
{
  static const char *const methods[] = {"gauss:s=3", "dirk:hw43", "rodas4p"};
  fixture s;
  CU_ASSERT_FATAL(!fixture_text(&s, rope, ""));
  for (size_t m = 0; m < sizeof methods / sizeof *methods; m++) {
    steif_options o = steif_defaults();
    o.rtol = 1e-6;
    steif_solver *solver = steif_solver_new(s.ctx, &s.p, methods[m], &o);
    CHECK(solver && steif_solve_to(solver, 1) == STEIF_UNSUPPORTED);
    CHECK(strstr(steif_message(s.ctx), "whose multipliers it does not find") != NULL);
    steif_solver_free(&solver);
  }
  fixture_close(&s);
}

static int force_squared(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  (void)t, (void)user;
  g[0] = NV_Ith_S(y, 4) * NV_Ith_S(y, 4);
  return 0;
}

/* A bead on a circle, turned back at height h: lam = -m w^2 up to t = asin(h/R)/w, then -m e^2 w^2. The derivatives of the
 * integral of lam^2 in closed form, by R, w, m, h and e; behind the event S is divided by the square of a step. */
static void multipliers_behind_an_event(void)
{
  static const char text[] =
    "param R=1.3, w=1, m=0.7, h=0.9, e=0.6\nstate x=R, y=0, u=0, v=R*w, lam\n"
    "x'=u\ny'=v\nm*u'=lam*x\nm*v'=lam*y\n0=x^2+y^2-R^2\n"
    "when y > h:\n u=-e*u\n v=-e*v\nend\ntime 0 to 2.987\n";
  static const char *const methods[] = {"auto", "radau:s=3", "radau:s=5", "bdf"};
  const double R = 1.3, w = 1, m = 0.7, h = 0.9, e = 0.6, t1 = 2.987, te = asin(h / R) / w;
  const double root = sqrt(R * R - h * h) * w, f = m * m * pow(w, 4), less = 1 - pow(e, 4);
  const double J = f * (te * less + pow(e, 4) * t1);
  const double exact[] = {-f * less * h / (R * root), 4 * J / w - f * less * te / w, 2 * J / m,
                          f * less / root, f * 4 * pow(e, 3) * (t1 - te)};
  const steif_quadrature squared = {.count = 1, .value = force_squared};
  for (size_t k = 0; k < sizeof methods / sizeof *methods; k++) {
    fixture s;
    CU_ASSERT_FATAL(!fixture_text(&s, text, ""));
    s.p.quadrature = &squared;
    steif_options o = steif_defaults();
    o.rtol = 1e-7, o.sensitivities = 1;
    steif_solver *solver = steif_solver_new(s.ctx, &s.p, methods[k], &o);
    CU_ASSERT_FATAL(solver && !steif_solve_to(solver, t1));
    for (int i = 0; i < 5; i++) {
      sunrealtype d = NAN;
      CHECK(!steif_quadrature_sensitivity(solver, t1, i, &d));
      CLOSE_FLOOR(d, exact[i], 3e-5, 1);
    }
    steif_solver_free(&solver);
    fixture_close(&s);
  }
}

/* x' = 2 up to p; x' = -c until x < 0.3: S before, at and behind them, where dense output evaluates f anew. */
static void explicit_methods_do_not_look_ahead(void)
{
  fixture s;
  sunrealtype S[2] = {0};
  CU_ASSERT_FATAL(
    !fixture_text(&s, "param p=1.3\nstate x=0\nx'=if t<p then 2 else 0\ntime 0 to 3\n", ""));
  CHECK(derivatives(&s, "dopri87", STEIF_DENSE, 1e-6, 1, S));
  CLOSE(S[0], 2, 1e-9);
  fixture_close(&s);
  CU_ASSERT_FATAL(!fixture_text(&s,
                                "param c=0.7, b=0.5\nstate x=1\ndiscrete s=0\n"
                                "x'=if s>0.5 then b else -c\nwhen x<0.3: s=1\ntime 0 to 2\n",
                                ""));
  steif_options o = steif_defaults();
  o.sensitivities = 1;
  steif_solver *solver = steif_solver_new(s.ctx, &s.p, "dopri87", &o);
  CU_ASSERT_PTR_NOT_NULL_FATAL(solver);
  N_Vector dy = N_VNew_Serial(1, steif_sundials(s.ctx));
  for (int i = 1; i < 16; i++) {
    const double t = i / 8.0;
    CHECK(!steif_solve_to(solver, t));
    for (int k = 0; k < 2; k++) {
      CHECK(!steif_sensitivity(solver, t, k, dy));
      CLOSE_FLOOR(NV_Ith_S(dy, 0), k ? t < 1 ? 0 : t - 1 : t < 1 ? -t : 0.5 / 0.7, 1e-9, 1);
    }
    if (i == 7) i++; /* at 1 itself: either side */
  }
  N_VDestroy(dy);
  steif_solver_free(&solver);
  fixture_close(&s);
}

/* The time of the third firing of a timer is 3 p, that of the only one p; their event functions have gone on behind them. */
static void timers_end_runs(void)
{
  static const struct {
    const char *text;
    double slope;
  } runs[] = {{"param p=0.4\nstate x=1\ndiscrete n=0\nx'=-x\nevery p: n=n+1\n"
               "when n>2.5: stop \"third\"\ntime 0 to 9\n",
               3},
              {"param p=1.2\nstate x=1\nx'=-x\nat p: stop \"once\"\ntime 0 to 3\n", 1}};
  for (size_t r = 0; r < sizeof runs / sizeof *runs; r++) {
    fixture s;
    sunrealtype slope = NAN;
    CU_ASSERT_FATAL(!fixture_text(&s, runs[r].text, ""));
    steif_options o = steif_defaults();
    o.sensitivities = 1;
    steif_solver *solver = steif_solver_new(s.ctx, &s.p, "radau:s=3", &o);
    CU_ASSERT_PTR_NOT_NULL_FATAL(solver);
    CHECK(steif_solve_to(solver, s.p.t1) == STEIF_EVENT);
    CHECK(!steif_sensitivity_event(solver, 0, &slope, NULL));
    CLOSE(slope, runs[r].slope, 1e-9);
    steif_solver_free(&solver);
    fixture_close(&s);
  }
}

/* d/dp of x = 2 p is not in steps that do not end at p. */
static void given_steps_pass_no_breaks(void)
{
  fixture s;
  CU_ASSERT_FATAL(
    !fixture_text(&s, "param p=1.3\nstate x=0\nx'=if t<p then 2 else 0\ntime 0 to 3\n", ""));
  steif_options o = steif_defaults();
  o.h = 0.01, o.sensitivities = 1;
  CHECK(!steif_solver_new(s.ctx, &s.p, "radau:s=3", &o));
  CHECK(steif_status(s.ctx) == STEIF_UNSUPPORTED);
  const steif_functional J = {.count = 1, .end = last};
  steif_gradient g = {0};
  o.sensitivities = 0;
  CHECK(steif_gradient_find(s.ctx, &s.p, "radau:s=3", &o, &J, &g) == STEIF_UNSUPPORTED);
  steif_gradient_free(s.ctx, &g);
  fixture_close(&s);
}

CU_TestInfo tests_of_sensitivities[] = {
  {"multipliers behind an event", multipliers_behind_an_event},
  {"explicit methods do not look ahead", explicit_methods_do_not_look_ahead},
  {"timers that end runs", timers_end_runs},
  {"given steps pass no breaks", given_steps_pass_no_breaks},
  {"an event that changes the index", an_event_that_changes_the_index},
  {"multipliers that appear", multipliers_that_appear_are_refused},
  {"jumps of linear starts", jumps_of_linear_starts},
  {"starts on constraints", starts_on_constraints_have_derivatives},
  {"derivatives of starts follow the equations", derivatives_of_starts_follow_the_equations},
  {"a jump of the start in closed form", a_jump_of_the_start_in_closed_form},
  {"without factors", without_factors},
  {"of DAEs without matrices", of_daes_without_matrices},
  {"gradients without factors", gradients_without_factors},
  CU_TEST_INFO_NULL};
