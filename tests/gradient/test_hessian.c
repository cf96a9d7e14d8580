/* test_hessian.c: products with second derivatives: figures, symmetry, differences of gradients, memory, refusals.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "subjects.h"
#include "base/failing.h"
#include <stdbool.h>
#include <string.h>

static const char *const methods[] = {
  "radau:s=1", "radau:s=3", "gauss:s=2", "lobatto3c:s=3", "radau:s=5",      "radau:s=7",
  "bdf:p=1",   "bdf:p=3",   "dirk:hw43", "dirk:esdirk43", "dirk:alexander2"};
enum { METHODS = sizeof methods / sizeof *methods, MOST = 64 };

static void product(steif_context *ctx, const steif_problem *p, const char *method,
                    const steif_options *o, const steif_functional *J, const sunrealtype *v,
                    const sunrealtype *u, steif_gradient *g, sunrealtype *Hp, sunrealtype *Hy0)
{
  steif_direction *d = steif_direction_new(ctx, p, v, u);
  CU_ASSERT_FATAL(d != NULL);
  const int code = steif_hessian_product(ctx, d, method, o, J, g, Hp, Hy0);
  if (code) printf("\n  %s: %s", method, steif_message(ctx));
  CU_ASSERT_FATAL(code == STEIF_OK);
  steif_direction_free(&d);
}

/* ---- figures ------------------------------------------------------------------------------------ */

static int distance(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  const sunrealtype a = NV_Ith_S(y, 0) - 1, b = NV_Ith_S(y, 1) - 1;
  (void)t, (void)user;
  g[0] = (a * a + b * b) / 2;
  return 0;
}

static int of_distance(sunrealtype t, N_Vector y, int i, int at_end, N_Vector dy,
                       sunrealtype *dp, void *user)
{
  (void)t, (void)i, (void)at_end, (void)dp, (void)user;
  NV_Ith_S(dy, 0) = NV_Ith_S(y, 0) - 1, NV_Ith_S(dy, 1) = NV_Ith_S(y, 1) - 1;
  return 0;
}

static int third(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  (void)t, (void)user;
  g[0] = NV_Ith_S(y, 2);
  return 0;
}

static int of_third(sunrealtype t, N_Vector y, int i, int at_end, N_Vector dy, sunrealtype *dp,
                    void *user)
{
  (void)t, (void)y, (void)i, (void)at_end, (void)dp, (void)user;
  NV_Ith_S(dy, 2) = 1;
  return 0;
}

static int multiplier(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  (void)t, (void)user;
  g[0] = NV_Ith_S(y, 4);
  return 0;
}

static int of_multiplier(sunrealtype t, N_Vector y, int i, int at_end, N_Vector dy,
                         sunrealtype *dp, void *user)
{
  (void)t, (void)y, (void)i, (void)at_end, (void)dp, (void)user;
  NV_Ith_S(dy, 4) = 1;
  return 0;
}

/* Row k of a Hessian in entries; those given as NAN are not known. */
static void row(const struct subject *s, const char *method, sunrealtype rtol, sunrealtype t1,
                const steif_functional *J, int k, const sunrealtype *H, double tolerance)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_options o = steif_defaults();
  steif_gradient g = {0};
  sunrealtype v[8] = {0}, Hp[8];
  o.rtol = rtol, o.t1 = t1, v[k] = 1;
  product(ctx, &s->problem, method, &o, J, v, NULL, &g, Hp, NULL);
  for (int j = 0; j < g.parameters; j++)
    if (!isnan(H[j])) CLOSE(Hp[j], H[j], tolerance);
  steif_gradient_free(ctx, &g);
  steif_context_free(&ctx);
}

