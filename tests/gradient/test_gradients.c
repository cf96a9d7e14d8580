/* test_gradients.c: gradients against figures made by Radau IIA with 5 to 9 stages in 113-bit arithmetic, forward
 * and transposed sweeps, where two numbers of stages agree in all digits.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "subjects.h"
#include <steif/data.h>

static int y3(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  (void)t, (void)user;
  g[0] = NV_Ith_S(y, 2);
  return 0;
}

static const struct {
  sunrealtype t, G, dp[3], lambda[3];
} rober[] = {{0.4,
              0.00302627479108087,
              {0.0737798474579308, -1.32810837233716e-8, 2.43170073079241e-12},
              {0.00296641497577093, 0.372816969606281, 0.373692055009931}},
             {40,
              7.98858586229491,
              {129.776482861602, -3.62638337322859e-4, 6.04429342100946e-8},
              {6.17549051536915, 13.2795841590149, 13.2797704248834}},
             {4000,
              2822.89337452086,
              {21660.8913290106, -0.0844289327884305, 1.40715897382561e-5},
              {2400.75173878424, 2421.17165998389, 2421.17048422555}}};

static void robertson(void)
{
  static const char *const methods[] = {"radau:s=3", "radau:s=5", "gauss:s=3"};
  const steif_functional J = {.count = 1, .integrand = y3};
  steif_context *ctx = steif_context_new(NULL);
  struct subject s;
  subject_robertson(&s);
  for (int i = 0; i < 3; i++)
    for (int m = 0; m < 3; m++) {
      steif_gradient g = {0};
      gradient_of(ctx, &s, methods[m], 1e-10, rober[i].t, &J, &g);
      CLOSE(g.value[0], rober[i].G, 1e-8);
      for (int k = 0; k < 3; k++) CLOSE(g.dp[k], rober[i].dp[k], 1e-8);
      for (int k = 0; k < 3; k++) CLOSE(g.dy0[k], rober[i].lambda[k], 1e-8);
      CHECK(g.count == 1 && g.parameters == 3 && g.n == 3 && g.cost.steps > 10);
      CHECK(g.cost.recomputed_steps == 0 && g.cost.factors <= 2 * g.cost.steps);
      steif_gradient_free(ctx, &g);
      CHECK(g.value == NULL);
    }
  steif_context_free(&ctx);
}

/* BDF and DIRK: errors are those of their steps. */
static void low_orders(void)
{
  static const char *const methods[] = {"bdf", "dirk:hw43", "dirk:esdirk43"};
  const steif_functional J = {.count = 1, .integrand = y3};
  steif_context *ctx = steif_context_new(NULL);
  struct subject s;
  subject_robertson(&s);
  for (int i = 0; i < 2; i++)
    for (int m = 0; m < 3; m++) {
      steif_gradient g = {0};
      gradient_of(ctx, &s, methods[m], 1e-9, rober[i].t, &J, &g);
      CLOSE(g.value[0], rober[i].G, 1e-5);
      for (int k = 0; k < 3; k++) CLOSE(g.dp[k], rober[i].dp[k], 1e-5);
      for (int k = 0; k < 3; k++) CLOSE(g.dy0[k], rober[i].lambda[k], 1e-5);
      steif_gradient_free(ctx, &g);
    }
  steif_context_free(&ctx);
}

static int lotka_integrand(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  const sunrealtype a = NV_Ith_S(y, 0) - 1, b = NV_Ith_S(y, 1) - 1;
  (void)t, (void)user;
  g[0] = (a * a + b * b) / 2, g[1] = 0;
  return 0;
}

static int lotka_end(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  lotka_integrand(t, y, g, user);
  g[1] = g[0], g[0] = 0;
  return 0;
}

