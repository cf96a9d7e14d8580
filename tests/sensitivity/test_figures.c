/* test_figures.c: S of problems of the collection and of models, against figures of Radau IIA with 5 to 9 stages in
 * 113-bit arithmetic, in which two numbers of stages agree.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "forcing.h"

static const char *const methods[] = {"radau:s=3", "radau:s=5", "gauss:s=3", "bdf",
                                      "dirk:hw43"};

/* Methods of high order at 1e-10; BDF and DIRK, whose order is 4 or 5, at 1e-8. */
static void columns(steif_context *ctx, const steif_problem *p, int m, sunrealtype t, int i,
                    int count, const sunrealtype *expected, sunrealtype more)
{
  sunrealtype S[64];
  steif_options o = steif_defaults();
  o.rtol = m < 3 ? 1e-10 : 1e-8, o.t1 = t, o.sensitivities = 1;
  for (int k = 0; k < count; k++) {
    sensitivity_at(ctx, p, methods[m], &o, k, t, S, NULL);
    const sunrealtype error = more * (m < 3 ? 1e-8 : 1e-6);
    if (!(fabs(S[i] - expected[k]) <= error * fabs(expected[k])))
      printf("\n  %s %s:", p->name, methods[m]);
    CLOSE(S[i], expected[k], error);
  }
}

static void all(const char *name, int used, sunrealtype t, int i, int count,
                const sunrealtype *expected, sunrealtype more)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  CU_ASSERT_FATAL(!steif_problem_find(ctx, name, &p));
  for (int m = 0; m < used; m++) columns(ctx, &p, m, t, i, count, expected, more);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

static void akzo_nobel(void)
{
  static const sunrealtype y1[] = {-0.0020003685178, -7.8330066609e-4, -7.9194689421e-5,
                                   7.4287278797e-4,  -4.0862217303e-6, -9.7677625042e-4,
                                   5.3873188457e-6,  -0.024144554769,  2.9484530926e-5},
                           y6[] = {-3.2320134277e-4, -0.0027698049160, -4.7030513468e-4,
                                   0.0077225658925,  -1.5137682341e-4, 7.1177983180e-5,
                                   9.8078966243e-5,  -0.0012990640875, 1.5863740553e-6};
  all("chemakzo", 5, 180, 0, 9, y1, 1);
  all("chemakzo", 2, 180, 5, 9, y6, 1); /* algebraic: damped by Radau only */
}

/* dy1/dp at 10. */
static void hunters_and_hunted(void)
{
  static const char text[] = "param a = 1.5, b = 1, c = 3, d = 1\nstate x = 1, y = 1\n"
                             "x' = a*x - b*x*y\ny' = d*x*y - c*y\ntime 0 to 10\n";
  static const sunrealtype x[] = {2.16055752356262, 0.188568777078059, 0.563182794168198,
                                  0.939651287153080};
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  CU_ASSERT_FATAL(!steif_model_parse(ctx, text, "hunters", NULL, &p));
  for (int m = 0; m < 5; m++) columns(ctx, &p, m, 10, 0, 4, x, 10);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* Up to the first jump, and two jumps later, where the absolute tolerance of S, that of y over 1e-6, is 1e-4. */
static void van_der_pol(void)
{
  static const char text[] = "param eps = 1e-6\nstate x = 2, z = -0.66\nx' = z\n"
                             "z' = ((1 - x^2)*z - x)/eps\ntime 0 to 2\n";
  static const sunrealtype early[] = {0.216565272968591}, late[] = {412.59488239};
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  CU_ASSERT_FATAL(!steif_model_parse(ctx, text, "relaxation", NULL, &p));
  columns(ctx, &p, 0, 0.5, 0, 1, early,
          3); /* of S the tolerance allows 1e-4 absolute, atol/eps */
  columns(ctx, &p, 1, 0.5, 0, 1, early, 3);
  columns(ctx, &p, 0, 2, 0, 1, late, 1000);
  columns(ctx, &p, 1, 2, 0, 1, late, 1000);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

static void brusselator(void)
{
  static const sunrealtype v10[] = {5.17671755933, 0.445278498534, -17.9802091259};
  all(EXAMPLES "/brusselator.steif", 5, 10, 29, 3, v10, 1);
}

CU_TestInfo tests_of_figures[] = {{"Akzo Nobel", akzo_nobel},
                                  {"hunters and hunted", hunters_and_hunted},
                                  {"van der Pol", van_der_pol},
                                  {"the Brusselator", brusselator},
                                  CU_TEST_INFO_NULL};