/* Gradients of a code of its own in 113-bit arithmetic, their differences: symmetric to the digits given. */
static void figures(void)
{
  static const sunrealtype lotka[4][4] = {
    {36.78202380949, -51.37253125405, -11.43200481033, 31.50203698235},
    {-51.37253125405, 148.8490902834, -14.21977993059, 50.17325667878},
    {-11.43200481033, -14.21977993059, 20.07742077732, -115.175689127},
    {31.50203698235, 50.17325667878, -115.175689127, 545.724559715}};
  static const sunrealtype rober[3][3] = {
    {-1533.628723783, -0.005661651933521, 9.436405651e-7},
    {-0.005661651933521, 4.424166812e-8, -1.329893980e-12},
    {9.436405651e-7, -1.329893980e-12, -1.793126514e-15}};
  static const sunrealtype pendulum[4][4] = {{10.23761797407, -0.03894152844383, NAN, NAN},
                                             {-0.03894152844383, -0.0984410755008, NAN, NAN},
                                             {NAN, NAN, 3.691904610792, -0.493276531330},
                                             {NAN, NAN, -0.493276531330, 0.275437454898}};
  const steif_functional of_lotka = {.count = 1, .integrand = distance, .slopes = of_distance},
                         of_rober = {.count = 1, .integrand = third, .slopes = of_third},
                         of_swing = {
                           .count = 1, .integrand = multiplier, .slopes = of_multiplier};
  struct subject s;
  subject_lotka(&s);
  for (int k = 0; k < 4; k++) row(&s, "radau:s=5", 1e-11, 10, &of_lotka, k, lotka[k], 1e-8);
  subject_robertson(&s);
  for (int k = 0; k < 3; k++) row(&s, "radau:s=5", 1e-10, 40, &of_rober, k, rober[k], 1e-7);
  subject_pendulum(&s);
  for (int k = 0; k < 4; k++) row(&s, "radau:s=5", 1e-10, 1, &of_swing, k, pendulum[k], 1e-6);
}

/* ---- laws --------------------------------------------------------------------------------------- */

/* Two functionals that depend on p and are not quadratic; at the end and in integrals. */
static int two(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  const sunrealtype *p = ((struct subject *)user)->p, a = NV_Ith_S(y, 0), b = NV_Ith_S(y, 1);
  (void)t;
  g[0] = sin(a) * b * p[0], g[1] = exp(-b) + p[1] * p[1] * a;
  return 0;
}

static int of_two(sunrealtype t, N_Vector y, int i, int at_end, N_Vector dy, sunrealtype *dp,
                  void *user)
{
  const sunrealtype *p = ((struct subject *)user)->p, a = NV_Ith_S(y, 0), b = NV_Ith_S(y, 1);
  (void)t, (void)at_end;
  NV_Ith_S(dy, 0) = i ? p[1] * p[1] : cos(a) * b * p[0];
  NV_Ith_S(dy, 1) = i ? -exp(-b) : sin(a) * p[0];
  dp[i] = i ? 2 * p[1] * a : sin(a) * b;
  return 0;
}

static const steif_functional both = {
  .count = 2, .integrand = two, .end = two, .slopes = of_two};

static sunrealtype dot(sunindextype n, const sunrealtype *a, const sunrealtype *b,
                       sunrealtype *size)
{
  sunrealtype sum = 0;
  for (sunindextype i = 0; i < n; i++) sum += a[i] * b[i], *size += fabs(a[i] * b[i]);
  return sum;
}

