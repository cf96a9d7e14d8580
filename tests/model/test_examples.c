/* test_examples.c: the models of examples/models by several methods, against end values that were computed
 * by other codes.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fixture.h"

/* Values at the end, of the components 0, 1, ... or of those listed; allowed: relative error at rtol 1e-8. */
typedef struct expected {
  const char *spec, *form;
  int count, component[8];
  double allowed, value[8];
} expected;

/* rober, transamp, akzo: IVP Test Set (F. Mazzia, C. Magherini), reproduced by Radau IIA of 4 and 5 stages;
 * vdpol: the same, from z = 0; orego, brusselator: DOP853 and Radau of SciPy at 1e-12 and 1e-13. */
static const expected models[] = {
  {"rober.steif",
   "ode",
   3,
   {0, 1, 2},
   1e-4,
   {2.08334014970e-8, 8.33336077033e-14, 0.9999999791665}},
  {"vdpol.steif", "ode", 2, {0, 1}, 1e-7, {1.70616773217, -0.892809701025}},
  {"orego.steif", "ode", 3, {0, 1, 2}, 1e-6, {1.00081487032, 1228.17852155, 132.055494285}},
  {"akzo.steif",
   "mass",
   6,
   {0, 1, 2, 3, 4, 5},
   1e-7,
   {0.115079492066, 0.00120383147156, 0.161156288741, 0.000365615642125, 0.0170801088526,
    0.00487353131031}},
  {"transamp.steif",
   "mass",
   8,
   {0, 1, 2, 3, 4, 5, 6, 7},
   1e-6,
   {-0.00556214501226, 3.00652247190, 2.84995878861, 2.92642253621, 2.70461786501,
    2.76183778339, 4.77092763162, 1.23699586809}},
  {"brusselator.steif",
   "ode",
   6,
   {0, 9, 19, 20, 29, 39},
   1e-6,
   {0.87765300972, 0.430660675748, 0.878294321596, 3.15470390907, 3.68901304277,
    3.15785311725}},
  /* The angle equation by mpmath with 16 digits. */
  {"pendulum.steif",
   "mass",
   5,
   {0, 1, 2, 3, 4},
   3e-5,
   {-0.608483930443792, 2.74193539301051, 0.793566195343322, 2.10243787443613,
    17.9076820729608}},
  /* IVP Test Set; after the positions the multipliers, which it does not give. */
  {"caraxis.steif",
   "mass",
   8,
   {0, 1, 2, 3, 6, 7, 8, 9},
   1e-5,
   {0.0493455784275, 0.496989460230, 1.04174252489, 0.373911027265, -0.0770583684041,
    0.00744686658724, 0.0175568157537, 0.770341043779}},
  /* Bounces in closed form: t_k = T + 2 T (e + ... + e^(k-1)), T = sqrt(2/g). */
  {"bounce.steif", "ode", 2, {0, 1}, 3e-7, {0.0687074609657657, -0.0153541333847448}},
  /* DOP853 at 1e-13 and Radau IIA with 6 stages: 11 digits. */
  {"hunters.steif", "ode", 2, {0, 1}, 1e-6, {9.0323603680, 10.9101166869}},
  /* Matrix exponentials between the switchings, 25 digits. */
  {"converter.steif",
   "mass",
   3,
   {0, 1, 2},
   3e-6,
   {1.364343218130264, 5.984448933003333, 0.7658983248299312}},
  /* DOP853 and Radau at 1e-13, restarted at the nodes of the table. */
  {"reactor.steif", "ode", 2, {0, 1}, 1e-7, {0.86765670158, 325.084224557}},
};

static void reach(const expected *e, const char *method)
{
  fixture s;
  CU_ASSERT_FATAL(fixture_example(&s, e->spec) == STEIF_OK);
  const char *form = steif_form_name(steif_problem_form(s.ctx, &s.p));
  if (strcmp(form, e->form)) printf("\n  %s: %s", e->spec, form);
  CU_ASSERT_STRING_EQUAL(form, e->form);
  steif_options o = steif_defaults();
  o.rtol = 1e-8;
  o.max_steps = 200000;
  steif_solver *solver = steif_solver_new(s.ctx, &s.p, method, &o);
  const int code = solver ? steif_solve_to(solver, s.p.t1) : steif_status(s.ctx);
  if (code) printf("\n  %s by %s: %s", e->spec, method, steif_message(s.ctx));
  CHECK(code == STEIF_OK);
  for (int i = 0; !code && i < e->count; i++) {
    const double got = NV_Ith_S(steif_solution(solver), e->component[i]);
    CLOSE(got, e->value[i], e->allowed);
  }
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
