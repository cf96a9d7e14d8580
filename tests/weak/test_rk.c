/* test_rk.c: Runge-Kutta methods on Jordan blocks at h = 1/128: the stage quadrature converges
 * where the nodal values do not.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "weak/data.h"

/* {error at 2^-7, order between 2^-6 and 2^-7}: stage quadrature on H-inc and on N-cons, nodal
 * values in R on H-inc, x_1(1) of N-inc; {0, 0}: exact. `last`: last node of the layer, 128: all. */
typedef struct row {
  const char *method;
  int k, last;
  double figure[4][2];
} row;
/* clang-format off */
static const row rows[] = {
  {"radau:s=1", 2, 1, {{-0.121635, 0.9608}, {-0.0053862, 0.9843}, {-0.0613739, 0.9739},
   {0.0038657, 0.9994}}},
  {"radau:s=1", 3, 2, {{1.77682, 0.947}, {-0.0128801, 0.9635}, {1.21583, 0.9603}, {0.00975486,
   0.9963}}},
  {"radau:s=1", 4, 3, {{-18.3877, 0.9412}, {-0.00319536, 1.294}, {-14.031, 0.9528},
   {0.0130058, 0.989}}},
  {"radau:s=2", 2, 1, {{-0.00111584, 1.97}, {-2.27612e-7, 2.997}, {-5.87725, -0.02935},
   {9.7888e-7, 2.032}}},
  {"radau:s=2", 3, 2, {{1.26794, 0.9507}, {-3.50311e-7, 2.997}, {6627.12, -1.059},
   {0.00392595, 0.9942}}},
  {"radau:s=2", 4, 3, {{-1268.14, -0.0833}, {-8.55593e-5, 1.932}, {-6.57674e6, -2.105},
   {-3.84153, 0.002041}}},
  {"radau:s=3", 2, 1, {{-5.24746e-6, 2.975}, {-1.47751e-12, 4.999}, {3.81588, -0.06873},
   {-5.89788e-9, 2.999}}},
  {"radau:s=3", 3, 2, {{0.00616637, 2.002}, {-1.61606e-12, 5.012}, {-15809.8, -1.03},
   {2.98199e-6, 1.995}}},
  {"radau:s=3", 4, 3, {{3.72253, 0.8112}, {-2.69736e-10, 3.949}, {9.35215e6, -1.908},
   {-0.000607513, 0.8567}}},
  {"gauss:s=1", 2, 128, {{-0.000854329, 1.999}, {-2.90281e-5, 2.0}, {0.0579986, 0.9838},
   {-158345.0, -2.0}}},
  {"gauss:s=1", 3, 128, {{0.0119607, 1.999}, {-0.000109871, 1.999}, {-0.587699, 0.974},
   {8.56831e9, -4.0}}},
  {"gauss:s=1", 4, 128, {{-0.107652, 1.999}, {6.83185e-5, 1.996}, {4.5576, 0.9685},
   {-2.18311e14, -6.0}}},
  {"gauss:s=2", 2, 128, {{-0.000189878, 2.0}, {-6.12094e-10, 4.0}, {-4543.62, -1.943},
   {-475034.0, -2.0}}},
  {"gauss:s=2", 3, 128, {{8.00186, 0.001006}, {-1.81279e-8, 2.192}, {1.22298e8, -3.937},
   {7.71155e10, -4.0}}},
  {"gauss:s=2", 4, 128, {{-262226.0, -1.999}, {-0.0100647, 0.002146}, {-2.68219e12, -5.932},
   {-5.89439e15, -6.0}}},
  {"gauss:s=3", 2, 128, {{-1.30374e-8, 4.0}, {-1.77031e-15, 6.0}, {10.3675, 0.04921},
   {-950068.0, -2.0}}},
  {"gauss:s=3", 3, 128, {{4.87599e-7, 4.0}, {2.84121e-16, 5.989}, {-852.878, 0.03688},
   {3.08463e11, -4.0}}},
  {"gauss:s=3", 4, 128, {{0.025623, 1.998}, {-2.68267e-14, 5.999}, {-2.02209e7, -1.969},
   {-4.71554e16, -6.0}}},
  {"lobatto3c:s=2", 2, 0, {{0, 0}, {5.80555e-5, 2.0}, {-2.0, 0.0}, {0.0038657, 0.9994}}},
  {"lobatto3c:s=2", 3, 1, {{0.646096, 0.9776}, {9.84921e-5, 2.0}, {766.432, -1.001},
   {-0.649778, -0.008602}}},
  {"lobatto3c:s=2", 4, 1, {{-223.354, -0.00405}, {0.0168693, 0.9707}, {-253557.0, -2.045},
   {-72.3058, -1.006}}},
  {"lobatto3c:s=3", 2, 0, {{0, 0}, {9.47304e-10, 4.0}, {-2.0, 0.0}, {7.32522e-7, 2.029}}},
  {"lobatto3c:s=3", 3, 1, {{0.0050524, 1.979}, {1.36747e-9, 4.0}, {-2211.3, -1.06},
   {0.00295116, 0.9975}}},
  {"lobatto3c:s=3", 4, 1, {{-5.18553, 0.9822}, {6.99034e-9, 3.978}, {3.80906e6, -2.046},
   {-0.955164, -0.005608}}},
  {"dirk:alexander2", 2, 1, {{0.0843341, 0.9314}, {1.00043e-5, 1.96}, {-11.3605, -0.03675},
   {-0.00273169, 0.9985}}},
  {"dirk:alexander2", 3, 2, {{-184.913, -0.09753}, {-0.00369366, 0.9278}, {24771.7, -1.074},
   {2.7203, 0.0138}}},
  {"dirk:alexander2", 4, 3, {{357907.0, -1.137}, {3.03544, -0.1127}, {-4.7765e7, -2.119},
   {1668.46, -1.067}}},
  {"dirk:alexander2b", 2, 1, {{-0.000696909, 1.977}, {-1.40874e-5, 2.0}, {-11.3605, -0.03675},
   {0.00386036, 0.9973}}},
  {"dirk:alexander2b", 3, 2, {{0.627761, 0.937}, {-7.19427e-5, 1.958}, {24771.7, -1.074},
   {-3.86177, 0.01906}}},
  {"dirk:alexander2b", 4, 3, {{-1208.59, -0.1117}, {0.0150392, 0.7997}, {-4.7765e7, -2.119},
   {-2331.37, -1.087}}},
  {"dirk:alexander3", 2, 1, {{0.0487939, 0.902}, {2.70244e-6, 1.76}, {-7.56405, -0.03276},
   {-0.00161051, 0.9981}}},
  {"dirk:alexander3", 3, 2, {{-90.6388, -0.108}, {-0.00281573, 0.9521}, {11631.0, -1.065},
   {1.34216, 0.01378}}},
  {"dirk:alexander3", 4, 3, {{128835.0, -1.139}, {1.28732, -0.1002}, {-1.59627e7, -2.107},
   {603.114, -1.063}}},
  {"dirk:crouzeix23", 2, 128, {{-0.000568188, 1.996}, {-1.08989e-9, 3.997}, {-0.107736,
   -0.547}, {0.000597497, 0.8974}}},
  {"dirk:crouzeix23", 3, 128, {{0.110539, 1.112}, {-4.01395e-5, 1.988}, {29.0551, -0.8591},
   {-0.0454964, 4.443}}},
  {"dirk:crouzeix23", 4, 128, {{-17.5272, 0.1258}, {0.00271098, 1.023}, {-4667.52, -1.799},
   {-2.58519, 11.23}}},
  {"radau1a:s=2", 2, 1, {{0, 0}, {1.73265e-7, 3.005}, {-5.87725, -0.02935}, {0.0077237,
   0.998}}},
  {"radau1a:s=2", 3, 2, {{0.00672555, 1.977}, {6.92296e-8, 3.346}, {6627.12, -1.059},
   {-3.95726, 0.01268}}},
  {"radau1a:s=2", 4, 3, {{-6.82543, 0.964}, {0.000390099, 1.94}, {-6.57674e6, -2.105},
   {-1251.48, -1.066}}},
};
/* clang-format on */
enum { ROWS = sizeof rows / sizeof *rows, STEPS = 128 };