/* (w, z) H (v, u) = (v, u) H (w, z), steps that are far from converged. */
static void symmetric(const struct subject *s, const steif_options *o, double tolerance)
{
  steif_context *ctx = steif_context_new(NULL);
  const sunindextype n = s->problem.n, P = s->parameters.count;
  sunrealtype x[2][MOST], y[2][MOST], Hp[2][2 * MOST], Hy[2][2 * MOST];
  for (int i = 0; i < 2; i++) {
    for (int k = 0; k < P; k++) x[i][k] = s->p[k] * sin(3. * k + i + 1);
    for (int k = 0; k < n; k++) y[i][k] = cos(2. * k + 5 * i);
  }
  for (int m = 0; m < METHODS; m++) {
    steif_gradient g[2] = {{0}, {0}}, alone = {0};
    for (int i = 0; i < 2; i++)
      product(ctx, &s->problem, methods[m], o, &both, x[i], y[i], &g[i], Hp[i], Hy[i]);
    for (int i = 0; i < 2; i++) {
      sunrealtype size = 0;
      const sunrealtype one =
        dot(P, Hp[0] + i * P, x[1], &size) + dot(n, Hy[0] + i * n, y[1], &size);
      const sunrealtype other =
        dot(P, Hp[1] + i * P, x[0], &size) + dot(n, Hy[1] + i * n, y[0], &size);
      CLOSE_FLOOR(one, other, tolerance, size);
    }
    CU_ASSERT_FATAL(!steif_gradient_find(ctx, &s->problem, methods[m], o, &both, &alone));
    const size_t size = sizeof *alone.dp;
    CHECK(!memcmp(alone.dp, g[0].dp, 2 * (size_t)P * size));
    CHECK(!memcmp(alone.dy0, g[1].dy0, 2 * (size_t)n * size));
    CHECK(alone.value[1] == g[0].value[1]);
    steif_gradient_free(ctx, &g[0]), steif_gradient_free(ctx, &g[1]);
    steif_gradient_free(ctx, &alone);
  }
  steif_context_free(&ctx);
}

static void symmetry(void)
{
  struct subject s;
  steif_options o = steif_defaults();
  o.h = 0.125, o.t1 = 2, o.newton = 1e-8;
  subject_lotka(&s);
  symmetric(&s, &o, 1e-11);
  o.h = 0.0625, o.t1 = 0.5;
  for (int storage = STEIF_DENSE; storage <= STEIF_SPARSE; storage++) {
    subject_brusselator(&s, (enum steif_storage)storage);
    symmetric(&s, &o, 1e-10);
  }
}

/* Gradients of runs with the same steps, p + theta v and y0 + theta u. */
static void moved_gradient(steif_context *ctx, struct subject *s, const char *method,
                           const steif_options *o, sunrealtype theta, sunrealtype c,
                           sunrealtype *sum)
{
  steif_gradient g = {0};
  for (int k = 0; k < 4; k++) s->p[k] += theta * (k + 1);
  for (int k = 0; k < 2; k++) s->y0[k] += theta * (1 - 2 * k);
  CU_ASSERT_FATAL(!steif_gradient_find(ctx, &s->problem, method, o, &both, &g));
  for (int k = 0; k < 8; k++) sum[k] += c * g.dp[k];
  for (int k = 0; k < 4; k++) sum[8 + k] += c * g.dy0[k];
  for (int k = 0; k < 4; k++) s->p[k] -= theta * (k + 1);
  for (int k = 0; k < 2; k++) s->y0[k] -= theta * (1 - 2 * k);
  steif_gradient_free(ctx, &g);
}

static void derivative_of_the_gradient(void)
{
  static const sunrealtype v[] = {1, 2, 3, 4}, u[] = {1, -1}, d = 2.5e-4;
  steif_context *ctx = steif_context_new(NULL);
  steif_options o = steif_defaults();
  o.h = 0.125, o.t1 = 2, o.newton = 1e-8;
  struct subject s;
  subject_lotka(&s);
  for (int m = 0; m < METHODS; m++) {
    sunrealtype Hp[8], Hy[4], sum[12] = {0};
    steif_gradient g = {0};
    product(ctx, &s.problem, methods[m], &o, &both, v, u, &g, Hp, Hy);
    moved_gradient(ctx, &s, methods[m], &o, d / 2, 8 / (6 * d), sum);
    moved_gradient(ctx, &s, methods[m], &o, -d / 2, -8 / (6 * d), sum);
    moved_gradient(ctx, &s, methods[m], &o, d, -1 / (6 * d), sum);
    moved_gradient(ctx, &s, methods[m], &o, -d, 1 / (6 * d), sum);
    for (int k = 0; k < 8; k++) CLOSE_FLOOR(Hp[k], sum[k], 1e-7, 1);
    for (int k = 0; k < 4; k++) CLOSE_FLOOR(Hy[k], sum[8 + k], 1e-7, 1);
    steif_gradient_free(ctx, &g);
  }
  steif_context_free(&ctx);
}

