/* test_newcomers.c: DAEs as they are first written down: no index, rough guesses, solved by auto to within ten
 * tolerances of a tight run.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"
#include <nvector/nvector_serial.h>
#include <steif/solver.h>
#include <stdlib.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

/* Prey and predators on a square, predators at once at their balance: idaFoodWeb of SUNDIALS (P. N. Brown, A. C.
 * Hindmarsh and L. R. Petzold, SIAM J. Sci. Comput. 19, 1998, 1495-1512), 20 x 20 points. Unknown 2 k is the prey,
 * 2 k + 1 the predator at point k. */
enum { SIDE = 20, N = 2 * SIDE * SIDE };

static int reflected(int i) { return i < 0 ? 1 : i >= SIDE ? SIDE - 2 : i; }

static double neighbours(const sunrealtype *c, int i, int j, int s)
{
  const int up = reflected(i + 1), down = reflected(i - 1), right = reflected(j + 1),
            left = reflected(j - 1);
  return c[2 * (up * SIDE + j) + s] + c[2 * (down * SIDE + j) + s] +
         c[2 * (i * SIDE + right) + s] + c[2 * (i * SIDE + left) + s] -
         4 * c[2 * (i * SIDE + j) + s];
}

static int food_web(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  static const double diffusion[] = {1, 0.05};
  const double dx = 1.0 / (SIDE - 1), pi = 3.14159265358979323846;
  const sunrealtype *c = N_VGetArrayPointer(y);
  (void)t, (void)user;
  for (int i = 0; i < SIDE; i++)
    for (int j = 0; j < SIDE; j++) {
      const double x = j * dx, z = i * dx;
      const double place = 1 + 50 * x * z + 1000 * sin(4 * pi * x) * sin(4 * pi * z);
      const sunrealtype *at = c + 2 * (i * SIDE + j);
      const double rate[] = {at[0] * (place - at[0] - 0.5e-6 * at[1]),
                             at[1] * (-place + 1e4 * at[0] - at[1])};
      for (int s = 0; s < 2; s++)
        NV_Ith_S(r, 2 * (i * SIDE + j) + s) =
          diffusion[s] * neighbours(c, i, j, s) / (dx * dx) + rate[s];
    }
  return 0;
}

static int of_prey(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  (void)t, (void)y, (void)yp;
  return steif_fill_diagonal(E, user);
}

static void start_of_the_web(sunrealtype *y, sunrealtype *d)
{
  for (int k = 0; k < N / 2; k++) {
    const double x = k % SIDE / (SIDE - 1.0), z = k / SIDE / (SIDE - 1.0);
    const double hill = 16 * x * (1 - x) * z * (1 - z);
    y[2 * k] = 10 + hill * hill;
    y[2 * k + 1] = 1e5;
    d[2 * k] = 1, d[2 * k + 1] = 0;
  }
}

/* Largest distance of the prey at t1 from `exact`, in tolerances; exact is filled where rtol is tight. */
static double web(const steif_problem *p, double rtol, sunrealtype *exact)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_options o = steif_defaults();
  double worst = 0;
  o.rtol = rtol;
  steif_solver *s = steif_solver_new(ctx, p, "auto", &o);
  CU_ASSERT_FATAL(s != NULL);
  CHECK(steif_initial_used(s)->moved > N / 4);
  CHECK(strstr(steif_initial_used(s)->message, "to fulfil e") != NULL);
  for (int k = 0; k < N / 2; k++) CHECK(steif_initial_used(s)->y[2 * k] == p->y0[2 * k]);
  const int code = steif_solve_to(s, p->t1);
  if (code) printf("\n  %s", steif_message(ctx));
  CHECK(code == STEIF_OK);
  const sunrealtype *y = N_VGetArrayPointer(steif_solution(s));
  for (int j = 0; j < N; j += 2) {
    if (rtol < 1e-9) exact[j] = y[j];
    worst = fmax(worst, fabs(y[j] - exact[j]) / (rtol * fabs(exact[j]) + rtol));
  }
  steif_solver_free(&s);
  steif_context_free(&ctx);
  return worst;
}

static void predators_are_found(void)
{
  static sunrealtype y0[N], d[N], exact[N];
  steif_context *ctx = steif_context_new(NULL);
  steif_pattern *pattern = NULL;
  start_of_the_web(y0, d);
  steif_problem p = {
    .name = "web", .n = N, .t1 = 0.01, .y0 = y0, .f = food_web, .E = of_prey, .user = d};
  CU_ASSERT_FATAL(!steif_pattern_find(ctx, &p, &pattern));
  p.pattern = pattern, p.storage = STEIF_SPARSE;
  web(&p, 1e-10, exact);
  for (double rtol = 1e-4; rtol > 0.9e-8; rtol *= 1e-2) CHECK(web(&p, rtol, exact) < 10);
  steif_pattern_free(ctx, &pattern);
  steif_context_free(&ctx);
}

/* x' = z, 0 = z^2 + x has no real z at x = 1: the equation is named, and nothing is said of steps and Jacobians that
 * the run met when it tried all the same. */
static int no_root(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  (void)t, (void)user;
  NV_Ith_S(r, 0) = NV_Ith_S(y, 1);
  NV_Ith_S(r, 1) = NV_Ith_S(y, 1) * NV_Ith_S(y, 1) + NV_Ith_S(y, 0);
  return 0;
}

static int of_x(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  SM_ELEMENT_D(E, 0, 0) = 1;
  return 0;
}

static void starts_that_are_not_found_name_the_equation(void)
{
  static const double y0[] = {1, 2};
  const steif_problem p = {.name = "none", .n = 2, .t1 = 1, .y0 = y0, .f = no_root, .E = of_x};
  static const char *const method[] = {"radau:s=3", "bdf", "auto"};
  for (int k = 0; k < 3; k++) {
    steif_context *ctx = steif_context_new(NULL);
    steif_solver *s = steif_solver_new(ctx, &p, method[k], NULL);
    CU_ASSERT_FATAL(s != NULL);
    CHECK(steif_solve_to(s, 1) == STEIF_NO_CONVERGENCE);
    CHECK(strstr(steif_message(ctx), "to fulfil e2 (off by 5)") &&
          !strstr(steif_message(ctx), "Jacobian"));
    steif_solver_free(&s);
    steif_context_free(&ctx);
  }
}

CU_TestInfo tests_of_newcomers[] = {
  {"predators of a food web are found", predators_are_found},
  {"starts that are not found name the equation", starts_that_are_not_found_name_the_equation},
  CU_TEST_INFO_NULL};