enum column { STAGE_H, STAGE_N, NODAL, POINT };

/* What rounding may do to a figure: the values of the layer (of the whole run for Gauss) times a
 * few eps, summed. */
static double blur(const row *r, enum column c)
{
  const double layer = pow(STEPS, r->k - 2), gauss = pow(STEPS, 2 * r->k - 3);
  if (c == POINT) return 6e-14 * STEPS * layer;
  if (c == STAGE_N) return 4e-15 * fmax(1, layer / 8);
  return 4e-15 * (r->method[0] == 'g' ? gauss : layer);
}

/* False if rounding decides the figure. */
static bool check(const row *r, enum column c, const steif_weak_row *seen)
{
  const double error = r->figure[c][0], order = r->figure[c][1], noise = blur(r, c);
  if (noise > 0.02 * fabs(error) && error != 0) return false;
  if (error == 0) {
    CLOSE_FLOOR(seen[1].error, 0.0, 1, 16 * noise);
    return true;
  }
  CLOSE(seen[1].error, error, 1e-5 + noise / fabs(error));
  CLOSE_FLOOR(seen[1].order, order, 6e-4 + 4 * noise / fabs(error), 1);
  return true;
}

/* Five smooth figures below 1e-11 (Gauss 3; Radau IIA 3, k > 2) are the rounding's. */
static void weak_column(enum column c, const char *name, enum steif_convention convention)
{
  steif_context *ctx = steif_context_new(NULL);
  int left_out = 0;
  for (int i = 0; i < ROWS; i++) {
    steif_weak_row seen[2];
    steif_weak_result result;
    CHECK(weak_rows(ctx, rows[i].method, rows[i].k, name, convention, NULL, 2.0 / STEPS, 2,
                    seen, &result) == STEIF_OK);
    left_out += !check(rows + i, c, seen);
  }
  CHECK(left_out == (c == STAGE_N ? 5 : 0));
  steif_context_free(&ctx);
}