/* What callbacks do not give: six digits are promised. */
static void by_differences(void)
{
  static const sunrealtype v[] = {1, -1, 2, 0.5};
  steif_context *ctx = steif_context_new(NULL);
  steif_options o = steif_defaults();
  o.t1 = 2, o.h = 0.125, o.newton = 1e-8;
  steif_functional bare = both;
  for (int what = 0; what < 3; what++) {
    sunrealtype Hp[2][8];
    for (int i = 0; i < 2; i++) {
      struct subject s;
      subject_lotka(&s);
      if (i && what == 0) s.problem.jac = NULL;
      if (i && what == 1) s.parameters.dFdp = NULL, s.parameters.dFdp_transposed = NULL;
      bare.slopes = i && what == 2 ? NULL : of_two;
      steif_gradient g = {0};
      product(ctx, &s.problem, "radau:s=3", &o, &bare, v, NULL, &g, Hp[i], NULL);
      steif_gradient_free(ctx, &g);
    }
    for (int k = 0; k < 8; k++) CLOSE_FLOOR(Hp[1][k], Hp[0][k], 1e-6, 1);
  }
  steif_context_free(&ctx);
}

/* ---- memory ------------------------------------------------------------------------------------- */

static void bit_for_bit(void)
{
  static const char *const some[] = {"radau:s=3", "bdf", "bdf:p=2", "dirk:esdirk43"};
  static const sunrealtype v[] = {1, -1, 0.01};
  steif_context *ctx = steif_context_new(NULL);
  steif_options o = steif_defaults();
  o.t1 = 1;
  struct subject s;
  subject_brusselator(&s, STEIF_SPARSE);
  for (int m = 0; m < 4; m++) {
    steif_gradient all = {0}, few = {.checkpoints = 4}, small = {.memory = 2000};
    sunrealtype H[2][6], Hy[2][2 * MOST];
    product(ctx, &s.problem, some[m], &o, &both, v, NULL, &all, H[0], Hy[0]);
    product(ctx, &s.problem, some[m], &o, &both, v, NULL, &few, H[1], Hy[1]);
    CHECK(few.cost.recomputed_steps > 0 && all.cost.recomputed_steps == 0);
    CHECK(!memcmp(H[0], H[1], sizeof H[0]));
    CHECK(!memcmp(Hy[0], Hy[1], 80 * sizeof *Hy[0]));
    steif_direction *d = steif_direction_new(ctx, &s.problem, v, NULL);
    CHECK(steif_hessian_product(ctx, d, some[m], &o, &both, &small, H[1], NULL) ==
          STEIF_BAD_INPUT);
    CHECK(strstr(steif_message(ctx), "too small") != NULL && small.dp == NULL);
    small.memory = all.cost.bytes / 2;
    CHECK(steif_hessian_product(ctx, d, some[m], &o, &both, &small, H[1], NULL) == STEIF_OK);
    CHECK(small.cost.bytes <= small.memory && !memcmp(H[0], H[1], sizeof H[0]));
    steif_direction_free(&d);
    steif_gradient_free(ctx, &all), steif_gradient_free(ctx, &few);
    steif_gradient_free(ctx, &small);
  }
  steif_context_free(&ctx);
}

