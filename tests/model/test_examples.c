/* test_examples.c: the models of examples/models by several methods, against the end values that each file has
 * with its source.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fixture.h"

/* digits: what rtol 1e-8 must bring at least, in the worst component of the reference; the index 3 and the
 * multipliers of pendulum and car axis, and instants of events, cost some. */
typedef struct expected {
  const char *spec, *form;
  int known; /* values in the reference */
  double digits;
} expected;

static const expected models[] = {
  {"rober.steif", "ode", 3, 6},        {"vdpol.steif", "ode", 2, 7},
  {"orego.steif", "ode", 3, 7},        {"akzo.steif", "mass", 6, 7},
  {"transamp.steif", "mass", 8, 8},    {"brusselator.steif", "ode", 6, 8},
  {"pendulum.steif", "mass", 5, 4.5},  {"caraxis.steif", "mass", 8, 4.7},
  {"bounce.steif", "ode", 2, 6.5},     {"hunters.steif", "ode", 2, 6},
  {"converter.steif", "mass", 3, 5.5}, {"reactor.steif", "ode", 2, 8},
};

static void reach(const expected *e, const char *method)
{
  fixture s;
  CU_ASSERT_FATAL(fixture_example(&s, e->spec) == STEIF_OK);
  const char *form = steif_form_name(steif_problem_form(s.ctx, &s.p));
  if (strcmp(form, e->form)) printf("\n  %s: %s", e->spec, form);
  CU_ASSERT_STRING_EQUAL(form, e->form);
  CU_ASSERT_PTR_NOT_NULL_FATAL(s.p.reference);
  CHECK(s.p.reference->t == s.p.t1 && s.p.reference->count == e->known);
  CHECK(s.p.reference->digits >= 11 && strlen(s.p.reference->source) > 10);
  steif_options o = steif_defaults();
  o.rtol = 1e-8;
  o.max_steps = 200000;
  steif_solver *solver = steif_solver_new(s.ctx, &s.p, method, &o);
  const int code = solver ? steif_solve_to(solver, s.p.t1) : steif_status(s.ctx);
  if (code) printf("\n  %s by %s: %s", e->spec, method, steif_message(s.ctx));
  CHECK(code == STEIF_OK);
  double scd = 0, mescd = 0;
  if (!code)
    CHECK(!steif_problem_digits(s.ctx, &s.p, s.p.t1, steif_solution(solver), 1, &scd, &mescd));
  if (scd < e->digits) printf("\n  %s by %s: %.2f digits", e->spec, method, scd);
  CHECK(scd >= e->digits);
  steif_solver_free(&solver);
  fixture_close(&s);
}

static void by_auto(void)
{
  for (size_t i = 0; i < sizeof models / sizeof *models; i++) reach(models + i, "auto");
}

static void by_radau(void)
{
  for (size_t i = 0; i < sizeof models / sizeof *models; i++) reach(models + i, "radau:s=3");
}

static void by_bdf(void)
{
  for (size_t i = 0; i < sizeof models / sizeof *models; i++)
    if (strcmp(models[i].spec, "pendulum.steif") && strcmp(models[i].spec, "caraxis.steif"))
      reach(models + i, "bdf"); /* index 3 */
}

/* eps = 0 makes the second equation algebraic: index 1, an impasse at y = 1, t = 3/2 - log 2, since along
 * z = y/(1 - y^2) = y' the time is log y - y^2/2 + const. */
static void parameters_change_the_form(void)
{
  fixture s;
  CU_ASSERT_FATAL(fixture_example(&s, "vdpol.steif:eps=0") == STEIF_OK);
  CHECK(steif_problem_form(s.ctx, &s.p) == STEIF_MASS);
  fixture_close(&s);
}

static void names_reach_the_problem(void)
{
  fixture s;
  CU_ASSERT_FATAL(fixture_example(&s, "brusselator.steif:n=12") == STEIF_OK);
  CHECK(s.p.n == 24);
  CU_ASSERT_STRING_EQUAL(s.p.names->unknown[0], "u[1]");
  CU_ASSERT_STRING_EQUAL(s.p.names->unknown[23], "v[12]");
  fixture_close(&s);
}

CU_TestInfo tests_of_examples[] = {
  {"by auto", by_auto},
  {"by radau with 3 stages", by_radau},
  {"by bdf", by_bdf},
  {"a parameter changes the form", parameters_change_the_form},
  {"sizes and names follow parameters", names_reach_the_problem},
  CU_TEST_INFO_NULL};
