/* test_forward.c: S against figures and closed forms, with errors tested.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "forcing.h"

static const char *const methods[] = {"radau:s=3", "radau:s=5", "gauss:s=3"};
enum { METHODS = sizeof methods / sizeof *methods };

/* Robertson: rows y, columns k1, k2, k3. Radau IIA with 5 to 9 stages in 113-bit arithmetic; two numbers of
 * stages agree in all digits. */
static const struct {
  sunrealtype t, S[3][3];
} table[] = {{0.4,
              {{-0.355952565982856, 9.54238142784977e-8, -1.58317663555763e-11},
               {3.90254405381822e-4, -2.13096103019365e-10, -5.29004109321481e-13},
               {0.355562311577474, -9.52107181754783e-8, 1.63607704648978e-11}}},
             {40,
              {{-4.24755877170573, 1.37308079734462e-5, -2.28835508890567e-9},
               {4.59119624925389e-5, -2.35719211384633e-10, -1.13805950935013e-13},
               {4.24751285974324, -1.37305722542349e-5, 2.28846889485660e-9}}},
             {4000,
              {{-4.75007118104822, 1.88088615855752e-5, -3.13481339098243e-9},
               {-5.99365171387680e-6, 2.31268734393446e-11, -1.87584661075622e-14},
               {4.75007717469994, -1.88088847124486e-5, 3.13483214944854e-9}}}};

static void robertson(steif_context *ctx, const char *form, const char *method, int i,
                      sunrealtype rtol, sunrealtype error)
{
  steif_problem p;
  sunrealtype S[3];
  steif_options o = steif_defaults();
  CU_ASSERT_FATAL(!steif_problem_find(ctx, form, &p));
  o.rtol = rtol, o.t1 = table[i].t, o.sensitivities = 1;
  for (int k = 0; k < 3; k++) {
    sensitivity_at(ctx, &p, method, &o, k, o.t1, S, NULL);
    for (int j = 0; j < 3; j++) CLOSE(S[j], table[i].S[j][k], error);
  }
  steif_problem_clear(ctx, &p);
}

/* The mass form by Radau only: others have y3 = 1 - y1 - y2 at rounding there, without S too. */
static void robertson_to_eight_digits(void)
{
  static const char *const forms[] = {"rober", "rober:form=mass"};
  steif_context *ctx = steif_context_new(NULL);
  for (int form = 0; form < 2; form++)
    for (int i = 0; i < 3; i++) {
      for (int m = 0; m < METHODS - form; m++)
        robertson(ctx, forms[form], methods[m], i, 1e-10, 1e-8);
      if (!form) robertson(ctx, "rober", "bdf", i, 1e-8, 1e-6);
    }
  robertson(ctx, "rober", "dirk:hw43", 0, 1e-8, 1e-6);
  for (int i = 0; i < 3; i++) robertson(ctx, "rober", "dirk:esdirk43", i, 1e-8, 1e-6);
  steif_context_free(&ctx);
}

/* Seen only by the test of errors of S: x = 0 for all t. S(20) = (sin 200 - 10 cos 200 + 10 e^-20) / 101. */
static void what_y_does_not_show_is_tested(void)
{
  steif_context *ctx = steif_context_new(NULL);
  struct forcing F;
  forcing_open(&F, 0);
  static const char *const all[] = {"radau:s=3", "gauss:s=3", "bdf", "dirk:hw43",
                                    "dirk:esdirk43"};
  for (int m = 0; m < 5; m++)
    for (int nonlinear = 0; nonlinear < 2; nonlinear++) {
      sunrealtype S;
      steif_options o = steif_defaults();
      steif_sensitivity_cost cost;
      F.problem.linear = !nonlinear;
      o.sensitivities = 1, o.rtol = 1e-8;
      sensitivity_at(ctx, &F.problem, all[m], &o, 1, 20, &S, &cost);
      CLOSE(S, -0.0568829111551734, 1e-6);
      CHECK(cost.tested && cost.columns == 3);
      sensitivity_at(ctx, &F.problem, all[m], &o, 2, 20, &S, NULL);
      CLOSE_FLOOR(S, exp(-20), 1e-7, 1);
    }
  steif_context_free(&ctx);
}