/* One factorisation and one solve of the stages a step more, and one transposed solve. */
static void cost(void)
{
  static const sunrealtype v[] = {1, -1, 2, 0.5};
  steif_context *ctx = steif_context_new(NULL);
  const steif_functional J = {.count = 1, .end = distance, .slopes = of_distance};
  steif_options o = steif_defaults();
  o.t1 = 2, o.h = 0.125;
  struct subject s;
  subject_lotka(&s);
  steif_gradient one = {0}, with = {0};
  sunrealtype H[4];
  CHECK(!steif_gradient_find(ctx, &s.problem, "radau:s=3", &o, &J, &one));
  product(ctx, &s.problem, "radau:s=3", &o, &J, v, NULL, &with, H, NULL);
  CHECK(with.cost.factors == one.cost.factors + 16 && with.cost.steps == 16);
  CHECK(with.cost.solves == one.cost.solves + 16);
  CHECK(with.cost.transposed_solves == 2 * one.cost.transposed_solves);
  steif_gradient_free(ctx, &one), steif_gradient_free(ctx, &with);
  steif_context_free(&ctx);
}

static void refused(void)
{
  static const sunrealtype v[] = {1, 1, 1, 1};
  steif_context *ctx = steif_context_new(NULL);
  struct subject s;
  subject_lotka(&s);
  steif_gradient g = {0};
  sunrealtype H[8];
  CHECK(steif_hessian_product(ctx, NULL, "bdf", NULL, &both, &g, H, NULL) == STEIF_BAD_INPUT);
  CHECK(strstr(steif_message(ctx), "direction") != NULL);
  steif_direction *d = steif_direction_new(ctx, &s.problem, v, NULL);
  CHECK(steif_hessian_product(ctx, d, "bdf", NULL, &both, &g, NULL, NULL) == STEIF_BAD_INPUT);
  CHECK(strstr(steif_message(ctx), "room for 4") != NULL);
  CHECK(steif_hessian_product(ctx, d, "rodas4", NULL, &both, &g, H, NULL) == STEIF_UNSUPPORTED);
  CHECK(steif_hessian_product(NULL, d, "bdf", NULL, &both, &g, H, NULL) == STEIF_BAD_INPUT);
  CHECK(g.dp == NULL && g.value == NULL);
  steif_direction_free(&d);
  steif_context_free(&ctx);
}

static void failing_requests(void)
{
  static const sunrealtype v[] = {1, 1, 1, 1};
  steif_options o = steif_defaults();
  o.rtol = 1e-4, o.t1 = 0.1;
  struct subject s;
  subject_lotka(&s);
  for (int images = 0; images < 4; images += 3) {
    bool done = false;
    for (long k = 2; !done && k < 2000; k++) {
      failing f = {.refuse_at = 0};
      const steif_setup setup = failing_setup(&f);
      steif_context *ctx = steif_context_new(&setup);
      f.served = 0, f.refuse_at = k;
      steif_gradient g = {.checkpoints = images};
      sunrealtype H[8];
      steif_direction *d = steif_direction_new(ctx, &s.problem, v, NULL);
      const int code = d ? steif_hessian_product(ctx, d, "radau:s=3", &o, &both, &g, H, NULL)
                         : steif_status(ctx);
      CHECK(code == STEIF_OK || code == STEIF_NO_MEMORY);
      CHECK(code == STEIF_OK || !g.value);
      done = code == STEIF_OK && f.served < k;
      steif_gradient_free(ctx, &g);
      steif_direction_free(&d);
      steif_context_free(&ctx);
      CHECK(f.alive == 0);
    }
    CHECK(done);
  }
}

CU_TestInfo tests_of_hessians[] = {
  {"figures of Lotka and Volterra, Robertson, pendulum", figures},
  {"symmetric to rounding", symmetry},
  {"the derivative of the gradient", derivative_of_the_gradient},
  {"what is left to differences", by_differences},
  {"images, or all stages: bit for bit", bit_for_bit},
  {"cost in factors and solves", cost},
  {"refused with a sentence", refused},
  {"failing requests for memory", failing_requests},
  CU_TEST_INFO_NULL};