static void two_functionals_of_lotka(void)
{
  static const sunrealtype dp[] = {2.6065444219661,  -39.312098123888, 44.001489290488,
                                   -147.44909877364, 0.6219615855513,  0.06800140415087,
                                   0.1691764639959,  0.2725606939500};
  static const char *const methods[] = {"radau:s=3", "radau:s=5", "gauss:s=3", "radau:s=7",
                                        "lobatto3c:s=4"};
  const steif_functional J = {.count = 2, .integrand = lotka_integrand, .end = lotka_end};
  steif_context *ctx = steif_context_new(NULL);
  struct subject s;
  subject_lotka(&s);
  for (int m = 0; m < 4; m++) {
    steif_gradient g = {0};
    gradient_of(ctx, &s, methods[m], 1e-11, 10, &J, &g);
    CLOSE(g.value[0], 50.8911611338521, 1e-8);
    for (int k = 0; k < 8; k++) CLOSE(g.dp[k], dp[k], 1e-8);
    steif_gradient_free(ctx, &g);
  }
  steif_context_free(&ctx);
}

static int square(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  (void)t, (void)user;
  g[0] = NV_Ith_S(y, 0) * NV_Ith_S(y, 0);
  return 0;
}

/* Over two jumps, where y2 comes to 1e6 and its equation is divided by 1e-6, rounding of the stages is what limits the
 * derivative in double precision. */
static void vanderpol(void)
{
  const steif_functional J = {.count = 1, .integrand = square};
  steif_context *ctx = steif_context_new(NULL);
  struct subject s;
  subject_vanderpol(&s);
  steif_gradient g = {0};
  gradient_of(ctx, &s, "radau:s=5", 1e-11, 0.5, &J, &g);
  CLOSE(g.value[0], 1.64963138056552, 1e-8);
  CLOSE(g.dp[0], 0.119696800428095, 1e-8);
  steif_gradient_free(ctx, &g);
  gradient_of(ctx, &s, "radau:s=3", 1e-12, 2, &J, &g);
  CLOSE(g.value[0], 5.83838771868336, 1e-8);
  CLOSE(g.dp[0], -436.24256987, 1e-5);
  steif_gradient_free(ctx, &g);
  steif_context_free(&ctx);
}

static int multiplier(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  (void)t, (void)user;
  g[0] = NV_Ith_S(y, 4), g[1] = 0;
  return 0;
}

static int position(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  (void)t, (void)user;
  g[0] = 0, g[1] = NV_Ith_S(y, 0);
  return 0;
}

/* As posed, index 3. lambda(0): an impulse counts in the integral of the multiplier, and a velocity off
 * the constraint is projected. */
static void pendulum_of_index_three(void)
{
  static const sunrealtype integral[] = {-9.8556015800332, 1.0046484791063, 4.5241759954676,
                                         0.19159636333813},
                           end[] = {-0.37888952725984, -0.041393985654835, -0.50345099387397,
                                    0.052263069153515};
  const steif_functional J = {.count = 2, .integrand = multiplier, .end = position};
  steif_context *ctx = steif_context_new(NULL);
  struct subject s;
  subject_pendulum(&s);
  steif_gradient g = {0};
  gradient_of(ctx, &s, "radau:s=5", 1e-10, 1, &J, &g);
  CLOSE(g.value[0], 12.2005228296252, 1e-7);
  CLOSE(g.value[1], -0.78496452653377, 1e-8);
  for (int k = 0; k < 4; k++) CLOSE(g.dp[k], integral[k], 1e-7);
  for (int k = 0; k < 4; k++) CLOSE(g.dp[4 + k], end[k], 1e-8);
  const sunrealtype nx = s.y0[0], ny = s.y0[1];
  CLOSE(nx * g.dy0[2] + ny * g.dy0[3], 1, 1e-6);
  CLOSE_FLOOR(nx * g.dy0[7] + ny * g.dy0[8], 0, 1e-6, 1);
  CLOSE_FLOOR(g.dy0[4], 0, 1e-14, 1);
  steif_gradient_free(ctx, &g);
  steif_context_free(&ctx);
}