/* Linear problems: the factors are those of the equations of S, one sweep a step does. */
static void linear_problems_take_one_solve(void)
{
  static const struct {
    const char *spec;
    long sweeps; /* in a step */
  } of[] = {{"radau:s=3", 1}, {"gauss:s=3", 1}, {"bdf:p=5", 1}, {"dirk:esdirk43", 5}};
  steif_context *ctx = steif_context_new(NULL);
  struct forcing F;
  forcing_open(&F, 0);
  F.p[1] = 1, F.y0[0] = 1;
  for (size_t m = 0; m < sizeof of / sizeof *of; m++) {
    sunrealtype S;
    steif_options o = steif_defaults();
    steif_sensitivity_cost cost;
    o.sensitivities = 1, o.h = 0.01, o.t1 = 2;
    sensitivity_at(ctx, &F.problem, of[m].spec, &o, 2, 2, &S, &cost);
    CLOSE(S, exp(-2), m == 2 ? 1e-3 : 1e-9); /* BDF begins with order 1 */
    CHECK(cost.sweeps == 200 * of[m].sweeps && cost.jacobians == 0);
  }
  steif_context_free(&ctx);
}

/* The order of S is that of y: d/da of x' = -a x + b sin 10 t at a = b = 1, by halving h. */
static void order_is_that_of_the_method(void)
{
  static const struct {
    const char *spec;
    int order;
  } of[] = {{"radau:s=2", 3},     {"radau:s=3", 5}, {"gauss:s=2", 4},
            {"lobatto3c:s=3", 4}, {"dirk:hw43", 4}, {"dirk:alexander2", 2}};
  steif_context *ctx = steif_context_new(NULL);
  struct forcing F;
  forcing_open(&F, 0);
  F.p[1] = 1;
  for (size_t m = 0; m < sizeof of / sizeof *of; m++) {
    sunrealtype S[3];
    for (int i = 0; i < 3; i++) {
      steif_options o = steif_defaults();
      o.sensitivities = 1, o.t1 = 2, o.h = 0.0125 / (1 << i);
      sensitivity_at(ctx, &F.problem, of[m].spec, &o, 0, 2, S + i, NULL);
    }
    const sunrealtype order = log2((S[0] - S[1]) / (S[1] - S[2]));
    CLOSE(order, of[m].order, 0.1);
  }
  steif_context_free(&ctx);
}

/* y_i and its derivatives by all parameters of a model, by Radau IIA with two numbers of stages in 113-bit
 * arithmetic. */
static void model(const char *path, const char *method, sunindextype i, int count,
                  const sunrealtype *expected)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  sunrealtype S[64];
  steif_options o = steif_defaults();
  CU_ASSERT_FATAL(!steif_problem_find(ctx, path, &p));
  o.sensitivities = 1, o.rtol = 1e-9;
  for (int k = 0; k < count; k++) {
    sensitivity_at(ctx, &p, method, &o, k, p.t1, S, NULL);
    CLOSE(S[i], expected[k], 1e-6);
  }
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* Akzo Nobel, index 1, whose start depends on parameters: y1 and y6 at 180. The Brusselator, banded: v_10 at
 * 10. */
static void models_as_text(void)
{
  static const sunrealtype y1[] = {-0.0020003685178, -7.8330066609e-4, -7.9194689421e-5,
                                   7.4287278797e-4,  -4.0862217303e-6, -9.7677625042e-4,
                                   5.3873188457e-6,  -0.024144554769,  2.9484530926e-5};
  static const sunrealtype y6[] = {-3.2320134277e-4, -0.0027698049160, -4.7030513468e-4,
                                   0.0077225658925,  -1.5137682341e-4, 7.1177983180e-5,
                                   9.8078966243e-5,  -0.0012990640875, 1.5863740553e-6};
  static const sunrealtype v10[] = {5.17671755933, 0.445278498534, -17.9802091259};
  static const char akzo[] = EXAMPLES "/akzo.steif",
                    brusselator[] = EXAMPLES "/brusselator.steif";
  model(akzo, "radau:s=3", 0, 9, y1);
  model(akzo, "radau:s=5", 5, 9, y6);
  model(brusselator, "radau:s=3", 29, 3, v10);
  model(brusselator, "radau:s=5", 29, 3, v10);
}

CU_TestInfo tests_of_forward[] = {
  {"models as text", models_as_text},
  {"Robertson to eight digits", robertson_to_eight_digits},
  {"what y does not show is tested", what_y_does_not_show_is_tested},
  {"linear problems take one solve", linear_problems_take_one_solve},
  {"the order is that of the method", order_is_that_of_the_method},
  CU_TEST_INFO_NULL};
