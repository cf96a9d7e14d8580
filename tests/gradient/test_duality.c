/* test_duality.c: forward and adjoint derivatives of one run agree to rounding, and with its differences.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "subjects.h"

static const char *const methods[] = {
  "radau:s=1", "radau:s=2",     "radau:s=3",   "radau:s=5",       "gauss:s=2",
  "gauss:s=3", "lobatto3c:s=3", "radau1a:s=2", "bdf:p=1",         "bdf:p=3",
  "bdf:p=5",   "dirk:hw43",     "radau:s=7",   "dirk:alexander2", "dirk:esdirk43"};
enum { METHODS = sizeof methods / sizeof *methods };

static int weighted(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  (void)t, (void)user;
  g[0] = 0;
  for (sunindextype i = 0; i < NV_LENGTH_S(y); i++)
    g[0] += cos(1.0 + (double)i) * NV_Ith_S(y, i);
  return 0;
}

static int weights(sunrealtype t, N_Vector y, int i, int at_end, N_Vector dy, sunrealtype *dp,
                   void *user)
{
  (void)t, (void)y, (void)i, (void)at_end, (void)dp, (void)user;
  for (sunindextype j = 0; j < NV_LENGTH_S(dy); j++) NV_Ith_S(dy, j) = cos(1.0 + (double)j);
  return 0;
}

/* w . S of the run forward against the gradient of w . y(T), given steps. */
static void forward_and_back(const struct subject *s, sunrealtype h, sunrealtype t1,
                             double floor)
{
  steif_context *ctx = steif_context_new(NULL);
  const steif_functional J = {.count = 1, .end = weighted, .slopes = weights};
  for (int m = 0; m < METHODS; m++) {
    steif_options o = steif_defaults();
    steif_gradient g = {0};
    o.h = h, o.t1 = t1, o.newton = 1e-8;
    const int code = steif_gradient_find(ctx, &s->problem, methods[m], &o, &J, &g);
    if (code) printf("\n  %s: %s", methods[m], steif_message(ctx));
    CU_ASSERT_FATAL(code == STEIF_OK);
    o.sensitivities = 1;
    steif_solver *forward = steif_solver_new(ctx, &s->problem, methods[m], &o);
    CU_ASSERT_FATAL(forward && steif_solve_to(forward, t1) == STEIF_OK);
    N_Vector S = N_VClone(steif_solution(forward));
    for (int k = 0; k < g.parameters; k++) {
      sunrealtype sum, size = 0;
      CHECK(steif_sensitivity(forward, t1, k, S) == STEIF_OK);
      weighted(t1, S, &sum, NULL);
      for (sunindextype i = 0; i < NV_LENGTH_S(S); i++) size = fmax(size, fabs(NV_Ith_S(S, i)));
      CLOSE_FLOOR(g.dp[k], sum, floor, size);
    }
    N_VDestroy(S);
    steif_solver_free(&forward);
    steif_gradient_free(ctx, &g);
  }
  steif_context_free(&ctx);
}

static void duality(void)
{
  struct subject s;
  subject_lotka(&s);
  forward_and_back(&s, 0.125, 2, 1e-12);
  subject_brusselator(&s, STEIF_DENSE);
  forward_and_back(&s, 0.0625, 1, 1e-12);
  subject_brusselator(&s, STEIF_BAND);
  forward_and_back(&s, 0.0625, 1, 1e-12);
  subject_brusselator(&s, STEIF_SPARSE);
  forward_and_back(&s, 0.0625, 1, 1e-12);
}

static sunrealtype value(steif_context *ctx, const struct subject *s, const char *method,
                         const steif_functional *J, sunrealtype h)
{
  steif_options o = steif_defaults();
  steif_gradient g = {0};
  o.h = h, o.t1 = 2, o.newton = 1e-6;
  const int code = steif_gradient_find(ctx, &s->problem, method, &o, J, &g);
  if (code) printf("\n  %s: %s", method, steif_message(ctx));
  CU_ASSERT_FATAL(code == STEIF_OK);
  const sunrealtype J0 = g.value[0];
  steif_gradient_free(ctx, &g);
  return J0;
}

static sunrealtype quotient(steif_context *ctx, struct subject *s, const char *method,
                            const steif_functional *J, sunrealtype *x, sunrealtype d)
{
  const sunrealtype here = *x;
  *x = here + d;
  const sunrealtype up = value(ctx, s, method, J, 0.125);
  *x = here - d;
  const sunrealtype down = value(ctx, s, method, J, 0.125);
  *x = here;
  return (up - down) / (2 * d);
}

static int square(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  const sunrealtype *p = ((struct subject *)user)->p;
  (void)t;
  g[0] = NV_Ith_S(y, 0) * NV_Ith_S(y, 1) * p[0] + NV_Ith_S(y, 0);
  return 0;
}

/* Of integrals and ends, coarse steps: the derivative is that of what the run returns. */
static void derivative_of_the_run(void)
{
  steif_context *ctx = steif_context_new(NULL);
  const steif_functional J = {.count = 1, .integrand = square, .end = square};
  struct subject s;
  subject_lotka(&s);
  for (int m = 0; m < METHODS; m++) {
    steif_gradient g = {0};
    steif_options o = steif_defaults();
    o.h = 0.125, o.t1 = 2, o.newton = 1e-6;
    const int code = steif_gradient_find(ctx, &s.problem, methods[m], &o, &J, &g);
    if (code) printf("\n  %s: %s", methods[m], steif_message(ctx));
    CU_ASSERT_FATAL(code == STEIF_OK);
    for (int k = 0; k < 6; k++) {
      sunrealtype *x = k < 4 ? &s.p[k] : &s.y0[k - 4];
      const sunrealtype a = quotient(ctx, &s, methods[m], &J, x, 2e-3),
                        b = quotient(ctx, &s, methods[m], &J, x, 1e-3);
      CLOSE_FLOOR(k < 4 ? g.dp[k] : g.dy0[k - 4], (4 * b - a) / 3, 1e-8, 1);
    }
    steif_gradient_free(ctx, &g);
  }
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_duality[] = {{"forward and adjoint agree to rounding", duality},
                                  {"the derivative is that of the run", derivative_of_the_run},
                                  CU_TEST_INFO_NULL};
