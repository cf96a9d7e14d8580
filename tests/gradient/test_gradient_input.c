/* test_gradient_input.c: what is refused, and failing allocations.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "subjects.h"
#include <stdbool.h>
#include <string.h>

static int good(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  (void)t, (void)user;
  g[0] = NV_Ith_S(y, 0);
  return 0;
}

static int bad(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  (void)y, (void)user;
  g[0] = t > 0.5 ? NAN : 1;
  return 0;
}

static int refusal(const steif_problem *p, const char *method, const steif_options *o,
                   const steif_functional *J, steif_gradient g, const char *word)
{
  steif_context *ctx = steif_context_new(NULL);
  const int code = steif_gradient_find(ctx, p, method, o, J, &g);
  const char *said = steif_message(ctx);
  if (!strstr(said, word)) printf("\n  %d: %s", code, said);
  CHECK(strstr(said, word) != NULL);
  CHECK(g.value == NULL && g.dp == NULL && g.dy0 == NULL);
  steif_context_free(&ctx);
  return code;
}

static void refused(void)
{
  struct subject s;
  subject_lotka(&s);
  const steif_functional J = {.count = 1, .end = good}, none = {.count = 1},
                         empty = {.end = good}, nan = {.count = 1, .integrand = bad};
  const steif_gradient g = {0}, two = {.checkpoints = 2};
  steif_options o = steif_defaults();
  const steif_problem *p = &s.problem;
  CHECK(refusal(p, "rodas4", &o, &J, g, "rodas4") == STEIF_UNSUPPORTED);
  CHECK(refusal(p, "cvode", &o, &J, g, "cvode") == STEIF_UNSUPPORTED);
  CHECK(refusal(p, "nothing", &o, &J, g, "nothing") == STEIF_UNKNOWN_NAME);
  CHECK(refusal(p, "radau:s=3", &o, &none, g, "no values") == STEIF_BAD_INPUT);
  CHECK(refusal(p, "radau:s=3", &o, &empty, g, "0 functionals") == STEIF_BAD_INPUT);
  CHECK(refusal(NULL, "radau:s=3", &o, &J, g, "needs") == STEIF_BAD_INPUT);
  CHECK(refusal(p, "radau:s=3", &o, &J, two, "at least 3") == STEIF_BAD_INPUT);
  CHECK(refusal(p, "radau:s=3", &o, &nan, g, "functional 1") == STEIF_NOT_FINITE);
  o.h = 0.3;
  CHECK(refusal(p, "bdf:p=2", &o, &J, g, "divides") == STEIF_UNSUPPORTED);
  o.h = 0, o.sensitivities = 1;
  CHECK(refusal(p, "radau:s=3", &o, &J, g, "sensitivities") == STEIF_UNSUPPORTED);
  o.sensitivities = 0, o.force_storage = 1, o.storage = STEIF_KRYLOV;
  struct subject products = s;
  products.problem.jac = NULL, products.problem.user = &products;
  products.parameters.value = products.p, products.problem.y0 = products.y0;
  products.problem.parameters = &products.parameters;
  CHECK(refusal(&products.problem, "radau:s=3", &o, &J, g, "transposed") == STEIF_UNSUPPORTED);
  o.force_storage = 0, s.p[2] = NAN;
  CHECK(refusal(p, "radau:s=3", &o, &J, g, "parameter 3") == STEIF_NOT_FINITE);
  s.p[2] = 3;
  s.parameters.obstacle = "none of its callbacks tells";
  CHECK(refusal(p, "radau:s=3", &o, &J, g, "none of its") == STEIF_UNSUPPORTED);
  CHECK(steif_gradient_find(NULL, p, "radau:s=3", &o, &J, &(steif_gradient){0}) ==
        STEIF_BAD_INPUT);
}

/* Without parameters there is lambda. */
static void without_parameters(void)
{
  struct subject s;
  subject_lotka(&s);
  s.problem.parameters = NULL;
  const steif_functional J = {.count = 1, .end = good};
  steif_context *ctx = steif_context_new(NULL);
  steif_gradient g = {0};
  gradient_of(ctx, &s, "radau:s=3", 1e-8, 1, &J, &g);
  CHECK(g.dp == NULL && g.parameters == 0 && g.dy0[0] != 0);
  CHECK(isfinite(g.error_estimate[0]));
  steif_gradient_free(ctx, &g);
  steif_context_free(&ctx);
}

static void failing_requests(void)
{
  const steif_functional J = {.count = 1, .end = good};
  steif_options o = steif_defaults();
  o.rtol = 1e-4, o.t1 = 0.1;
  struct subject s;
  subject_lotka(&s);
  for (int images = 0; images < 4; images += 3)
    requests_fail(&s.problem, "radau:s=3", &o, &J, images);
}

CU_TestInfo tests_of_gradient_input[] = {{"refused with a sentence", refused},
                                         {"without parameters", without_parameters},
                                         {"failing requests for memory", failing_requests},
                                         CU_TEST_INFO_NULL};