static int mean(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  (void)t, (void)user;
  g[0] = 0;
  for (int i = 0; i < 20; i++) g[0] += NV_Ith_S(y, 2 * i) / 21;
  return 0;
}

static void brusselator_in_every_storage(void)
{
  static const enum steif_storage storages[] = {STEIF_DENSE, STEIF_BAND, STEIF_SPARSE};
  static const sunrealtype dp[] = {6.81874889039, -2.36694501979, 16.0549637306};
  const steif_functional J = {.count = 1, .integrand = mean};
  steif_context *ctx = steif_context_new(NULL);
  struct subject s;
  for (int k = 0; k < 3; k++) {
    subject_brusselator(&s, storages[k]);
    steif_gradient g = {0};
    gradient_of(ctx, &s, "radau:s=5", 1e-10, 10, &J, &g);
    CLOSE(g.value[0], 9.554735627872, 1e-8);
    for (int i = 0; i < 3; i++) CLOSE(g.dp[i], dp[i], 1e-8);
    CLOSE(g.dy0[0], 0.0208807299573, 1e-7);
    CLOSE(g.dy0[1], 0.0191928285611, 1e-7);
    CLOSE(g.dy0[2], 0.0357524218358, 1e-7);
    steif_gradient_free(ctx, &g);
  }
  steif_context_free(&ctx);
}

static int first(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  (void)t, (void)user;
  g[0] = NV_Ith_S(y, 0);
  return 0;
}

static int of_first(sunrealtype t, N_Vector y, int i, int at_end, N_Vector dy, sunrealtype *dp,
                    void *user)
{
  (void)t, (void)y, (void)i, (void)at_end, (void)dp, (void)user;
  NV_Ith_S(dy, 0) = 1;
  return 0;
}

/* Akzo Nobel, index 1, its start a function of Ks: the integral of y1 to 180 by k1, k2, k3, k4, K, klA, Ks, pCO2, H; a
 * Radau code in 113-bit arithmetic. Radau does not read the algebraic y6 at the start. */
static void akzo(void)
{
  static const sunrealtype dp[] = {-0.4279803827489,  -0.1739629386550,   -0.03014970786549,
                                   0.5173379340702,   -2.431794541060e-4, -0.8061649757004,
                                   0.003751738449615, -7.242654559274,    0.008844489963836},
                           lambda[] = {22.20655203693, -62.69455688606, -2.511446676022,
                                       91.83653702848, 3.517562488633};
  const steif_functional J = {.count = 1, .integrand = first, .slopes = of_first};
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  CU_ASSERT_FATAL(!steif_problem_find(ctx, "chemakzo", &p));
  CU_ASSERT_FATAL(p.parameters && p.parameters->count == 9);
  steif_options o = steif_defaults();
  steif_gradient g = {0};
  o.rtol = 1e-10, o.t1 = 180;
  CU_ASSERT_FATAL(!steif_gradient_find(ctx, &p, "radau:s=5", &o, &J, &g));
  CLOSE(g.value[0], 31.2642161949441, 1e-9);
  for (int k = 0; k < 9; k++) CLOSE(g.dp[k], dp[k], 1e-8);
  for (int k = 0; k < 5; k++) CLOSE(g.dy0[k], lambda[k], 1e-7);
  CLOSE_FLOOR(g.dy0[5], 0, 1e-12, 1);
  steif_gradient_free(ctx, &g);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_gradients[] = {
  {"Robertson to eight digits", robertson},
  {"BDF and DIRK", low_orders},
  {"two functionals of Lotka and Volterra", two_functionals_of_lotka},
  {"Van der Pol over two jumps", vanderpol},
  {"pendulum of index 3 as posed", pendulum_of_index_three},
  {"Akzo Nobel, nine parameters", akzo},
  {"Brusselator, dense, band and sparse", brusselator_in_every_storage},
  CU_TEST_INFO_NULL};
