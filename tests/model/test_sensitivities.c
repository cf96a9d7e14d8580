/* test_sensitivities.c: derivatives by parameters of models whose starts do not say them, and without factors.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fixture.h"
#include <math.h>
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

CU_TestInfo tests_of_sensitivities[] = {
  {"derivatives of starts follow the equations", derivatives_of_starts_follow_the_equations},
  {"a jump of the start in closed form", a_jump_of_the_start_in_closed_form},
  {"without factors", without_factors},
  CU_TEST_INFO_NULL};
