/* law_order.c: the observed order of every listed method is the claimed one, on a linear and on a
 * nonlinear smooth problem. The baselines claim no single order.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "laws.h"
#include <sunmatrix/sunmatrix_dense.h>

/* u' = -2 t u^2, v' = 2 t u v with u = 1/(1 + t^2), v = 1 + t^2. */
static int f(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  const sunrealtype u = NV_Ith_S(y, 0), v = NV_Ith_S(y, 1);
  (void)user;
  NV_Ith_S(r, 0) = -2 * t * u * u;
  NV_Ith_S(r, 1) = 2 * t * u * v;
  return 0;
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
               N_Vector b, N_Vector c)
{
  const sunrealtype u = NV_Ith_S(y, 0), v = NV_Ith_S(y, 1);
  (void)fy, (void)user, (void)a, (void)b, (void)c;
  SM_ELEMENT_D(J, 0, 0) = -4 * t * u;
  SM_ELEMENT_D(J, 1, 0) = 2 * t * v;
  SM_ELEMENT_D(J, 1, 1) = 2 * t * u;
  return 0;
}

static int exact(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  NV_Ith_S(y, 0) = 1 / (1 + t * t);
  NV_Ith_S(y, 1) = 1 + t * t;
  return yp ? f(t, y, yp, user) : 0;
}

static const sunrealtype start[] = {1 / 1.36, 1.36};
static const steif_problem rational = {.name = "rational",
                                       .n = 2,
                                       .t0 = -0.6,
                                       .t1 = 1.4,
                                       .y0 = start,
                                       .f = f,
                                       .jac = jac,
                                       .exact = exact};

enum { ROWS = 8, HIGHEST = 7 };

/* The last order between errors above `floor`; NaN if there is none. */
static double observed(const steif_order_row *row, int rows, double floor)
{
  double order = NAN;
  for (int i = 1; i < rows; i++)
    if (row[i - 1].error > floor && row[i].error > floor) order = row[i].order;
  return order;
}

/* With exact start values, and Newton solved to rounding. */
static double measure(steif_context *ctx, const steif_problem *problem, const char *method,
                      double t1, double h, int rows)
{
  steif_order_row row[ROWS];
  steif_options o = steif_defaults();
  o.start = "exact", o.newton = 1e-6, o.t1 = t1;
  const int code = steif_order_measure(ctx, problem, method, &o, h, (size_t)rows, row);
  if (code != STEIF_OK) printf("\n  %s: %s", method, steif_message(ctx));
  return code == STEIF_OK ? observed(row, rows, 4e-12) : NAN;
}

static void linear_problem(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem harmonic;
  steif_method_info info;
  CU_ASSERT_FATAL(steif_problem_find(ctx, "harmonic", &harmonic) == STEIF_OK);
  for (size_t i = 0; steif_method_at(ctx, i, &info) == STEIF_OK; i++) {
    if (info.order == 0 || law_exponential(&info)) continue;
    const double order = measure(ctx, &harmonic, info.name, 6, 3, ROWS);
    /* R(z) may be of higher order than the method: of Rosenbrock methods, and nearly of dopri87, whose
     * b A^8 1 is 0.9987 / 9!. */
    const int higher = !strcmp(info.family, "rosenbrock") || !strcmp(info.name, "dopri87");
    const double excess = higher ? 1.2 : 0.2;
    const int good = order >= info.order - 0.2 && order <= info.order + excess;
    if (!good) printf("\n  %s: order %.3f", info.name, order);
    CHECK(good);
  }
  steif_problem_clear(ctx, &harmonic);
  steif_context_free(&ctx);
}

static void exponential_methods_are_exact(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem harmonic;
  steif_method_info info;
  steif_order_row row[2];
  steif_options o = steif_defaults();
  int seen = 0;
  o.t1 = 6;
  CU_ASSERT_FATAL(steif_problem_find(ctx, "harmonic", &harmonic) == STEIF_OK);
  for (size_t i = 0; steif_method_at(ctx, i, &info) == STEIF_OK; i++) {
    if (!law_exponential(&info)) continue;
    CHECK(steif_order_measure(ctx, &harmonic, info.name, &o, 3, 2, row) == STEIF_OK);
    if (!(row[0].error < 1e-14 && row[1].error < 1e-14))
      printf("\n  %s: %.2e, %.2e", info.name, row[0].error, row[1].error);
    CHECK(row[0].error < 1e-14 && row[1].error < 1e-14);
    seen++;
  }
  CHECK(seen == 9);
  steif_problem_clear(ctx, &harmonic);
  steif_context_free(&ctx);
}

/* Methods that split are measured on a problem that can be split, the pendulum. Above order HIGHEST
 * the first two errors are at rounding already. */
static void nonlinear_problem(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_method_info info;
  steif_problem pendulum;
  int seen = 0;
  CU_ASSERT_FATAL(steif_problem_find(ctx, "pendulum", &pendulum) == STEIF_OK);
  for (size_t i = 0; steif_method_at(ctx, i, &info) == STEIF_OK; i++) {
    if (info.order == 0 || info.order > HIGHEST) continue;
    if (!strcmp(info.name, "rodas4")) continue; /* its leading error nearly cancels here */
    const double order = strcmp(info.family, "sympl")
                           ? measure(ctx, &rational, info.name, 1.4, 0.25, ROWS - 1)
                           : measure(ctx, &pendulum, info.name, 10, 0.5, ROWS - 1);
    if (!(fabs(order - info.order) <= 0.2)) printf("\n  %s: order %.3f", info.name, order);
    CHECK(fabs(order - info.order) <= 0.2);
    seen++;
  }
  CHECK(seen > 15);
  steif_problem_clear(ctx, &pendulum);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_law_order[] = {
  {"on the harmonic oscillator the order is the claimed one", linear_problem},
  {"on the harmonic oscillator exponential methods are exact", exponential_methods_are_exact},
  {"on a nonlinear problem the order is the claimed one", nonlinear_problem},
  CU_TEST_INFO_NULL};