static void stage_quadrature_of_an_impulse(void) { weak_column(STAGE_H, "H-inc", STEIF_STAGE); }
static void stage_quadrature_of_a_smooth_part(void)
{
  weak_column(STAGE_N, "N-cons", STEIF_STAGE);
}
static void nodal_values_of_an_impulse(void) { weak_column(NODAL, "H-inc", STEIF_R); }

static sunrealtype values[4][MOST * (STEPS + 1)];

static int layer(steif_context *ctx, const row *r, const char *name, sunrealtype h,
                 size_t steps, steif_layer_result *result)
{
  char problem[48];
  snprintf(problem, sizeof problem, "jordan:k=%d,case=%s", r->k, name);
  return steif_layer_measure(ctx, r->method, problem, NULL, h, steps, values[0], values[1],
                             values[2], values[3], result);
}

static void pointwise_at_one(void)
{
  steif_context *ctx = steif_context_new(NULL);
  for (int i = 0; i < ROWS; i++) {
    steif_weak_row seen[2] = {{0}};
    steif_layer_result result;
    for (size_t j = 0; j < 2; j++) {
      const size_t steps = (size_t)(STEPS / 2) << j, last = steps * (size_t)rows[i].k;
      CHECK(layer(ctx, rows + i, "N-inc", 1 / (double)steps, steps, &result) == STEIF_OK);
      seen[j].error = values[1][last] - values[2][last];
    }
    seen[1].order = log2(fabs(seen[0].error / seen[1].error));
    CHECK(check(rows + i, POINT, seen));
  }
  steif_context_free(&ctx);
}

/* The last node that differs from zero: ceil(k/m) - 1 for R(z) = O(z^-m); Crouzeix's R(inf) =
 * -0.73 and Gauss's |R(inf)| = 1 never reach zero (24 steps keep the former above 1e-9). */
static void layers_end_where_they_should(void)
{
  steif_context *ctx = steif_context_new(NULL);
  for (int i = 0; i < ROWS; i++) {
    steif_layer_result result;
    CHECK(layer(ctx, rows + i, "H-inc", 1.0 / STEPS, 24, &result) == STEIF_OK);
    CHECK(result.layer_steps == (rows[i].last < 24 ? rows[i].last : 24));
  }
  steif_context_free(&ctx);
}

/* Gauss at t = 1 grows like h^{-2(k-1)}: by 4^{k-1} when h is halved. */
static void gauss_never_forgets(void)
{
  steif_context *ctx = steif_context_new(NULL);
  for (int s = 1; s <= 3; s++)
    for (int k = 2; k <= 4; k++) {
      char method[16];
      double end[2];
      snprintf(method, sizeof method, "gauss:s=%d", s);
      const row r = {.method = method, .k = k};
      for (size_t j = 0; j < 2; j++) {
        const size_t steps = (size_t)(STEPS / 2) << j;
        steif_layer_result result;
        CHECK(layer(ctx, &r, "H-inc", 1 / (double)steps, steps, &result) == STEIF_OK);
        CHECK(result.layer_steps == (int)steps);
        end[j] = values[1][steps * (size_t)k];
      }
      CLOSE(end[1] / end[0], pow(4, k - 1), 0.01);
    }
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_rk[] = {
  {"stage quadrature of the impulse: errors and orders", stage_quadrature_of_an_impulse},
  {"stage quadrature of the smooth part: errors and orders", stage_quadrature_of_a_smooth_part},
  {"nodal values give a wrong strength", nodal_values_of_an_impulse},
  {"pointwise errors and orders at t = 1", pointwise_at_one},
  {"layers end at the node that theory gives", layers_end_where_they_should},
  {"Gauss grows by 4^(k-1) when h is halved", gauss_never_forgets},
  CU_TEST_INFO_NULL};
