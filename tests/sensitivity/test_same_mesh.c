/* test_same_mesh.c: S is the derivative of the numbers that a run returns: against central differences of
 * runs on the same mesh, two of them extrapolated.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "forcing.h"

enum { STEPS = 40 };

static void mesh_of(sunrealtype *mesh)
{
  mesh[0] = 0;
  for (int i = 1; i <= STEPS; i++) mesh[i] = 40 * pow(10, -6 * (STEPS - i) / (double)STEPS);
}

static void solution(steif_context *ctx, const steif_problem *p, const char *method,
                     const steif_options *o, sunrealtype t, sunrealtype *y)
{
  steif_solver *s = steif_solver_new(ctx, p, method, o);
  CU_ASSERT_FATAL(s && !steif_solve_to(s, t));
  for (int i = 0; i < 3; i++) y[i] = NV_Ith_S(steif_solution(s), i);
  steif_solver_free(&s);
}

/* (y(p + d) - y(p - d)) / 2 d. */
static void quotient(steif_context *ctx, const steif_problem *p, const char *method,
                     const steif_options *o, sunrealtype t, int k, sunrealtype d,
                     sunrealtype *out)
{
  sunrealtype *value = p->parameters->value, at = value[k], low[3];
  const sunrealtype up = at + d, down = at - d;
  value[k] = up;
  solution(ctx, p, method, o, t, out);
  value[k] = down;
  solution(ctx, p, method, o, t, low);
  value[k] = at;
  for (int i = 0; i < 3; i++) out[i] = (out[i] - low[i]) / (up - down);
}

static void agree(const char *problem, const char *method, sunrealtype t)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  sunrealtype mesh[STEPS + 1], S[3], wide[3], narrow[3];
  steif_options o = steif_defaults(), plain;
  mesh_of(mesh);
  CU_ASSERT_FATAL(!steif_problem_find(ctx, problem, &p));
  o.mesh = mesh, o.mesh_size = STEPS + 1;
  plain = o, o.sensitivities = 1;
  for (int k = 0; k < 3; k++) {
    const sunrealtype d = 2e-3 * p.parameters->value[k];
    sensitivity_at(ctx, &p, method, &o, k, t, S, NULL);
    quotient(ctx, &p, method, &plain, t, k, d, wide);
    quotient(ctx, &p, method, &plain, t, k, d / 2, narrow);
    for (int i = 0; i < 3; i++) {
      const sunrealtype expected = (4 * narrow[i] - wide[i]) / 3;
      if (!(fabs(S[i] - expected) <= 1e-8 * fabs(expected)))
        printf("\n  %s %s:", problem, method);
      CLOSE(S[i], expected, 1e-8);
    }
  }
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* Index 0 and 1; 25 is inside of a step. */
static void agree_with_differences(void)
{
  static const char *const methods[] = {"radau:s=2",  "radau:s=3", "radau:s=5",
                                        "radau:s=12", "gauss:s=2", "lobatto3c:s=3"};
  for (size_t m = 0; m < sizeof methods / sizeof *methods; m++) {
    agree("rober", methods[m], 40);
    agree("rober:form=mass", methods[m], 40);
    agree("rober", methods[m], 25);
  }
  agree("rober", "dirk:esdirk43", 40);
  agree("rober", "dirk:esdirk43", 25);
}

CU_TestInfo tests_of_same_mesh[] = {
  {"S and differences of the run agree", agree_with_differences}, CU_TEST_INFO_NULL};
