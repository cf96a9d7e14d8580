/* test_duality.c: forward and adjoint derivatives of one run agree to rounding, and with its differences.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "subjects.h"

static const char *const methods[] = {
  "radau:s=1", "radau:s=2",     "radau:s=3",   "radau:s=5",       "gauss:s=2",
  "gauss:s=3", "lobatto3c:s=3", "radau1a:s=2", "bdf:p=1",         "bdf:p=3",
  "bdf:p=5",   "dirk:hw43",     "radau:s=7",   "dirk:alexander2", "dirk:esdirk43"};
enum { METHODS = sizeof methods / sizeof *methods };

/* w . S of the run forward against the gradient of w . y(T), given steps. */
static void forward_and_back(const struct subject *s, sunrealtype h, sunrealtype t1,
                             double floor)
{
  steif_context *ctx = steif_context_new(NULL);
  const steif_functional J = {.count = 1, .end = weighted_sum, .slopes = weighted_slopes};
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
      weighted_sum(t1, S, &sum, NULL);
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

static int alone; /* functional that is asked for, 0: both */

/* The square above and a sum over all unknowns; or one of them. */
static int pair(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  sunrealtype both[] = {0, 0};
  square(t, y, both, user);
  for (sunindextype i = 0; i < NV_LENGTH_S(y); i++)
    both[1] += (sunrealtype)(i + 1) * NV_Ith_S(y, i) * NV_Ith_S(y, i);
  g[0] = both[alone == 2];
  if (!alone) g[1] = both[1];
  return 0;
}

static sunrealtype apart(const sunrealtype *x, const sunrealtype *y, sunindextype n)
{
  sunrealtype most = 0, size = 0;
  for (sunindextype i = 0; i < n; i++)
    most = fmax(most, fabs(x[i] - y[i])), size = fmax(size, fabs(y[i]));
  return most / size;
}

/* Two functionals in one solve are those of two runs. */
static void several_at_once(void)
{
  static const char *const of[] = {"radau:s=3", "be", "bdf", "dirk:hw43"};
  steif_context *ctx = steif_context_new(NULL);
  struct subject s;
  for (int storage = 0; storage < 4; storage++)
    for (int m = 0; m < 4; m++) {
      if (storage == 3)
        subject_lotka(&s);
      else
        subject_brusselator(&s, storage == 2   ? STEIF_SPARSE
                                : storage == 1 ? STEIF_BAND
                                               : STEIF_DENSE);
      const int P = s.parameters.count;
      steif_gradient g[3] = {{0}};
      for (alone = 0; alone < 3; alone++) {
        const steif_functional J = {.count = alone ? 1 : 2, .integrand = pair, .end = pair};
        steif_options o = steif_defaults();
        o.h = 0.0625, o.t1 = 1;
        CU_ASSERT_FATAL(!steif_gradient_find(ctx, &s.problem, of[m], &o, &J, &g[alone]));
      }
      alone = 0;
      for (int i = 0; i < 2; i++) {
        CHECK(apart(g[0].dp + i * P, g[i + 1].dp, P) < 1e-12);
        CHECK(apart(g[0].dy0 + i * g[0].n, g[i + 1].dy0, g[0].n) < 1e-12);
        CHECK(g[0].value[i] == g[i + 1].value[0]);
      }
      CHECK(apart(g[1].dp, g[2].dp, P) > 1e-3);
      for (int i = 0; i < 3; i++) steif_gradient_free(ctx, &g[i]);
    }
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_duality[] = {{"forward and adjoint agree to rounding", duality},
                                  {"the derivative is that of the run", derivative_of_the_run},
                                  {"several functionals at once", several_at_once},
                                  CU_TEST_INFO_NULL};
